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

double sweep(int threads, const Point& point) {
    return seconds_of([&] {
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
    for (const auto& kind : kinds)
        for (int threads : {1, 2})
            measurements.push_back([&kind, threads] { return sweep(threads, kind.point); });
    const auto times = in_turn(rounds, measurements);
    for (std::size_t k = 0; k < std::size(kinds); ++k) {
        const std::string name = "1000 values of b, 2 to 40 mm, " + std::string(kinds[k].name);
        const auto &one = times[2 * k], &two = times[2 * k + 1];
        row(name + ", one thread", one, "s", rate(one, values_of_b));
        row(name + ", two threads", two, "s",
            rate(two, values_of_b) + ", parallel efficiency " +
                digits(50 * median(ratios(one, two))) + " %");
    }
}

void bench_map() {
    constexpr std::size_t columns = 120, lines = 80;
    const auto map = [&] {
        return seconds_of([&] {
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
        "s", rate(times[0], columns * lines));
}

}  // namespace

void bench_sweeps() {
    bench_sweep_of_b();
    bench_map();
}

}  // namespace vines::bench
