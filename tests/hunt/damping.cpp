#include "damping.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include "core/sweep/parallel.hpp"
#include "exact_product.hpp"
#include "systems.hpp"

namespace vines::hunt {

namespace {

constexpr double tolerance = 1e-6;
constexpr int max_impacts_of_exact_product = 60;
// R = 0 soon leads to sticking: windows with few impacts keep some of these runs at rank 3.
int fewest_impacts(const Parameters& p) { return std::min(p.R_plus, p.R_minus) > 0 ? 5 : 3; }
// Double precision can depart from the true run; a window is excluded if the event times differ by
// more than this (in tau).
constexpr double max_departure = 1e-9;

/// Results of a window, and the exact values.
struct Window {
    std::string request;
    ExactExponents exact;
    Exponents qr, eigenvalues;
    int impacts, rank;
    double residual;  ///< of the sum rule, or of its equivalent at a lower rank
};

/// The run's first impacts: at most `most`, and at most the number for which the digits are enough.
/// Empty if these are too few, or if double precision departs from the true run.
std::optional<Window> window_of(const System& system, int most) {
    const auto& [p, start] = system;
    const double longest = 500 / p.Omega;
    for (; most >= fewest_impacts(p); most = most * 2 / 3) {
        EventRecord record;
        Lyapunov lyapunov(
            p, {0, longest}, {.qr = true, .eigenvalues = true, .history = shortest_history});
        Observer* const observers[] = {&record, &lyapunov};
        simulate(p, start, {longest, most, {}}, observers);
        while (!record.events.empty() && record.events.back().kind != Event::impact)
            record.events.pop_back();
        const TransferProduct& product = lyapunov.product();
        if (product.impacts() < fewest_impacts(p)) return std::nullopt;
        const Retraced run = retrace(p, start, record.events);
        if (!(run.departure < max_departure)) return std::nullopt;
        if (!exact_exponents_possible(digits_lost(p, run))) continue;
        char more[100];
        std::snprintf(
            more, sizeof more, "\"tau_end\":%.17g,\"max_impacts\":%d,\"include\":[\"exponents\"]",
            longest, most);
        return Window{
            request(system, more),
            exact_exponents(p, run),
            product.qr(),
            product.eigenvalues(),
            static_cast<int>(product.impacts()),
            product.rank(),
            product.sum_rule_residual()};
    }
    return std::nullopt;
}

/// First random system of this number that has a window.
Window random_window(std::uint64_t seed, int number) {
    std::mt19937_64 engine = engine_of(seed, number);
    for (;;) {
        const System system = strongly_damped(engine);
        const int fewest = fewest_impacts(system.parameters),
                  most = fewest == 3 ? 5 : max_impacts_of_exact_product;
        if (auto window =
                window_of(system, fewest + static_cast<int>(engine() % (most - fewest + 1))))
            return *window;
    }
}

/// Largest difference of two spectra, each sorted in descending order; infinite if only one has a
/// value.
double difference(Exponents a, Exponents b) {
    double most = 0;
    std::sort(a.begin(), a.end(), std::greater<>());
    std::sort(b.begin(), b.end(), std::greater<>());
    for (int k = 0; k < 4; ++k) {
        if (status_of(a[k]) != status_of(b[k])) return INFINITY;
        if (status_of(a[k]) == Status::ok) most = std::max(most, std::abs(a[k] - b[k]));
    }
    return most;
}

void print(const char* name, Exponents e) {
    std::sort(e.begin(), e.end(), std::greater<>());
    std::printf("    %-20s %.12g %.12g %.12g %.12g\n", name, e[0], e[1], e[2], e[3]);
}

}  // namespace

bool hunt_exponents(int systems, std::uint64_t seed, int threads) {
    std::vector<std::optional<Window>> windows(static_cast<std::size_t>(systems));
    parallel(windows.size(), threads, nullptr, [&](std::size_t i) {
        windows[i] = random_window(seed, static_cast<int>(i));
    });
    int of_rank[5] = {}, wrong_qr = 0, wrong_eigenvalues = 0, wrong_rank = 0, wrong_residual = 0;
    double worst = 0;
    for (const auto& window : windows) {
        const auto& [request, exact, qr, eigenvalues, impacts, rank, residual] = *window;
        const double of_qr = difference(qr, exact.qr),
                     of_eigenvalues = difference(eigenvalues, exact.eigenvalues);
        const bool rank_is_wrong = rank != exact.rank || impacts != exact.impacts,
                   residual_is_wrong = !(residual < tolerance);
        ++of_rank[exact.rank];
        wrong_rank += rank_is_wrong;
        wrong_residual += residual_is_wrong;
        wrong_qr += of_qr > tolerance;
        wrong_eigenvalues += of_eigenvalues > tolerance;
        worst = std::max({worst, of_qr, of_eigenvalues});
        if (!rank_is_wrong && !residual_is_wrong && std::max(of_qr, of_eigenvalues) <= tolerance)
            continue;
        std::printf(
            "WRONG  exponents: %d impacts (%d), rank %d (%d), sum rule residual %.3g\n    %s\n",
            impacts, exact.impacts, rank, exact.rank, residual, request.c_str());
        print("qr", qr);
        print("qr, exact", exact.qr);
        print("eigenvalues", eigenvalues);
        print("eigenvalues, exact", exact.eigenvalues);
    }
    std::printf(
        "%d strongly damped systems (rank 4: %d, 3: %d, 2: %d): %d wrong qr, %d wrong eigenvalues, "
        "%d wrong ranks, "
        "%d residuals above 1e-6; worst difference %.2g\n",
        systems, of_rank[4], of_rank[3], of_rank[2], wrong_qr, wrong_eigenvalues, wrong_rank,
        wrong_residual, worst);
    return wrong_qr + wrong_eigenvalues + wrong_rank + wrong_residual == 0;
}

}  // namespace vines::hunt
