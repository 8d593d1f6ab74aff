#include "core/orbit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/record.hpp"
#include "core/regime.hpp"

namespace vines {

namespace {

// A period with more impacts than this is not looked for.
constexpr long most_impacts = 20000;
// Newton's method has found the orbit when its return misses it by no more, in units of the scale.
constexpr double closed = 1e-10;

double cycle_of(const Parameters& p) { return 2 * std::numbers::pi / p.Omega; }

Eigen::Vector4d vector(const State& s) { return {s.x_dot, s.x, s.y_dot, s.y}; }
State state(const Eigen::Vector4d& v) { return {v(0), v(1), v(2), v(3)}; }

/// The product of all transfer matrices of a run.
class Monodromy : public Observer {
public:
    explicit Monodromy(const Parameters& p) : p_(p) {}
    void on_stretch(const Stretch& stretch) override { passage_.extend(stretch, p_.epsilon); }
    void on_impact(const Impact& impact) override { passage_.strike(saltation(p_, impact)); }
    const Matrix4& matrix() const { return passage_.matrix(); }

private:
    const Parameters& p_;
    Passage passage_;
};

/// The state after a time, or none where that takes too many impacts.
std::optional<State> follow(const Parameters& p, const State& start, double tau, double duration, std::span<Observer* const> observers = {}) {
    const Outcome outcome = simulate(p, start, {tau + duration, most_impacts, {}, tau}, observers);
    if (outcome.reason != End::tau_end) return std::nullopt;
    return outcome.state;
}

/// The middle of the longest flight within one cycle from a state at a whole cycle: a moment with no event nearby.
double quiet_moment(const Parameters& p, const State& start) {
    ContactRecord contacts;
    Observer* const observers[] = {&contacts};
    const double cycle = cycle_of(p);
    follow(p, start, 0, cycle, observers);
    double from = 0, length = 0, middle = 0.5 * cycle;
    auto flight_to = [&](double tau) {
        if (tau - from > length) length = tau - from, middle = 0.5 * (from + tau);
        from = tau;
    };
    // A stuck phase is no flight: it is passed by.
    std::size_t stick = 0;
    auto sticks_until = [&](double tau) {
        for (; stick < contacts.sticks.size() && contacts.sticks[stick].tau_start <= tau; ++stick) {
            flight_to(contacts.sticks[stick].tau_start);
            from = contacts.sticks[stick].tau_end;
        }
    };
    for (const Contacts& c : contacts.contacts) {
        sticks_until(c.tau);
        flight_to(c.tau);
    }
    sticks_until(cycle);
    flight_to(cycle);
    return middle;
}

std::array<std::complex<double>, 4> eigenvalues(const Matrix4& m) {
    const Eigen::EigenSolver<Matrix4> solver(m, false);
    std::array<std::complex<double>, 4> values;
    for (int k = 0; k < 4; ++k) values[k] = solver.eigenvalues()(k);
    std::stable_sort(values.begin(), values.end(), [](auto a, auto b) { return std::abs(a) > std::abs(b); });
    return values;
}

struct Return {
    State state;
    Matrix4 monodromy;
};
std::optional<Return> after_period(const Parameters& p, const State& s, double tau, int cycles) {
    if (std::abs(s.x - s.y) > p.b) return std::nullopt;
    Monodromy monodromy(p);
    Observer* const observers[] = {&monodromy};
    const auto end = follow(p, s, tau, cycles * cycle_of(p), observers);
    if (!end) return std::nullopt;
    return Return{*end, monodromy.matrix()};
}

/// Newton's method, in coordinates scaled to order one.
std::optional<State> close(const Parameters& p, State s, double tau, int cycles, const State& scale, double reach) {
    const State guess = s;
    const Eigen::Vector4d unit = vector(scale);
    double miss_before = std::numeric_limits<double>::infinity();
    for (int step = 0; step < 25; ++step) {
        const auto back = after_period(p, s, tau, cycles);
        if (!back) return std::nullopt;
        const Eigen::Vector4d miss = (vector(back->state) - vector(s)).cwiseQuotient(unit);
        const double size = miss.cwiseAbs().maxCoeff();
        // Near the orbit each step squares the miss, until rounding stops it.
        if (size < 1e-14 || (size < closed && size > 0.1 * miss_before)) return s;
        if (step > 8 && size > miss_before) return std::nullopt;
        miss_before = size;
        const Matrix4 D = unit.asDiagonal().inverse() * (back->monodromy - Matrix4::Identity()) * unit.asDiagonal();
        // Neutral directions (a mass at rest that is never hit) are left as they are: the smallest step solves.
        Eigen::CompleteOrthogonalDecomposition<Matrix4> solver;
        solver.setThreshold(1e-10);
        solver.compute(D);
        Eigen::Vector4d correction = -solver.solve(miss);
        State next = state(vector(s) + correction.cwiseProduct(unit));
        for (int half = 0; half < 6 && std::abs(next.x - next.y) > p.b; ++half) {
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
    // The free mass is never slower, by order of magnitude, than b per half cycle where it meets both walls.
    State scale{1e-9 * p.b, 1e-9 * p.b, 0.1 * p.b, p.b};
    for (const State& s : states)
        scale = {std::max(scale.x_dot, std::abs(s.x_dot)), std::max(scale.x, std::abs(s.x)), std::max(scale.y_dot, std::abs(s.y_dot)), scale.y};
    scale.x = scale.x_dot = std::max(scale.x, scale.x_dot);  // at one phase of the forcing either may pass through zero
    return scale;
}

double distance(const State& a, const State& b, const State& scale) {
    return (vector(a) - vector(b)).cwiseQuotient(vector(scale)).cwiseAbs().maxCoeff();
}

Exponents PeriodicOrbit::exponents(const Parameters& p) const {
    Exponents lambda;
    // Multipliers below what rounding leaves of a zero are zero: the orbit sticks, or R = 0.
    for (int k = 0; k < 4; ++k) lambda[k] = std::log(std::abs(multipliers[k])) / (cycles * cycle_of(p));
    return lambda;
}

std::optional<PeriodicOrbit> find_orbit(const Parameters& p, const State& at_whole_cycle, int cycles, const State& scale, double reach) {
    const double tau = quiet_moment(p, at_whole_cycle), cycle = cycle_of(p);
    const auto guess = follow(p, at_whole_cycle, 0, tau);
    if (!guess) return std::nullopt;
    const auto found = close(p, *guess, tau, cycles, scale, reach);
    if (!found) return std::nullopt;

    PeriodicOrbit orbit{};
    orbit.tau = tau;
    orbit.state = *found;
    // The smallest period: a divisor after which the state is back.
    for (int divisor = 1; divisor <= cycles; ++divisor) {
        if (cycles % divisor != 0) continue;
        const auto back = after_period(p, *found, tau, divisor);
        if (!back) return std::nullopt;
        orbit.closure = distance(back->state, *found, scale);
        if (divisor < cycles && orbit.closure > 1e3 * closed) continue;
        orbit.cycles = divisor;
        orbit.multipliers = eigenvalues(back->monodromy);
        break;
    }

    ContactRecord contacts;
    Observer* const observers[] = {&contacts};
    follow(p, *found, tau, orbit.cycles * cycle, observers);
    orbit.contacts = static_cast<long>(contacts.contacts.size());
    orbit.impacts = contacts.impacts;
    orbit.sticks = static_cast<long>(contacts.sticks.size());
    // A stick, or R = 0, makes multipliers exactly zero; what the eigenvalue solver leaves of them is rounding.
    const int rank = orbit.sticks > 0 ? 2 : orbit.impacts > 0 && std::min(p.R_plus, p.R_minus) == 0 ? 3 : 4;
    for (int k = rank; k < 4; ++k) orbit.multipliers[k] = 0;
    // Half a period on, the forcing has the opposite sign only where the period is an odd number of cycles.
    if (orbit.cycles % 2 == 1) {
        const auto half = follow(p, *found, tau, 0.5 * orbit.cycles * cycle);
        orbit.symmetric = half && distance(state(-vector(*half)), *found, scale) < 1e-6;
    }
    return orbit;
}

bool attracts(const Parameters& p, const PeriodicOrbit& orbit, const State& at_whole_cycle, const State& scale) {
    const auto begin = follow(p, at_whole_cycle, 0, orbit.tau);
    if (!begin) return false;
    State s = *begin;
    const double first = distance(s, orbit.state, scale);
    // Without an impact nothing pulls the free mass back: its two multipliers are 1, and it is the oscillator that converges.
    const bool untouched = orbit.contacts == 0 && orbit.state.y_dot == 0;
    if (!orbit.stable() && !untouched) return false;
    constexpr double there = 1e-8;
    if (first < there) return true;
    // So many periods as should bring it a hundred times closer, three times over.
    const double per_period = -std::log(std::abs(orbit.multipliers[untouched ? 2 : 0]));
    const int periods = static_cast<int>(std::clamp(3 * std::log(100.0) / per_period, 10.0, 3000.0 / orbit.cycles + 10));
    for (int k = 0; k < periods; ++k) {
        const auto next = follow(p, s, orbit.tau, orbit.cycles * cycle_of(p));
        if (!next) return false;
        s = *next;
        if (distance(s, orbit.state, scale) < std::max(0.01 * first, there)) return true;
    }
    return false;
}

std::vector<State> whole_cycle_states(const Parameters& p, const PeriodicOrbit& orbit) {
    StroboscopicRecord record(p, 1);
    Observer* const observers[] = {&record};
    follow(p, orbit.state, orbit.tau, (orbit.cycles + 0.5) * cycle_of(p), observers);
    record.states.resize(orbit.cycles);
    return record.states;
}

}  // namespace vines
