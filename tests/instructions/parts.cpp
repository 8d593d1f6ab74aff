// Program whose instructions are counted. Each part is a function that callgrind recognises by its
// name (counting begins and ends with it, see count.mjs). main() calls all parts twice: first to
// fill the tables that a thread keeps, then to be counted. It prints the compiler, and for each
// part its name, its unit and the number of units.
#include <cstdio>
#include <string>

#include "api/json_text.hpp"
#include "api/simulate.hpp"
#include "core/motion/record.hpp"
#include "core/sweep/point.hpp"

using namespace vines;

namespace {

Parameters closed_form(double b) {
    Parameters p;
    p.b = b;
    p.damping = Damping::closed_form;
    return p;
}

constexpr long impacts = 2000;

double trajectory(double b) {
    const Parameters p = closed_form(b);
    ImpactRecord record;
    Observer* const observers[] = {&record};
    simulate(p, default_state(p), {1e9, impacts, {}}, observers);
    return static_cast<double>(record.entries.size());
}

double spectrum(double b) {
    const Parameters p = closed_form(b);
    Lyapunov lyapunov(p, {0, 1e9}, qr_alone);
    Observer* const observers[] = {&lyapunov};
    simulate(p, default_state(p), {1e9, impacts, {}}, observers);
    return static_cast<double>(lyapunov.product().impacts());
}

double point(double b) {
    const Parameters p = closed_form(b);
    return measure(p, default_state(p), {}, {}).measured ? 1 : 0;
}

}  // namespace

extern "C" {
[[gnu::noinline]] double part_trajectory_15() { return trajectory(0.015); }
[[gnu::noinline]] double part_trajectory_22() { return trajectory(0.022); }
[[gnu::noinline]] double part_spectrum_15() { return spectrum(0.015); }
[[gnu::noinline]] double part_spectrum_22() { return spectrum(0.022); }
[[gnu::noinline]] double part_point_15() { return point(0.015); }
[[gnu::noinline]] double part_point_22() { return point(0.022); }
[[gnu::noinline]] double part_answer() {
    // 300 / (2 pi) * 41.88 = 2000 samples.
    const auto request = api::Json::parse(
        R"({"b":0.015,"tau_end":300,"samples_per_cycle":41.88,"include":["series"]})");
    const std::string text =
        api::json_text(api::simulate_in_parts(api::read_simulate_request(request), {}).json);
    return text.size() > 100000 ? 1 : 0;
}
}

#ifdef __x86_64__
constexpr const char* processor = "x86-64";
#else
constexpr const char* processor = "another processor";
#endif

int main() {
    std::printf("g++ %d, %s\n", __GNUC__, processor);
    const struct {
        const char *name, *unit;
        double (*run)();
    } parts[] = {
        {"part_trajectory_15", "impact", part_trajectory_15},
        {"part_trajectory_22", "impact", part_trajectory_22},
        {"part_spectrum_15", "impact", part_spectrum_15},
        {"part_spectrum_22", "impact", part_spectrum_22},
        {"part_point_15", "point", part_point_15},
        {"part_point_22", "point", part_point_22},
        {"part_answer", "answer", part_answer}};
    for (const auto& p : parts) {
        p.run();
        std::printf("%s %s %.0f\n", p.name, p.unit, p.run());
    }
}
