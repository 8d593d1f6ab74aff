// Steps of the search, each over the worst motion of all default starts:
// 1. a row of b from above the amplitude C without absorber down to part of it, or to about G: with
//    weak damping C is many times G, and strongly modulated responses begin at one to a few G;
// 2. more b around the best one, ever closer;
// 3. the row of step 1 at the frequencies f_tolerance below and above;
// 4. tolerance_ratio of each b of step 1: the largest value at the three frequencies among the b
//    within the factor F_tolerance. The b with the smallest one is the robust b;
// 5. for the best and the robust b the margin of f, by doubling and halving the change of f. The
//    margin of F follows from steps 1 and 2.
#include "core/sweep/recommend.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

// Long enough to determine the rms of a strongly modulated response to within 5 %.
constexpr PointOptions length_of_try{.transient_cycles = 200, .cycles = 400, .max_impacts = 50000};

// The row of b: the ratio of neighbours (F_tolerance is two steps), the largest b below C, over C,
// the number of b above it and of most b below it, and the last b, over C and over G.
const double step = std::sqrt(F_tolerance);
constexpr double below_C = 0.99;
constexpr int steps_above = 2, most_steps_below = 45;
constexpr double last_b_over_C = 0.3, last_b_over_G = 0.9;
// Tries around the best one: their number on each side, and the first and last distance, over b.
constexpr int reach = 4;
constexpr double most_width = 0.02, least_width = 0.003;
constexpr std::size_t most_tries = 100;
// First and largest change of f in the search for its margin, and the halvings after it.
constexpr double first_change = 0.0025, most_change = 0.32;
constexpr int halvings = 3;
// The robust b differs from the best one if its tolerance_ratio is smaller by this factor.
constexpr double robust_gain = 0.9;

/// A try of a b, up to its regime: the worst of the motions from all starts. A motion that is not
/// measured, for too many impacts, excludes its b.
Recommendation tried(Parameters p, double b, const StopRequest& stop) {
    p.b = b;
    Recommendation t{b};
    for (const auto& [name, start] : default_starts(p)) {
        const PointResult r = measure(p, start, length_of_try, stop);
        if (stop && stop()) throw Stopped();
        const double ratio = r.measured ? r.x_rms_ratio : infinity;
        if (ratio > t.x_rms_ratio) t = {b, ratio, name, r.x_max, r.regime.type};
    }
    return t;
}

/// The search in one system, apart from b.
struct Search {
    const Parameters parameters;
    const double C;  // amplitude without absorber
    const StopRequest& stop;
    std::vector<Recommendation> tries = {};  // at the given frequency

    double top() const { return below_C * C; }

    const Recommendation& best() const {
        return *std::ranges::min_element(tries, {}, [&](const Recommendation& t) {
            return t.b <= top() ? t.x_rms_ratio : infinity;
        });
    }

    void try_b(const std::vector<double>& bs) {
        for (const double b : bs) tries.push_back(tried(parameters, b, stop));
    }

    /// Steps 1 and 2; returns the b of the row.
    std::vector<double> run() {
        const double last = std::min(last_b_over_C * C, last_b_over_G * parameters.G),
                     steps = elementary::log(top() / last) / elementary::log(step);
        std::vector<double> row;
        for (int k = -steps_above; k <= most_steps_below && k < steps + 1; ++k)
            row.push_back(top() * elementary::pow(step, -k));
        try_b(row);
        for (double width = most_width; width > least_width;) {
            const double middle = best().b;
            std::vector<double> around;
            for (int k = -reach; k <= reach; ++k)
                if (const double b = middle * elementary::pow(1 + width, k); k != 0 && b <= top())
                    around.push_back(b);
            try_b(around);
            // The best one can lie beyond the last of them.
            const bool at_end = best().b == around.front() || best().b == around.back();
            if (!at_end || tries.size() > most_tries) width /= reach;
        }
        return row;
    }
};

/// Tries at one frequency.
struct AtFrequency {
    double C;  // amplitude without absorber there
    std::vector<Recommendation> tries;
};

Parameters at_frequency(Parameters p, double factor) {
    p.Omega *= factor;
    return p;
}

/// Step 4; `rows` are those at all frequencies. Half a step of slack covers the gaps between tries.
double tolerance_ratio(double b, const std::vector<AtFrequency>& rows) {
    const double factor = F_tolerance * std::sqrt(step);
    double C_most = 0, worst = 0;
    for (const AtFrequency& row : rows) {
        C_most = std::max(C_most, row.C);
        for (const Recommendation& t : row.tries)
            if (t.b < b * factor && t.b > b / factor)
                worst = std::max(worst, t.x_rms_ratio * row.C);
    }
    return worst / C_most;
}

/// Factors on F: with F/s, b does what s b does with F. `by_b`: the tries in the order of b.
Interval margin_of_F(const std::vector<Recommendation>& by_b, double b, double limit) {
    auto low = std::ranges::find(by_b, b, &Recommendation::b), high = low;
    while (low != by_b.begin() && low[-1].x_rms_ratio <= limit) --low;
    while (high + 1 != by_b.end() && high[1].x_rms_ratio <= limit) ++high;
    return {b / high->b, b / low->b};
}

/// The largest change of f, upwards or downwards, that keeps the ratio within the limit.
double f_margin(const Search& s, double b, double limit, bool upwards) {
    auto holds = [&](double change) {
        const Parameters p = at_frequency(s.parameters, 1 + (upwards ? change : -change));
        return tried(p, b, s.stop).x_rms_ratio <= limit;
    };
    double within = 0, beyond = first_change;
    for (; holds(beyond); beyond *= 2)
        if ((within = beyond) >= most_change) return within;
    for (int i = 0; i < halvings; ++i) {
        const double middle = (within + beyond) / 2;
        (holds(middle) ? within : beyond) = middle;
    }
    return within;
}

Recommendation completed(const Search& s, Recommendation t, const std::vector<AtFrequency>& rows) {
    const Parameters& p = s.parameters;
    const double limit = (1 + t.x_rms_ratio) / 2;
    std::vector<Recommendation> by_b = s.tries;
    std::ranges::sort(by_b, {}, &Recommendation::b);
    t.fold_share = manifold_fold(p.R_plus, p.Omega, t.b).C / s.C;
    t.tolerance_ratio = tolerance_ratio(t.b, rows);
    t.margin_F = margin_of_F(by_b, t.b, limit);
    t.margin_f = {1 - f_margin(s, t.b, limit, false), 1 + f_margin(s, t.b, limit, true)};
    return t;
}

Recommendations recommendations(Search& s, const std::vector<double>& row) {
    std::vector<AtFrequency> rows = {{s.C, s.tries}};
    for (const double factor : {1 - f_tolerance, 1 + f_tolerance}) {
        const Parameters p = at_frequency(s.parameters, factor);
        const auto C = free_amplitude(p);
        if (!C) continue;  // undamped resonance has no amplitude to refer to
        rows.push_back({*C, {}});
        for (const double b : row) rows.back().tries.push_back(tried(p, b, s.stop));
    }
    auto tolerance_of = [&](const Recommendation& t) { return tolerance_ratio(t.b, rows); };
    // The b of the row that stay within it when changed by the factor F_tolerance.
    const std::span<const Recommendation> candidates(
        s.tries.data() + steps_above, row.size() - steps_above - 2);
    const Recommendation& robust = *std::ranges::min_element(candidates, {}, tolerance_of);
    Recommendations r{completed(s, s.best(), rows), {}};
    if (tolerance_of(robust) < robust_gain * r.best->tolerance_ratio && robust.x_rms_ratio < 1)
        r.robust = completed(s, robust, rows);
    return r;
}

}  // namespace

Recommendations recommended_b(const Parameters& p, const StopRequest& stop) {
    const auto C = free_amplitude(p);
    if (!p.has_straight_flights() || !p.has_constant_R() || !p.has_equal_walls() || p.R_plus == 1 ||
        !C || *C == 0)
        return {};
    try {
        Search search{p, *C, stop};
        const std::vector<double> row = search.run();
        if (!(search.best().x_rms_ratio < 1)) return {};
        return recommendations(search, row);
    } catch (const Stopped&) {
        return {};
    }
}

}  // namespace vines
