#include "long_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "tangent.hpp"

namespace vines::hunt {

namespace {

// Longest period searched for.
constexpr int longest_period = 400;
// Distance of a return, relative to the size of the motion.
constexpr double returned = 1e-9;
// After settled_after cycles, a run that has returned for settled_for cycles is ended.
constexpr int settled_after = 6000, settled_for = 1000;
// Enough for thirty impacts per cycle.
constexpr long max_impacts_of_long_run = 600000;

/// Records the states at half cycles.
class HalfCycleStates : public Observer {
public:
    HalfCycleStates(const Parameters& p, std::vector<State>& states)
        : half_(0.5 * p.cycle()),
          states_(states) {}
    void on_stretch(const Stretch& stretch) override {
        for (double tau;
             (tau = static_cast<double>(states_.size()) * half_) < stretch.tau + stretch.duration;)
            states_.push_back(stretch.at(std::max(0.0, tau - stretch.tau)));
    }

private:
    const double half_;
    std::vector<State>& states_;
};

/// Propagates a deviation, and counts the events of each cycle.
class Deviation : public Observer {
public:
    Deviation(
        const Parameters& p, std::vector<double>& growth, std::vector<int>& impacts,
        std::vector<int>& sticks)
        : p_(p),
          free_(Oscillator<double>::free(p)),
          stuck_(Oscillator<double>::stuck(p)),
          growth_(growth),
          impacts_(impacts),
          sticks_(sticks) {}

    void on_stretch(const Stretch& stretch) override {
        carry(
            stretch.sticking_side == 0 ? flight(free_, stretch.duration)
                                       : together(stuck_, p_.epsilon, stretch.duration));
        const auto cycle = static_cast<std::size_t>((stretch.tau + stretch.duration) / p_.cycle());
        while (growth_.size() <= cycle) growth_.push_back(log_);
    }
    void on_impact(const Impact& i) override {
        const double x_ddot_after =
            i.x_ddot_before - free_.damping * (i.x_dot_after - i.x_dot_before);
        carry(strike(
            Collision<double>{
                i.R, i.x_dot_before, i.x_dot_after, i.y_dot_before, i.y_dot_after, i.x_ddot_before,
                x_ddot_after},
            p_.epsilon));
        count(impacts_, i.tau);
    }
    void on_stick(const StickStart& s) override { count(sticks_, s.tau); }

private:
    void carry(const Square<double>& T) {
        std::array<double, 4> next{};
        double square = 0;
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) next[i] += T(i, j) * d_[j];
            square += next[i] * next[i];
        }
        const double length = std::sqrt(square);
        for (int i = 0; i < 4; ++i) d_[i] = next[i] / length;
        log_ += std::log(length);
    }
    void count(std::vector<int>& per_cycle, double tau) {
        const auto cycle = static_cast<std::size_t>(tau / p_.cycle());
        if (per_cycle.size() <= cycle) per_cycle.resize(cycle + 1);
        ++per_cycle[cycle];
    }

    const Parameters p_;
    const Oscillator<double> free_, stuck_;
    std::array<double, 4> d_ = {0.5, -0.4, 0.6, 0.5};  // a generic direction
    double log_ = 0;
    std::vector<double>& growth_;
    std::vector<int>&impacts_, &sticks_;
};

}  // namespace

LongRun::LongRun(const Parameters& p, const State& start, int cycles) : parameters_(p) {
    HalfCycleStates states(p, states_);
    Deviation deviation(p, growth_, impacts_, sticks_);
    Observer* const observers[] = {&states, &deviation};
    int look = settled_after;
    const auto settled = [&] {
        if (complete_cycles() < look) return false;
        const int period = period_at(look);
        const bool all_along = period > 0 && period_at(look - settled_for) == period;
        look += settled_for;
        return all_along;
    };
    simulate(p, start, {(cycles + 0.25) * p.cycle(), max_impacts_of_long_run, settled}, observers);
    cycles_ = std::min(cycles, complete_cycles());
    impacts_.resize(std::max(impacts_.size(), static_cast<std::size_t>(cycles_) + 1));
    sticks_.resize(std::max(sticks_.size(), static_cast<std::size_t>(cycles_) + 1));
}

int LongRun::complete_cycles() const {
    return std::min(static_cast<int>(states_.size() - 1) / 2, static_cast<int>(growth_.size()) - 1);
}

LongRun::Scale LongRun::scale_at(int cycle) const {
    Scale scale{0, 0, parameters_.b};
    for (int k = std::max(0, cycle - longest_period); k <= cycle; ++k) {
        const State& s = at_cycle(k);
        scale.x = std::max({scale.x, std::abs(s.x), std::abs(s.x_dot)});
        scale.y_dot = std::max(scale.y_dot, std::abs(s.y_dot));
    }
    scale.y_dot = std::max(scale.y_dot, scale.x);
    return scale;
}

double LongRun::distance(const State& a, const State& b, const Scale& scale) const {
    const double gap = (a.x - a.y) - (b.x - b.y);
    return std::max(
        {std::abs(a.x - b.x) / scale.x, std::abs(a.x_dot - b.x_dot) / scale.x,
         std::abs(a.y_dot - b.y_dot) / scale.y_dot, std::abs(gap) / scale.gap});
}

int LongRun::period_at(int at) const {
    const Scale scale = scale_at(at);
    const auto returns = [&](int period, double tolerance) {
        const int looked_at = std::max(2 * period, 10);
        for (int k = 0; k < looked_at; ++k)
            if (at - k < period ||
                !(distance(at_cycle(at - k), at_cycle(at - k - period), scale) < tolerance))
                return false;
        return true;
    };
    // The return of a shorter period can be spoilt by rounding in a chatter, or still be
    // converging, with the slower of two multipliers.
    const auto returns_in_the_end = [&](int period, int multiple) {
        if (returns(period, 100 * returned)) return true;
        const int before = at - at / 4 / multiple * multiple;  // the same phase of the longer one
        return before > period && miss(at, period) < 1e-4 &&
               miss(at, period) < 0.98 * miss(before, period);
    };
    for (int period = 1; period <= std::min(longest_period, at / 3); ++period) {
        if (!returns(period, returned)) continue;
        for (int shorter = 1; shorter < period; ++shorter)
            if (period % shorter == 0 && returns_in_the_end(shorter, period)) return shorter;
        return period;
    }
    return 0;
}

bool LongRun::returns_throughout(int from, int to) const {
    const int middle = (from + to) / 2, longest = std::min(longest_period, (to - from) / 4);
    int nearest = 1;
    for (int period = 2; period <= longest; ++period)
        if (miss(middle, period) < 0.5 * miss(middle, nearest)) nearest = period;
    int returns = 0;
    const Scale scale = scale_at(middle);
    for (int k = from + nearest; k <= to; ++k)
        returns += distance(at_cycle(k), at_cycle(k - nearest), scale) < 1e-3;
    return returns > 0.8 * (to - from - nearest);
}

double LongRun::miss(int at, int period) const {
    return distance(at_cycle(at), at_cycle(at - period), scale_at(at));
}

int LongRun::captured_from(int period, double within) const {
    const Scale scale = scale_at(cycles_);
    int k = cycles_ - period;
    while (k >= 0 &&
           distance(at_cycle(k), at_cycle(cycles_ - (cycles_ - k) % period), scale) < within)
        --k;
    return k + 1;
}

bool LongRun::ends_symmetric(int period) const {
    if (period % 2 == 0) return false;  // half a period later the forcing is the same
    const State
        now = at_cycle(cycles_),
        half = states_[2 * static_cast<std::size_t>(cycles_) - static_cast<std::size_t>(period)];
    return distance(now, {-half.x_dot, -half.x, -half.y_dot, -half.y}, scale_at(cycles_)) < 1e-6;
}

LongRun::PeriodContacts LongRun::contacts_at_end(int period) const {
    // Rounding can move an impact across the end of a cycle; average over several periods.
    const int periods = std::max(1, 100 / period);
    PeriodContacts sum{0, 0};
    for (int k = cycles_ - periods * period; k < cycles_; ++k) {
        sum.impacts += impacts_[k];
        sum.sticks += sticks_[k];
    }
    return {
        static_cast<int>(std::lround(1.0 * sum.impacts / periods)),
        static_cast<int>(std::lround(1.0 * sum.sticks / periods))};
}

double LongRun::growth(int from, int to) const { return growth_[to] - growth_[from]; }

LongRun::Rise LongRun::rise(int from, int to) const {
    int lowest = from, begin = from, end = from;
    for (int k = from; k <= to; ++k) {
        if (growth_[k] < growth_[lowest]) lowest = k;
        if (growth(lowest, k) > growth(begin, end)) begin = lowest, end = k;
    }
    const double whole = growth(begin, end);
    constexpr int quarters = 4, removed = 3;
    if (end - begin < 4 * quarters) return {whole, 0};
    std::vector<double> steps;
    for (int k = begin; k < end; ++k) steps.push_back(growth(k, k + 1));
    std::ranges::sort(steps, std::greater<>());
    double sustained = whole;
    for (int k = 0; k < removed; ++k) sustained -= steps[k];
    for (int q = 0; q < quarters; ++q) {
        const auto bound = [&](int k) { return begin + (end - begin) * k / quarters; };
        if (growth(bound(q), bound(q + 1)) < 0.05 * whole) return {whole, 0};
    }
    return {whole, sustained};
}

double LongRun::closest_return(int from) const {
    const Scale scale = scale_at(cycles_);
    double closest = INFINITY;
    for (int k = from; k < cycles_ - 1; ++k)
        closest = std::min(closest, distance(at_cycle(cycles_), at_cycle(k), scale));
    return closest;
}

LongRun::Exponent LongRun::exponent(int from, int to) const {
    constexpr int blocks = 20;
    const double length = static_cast<double>(to - from) / blocks;
    double sum = 0, squares = 0;
    for (int k = 0; k < blocks; ++k) {
        const int begin = from + static_cast<int>(k * length),
                  end = from + static_cast<int>((k + 1) * length);
        const double mean = growth(begin, end) / std::max(1, end - begin) / parameters_.cycle();
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / blocks;
    return {mean, std::sqrt(std::max(0.0, squares / blocks - mean * mean) / (blocks - 1))};
}

}  // namespace vines::hunt
