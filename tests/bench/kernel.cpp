#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/motion/load.hpp"
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
                Lyapunov lyapunov(p, {0, 1e9}, qr_alone);
                return run(lyapunov);
            },
            [&] { return per_impact(impacts, [&] { kept = states_at(p, *flow, known.entries); }); },
            [&] { return per_impact(c.plain_impacts, [&] { plain(p, c.plain_impacts, 0.05); }); }});
    const std::string name = c.name;
    const auto of_limit = [&](const std::vector<double>& of) {
        return ", " + digits(median(ratios(of, times[2]))) + " times the states alone";
    };
    row(name + ": trajectory and its list of impacts", times[0], "ns per impact",
        of_limit(times[0]));
    row(name + ": trajectory and all four exponents", times[1], "ns per impact",
        of_limit(times[1]));
    row(name + ": the states at its contacts alone, if these are known", times[2], "ns per impact");
    row(name + ": the plain program, with all four exponents", times[3], "ns per impact");
    row(name + ": time of the plain program, relative to trajectory and all four exponents",
        ratios(times[3], times[1]), "times");
}

/// What a system costs that was never seen: the table of its flow.
void bench_first_run() {
    Parameters p;
    p.b = 0.015, p.damping = Damping::closed_form;
    const auto run = [&p] {
        ImpactRecord record;
        Observer* const observers[] = {&record};
        return 1e6 * seconds_of([&] { simulate(p, default_state(p), {1e9, 20, {}}, observers); });
    };
    const auto times = in_turn(
        99, {[&] {
                 p.Omega += 1e-9;
                 return run();
             },
             run});
    row("b = 15 mm: the first 20 impacts, of a system never seen", times[0], "us");
    row("b = 15 mm: the first 20 impacts, of a known system", times[1], "us");
}

/// Counts flights, which an impact or the end of a sliding ends.
struct Flights : Observer {
    void on_impact(const Impact&) override { ++count; }
    void on_slip(const Slip&) override { ++count; }
    long count = 0;
};

/// With friction of the ball: time of a flight, relative to one without.
void bench_friction() {
    Parameters p;
    p.b = 0.015, p.damping = Damping::closed_form;
    Parameters sliding = p;
    sliding.friction = 0.05 * p.epsilon * p.G;
    const auto per_flight = [](const Parameters& of) {
        Flights flights;
        Observer* const observers[] = {&flights};
        const double time =
            per_impact(1, [&] { simulate(of, default_state(of), {1e9, impacts, {}}, observers); });
        return time / static_cast<double>(flights.count);
    };
    const auto times =
        in_turn(9, {[&] { return per_flight(sliding); }, [&] { return per_flight(p); }});
    row("b = 15 mm, a ball with friction: trajectory", times[0], "ns per flight");
    row("b = 15 mm: time of a flight with friction, relative to one without",
        ratios(times[0], times[1]), "times");
}

/// A record of 60 s at 200 Hz, of an oscillator of 8 Hz.
void bench_record() {
    constexpr int samples = 12001;
    const double step = 2 * std::numbers::pi * 8 / 200;
    std::vector<double> tau, values;
    for (int k = 0; k < samples; ++k) {
        tau.push_back(k * step);
        values.push_back(1e-3 * (std::sin(tau.back()) + 0.3 * std::sin(7.3 * tau.back())));
    }
    Parameters p;
    p.b = 0.03, p.G = 0;
    const auto times = in_turn(
        9, {[&] {
            return 1e-6 * per_impact(1, [&] {
                       p.load =
                           std::make_shared<const Load>(LoadKind::base_acceleration, tau, values);
                       Lyapunov lyapunov(p, {0, 1e9}, qr_alone);
                       Observer* const observers[] = {&lyapunov};
                       simulate(p, default_state(p), {p.load->length(), 1000000, {}}, observers);
                   });
        }});
    row("a recorded load of 60 s with 200 Hz, all four exponents", times[0], "ms");
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
    bench_first_run();
    bench_friction();
    bench_record();
}

}  // namespace vines::bench
