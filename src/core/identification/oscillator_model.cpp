#include "core/identification/oscillator_model.hpp"

#include "core/motion/elementary.hpp"

namespace vines {

OscillatorModel::OscillatorModel(const Parameters& p)
    : damping_(2 * p.zeta()),
      Omega_(p.Omega),
      flow_(1, 2 * p.zeta(), 1, p.Omega) {}

ModelRows OscillatorModel::at(double tau, double s) const {
    const double sin = elementary::sin(Omega_ * tau), cos = elementary::cos(Omega_ * tau);
    const Oscillation parts[4] = {
        flow_.after({1, 0, 0, 0}, s), flow_.after({0, 1, 0, 0}, s),
        flow_.after({0, 0, sin, cos}, s), flow_.after({0, 0, cos, -sin}, s)};
    ModelRows rows;
    for (int k = 0; k < 4; ++k) {
        rows.x(k) = parts[k].x;
        rows.x_dot(k) = parts[k].x_dot;
        rows.x_ddot(k) =
            -parts[k].x - damping_ * parts[k].x_dot + (k >= 2 ? parts[k].sin_theta : 0);
    }
    return rows;
}

}  // namespace vines
