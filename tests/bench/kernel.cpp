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
    /// Of the plain program: as many as it comes to in reasonable time, before it chatters. Its
    /// step of .05 still misses contacts, but few enough that it gets through.
    long plain_impacts;
};

double per_impact(long count, const std::function<void()>& work) {
    return 1e9 * seconds_of(work) / static_cast<double>(count);
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
            [&] { return per_impact(c.plain_impacts, [&] { plain(p, c.plain_impacts, 0.05); }); }});
    const std::string name = c.name;
    row(name + ": trajectory and its list of impacts", times[0], "ns per impact");
    row(name + ": trajectory and all four exponents", times[1], "ns per impact");
    row(name + ": the plain program, with all four exponents", times[2], "ns per impact");
    row(name + ": the plain program takes", ratios(times[2], times[1]), "times that");
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
