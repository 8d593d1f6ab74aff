// A free flight judged by dense sampling: its motion in Taylor series of long double, from the
// coefficients of the equation of motion alone, so that it shares nothing with the tables and the
// proofs of the search for contacts that it judges.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/motion/guard.hpp"

namespace vines::hunt {

/// The motion x'' = -stiffness x - damping x' + forcing sin theta, theta' = Omega.
class SeriesMotion {
public:
    using Real = long double;
    struct Place {
        Real x, x_dot, sin, cos;
    };
    /// Taylor coefficients of x about a place.
    static constexpr int terms = 30;
    using Series = std::array<Real, terms>;

    explicit SeriesMotion(const Flow::Coefficients& coefficients);

    /// 1/200 of the period of the fastest of forcing, oscillator and damper; a series reaches
    /// twenty of them with an error below 1e-17 of the motion.
    Real step() const { return step_; }
    Series series(const Place& place) const;
    /// A step further.
    Place next(const Place& place) const;
    Place after(Place place, Real s) const;
    /// Of |x''| over the next step, by the growth of the energy.
    Real most_acceleration(const Place& place) const;
    Real forcing() const { return forcing_; }
    Real damping() const { return damping_; }

private:
    Place by_series(const Place& place, Real d) const;

    const Real stiffness_, damping_, forcing_, Omega_, step_;
    std::array<Place, 4> over_step_;  // what each part of a place, of size 1 and alone, becomes
};

SeriesMotion::Place place_of(const Oscillation& lo);

/// What a search for the next contact claimed, and what is wrong with it.
struct FlightJudgement {
    std::string wrong;  ///< empty: nothing
    /// By how much x - y is beyond a wall at the most before the contact that was found (or the end
    /// of the search), or off the wall at it: over the rounding that is allowed.
    long double worst = 0;
};

/// Samples the flight up to the contact, or to `limit` where none was found, and refines wherever a
/// wall may be passed between two samples: until a bound of the curvature proves that it is not.
/// What is allowed: 16 ulp of the positions' terms; of the flight's own wall, within the first cell
/// of the search, 16 ulp of the terms of (x - y - side b)/s, so that a chatter's hops are judged
/// relative to themselves.
FlightJudgement judge_flight(
    const Flow& flow, const FlightStart& start, double b, double limit,
    const std::optional<Contact>& found);

}  // namespace vines::hunt
