#include "core/identification/oscillator_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/elementary.hpp"

namespace vines {

OscillatorModel::OscillatorModel(const Parameters& p)
    : damping_(2 * p.zeta()),
      Omega_(p.Omega),
      flow_(1, 2 * p.zeta(), 1, p.Omega) {}

OscillatorModel::Interval::Interval(const OscillatorModel& model, double tau)
    : model_(model),
      start_([&model, tau] {
          const double sin = elementary::sin(model.Omega_ * tau),
                       cos = elementary::cos(model.Omega_ * tau);
          return Parts{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, sin, cos}, {0, 0, cos, -sin}}};
      }()),
      far_(start_) {}

void OscillatorModel::Interval::look_up(int looks, int cell) {
    const Flow& flow = model_.flow_;
    if (looks < looks_) far_ = start_, looks_ = 0;
    for (; looks_ < looks; ++looks_)
        for (Oscillation& part : far_) part = flow.at(part, Flow::cells);
    cell_ = cell;
    for (std::size_t k = 0; k < far_.size(); ++k) {
        near_[k] = flow.at(far_[k], cell);
        series_[k] = flow.near_series(near_[k]);
    }
}

ModelRows OscillatorModel::Interval::at(double s) {
    const Flow& flow = model_.flow_;
    int looks = 0;
    for (; s >= flow.reach(); s -= flow.reach()) ++looks;
    const int cell = static_cast<int>(s / flow.cell());
    if (looks != looks_ || cell != cell_) look_up(looks, cell);
    const double d = std::max(0.0, s - cell * flow.cell());
    // The last part of the motion is forced a quarter of a turn ahead of the one before it.
    const Oscillation turned = flow.turned(near_[2], d);
    const double force[] = {0, 0, turned.sin_theta, turned.cos_theta};
    ModelRows rows;
    for (std::size_t k = 0; k < series_.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        const auto [x, x_dot] = series_[k].at(d);
        rows.x(row) = x;
        rows.x_dot(row) = x_dot;
        rows.x_ddot(row) = -x - model_.damping_ * x_dot + force[k];
    }
    return rows;
}

}  // namespace vines
