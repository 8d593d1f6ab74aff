// Motions of one flow, followed from a start: at moments in order each cell of the flow's table is
// looked up once.
#pragma once

#include <algorithm>
#include <array>

#include "core/motion/flow.hpp"

namespace vines {

/// x and its derivatives.
struct OscillatorMotion {
    double x, x_dot, x_ddot;
};

/// N motions. The flow outlives it.
template <std::size_t N>
class FollowedFlow {
public:
    FollowedFlow(const Flow& flow, const std::array<Oscillation, N>& start)
        : flow_(flow),
          start_(start),
          far_(start) {}

    /// At a time s >= 0 after the start. `with_acceleration`: else x'' is 0, and costs nothing.
    std::array<OscillatorMotion, N> at(double s, bool with_acceleration) {
        int looks = 0;
        for (; s >= flow_.reach(); s -= flow_.reach()) ++looks;
        const int cell = static_cast<int>(s / flow_.cell());
        if (looks != looks_ || cell != cell_) look_up(looks, cell);
        const double d = std::max(0.0, s - cell * flow_.cell());
        std::array<OscillatorMotion, N> motions;
        for (std::size_t k = 0; k < N; ++k) {
            const auto [x, x_dot] = series_[k].at(d);
            motions[k] = {x, x_dot, 0};
            if (!with_acceleration) continue;
            const Oscillation& o = near_[k];
            const double sine =
                o.sin_theta == 0 && o.cos_theta == 0 ? 0 : flow_.turned(o, d).sin_theta;
            motions[k].x_ddot = flow_.acceleration({x, x_dot, sine, 0});
        }
        return motions;
    }

private:
    void look_up(int looks, int cell) {
        if (looks < looks_) far_ = start_, looks_ = 0;
        for (; looks_ < looks; ++looks_)
            for (Oscillation& part : far_) part = flow_.at(part, Flow::cells);
        cell_ = cell;
        for (std::size_t k = 0; k < N; ++k) {
            near_[k] = flow_.at(far_[k], cell);
            series_[k] = flow_.near_series(near_[k]);
        }
    }

    const Flow& flow_;
    const std::array<Oscillation, N> start_;
    // What the motions are behind so many of the flow's reaches, and then at a cell's start.
    std::array<Oscillation, N> far_, near_{};
    std::array<Flow::Near, N> series_;  // within the cell
    int looks_ = 0, cell_ = -1;
};

}  // namespace vines
