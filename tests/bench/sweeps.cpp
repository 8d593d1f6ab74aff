#include <ctime>
#include <string>

#include "core/stability/lyapunov.hpp"
#include "core/sweep/parallel.hpp"
#include "core/sweep/point.hpp"
#include "parts.hpp"
#include "table.hpp"

namespace vines::bench {

namespace {

constexpr std::size_t values_of_b = 1000;
constexpr int rounds = 5;

Parameters closed_form(double b, double R) {
    Parameters p;
    p.b = b;
    p.R_plus = p.R_minus = R;
    p.damping = Damping::closed_form;
    return p;
}

double between(double from, double to, std::size_t k, std::size_t count) {
    return from + (to - from) * static_cast<double>(k) / static_cast<double>(count - 1);
}

/// The simulation and its exponents, and nothing else.
void spectrum_alone(const Parameters& p, double cycles) {
    const double end = cycles * p.cycle();
    Lyapunov lyapunov(p, 0, end, qr_alone);
    Observer* const observers[] = {&lyapunov};
    simulate(p, default_state(p), {end, 1000000, {}}, observers);
}

using Point = std::function<void(const Parameters&)>;

/// How many cores a piece of work had: on a busy machine less than its threads could use.
class Cores {
public:
    double seconds_of(const std::function<void()>& work) {
        const std::clock_t before = std::clock();  // of all threads
        const double seconds = bench::seconds_of(work);
        cores_.push_back(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC / seconds);
        return seconds;
    }
    std::string told() const { return ", on " + digits(median(cores_)) + " cores"; }

private:
    std::vector<double> cores_;
};

double sweep(int threads, const Point& point, Cores& cores) {
    return cores.seconds_of([&] {
        parallel(values_of_b, threads, [&](std::size_t i) {
            point(closed_form(between(0.002, 0.040, i, values_of_b), 0.6));
        });
    });
}

std::string rate(const std::vector<double>& seconds, std::size_t points) {
    return ", " + digits(static_cast<double>(points) / median(seconds)) + " points per second";
}

void bench_sweep_of_b() {
    const auto measured = [](double transient) {
        return [transient](const Parameters& p) {
            measure(p, default_state(p), {.transient_cycles = transient, .cycles = 1000}, {});
        };
    };
    const struct {
        const char* name;
        Point point;
    } kinds[] = {
        {"1000 cycles, all four exponents", [](const Parameters& p) { spectrum_alone(p, 1000); }},
        {"1000 cycles, all that a point holds", measured(0)},
        {"200 + 1000 cycles, all that a point holds", measured(200)}};
    std::vector<std::function<double()>> measurements;
    Cores cores[std::size(kinds)][2];
    for (std::size_t k = 0; k < std::size(kinds); ++k)
        for (int threads : {1, 2})
            measurements.push_back([&kinds, &cores, k, threads] {
                return sweep(threads, kinds[k].point, cores[k][threads - 1]);
            });
    const auto times = in_turn(rounds, measurements);
    for (std::size_t k = 0; k < std::size(kinds); ++k) {
        const std::string name = "1000 values of b, 2 to 40 mm, " + std::string(kinds[k].name);
        const auto &one = times[2 * k], &two = times[2 * k + 1];
        row(name + ", one thread", one, "s", rate(one, values_of_b));
        row(name + ", two threads", two, "s",
            rate(two, values_of_b) + ", " + digits(median(ratios(one, two))) +
                " times as fast as one" + cores[k][1].told());
    }
}

void bench_map() {
    constexpr std::size_t columns = 120, lines = 80;
    Cores cores;
    const auto map = [&] {
        return cores.seconds_of([&] {
            parallel(columns * lines, 2, [&](std::size_t i) {
                const Parameters p = closed_form(
                    between(0.002, 0.040, i % columns, columns),
                    between(0.3, 0.9, i / columns, lines));
                measure(p, default_state(p), {.transient_cycles = 100, .cycles = 200}, {});
            });
        });
    };
    const auto times = in_turn(rounds, {map});
    row("map of 120 x 80 points, b 2 to 40 mm, R .3 to .9, 100 + 200 cycles, two threads", times[0],
        "s", rate(times[0], columns * lines) + cores.told());
}

}  // namespace

void bench_sweeps() {
    bench_sweep_of_b();
    bench_map();
}

}  // namespace vines::bench
