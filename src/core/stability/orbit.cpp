#include "core/stability/orbit.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/contacts.hpp"
#include "core/motion/elementary.hpp"
#include "core/motion/record.hpp"
#include "core/motion/special_values.hpp"
#include "core/stability/linear.hpp"

namespace vines {

namespace {

// A period with more impacts than this is not looked for.
constexpr long most_orbit_impacts = 20000;
// Newton's method has found the orbit when its return misses it by no more, in units of the scale.
constexpr double closed = 1e-10;
// Closer than this it cannot come: some ulps of a state of order one. Before that, a step which
// does not shrink the miss to a tenth has met rounding: near the orbit it would square it.
constexpr double closed_to_rounding = 1e-14, converging = 0.1;
// Newton's method gives up after so many steps, or so many that led further away; a step out of the
// cavity is halved so many times. And where the motion stretches deviations by more, in units of
// the scale: an ulp of the state alone then moves its return by more than `closed`. It is so at
// returns of a chaotic motion after many cycles, of which half of all steps were.
constexpr int most_steps = 25, most_worse_steps = 2, most_halvings = 6;
constexpr double most_stretch = 1e6;
// A divisor of the period closes, too, if the state misses itself by no more than this.
constexpr double divisor_closed = 1e3 * closed;
// An eigenvalue this much smaller than the largest one has lost six digits to the solver's error,
// an ulp of the largest: the exterior powers know its modulus better.
constexpr double small_multiplier = 1e-6;
// What a motion is measured by at least, in b: less is rest. And the free mass is never slower, by
// order of magnitude, than b per half cycle where it meets both walls.
constexpr double least_scale = 1e-9, least_mass_speed = 0.1;
// A contact's tau is known to rounding, which must not count it twice: share of a period.
constexpr double contact_rounding = 1e-9;
// An orbit is symmetric if its state after half a period is the opposite one to this, in units of
// the scale: far above what it closes to, far below what an asymmetry of any use would be.
constexpr double symmetric_within = 1e-6;

Eigen::Vector4d vector(const State& s) { return {s.x_dot, s.x, s.y_dot, s.y}; }
State state(const Eigen::Vector4d& v) { return {v(0), v(1), v(2), v(3)}; }

/// The product of all transfer matrices of a run.
class Monodromy : public Observer {
public:
    explicit Monodromy(const Parameters& p) : p_(p) {}
    void on_stretch(const Stretch& stretch) override {
        const Leg leg = leg_of(stretch);
        for (long part = 0; part < leg.parts; ++part) carry(matrix, leg, p_.epsilon);
    }
    void on_impact(const Impact& impact) override { matrix = saltation(p_, impact).times(matrix); }

    Frame matrix = Frame::Identity();

private:
    const Parameters p_;
};

/// Its exterior powers.
class Powers : public Observer {
public:
    explicit Powers(const Parameters& p) : product(p.epsilon), p_(p) {}
    void on_stretch(const Stretch& stretch) override { product.pass(leg_of(stretch)); }
    void on_impact(const Impact& impact) override { product.strike(saltation(p_, impact)); }

    PowerProduct product;

private:
    const Parameters p_;
};

/// Eigenvalues by descending modulus. The solver's error is one of the largest: small ones get
/// their moduli from the exterior powers.
std::array<std::complex<double>, 4> multipliers_of(
    const Matrix4& monodromy, const PowerProduct& powers) {
    const Eigen::Vector4cd eigenvalues = eigenvalues_of(monodromy);
    std::array<std::complex<double>, 4> values;
    for (int k = 0; k < 4; ++k) values[k] = eigenvalues(k);
    std::stable_sort(values.begin(), values.end(), [](auto a, auto b) {
        return elementary::modulus(a) > elementary::modulus(b);
    });
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

using Stop = std::function<bool()>;

/// The middle of the longest flight within one cycle from a state at a whole cycle: a moment with
/// no event nearby.
double quiet_moment(const Parameters& p, const State& start, const Stop& stop) {
    ImpactRecord impacts;
    StickRecord sticks;
    Observer* const observers[] = {&impacts, &sticks};
    const double cycle = p.cycle();
    follow(p, start, 0, cycle, stop, observers);
    double from = 0, length = 0, middle = 0.5 * cycle;
    std::size_t stick = 0;
    auto flight_to = [&](double tau) {
        // What is left of a chatter, and the stuck phase behind it, are no flight.
        for (; stick < sticks.entries.size() && sticks.entries[stick].start.tau <= tau; ++stick)
            from = std::max(from, sticks.entries[stick].tau_end);
        if (tau - from > length) length = tau - from, middle = 0.5 * (from + tau);
        from = std::max(from, tau);
    };
    for (const Impact& i : impacts.entries) flight_to(i.tau);
    flight_to(cycle);
    return middle;
}

std::optional<State> after_period(
    const Parameters& p, const State& s, double tau, int cycles, const Stop& stop,
    std::span<Observer* const> observers) {
    if (std::abs(s.x - s.y) > p.b) return std::nullopt;
    return follow(p, s, tau, cycles * p.cycle(), stop, observers);
}

/// Of the eigenvalues: whatever the units, it is below the norm in them.
double largest_modulus(const Matrix4& monodromy) {
    double largest = 0;
    for (const std::complex<double>& value : eigenvalues_of(monodromy))
        largest = std::max(largest, elementary::modulus(value));
    return monodromy.allFinite() ? largest : infinity;
}

/// Newton's method, in coordinates scaled to order one.
std::optional<State> close(
    const Parameters& p, State s, double tau, int cycles, const State& scale, double reach,
    const Stop& stop) {
    const State guess = s;
    const Eigen::Vector4d unit = vector(scale);
    double miss_before = infinity;
    for (int step = 0, worse = 0; step < most_steps; ++step) {
        Monodromy monodromy(p);
        Observer* const observers[] = {&monodromy};
        const auto back = after_period(p, s, tau, cycles, stop, observers);
        if (!back) return std::nullopt;
        const Eigen::Vector4d miss = (vector(*back) - vector(s)).cwiseQuotient(unit);
        const double size = miss.cwiseAbs().maxCoeff();
        if (size < closed_to_rounding || (size < closed && size > converging * miss_before))
            return s;
        if (size > miss_before && ++worse > most_worse_steps) return std::nullopt;
        miss_before = size;
        const Matrix4 D = unit.asDiagonal().inverse() *
                          (Matrix4(monodromy.matrix) - Matrix4::Identity()) * unit.asDiagonal();
        if (!(D.norm() < most_stretch) && !(largest_modulus(monodromy.matrix) < most_stretch))
            return std::nullopt;
        // Neutral directions (a mass at rest that is never hit) are left as they are: the smallest
        // step solves.
        Eigen::Vector4d correction = -smallest_solution(D, miss);
        State next = state(vector(s) + correction.cwiseProduct(unit));
        for (int half = 0; half < most_halvings && std::abs(next.x - next.y) > p.b; ++half) {
            correction *= 0.5;
            next = state(vector(s) + correction.cwiseProduct(unit));
        }
        s = next;
        if (!(distance(s, guess, scale) < reach)) return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace

State scale_of(const Parameters& p, std::span<const State> states) {
    State scale{least_scale * p.b, least_scale * p.b, least_mass_speed * p.b, p.b};
    for (const State& s : states)
        scale = {
            std::max(scale.x_dot, std::abs(s.x_dot)), std::max(scale.x, std::abs(s.x)),
            std::max(scale.y_dot, std::abs(s.y_dot)), scale.y};
    // At one phase of the forcing either may pass through zero.
    scale.x = scale.x_dot = std::max(scale.x, scale.x_dot);
    return scale;
}

double distance(const State& a, const State& b, const State& scale) {
    return (vector(a) - vector(b)).cwiseQuotient(vector(scale)).cwiseAbs().maxCoeff();
}

Exponents PeriodicOrbit::exponents(const Parameters& p) const {
    Exponents lambda;
    // Multipliers below what rounding leaves of a zero are zero: the orbit sticks, or R = 0.
    for (int k = 0; k < 4; ++k)
        lambda[k] = elementary::log(elementary::modulus(multipliers[k])) / (cycles * p.cycle());
    return lambda;
}

std::optional<State> follow(
    const Parameters& p, const State& start, double tau, double duration, const Stop& stop,
    std::span<Observer* const> observers) {
    const Outcome outcome =
        simulate(p, start, {tau + duration, most_orbit_impacts, stop, tau}, observers);
    if (outcome.reason != End::tau_end) return std::nullopt;
    return outcome.state;
}

namespace {

/// The smallest period: the first divisor of `cycles` after which the state is back. Sets what the
/// monodromy matrix over it says; false where the search was stopped.
bool close_smallest(
    const Parameters& p, int cycles, const State& scale, const Stop& stop, PeriodicOrbit& orbit) {
    for (int divisor = 1; divisor <= cycles; ++divisor) {
        if (cycles % divisor != 0) continue;
        Monodromy monodromy(p);
        Powers powers(p);
        Observer* const observers[] = {&monodromy, &powers};
        const auto back = after_period(p, orbit.state, orbit.tau, divisor, stop, observers);
        if (!back) return false;
        orbit.closure = distance(*back, orbit.state, scale);
        if (divisor < cycles && orbit.closure > divisor_closed) continue;
        orbit.cycles = divisor;
        orbit.monodromy = monodromy.matrix;
        orbit.multipliers = multipliers_of(orbit.monodromy, powers.product);
        break;
    }
    return true;
}

/// Counts what happens in a period; false where the search was stopped.
bool count_period(const Parameters& p, const Stop& stop, PeriodicOrbit& orbit) {
    // Three periods, of which one is counted from the first contact after a release: a chatter must
    // not be cut in two.
    ContactRecord contacts;
    ImpactRecord impacts;
    Observer* const observers[] = {&contacts, &impacts};
    const double period = orbit.cycles * p.cycle();
    if (!follow(p, orbit.state, orbit.tau, 3 * period, stop, observers)) return false;
    double from = contacts.sticks.empty() ? orbit.tau : contacts.sticks[0].tau_end;
    for (const CountedContact& c : contacts.contacts)
        if (c.tau >= from) {
            from = c.tau;
            break;
        }
    const double to = from + period * (1 - contact_rounding);
    const auto within = [&](double t) { return t >= from && t < to; };
    orbit.contacts = std::count_if(
        contacts.contacts.begin(), contacts.contacts.end(),
        [&](const CountedContact& c) { return within(c.tau); });
    orbit.impacts = std::count_if(
        impacts.entries.begin(), impacts.entries.end(),
        [&](const Impact& i) { return within(i.tau); });
    orbit.sticks = std::count_if(
        contacts.sticks.begin(), contacts.sticks.end(),
        [&](const auto& s) { return within(s.tau_start); });
    return true;
}

/// Half a period on, the forcing has the opposite sign only where the period is an odd number of
/// cycles. Walls that differ may leave the motion between their chatters the same, but not the
/// chatters.
bool is_symmetric(
    const Parameters& p, const PeriodicOrbit& orbit, const State& scale, const Stop& stop) {
    if (orbit.cycles % 2 == 0 || (p.R_plus != p.R_minus && orbit.impacts != 0)) return false;
    const auto half = follow(p, orbit.state, orbit.tau, 0.5 * orbit.cycles * p.cycle(), stop);
    return half && distance(state(-vector(*half)), orbit.state, scale) < symmetric_within;
}

}  // namespace

std::optional<PeriodicOrbit> find_orbit(
    const Parameters& p, const State& at_whole_cycle, int cycles, const State& scale, double reach,
    const Stop& stop) {
    const double tau = quiet_moment(p, at_whole_cycle, stop);
    const auto guess = follow(p, at_whole_cycle, 0, tau, stop);
    if (!guess) return std::nullopt;
    const auto found = close(p, *guess, tau, cycles, scale, reach, stop);
    if (!found) return std::nullopt;
    PeriodicOrbit orbit{};
    orbit.tau = tau;
    orbit.state = *found;
    if (!close_smallest(p, cycles, scale, stop, orbit) || !count_period(p, stop, orbit))
        return std::nullopt;
    orbit.symmetric = is_symmetric(p, orbit, scale, stop);
    return orbit;
}

namespace {

/// z^n, n > 0, by squaring.
std::complex<double> power(std::complex<double> z, int n) {
    std::complex<double> result = 1;
    for (; n > 0; n /= 2, z *= z)
        if (n % 2 == 1) result *= z;
    return result;
}

/// Deviations from an orbit in the eigenvectors of its monodromy matrix: there a small one shrinks,
/// period by period, by the multipliers' moduli, however far from orthogonal the eigenvectors are.
class EigenCoordinates {
public:
    EigenCoordinates(const PeriodicOrbit& orbit, const State& scale, bool oscillator_alone)
        : at_(vector(orbit.state)),
          unit_(vector(scale)) {
        Matrix4 D = unit_.asDiagonal().inverse() * orbit.monodromy * unit_.asDiagonal();
        if (oscillator_alone) D.bottomRows<2>().setZero(), D.rightCols<2>().setZero();
        base_ = eigen_base_of(D);
    }
    Eigen::Vector4cd of(const State& s) const {
        return base_.to_coordinates * (vector(s) - at_).cwiseQuotient(unit_);
    }
    Eigen::Vector4cd after(Eigen::Vector4cd deviation, int periods) const {
        for (int k = 0; k < 4; ++k) deviation(k) *= power(base_.values(k), periods);
        return deviation;
    }
    bool usable() const { return base_.to_coordinates.allFinite(); }

private:
    const Eigen::Vector4d at_, unit_;
    EigenBase base_;
};

// From order one to there takes this many times the contraction's own time, and some more while it
// is not linear yet.
constexpr double decay_times = 24;
constexpr int more_periods = 20;
// A motion is followed for so many cycles at most, but for so many periods at least.
constexpr int most_cycles = 4000, least_periods = 30;
// Where that is too short, it must move as the orbit's linear map says, in each of so many spans,
// to this share of what the map contracts in the span.
constexpr int spans = 3;
constexpr double linear_return_share = 0.2;
// ln of the contraction of a period that is more than rounding.
constexpr double least_contraction = 1e-9;

}  // namespace

bool attracts(
    const Parameters& p, const PeriodicOrbit& orbit, const State& at_whole_cycle,
    const State& scale, const Stop& stop) {
    // Without an impact nothing pulls the free mass back: its two multipliers are 1, and it is the
    // oscillator that converges.
    const bool untouched = orbit.contacts == 0 && orbit.state.y_dot == 0;
    const double largest = untouched ? spectral_radius(orbit.monodromy.topLeftCorner<2, 2>())
                                     : elementary::modulus(orbit.multipliers[0]);
    const double per_period = -elementary::log(largest);
    if (!(per_period > least_contraction)) return false;
    std::optional<State> s = follow(p, at_whole_cycle, 0, orbit.tau, stop);
    auto distant = [&] { return distance(*s, orbit.state, scale); };
    auto pass = [&](int periods) {
        for (int k = 0; k < periods && s && distant() >= on_the_orbit; ++k)
            s = follow(p, *s, orbit.tau, orbit.cycles * p.cycle(), stop);
        return s.has_value();
    };
    if (!s) return false;

    const int most_periods = std::max(most_cycles / orbit.cycles, least_periods);
    const double needed = decay_times / per_period + more_periods;
    if (needed <= most_periods) return pass(static_cast<int>(needed)) && distant() < on_the_orbit;

    const EigenCoordinates coordinates(orbit, scale, untouched);
    if (!coordinates.usable()) return false;
    const int periods = most_periods / spans;
    const double contraction = 1 - elementary::pow(largest, periods);
    for (int span = 0; span < spans; ++span) {
        const Eigen::Vector4cd before = coordinates.of(*s),
                               linear = coordinates.after(before, periods);
        if (!pass(periods)) return false;
        if (distant() < on_the_orbit) return true;
        if ((coordinates.of(*s) - linear).norm() >
            linear_return_share * contraction * before.norm())
            return false;
    }
    return true;
}

std::vector<State> whole_cycle_states(const Parameters& p, const PeriodicOrbit& orbit) {
    StroboscopicRecord record(p, 1);
    Observer* const observers[] = {&record};
    follow(p, orbit.state, orbit.tau, (orbit.cycles + 0.5) * p.cycle(), {}, observers);
    record.states.resize(orbit.cycles);
    return record.states;
}

}  // namespace vines
