#include <algorithm>
#include <vector>

#include "core/motion/record.hpp"
#include "core/stability/lyapunov.hpp"
#include "parts.hpp"
#include "plain.hpp"
#include "table.hpp"

namespace vines::bench {

namespace {

constexpr long impacts = 2000;

struct Case {
    const char* name;
    double b;
    Damping damping;
    /// For the plain program: the number it reaches in reasonable time, before a chatter. With its
    /// step of .05 it still misses contacts, but few enough to continue.
    long plain_impacts;
};

double per_impact(long count, const std::function<void()>& work) {
    return 1e9 * seconds_of(work) / static_cast<double>(count);
}

/// Lower bound for any contact search: the state at each contact and the impact there, for flights
/// of known duration. Returns a number that depends on all of them.
double states_at(const Parameters& p, const Flow& flow, const std::vector<Impact>& impacts) {
    const Impact& first = impacts.front();
    Oscillation o{first.x, first.x_dot_after, first.sin_theta, first.cos_theta};
    double y_dot = first.y_dot_after, sum = 0;
    for (std::size_t i = 1; i < impacts.size(); ++i) {
        const double s = std::min(impacts[i].tau - impacts[i - 1].tau, 0.99 * flow.reach());
        const int k = static_cast<int>(s / flow.cell());
        const Oscillation left = flow.roughly_at(o, k);
        const double d = s - k * flow.cell();
        o = flow.rotated(left, d);
        const auto [x, x_dot] = flow.short_series(left).at(d);
        o.x = x, o.x_dot = x_dot;
        const Contact contact{s, impacts[i].side, o, x_dot - y_dot};
        const Impact impact = impact_at(p, contact, flow.acceleration(o), impacts[i].tau);
        o.x_dot = impact.x_dot_after;
        y_dot = impact.y_dot_after;
        sum += impact.x_ddot_before;
    }
    return sum;
}

void bench_case(const Case& c) {
    Parameters p;
    p.b = c.b;
    p.damping = c.damping;
    const Limits limits{1e9, impacts, {}};
    const auto run = [&](Observer& observer) {
        Observer* const observers[] = {&observer};
        return per_impact(impacts, [&] { simulate(p, default_state(p), limits, observers); });
    };
    ImpactRecord known;
    Observer* const recording[] = {&known};
    simulate(p, default_state(p), limits, recording);
    const auto flow = Flow::shared_free(p);
    volatile double kept = 0;  // keeps the compiler from removing the computation
    const auto times = in_turn(
        9, {[&] {
                ImpactRecord record;
                record.entries.reserve(impacts);
                return run(record);
            },
            [&] {
                Lyapunov lyapunov(p, 0, 1e9, qr_alone);
                return run(lyapunov);
            },
            [&] { return per_impact(impacts, [&] { kept = states_at(p, *flow, known.entries); }); },
            [&] { return per_impact(c.plain_impacts, [&] { plain(p, c.plain_impacts, 0.05); }); }});
    const std::string name = c.name;
    row(name + ": trajectory and its list of impacts", times[0], "ns per impact");
    row(name + ": trajectory and all four exponents", times[1], "ns per impact");
    row(name + ": the states at its contacts alone, if these are known", times[2], "ns per impact");
    row(name + ": the plain program, with all four exponents", times[3], "ns per impact");
    row(name + ": time of the plain program, relative to trajectory and all four exponents",
        ratios(times[3], times[1]), "times");
}

}  // namespace

void bench_kernel() {
    for (const Case& c :
         {Case{"b = 15 mm, two impacts per cycle", 0.015, Damping::closed_form, impacts},
          Case{
              "b = 8 mm, equation of motion, three impacts per cycle", 0.008,
              Damping::equation_of_motion, impacts},
          Case{"b = 3 mm, irregular", 0.003, Damping::closed_form, impacts},
          Case{"b = 22 mm, irregular", 0.022, Damping::closed_form, 100},
          Case{"b = 34 mm, sparse", 0.034, Damping::closed_form, 300}})
        bench_case(c);
}

}  // namespace vines::bench
