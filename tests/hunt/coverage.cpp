#include "coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "../core/support.hpp"
#include "core/analysis/analysis.hpp"
#include "core/sweep/parallel.hpp"

namespace vines::hunt {

namespace {

constexpr const char* quantities[] = {"lambda1", "lambda2", "x_rms", "z", "share_impacts"};
constexpr std::size_t quantity_count = std::size(quantities);
// Quantiles of Student's distribution with seven (exponents) and four degrees of freedom for the
// two-sided probabilities of one, two and three standard deviations.
constexpr std::array<double, 3> of_exponents = {1.0767, 2.4288, student_three_sigma},
                                of_others = {1.1416, 2.8693, 6.6202};

struct WithError {
    double value, error;
};
struct Estimates {
    std::array<WithError, quantity_count> of;
    bool stationary;
};

struct Examined {
    std::string name;
    Parameters parameters;
};

std::vector<Examined> systems() {
    std::vector<Examined> list;
    const auto table = [&](double b, Damping damping) {
        list.push_back(
            {std::string(
                 damping == Damping::closed_form ? "Table 1, closed form, b = "
                                                 : "Table 1, eq. (1), b = ") +
                 std::to_string(static_cast<int>(std::lround(1000 * b))) + " mm",
             test::table1(b, damping)});
    };
    for (const double b : {0.003, 0.020, 0.025, 0.034, 0.040}) table(b, Damping::closed_form);
    for (const double b : {0.025, 0.031, 0.040}) table(b, Damping::equation_of_motion);
    const auto other = [&](double epsilon, double lambda, double Omega, double R, double b) {
        Parameters p;
        p.epsilon = epsilon, p.lambda = lambda, p.Omega = Omega, p.G = 0.01;
        p.R_plus = p.R_minus = R, p.b = b;
        char name[100];
        std::snprintf(
            name, sizeof name, "epsilon %g, lambda %g, Omega %g, R %g, b = %g mm", epsilon, lambda,
            Omega, R, 1000 * b);
        list.push_back({name, p});
    };
    other(0.05, 0.4, 1.02, 0.7, 0.03);
    other(0.02, 1, 0.97, 0.8, 0.02);
    other(0.1, 0.5, 1.0, 0.5, 0.02);
    other(0.3, 0.3, 1.1, 0.65, 0.02);
    return list;
}

/// Consecutive windows of a motion; after a capture by a periodic orbit the motion starts anew.
std::vector<Estimates> windows_of(const Parameters& p, int count, int cycles) {
    std::vector<Estimates> found;
    int starts = 0;
    constexpr int transient = 100, most_starts = 50;
    const auto begin = [&] {
        State start = default_state(p);
        start.y *= 1 - 1e-3 * ++starts;
        return simulate(p, start, {.tau_end = transient * p.cycle()}).state;
    };
    State state = begin();
    while (static_cast<int>(found.size()) < count && starts < most_starts) {
        const double tau_end = cycles * p.cycle();
        const Analysis a = analyse(
            {.parameters = p,
             .start = state,
             .tau_end = tau_end,
             .max_impacts = 10000000,
             .window = {0, tau_end},
             .parts = {.energy = true, .regime = true},
             .estimators = qr_alone});
        if (a.regime->orbit) {
            state = begin();
            continue;
        }
        state = a.outcome.state;
        const WindowExponents& e = *a.exponents;
        const Exponents lambda = e.product.qr(), &error = e.growth.standard_error;
        const EnergyBalance& energy = a.energy->balance;
        found.push_back(
            {{{{lambda[0], error[0]},
               {lambda[1], error[1]},
               {energy.rms, energy.rms_error},
               {a.regime->z_overall, a.regime->z_error},
               {*energy.share_impacts, energy.share_impacts_error}}},
             !halves_differ(e.growth.difference_of_halves) &&
                 !halves_differ(energy.difference_of_halves)});
    }
    return found;
}

/// Percentages outside, of one quantity.
std::array<double, 3> outside(const std::vector<Estimates>& windows, std::size_t quantity) {
    std::vector<WithError> finite;
    for (const Estimates& w : windows)
        if (std::isfinite(w.of[quantity].value)) finite.push_back(w.of[quantity]);
    double mean = 0;
    for (const WithError& e : finite) mean += e.value / static_cast<double>(finite.size());
    std::array<double, 3> share{};
    const auto& quantiles = quantity < 2 ? of_exponents : of_others;
    for (std::size_t k = 0; k < share.size(); ++k)
        share[k] = 100.0 *
                   static_cast<double>(std::ranges::count_if(
                       finite,
                       [&](const WithError& e) {
                           return std::abs(e.value - mean) > quantiles[k] * e.error;
                       })) /
                   static_cast<double>(finite.size());
    return share;
}

}  // namespace

void print_coverage(int windows, int cycles, int threads) {
    const std::vector<Examined> list = systems();
    std::vector<std::vector<Estimates>> found(list.size());
    parallel(list.size(), threads, nullptr, [&](std::size_t i) {
        found[i] = windows_of(list[i].parameters, windows, cycles);
    });
    std::array<std::array<double, 3>, quantity_count> mean{};
    double mean_drifting = 0;
    std::printf("| windows of %d cycles | number", cycles);
    for (const char* q : quantities) std::printf(" | %s", q);
    std::printf(" | not stationary |\n| --- | --- | ---");
    for (std::size_t q = 0; q < quantity_count; ++q) std::printf(" | ---");
    std::printf(" |\n");
    const auto print = [](const std::array<double, 3>& share) {
        std::printf(" | %.1f, %.1f, %.2f", share[0], share[1], share[2]);
    };
    for (std::size_t i = 0; i < list.size(); ++i) {
        std::printf("| %s | %zu", list[i].name.c_str(), found[i].size());
        for (std::size_t q = 0; q < quantity_count; ++q) {
            const auto share = outside(found[i], q);
            print(share);
            for (std::size_t k = 0; k < 3; ++k)
                mean[q][k] += share[k] / static_cast<double>(list.size());
        }
        const double drifting =
            100.0 *
            static_cast<double>(std::ranges::count(found[i], false, &Estimates::stationary)) /
            static_cast<double>(found[i].size());
        std::printf(" | %.1f |\n", drifting);
        mean_drifting += drifting / static_cast<double>(list.size());
    }
    std::printf("| all | ");
    for (const auto& share : mean) print(share);
    std::printf(" | %.1f |\n", mean_drifting);
}

}  // namespace vines::hunt
