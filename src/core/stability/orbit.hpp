// Periodic orbits of the forced system, by Newton's method on the return after whole cycles. The
// derivative of the return map is the product of the transfer matrices over the period (monodromy
// matrix); its eigenvalues, the Floquet multipliers, lie inside the unit circle for a stable orbit.
#pragma once

#include <optional>

#include "core/motion/elementary.hpp"
#include "core/stability/linear.hpp"
#include "core/stability/lyapunov.hpp"

namespace vines {

/// Scale of each component of a state: about the largest value that it takes.
State scale_of(const Parameters& parameters, std::span<const State> states);
/// Largest difference of a component, in units of its scale.
double distance(const State& a, const State& b, const State& scale);

struct PeriodicOrbit {
    int cycles;      ///< smallest period, in forcing cycles
    double tau;      ///< a time within a flight, 0 <= tau < 2 pi/Omega
    State state;     ///< state at tau
    double closure;  ///< distance between the state and its return
    /// Impacts per period; a chatter that ends in sticking counts once.
    long contacts;
    long impacts, sticks;  ///< all, per period
    bool symmetric;        ///< x(tau + half the period) = -x(tau), and y alike
    Eigenvalues multipliers;

    Eigen::Matrix4d monodromy;  ///< derivative of the return map at `state`

    bool stable() const { return elementary::modulus(multipliers[0]) < 1; }
    /// ln|multiplier| / period: those of every motion that the orbit attracts.
    Exponents exponents(const Parameters& parameters) const;
};

/// Product of all transfer matrices of a run.
class Monodromy : public Observer {
public:
    explicit Monodromy(const Parameters& p) : p_(p) {}
    void on_stretch(const Stretch& stretch) override {
        const Leg leg = leg_of(stretch);
        for (long part = 0; part < leg.parts; ++part) carry(matrix, leg, p_.epsilon);
    }
    void on_impact(const Impact& impact) override { matrix = saltation(p_, impact).times(matrix); }
    void on_slip(const Slip& slip) override { matrix = saltation(p_.epsilon, slip).times(matrix); }

    Frame matrix = Frame::Identity();

private:
    const Parameters p_;
};

/// The middle of the longest flight in the cycle after a state at a whole cycle: far from events.
double time_far_from_events(const Parameters& p, const State& start, const StopRequest& stop);

/// The state at tau + duration of a motion from tau; nullopt after too many impacts or a stop.
std::optional<State> follow(
    const Parameters& parameters, const State& start, double tau, double duration,
    const StopRequest& stop, std::initializer_list<Observer*> observers = {});

/// The orbit of that period or a divisor that Newton's method finds within `reach`.
std::optional<PeriodicOrbit> find_orbit(
    const Parameters& parameters, const State& at_whole_cycle, int cycles, const State& scale,
    double reach, const StopRequest& stop);

/// At this distance a motion stays: a chance return would take 1e16 cycles or more.
inline constexpr double on_the_orbit = 1e-8;

/// True if a stable orbit attracts the motion from a state at a whole cycle: followed, it comes
/// closer than chance can explain, or, if the orbit contracts too slowly for that, agrees with its
/// linear map much more precisely than the map contracts.
bool attracts(
    const Parameters& parameters, const PeriodicOrbit& orbit, const State& at_whole_cycle,
    const State& scale, const StopRequest& stop);

/// The orbit's states at the whole cycles 1, ..., orbit.cycles after `tau`.
std::vector<State> whole_cycle_states(const Parameters& parameters, const PeriodicOrbit& orbit);

}  // namespace vines
