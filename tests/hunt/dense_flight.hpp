// Check of a free flight by dense sampling. The motion is computed by Taylor series in long double,
// from the coefficients of the equation of motion alone, and is therefore independent of the tables
// and proofs of the contact search under test.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/motion/contact_search.hpp"

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

    /// 1/200 of the shortest period of forcing, oscillator and damper. Over twenty steps a series
    /// has an error below 1e-17 of the motion.
    Real step() const { return step_; }
    Series series(const Place& place) const;
    /// State one step later.
    Place next(const Place& place) const;
    Place after(Place place, Real s) const;
    /// Bound of |x''| over the next step, from the growth of the energy.
    Real acceleration_bound(const Place& place) const;
    Real forcing() const { return forcing_; }
    Real damping() const { return damping_; }

private:
    Place by_series(const Place& place, Real d) const;

    const Real stiffness_, damping_, forcing_, Omega_, step_;
    std::array<Place, 4> over_step_;  // fundamental solutions over one step: one for each component
                                      // of a place, set to 1
};

SeriesMotion::Place place_of(const Oscillation& lo);

/// Error in the result of a contact search, if any.
struct FlightJudgement {
    std::string wrong;  ///< empty: none
    /// Largest excess of x - y over a wall before the contact (or the end of the search), or
    /// distance from the wall at the contact, relative to the allowed rounding.
    long double worst = 0;
};

/// Samples the flight up to the contact found, or to `limit` if none was found, and refines where a
/// wall can be crossed between two samples, until a bound of the curvature proves that it is not.
/// Allowed rounding: 16 ulp of the terms of the positions; for the flight's own wall within the
/// first cell of the search, 16 ulp of the terms of (x - y - side b)/s, so that the tiny hops of a
/// chatter are checked relative to their own size.
FlightJudgement judge_flight(
    const Flow& flow, const FlightStart& start, double b, double limit,
    const std::optional<Contact>& found);

}  // namespace vines::hunt
