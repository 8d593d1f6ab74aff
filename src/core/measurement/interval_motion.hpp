// The motion of the oscillator between two impacts, with its derivatives by the initial state, the
// forcing and the oscillator's parameters.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/measurement/measured_load.hpp"
#include "core/motion/flow.hpp"

namespace vines {

/// Motions from x = 1, from x' = 1, and from rest under a sine and a cosine that starts at `angle`.
std::array<Oscillation, 4> unit_motions(double angle);

/// N motions. The flow must outlive this object.
template <std::size_t N>
class FollowedFlow {
public:
    FollowedFlow(const Flow& flow, const std::array<Oscillation, N>& start)
        : flow_(flow),
          start_(start),
          far_(start) {}

    /// Motions at a time s >= 0 after the start; x'' is 0 unless `with_acceleration`.
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
                o.sin_theta == 0 && o.cos_theta == 0 ? 0 : flow_.rotated(o, d).sin_theta;
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
            series_[k] = flow_.short_series(near_[k]);
        }
    }

    const Flow& flow_;
    const std::array<Oscillation, N> start_;
    // Motions after `looks_` table lengths, and at the start of the current cell.
    std::array<Oscillation, N> far_, near_{};
    std::array<Flow::ShortSeries, N> series_;  // within the cell
    int looks_ = 0, cell_ = -1;
};

/// The direction in which the mass slides during a flight, sign(y' - x').
struct Sliding {
    double first = 0;                ///< at the start; 0: unknown
    std::vector<double> turns = {};  ///< times since the start at which it reverses
    // Means over the flight: plainly, and weighted with the time to its end and since its start,
    // over its duration. Friction lifts y' at the start, and lowers it at the end, by its
    // deceleration times the last two and the duration.
    double mean = 0, to_end = 0, from_start = 0;

    /// Constant, on the way between two walls; unknown on one back to the same wall.
    static Sliding between(int from_side, int to_side) {
        const double direction = 0.5 * (from_side - to_side);
        return {direction, {}, direction, 0.5 * direction, 0.5 * direction};
    }
};

/// An interval between impacts, with its state after the impact.
struct FittedInterval {
    double tau, x, x_dot;
    bool sticks = false;  ///< the free mass moves with the oscillator
    Sliding sliding = {};
    double pull = 0;  ///< |acceleration| of the oscillator by a given friction of the mass
};

/// A flow with the response to a load's excess, if there is one.
struct LoadedFlow {
    /// Stiffness and damping exceed `values` by these amounts. `mass`: moving mass divided by m1.
    LoadedFlow(
        const UnknownValues& values, double stiffer, double more_damped, double force, double mass,
        const LoadResponse::Excess* excess);
    /// Response to the load alone, tabulated from rest before the record; 0 without a load.
    OscillatorMotion load_at(double sigma, double force_sin, double force_cos) const;

    Flow flow;
    std::optional<LoadResponse> response;
};

/// Flows of the oscillator: with the values themselves, and with k and c each slightly increased.
struct OscillatorFlows {
    /// `oscillator_moves`: whether derivatives by k and c are needed. `excess`: of a load, or null.
    OscillatorFlows(
        const UnknownValues& values, bool oscillator_moves, double mass = 1,
        const LoadResponse::Excess* excess = nullptr);

    bool oscillator_moves;
    double force, phase, Omega;  ///< amplitude of the forcing, m, and its phase at tau_m
    LoadedFlow parts, by_stiffness, by_damping;
};

/// Flows of both kinds of interval: free, and sticking.
struct IntervalFlows {
    /// `load`: null if the forcing is a sine.
    IntervalFlows(
        const UnknownValues& values, bool oscillator_moves, double epsilon,
        const MeasuredLoad* load);
    const OscillatorFlows& of(const FittedInterval& i) const { return i.sticks ? stuck : free; }

    std::optional<LoadResponse::Excess> excess;
    OscillatorFlows free, stuck;
};

/// A motion with its derivatives.
struct MotionRow {
    OscillatorMotion value;
    std::array<OscillatorMotion, 4> parts;  ///< derivatives by x and x' at the start, f_s and f_c
    OscillatorMotion by_Omega, by_stiffness, by_damping;
};

/// The motion in one interval. The flows must outlive this object.
class IntervalMotion {
public:
    IntervalMotion(
        const OscillatorFlows& flows, const UnknownValues& values, double tau_middle,
        const FittedInterval& interval);

    /// Motion at a time s >= 0 after the start; x'' is valid only `with_acceleration`.
    MotionRow at(double s, bool with_acceleration);

private:
    void add_load(double s, std::array<OscillatorMotion, 4>& parts) const;
    void add_pull(double s, OscillatorMotion& m) const;
    std::array<Oscillation, 1> whole(const LoadedFlow& flow) const;
    OscillatorMotion derivative(
        const LoadedFlow& flow, const OscillatorMotion& moved, double s,
        const OscillatorMotion& plain) const;

    const OscillatorFlows& flows_;
    const double since_middle_;
    const std::array<double, 4> start_;
    FollowedFlow<4> parts_;
    LoadResponse::Motion load_at_start_;
    FollowedFlow<1> by_stiffness_, by_damping_;
    /// A constant force from a time on: the position of rest moves, and the oscillator follows.
    struct Step {
        double from, displaced;
    };
    std::vector<Step> pulls_;
};

using UnknownRow = Eigen::Matrix<double, 1, sensed_unknowns>;
inline double& element(UnknownRow& row, Unknown u) { return row(static_cast<Eigen::Index>(u)); }

/// Derivatives of one of x, x', x'' by the initial state and by the unknowns; 0 for unknowns
/// that do not affect the motion.
struct MotionDerivatives {
    MotionDerivatives(const MotionRow& row, double OscillatorMotion::* member);

    Eigen::RowVector2d by_start;
    UnknownRow by_unknowns = UnknownRow::Zero();
};

}  // namespace vines
