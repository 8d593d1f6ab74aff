#include "api/answer_size.hpp"

#include <algorithm>

namespace vines::api {

namespace {

// Words, parameters, the orbit, 200 points on each branch of the manifold.
constexpr double rest = 64 * 1024;
// The exponents of one window by three estimators, with their words.
constexpr double window = 2048;
constexpr double fewest_points = 256;

struct AnswerSize {
    double point = 0, impact = 0, fixed = rest;
};

AnswerSize size_of(const SimulateRequest& r) {
    // "-2.2250738585072014e-308,": the longest double that reads back to the same bits.
    // count: up to 2000000; word: true, false, null.
    constexpr double number = 25, side = 3, count = 8, word = 6, bracket = 2;
    AnswerSize size;
    const double si = r.system.si ? number : 0;  // of each column that has a twin in SI
    size.fixed += window * static_cast<double>(r.wanted.windows.size());
    if (r.includes("series")) size.point += 6 * number + 4 * si;
    if (r.includes("exponents")) {  // tau and four exponents, and the floor
        if (r.wanted.estimators.qr) size.point += 5 * number + si;
        if (r.wanted.estimators.raw_product) size.point += 6 * number + si;
        if (r.wanted.estimators.eigenvalues)
            size.fixed += static_cast<double>(most_eigenvalue_entries) * (5 * number + si);
    }
    if (r.includes("eigenvalues")) size.point += 14 * number + si + 3 * bracket;
    if (r.includes("matrices")) size.point += 49 * number + si + 15 * bracket;
    if (r.includes("section")) size.point += 11 * number + 7 * si + side;
    if (r.includes("regime")) size.point += 6 * number + 3 * si;    // z_moving, stretches
    if (r.includes("manifold")) size.point += 3 * number + 2 * si;  // the half cycles
    if (r.wanted.perturbation) size.point += 7 * number + 3 * si;
    size.impact = 2 * (number + si) + side + count;  // sticking
    // Impacts, touches.
    if (r.includes("impacts"))
        size.impact += 11 * number + 8 * si + side + word + number + si + side;
    if (r.wanted.perturbation) size.impact += number + si + side;
    return size;
}

}  // namespace

void fit_answer(SimulateRequest& r, std::size_t bytes, Warnings& warnings) {
    const AnswerSize size = size_of(r);
    const double room = std::max(0.0, static_cast<double>(bytes) - size.fixed);
    const double points = static_cast<double>(r.wanted.most_points) * size.point,
                 impacts = static_cast<double>(r.wanted.most_listed) * size.impact;
    if (points + impacts <= room) return;
    // What needs less than half of the room gets all that it needs.
    const double for_points = std::min(
                     points, std::max({room / 2, room - impacts, fewest_points * size.point})),
                 for_impacts = room - for_points;
    if (impacts > for_impacts)
        r.wanted.most_listed = static_cast<std::size_t>(std::max(1.0, for_impacts / size.impact));
    if (points <= for_points) return;
    const std::size_t fit = static_cast<std::size_t>(for_points / size.point);
    warnings.push_back(
        "max_points is " + std::to_string(fit) + " instead of " +
        std::to_string(r.wanted.most_points) + limit_of(bytes));
    r.wanted.most_points = r.wanted.estimators.history = fit;
}

}  // namespace vines::api
