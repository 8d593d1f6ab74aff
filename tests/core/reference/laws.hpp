// The systems whose motion under gravity, friction, R of the speed and a recorded load is known to
// 60 digits. Both the program that makes the files and the test that reads them use these doubles.
#pragma once

#include <string>
#include <vector>

namespace vines::test {

inline constexpr int law_impacts = 32;

struct LawCase {
    std::string name;
    double epsilon = 0.05, lambda = 0.4, G = 0.4, Omega = 0.93, b = 0.02, R = 0.6;
    double gravity = 0, friction = 0;
    std::vector<double> speed = {}, table = {};    // R of the speed
    std::vector<double> load_tau = {}, load = {};  // acceleration of the base
    double y0 = 0.01, y_dot0 = 0.002;
};

inline std::vector<LawCase> law_cases() {
    LawCase gravity{.name = "gravity"}, friction{.name = "friction"},
        restitution{.name = "restitution"}, load{.name = "load"}, all{.name = "all"};
    gravity.gravity = all.gravity = 0.004;
    friction.friction = 0.004, all.friction = 0.002;
    restitution.speed = all.speed = {0.005, 0.02, 0.06};
    restitution.table = all.table = {0.85, 0.7, 0.5};
    load.G = all.G = 0;
    for (int i = 0; i <= 400; ++i) {
        // A parabola for each half cycle of 3.125, and a saw of other periods.
        const double at = (i % 25) / 25.0, half = (i / 25) % 2 == 0 ? 1 : -1;
        load.load_tau.push_back(i * 0.125 + (i % 3) * 0.0078125);
        load.load.push_back(0.1 * half * at * (1 - at) + 0.002 * ((i * 7) % 11 - 5));
    }
    all.load_tau = load.load_tau, all.load = load.load;
    return {gravity, friction, restitution, load, all};
}

}  // namespace vines::test
