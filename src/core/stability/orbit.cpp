#include "core/stability/orbit.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

// Orbits with more impacts per period are not searched for.
constexpr long most_orbit_impacts = 20000;
// Newton's method has converged when the return differs by at most this, in units of the scale.
constexpr double return_tolerance = 1e-10;
// Rounding prevents anything closer; it is reached, too, by a step that does not reduce the miss to
// a tenth, because convergence near the orbit is quadratic.
constexpr double rounding_tolerance = 1e-14, least_improvement = 0.1;
// Limits of Newton's method: steps, steps that increase the miss, halvings of a step out of the
// cavity, stretching of deviations in units of the scale. Beyond most_stretch an ulp of the state
// moves its return by more than `return_tolerance`, as in a chaotic motion after many cycles.
constexpr int most_steps = 25, most_worse_steps = 2, most_halvings = 6;
constexpr double most_stretch = 1e6;
// A divisor of the period also closes if the state returns to within this distance.
constexpr double divisor_tolerance = 1e3 * return_tolerance;
// Below this fraction of the largest eigenvalue the solver loses more than six digits.
constexpr double small_multiplier = 1e-6;
// Smallest scales, in units of b. A ball that meets both walls is hardly slower.
constexpr double least_scale = 1e-9, least_ball_speed = 0.1;
// Rounding of a contact's tau, as a fraction of a period; it must not be counted twice.
constexpr double contact_rounding = 1e-9;
// Distance, in units of the scale, of the state after half a period from the mirrored one.
constexpr double symmetric_within = 1e-6;

/// Exterior powers of that product.
class Powers : public Observer {
public:
    explicit Powers(const Parameters& p) : product(p.epsilon), p_(p) {}
    void on_stretch(const Stretch& stretch) override { product.pass(leg_of(stretch)); }
    void on_impact(const Impact& impact) override { product.strike(saltation(p_, impact)); }
    void on_slip(const Slip& slip) override { product.strike(saltation(p_.epsilon, slip)); }

    PowerProduct product;

private:
    const Parameters p_;
};

/// Eigenvalues; the exterior powers give the moduli of small ones.
Eigenvalues multipliers_of(const Matrix4& monodromy, const PowerProduct& powers) {
    Eigenvalues values = eigenvalues_of(monodromy);
    const auto logs = powers.log_moduli();
    for (int k = 0; k < 4; ++k) {
        const double modulus = elementary::modulus(values[k]);
        if (k >= powers.rank() || modulus == 0) values[k] = 0;
        else if (
            modulus < small_multiplier * elementary::modulus(values[0]) && std::isfinite(logs[k]))
            values[k] *= elementary::exp(logs[k]) / modulus;
    }
    return values;
}

/// The longest part of a run without an event.
class LongestFlight : public Observer {
public:
    explicit LongestFlight(double otherwise) : middle(otherwise) {}

    void on_impact(const Impact& impact) override { flight_to(impact.tau); }
    void on_slip(const Slip& slip) override { flight_to(slip.tau); }
    // The rest of a chatter and the sticking phase after it are not a flight.
    void on_release(double tau) override { from_ = std::max(from_, tau); }
    void on_stretch(const Stretch& s) override {
        if (s.rests_inside()) from_ = std::max(from_, s.tau + s.duration);
    }
    void flight_to(double tau) {
        if (tau - from_ > length_) length_ = tau - from_, middle = 0.5 * (from_ + tau);
        from_ = std::max(from_, tau);
    }

    double middle;  ///< its middle

private:
    double from_ = 0, length_ = 0;
};

/// Newton's method, in coordinates scaled to order one.
std::optional<State> solve_return(
    const Parameters& p, State s, double tau, int cycles, const State& scale, double reach,
    const StopRequest& stop) {
    const State guess = s;
    const Eigen::Vector4d unit = vector_of(scale);
    double miss_before = infinity;
    for (int step = 0, worse = 0; step < most_steps; ++step) {
        Monodromy monodromy(p);
        if (std::abs(s.x - s.y) > p.b) return std::nullopt;
        const auto back = follow(p, s, tau, cycles * p.cycle(), stop, {&monodromy});
        if (!back) return std::nullopt;
        const Eigen::Vector4d miss = (vector_of(*back) - vector_of(s)).cwiseQuotient(unit);
        const double size = miss.cwiseAbs().maxCoeff();
        if (size < rounding_tolerance ||
            (size < return_tolerance && size > least_improvement * miss_before))
            return s;
        if (size > miss_before && ++worse > most_worse_steps) return std::nullopt;
        miss_before = size;
        const Matrix4 M = monodromy.matrix, D = unit.asDiagonal().inverse() *
                                                (M - Matrix4::Identity()) * unit.asDiagonal();
        // The spectral radius is at most the norm, in any units.
        if (!(D.norm() < most_stretch) && (!M.allFinite() || spectral_radius(M) >= most_stretch))
            return std::nullopt;
        // Neutral directions (a ball at rest, never hit) are left unchanged: the minimum-norm step.
        Eigen::Vector4d correction = -minimum_norm_solution(D, miss);
        State next = state_of(vector_of(s) + correction.cwiseProduct(unit));
        for (int half = 0; half < most_halvings && std::abs(next.x - next.y) > p.b; ++half) {
            correction *= 0.5;
            next = state_of(vector_of(s) + correction.cwiseProduct(unit));
        }
        s = next;
        if (!(distance(s, guess, scale) < reach)) return std::nullopt;
    }
    return std::nullopt;
}

/// Sets the smallest period and the results of the monodromy matrix over it; false if stopped.
bool find_smallest_period(
    const Parameters& p, int cycles, const State& scale, const StopRequest& stop,
    PeriodicOrbit& orbit) {
    for (int divisor = 1; divisor <= cycles; ++divisor) {
        if (cycles % divisor != 0) continue;
        Monodromy monodromy(p);
        Powers powers(p);
        const auto back =
            follow(p, orbit.state, orbit.tau, divisor * p.cycle(), stop, {&monodromy, &powers});
        if (!back) return false;
        orbit.closure = distance(*back, orbit.state, scale);
        if (divisor < cycles && orbit.closure > divisor_tolerance) continue;
        orbit.cycles = divisor;
        orbit.monodromy = monodromy.matrix;
        orbit.multipliers = multipliers_of(orbit.monodromy, powers.product);
        break;
    }
    return true;
}

/// Counts the events in a period; false if the search was stopped.
bool count_period(const Parameters& p, const StopRequest& stop, PeriodicOrbit& orbit) {
    // Counts one of three periods from the first contact after a release: no chatter is cut.
    ContactRecord contacts;
    ImpactRecord impacts;
    const double period = orbit.cycles * p.cycle();
    if (!follow(p, orbit.state, orbit.tau, 3 * period, stop, {&contacts, &impacts})) return false;
    double from = contacts.sticks.empty() ? orbit.tau : contacts.sticks[0].to;
    const auto first = std::ranges::lower_bound(contacts.contacts, from, {}, &ContactEvent::tau);
    if (first != contacts.contacts.end()) from = first->tau;
    const double to = from + period * (1 - contact_rounding);
    const auto within = [&](double t) { return t >= from && t < to; };
    orbit.contacts = std::ranges::count_if(
        contacts.contacts, [&](const ContactEvent& c) { return within(c.tau); });
    orbit.impacts =
        std::ranges::count_if(impacts.entries, [&](const Impact& i) { return within(i.tau); });
    orbit.sticks =
        std::ranges::count_if(contacts.sticks, [&](const auto& s) { return within(s.from); });
    return true;
}

/// After half a period the forcing has the opposite sign only if the period is an odd number of
/// cycles. Unequal walls can leave the motion between chatters symmetric, but not the chatters.
bool is_symmetric(
    const Parameters& p, const PeriodicOrbit& orbit, const State& scale, const StopRequest& stop) {
    if (orbit.cycles % 2 == 0 || (!p.has_equal_walls() && orbit.impacts != 0)) return false;
    const auto half = follow(p, orbit.state, orbit.tau, 0.5 * orbit.cycles * p.cycle(), stop);
    return half && distance(state_of(-vector_of(*half)), orbit.state, scale) < symmetric_within;
}

/// z^n, n > 0, by squaring.
std::complex<double> power(std::complex<double> z, int n) {
    std::complex<double> result = 1;
    for (; n > 0; n /= 2, z *= z)
        if (n % 2 == 1) result *= z;
    return result;
}

/// Deviations from an orbit in eigenvector coordinates of its monodromy matrix, where they shrink
/// per period by the multipliers' moduli.
class EigenCoordinates {
public:
    EigenCoordinates(const PeriodicOrbit& orbit, const State& scale, bool oscillator_alone)
        : at_(vector_of(orbit.state)),
          unit_(vector_of(scale)) {
        Matrix4 D = unit_.asDiagonal().inverse() * orbit.monodromy * unit_.asDiagonal();
        if (oscillator_alone) D.bottomRows<2>().setZero(), D.rightCols<2>().setZero();
        base_ = eigen_basis_of(D);
    }
    Eigen::Vector4cd of(const State& s) const {
        return base_.to_coordinates * (vector_of(s) - at_).cwiseQuotient(unit_);
    }
    Eigen::Vector4cd after(Eigen::Vector4cd deviation, int periods) const {
        for (int k = 0; k < 4; ++k) deviation(k) *= power(base_.values(k), periods);
        return deviation;
    }
    bool usable() const { return base_.to_coordinates.allFinite(); }

private:
    const Eigen::Vector4d at_, unit_;
    EigenBasis base_;
};

// Time constants of a convergence from order one to on_the_orbit, and periods before it is linear.
constexpr double decay_times = 24;
constexpr int more_periods = 20;
// Longest time that a motion is followed, in cycles, but at least least_periods periods.
constexpr int most_cycles = 4000, least_periods = 30;
// If that is too short, the motion must agree with the orbit's linear map in each of `spans`
// intervals, to this fraction of the contraction.
constexpr int spans = 3;
constexpr double linear_return_share = 0.2;
// ln of the smallest contraction per period that is more than rounding.
constexpr double least_contraction = 1e-9;

}  // namespace

double time_far_from_events(const Parameters& p, const State& start, const StopRequest& stop) {
    const double cycle = p.cycle();
    LongestFlight longest(0.5 * cycle);
    follow(p, start, 0, cycle, stop, {&longest});
    longest.flight_to(cycle);
    return longest.middle;
}

State scale_of(const Parameters& p, std::span<const State> states) {
    State scale{least_scale * p.b, least_scale * p.b, least_ball_speed * p.b, p.b};
    for (const State& s : states)
        scale = {
            std::max(scale.x_dot, std::abs(s.x_dot)), std::max(scale.x, std::abs(s.x)),
            std::max(scale.y_dot, std::abs(s.y_dot)), scale.y};
    // At a given phase of the forcing either can pass through zero.
    scale.x = scale.x_dot = std::max(scale.x, scale.x_dot);
    return scale;
}

double distance(const State& a, const State& b, const State& scale) {
    return (vector_of(a) - vector_of(b)).cwiseQuotient(vector_of(scale)).cwiseAbs().maxCoeff();
}

Exponents PeriodicOrbit::exponents(const Parameters& p) const {
    Exponents lambda;
    // A multiplier that is zero up to rounding is zero: the orbit sticks, or R = 0.
    for (int k = 0; k < 4; ++k)
        lambda[k] = elementary::log(elementary::modulus(multipliers[k])) / (cycles * p.cycle());
    return lambda;
}

std::optional<State> follow(
    const Parameters& p, const State& start, double tau, double duration, const StopRequest& stop,
    std::initializer_list<Observer*> observers) {
    const Outcome outcome =
        simulate(p, start, {tau + duration, most_orbit_impacts, stop, tau}, observers);
    if (outcome.reason != End::tau_end) return std::nullopt;
    return outcome.state;
}

std::optional<PeriodicOrbit> find_orbit(
    const Parameters& p, const State& at_whole_cycle, int cycles, const State& scale, double reach,
    const StopRequest& stop) {
    const double tau = time_far_from_events(p, at_whole_cycle, stop);
    const auto guess = follow(p, at_whole_cycle, 0, tau, stop);
    if (!guess) return std::nullopt;
    const auto found = solve_return(p, *guess, tau, cycles, scale, reach, stop);
    if (!found) return std::nullopt;
    PeriodicOrbit orbit{};
    orbit.tau = tau;
    orbit.state = *found;
    if (!find_smallest_period(p, cycles, scale, stop, orbit) || !count_period(p, stop, orbit))
        return std::nullopt;
    orbit.symmetric = is_symmetric(p, orbit, scale, stop);
    return orbit;
}

bool attracts(
    const Parameters& p, const PeriodicOrbit& orbit, const State& at_whole_cycle,
    const State& scale, const StopRequest& stop) {
    // Without impacts the ball has two multipliers 1, and only the oscillator converges.
    const bool untouched = orbit.contacts == 0 && orbit.state.y_dot == 0;
    const double largest =
        untouched ? spectral_radius(Eigen::Matrix2d(orbit.monodromy.topLeftCorner<2, 2>()))
                  : elementary::modulus(orbit.multipliers[0]);
    const double per_period = -elementary::log(largest);
    if (!(per_period > least_contraction)) return false;
    std::optional<State> s = follow(p, at_whole_cycle, 0, orbit.tau, stop);
    auto distance_to_orbit = [&] { return distance(*s, orbit.state, scale); };
    auto pass = [&](int periods) {
        for (int k = 0; k < periods && s && distance_to_orbit() >= on_the_orbit; ++k)
            s = follow(p, *s, orbit.tau, orbit.cycles * p.cycle(), stop);
        return s.has_value();
    };
    if (!s) return false;

    const int most_periods = std::max(most_cycles / orbit.cycles, least_periods);
    const double needed = decay_times / per_period + more_periods;
    if (needed <= most_periods)
        return pass(static_cast<int>(needed)) && distance_to_orbit() < on_the_orbit;

    const EigenCoordinates coordinates(orbit, scale, untouched);
    if (!coordinates.usable()) return false;
    const int periods = most_periods / spans;
    const double contraction = 1 - elementary::pow(largest, periods);
    for (int span = 0; span < spans; ++span) {
        const Eigen::Vector4cd before = coordinates.of(*s),
                               linear = coordinates.after(before, periods);
        if (!pass(periods)) return false;
        if (distance_to_orbit() < on_the_orbit) return true;
        if ((coordinates.of(*s) - linear).norm() >
            linear_return_share * contraction * before.norm())
            return false;
    }
    return true;
}

std::vector<State> whole_cycle_states(const Parameters& p, const PeriodicOrbit& orbit) {
    StroboscopicRecord record(p, {.first = 1});
    follow(p, orbit.state, orbit.tau, (orbit.cycles + 0.5) * p.cycle(), {}, {&record});
    record.states.resize(orbit.cycles);
    return record.states;
}

}  // namespace vines
