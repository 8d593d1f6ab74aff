// Speed of sweeps over b and of a map over b and R, on one and two threads. Each row is the median
// of `rounds` rounds, in which all measurements take turns, so that other load affects all of them.
#include <ctime>
#include <string>

#include "core/stability/lyapunov.hpp"
#include "core/sweep/parallel.hpp"
#include "core/sweep/point.hpp"
#include "parts.hpp"
#include "table.hpp"

namespace vines::bench {

namespace {

constexpr std::size_t b_count = 1000;
constexpr int rounds = 5;

/// Table 1 with the damping of the closed form; b in m.
Parameters closed_form_parameters(double b, double R) {
    Parameters p;
    p.b = b;
    p.R_plus = p.R_minus = R;
    p.damping = Damping::closed_form;
    return p;
}

/// Value k of `count` equidistant ones.
double linspace_value(double from, double to, std::size_t k, std::size_t count) {
    return from + (to - from) * static_cast<double>(k) / static_cast<double>(count - 1);
}

Parameters parameters_at(std::size_t i) {
    return closed_form_parameters(linspace_value(0.002, 0.040, i, b_count), 0.6);
}

/// Simulations for all values of b, with their exponents if requested.
void run_motions(int threads, double cycles, bool exponents) {
    parallel(b_count, threads, nullptr, [&](std::size_t i) {
        const Parameters p = parameters_at(i);
        const double end = cycles * p.cycle();
        std::optional<Lyapunov> lyapunov;
        std::vector<Observer*> observers;
        if (exponents) observers = {&lyapunov.emplace(p, Interval{0, end}, qr_alone)};
        simulate(p, default_state(p), {.tau_end = end, .max_impacts = 1000000}, observers);
    });
}

/// Computes complete sweep points: motion, exponents, regime and verdict.
void run_sweep_points(
    int threads, std::size_t count, const PointOptions& options,
    const std::function<Parameters(std::size_t)>& parameters_of) {
    RunControl control;
    parallel(count, threads, nullptr, [&](std::size_t i) {
        const Parameters p = parameters_of(i);
        const State start = default_state(p);
        run_point({p, start, options.max_impacts}, start, options, control);
    });
}

/// Average number of cores that a piece of work used; lower than the number of threads on a
/// busy machine.
class Cores {
public:
    double seconds_of(const std::function<void()>& work) {
        const std::clock_t before = std::clock();  // CPU time of all threads
        const double seconds = bench::seconds_of(work);
        cores_.push_back(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC / seconds);
        return seconds;
    }
    std::string text() const { return ", on " + digits(median(cores_)) + " cores"; }

private:
    std::vector<double> cores_;
};

std::string rate(const std::vector<double>& seconds, std::size_t points) {
    return ", " + digits(static_cast<double>(points) / median(seconds)) + " points per second";
}

void bench_sweep_of_b() {
    const auto measured = [](double transient) {
        return [transient](int threads) {
            run_sweep_points(
                threads, b_count, {.transient_cycles = transient, .cycles = 1000}, parameters_at);
        };
    };
    const struct {
        const char* name;
        std::function<void(int)> run;
    } kinds[] = {
        {"1000 cycles, trajectories alone", [](int threads) { run_motions(threads, 1000, false); }},
        {"1000 cycles, all four exponents", [](int threads) { run_motions(threads, 1000, true); }},
        {"1000 cycles, complete points", measured(0)},
        {"200 + 1000 cycles, complete points", measured(200)}};
    std::vector<std::function<double()>> measurements;
    Cores cores[std::size(kinds)][2];
    for (std::size_t k = 0; k < std::size(kinds); ++k)
        for (int threads : {1, 2})
            measurements.push_back([&kinds, &cores, k, threads] {
                return cores[k][threads - 1].seconds_of([&] { kinds[k].run(threads); });
            });
    const auto times = in_turn(rounds, measurements);
    for (std::size_t k = 0; k < std::size(kinds); ++k) {
        const std::string name = "1000 values of b, 2 to 40 mm, " + std::string(kinds[k].name);
        const auto &one = times[2 * k], &two = times[2 * k + 1];
        row(name + ", one thread", one, "s", rate(one, b_count));
        row(name + ", two threads", two, "s",
            rate(two, b_count) + ", " + digits(median(ratios(one, two))) + " times as fast as one" +
                cores[k][1].text());
    }
}

void bench_map() {
    static constexpr std::size_t columns = 120, lines = 80;
    Cores cores;
    const auto map = [&] {
        return cores.seconds_of([&] {
            run_sweep_points(
                2, columns * lines, {.transient_cycles = 100, .cycles = 200}, [](std::size_t i) {
                    return closed_form_parameters(
                        linspace_value(0.002, 0.040, i % columns, columns),
                        linspace_value(0.3, 0.9, i / columns, lines));
                });
        });
    };
    const auto times = in_turn(rounds, {map});
    row("map of 120 x 80 points, b 2 to 40 mm, R 0.3 to 0.9, 100 + 200 cycles, two threads",
        times[0], "s", rate(times[0], columns * lines) + cores.text());
}

}  // namespace

void bench_sweeps() {
    bench_sweep_of_b();
    bench_map();
}

}  // namespace vines::bench
