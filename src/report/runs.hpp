// The paper's system (Table 1) run from its initial state and from others: all that the chapters
// ask of the simulation.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/analysis/analysis.hpp"
#include "report/statistics.hpp"

namespace vines::report {

/// The window of the paper's exponents ends here (Table 2, first row); its other runs are about as
/// long.
inline constexpr double window_end = 1708.9;

/// Table 1 with a half-width b, in m.
Parameters table1(double b, Damping damping);

/// I is 1, VI is 6: what a verdict on a regime rests on.
inline double number_of(RegimeType type) { return static_cast<double>(type); }

/// How many of them are above zero.
long positive(const Exponents& lambda);

/// Everything about one run from the paper's initial state to window_end.
struct Response {
    Parameters parameters;
    Analysis run;  ///< 32 samples a cycle; exponents from the first impact on, by all estimators

    std::string type() const;  ///< "Type II"
};

/// x and y alone, from the paper's initial state to tau_end; `b` in m.
Series series_until(double b, double tau_end);

/// lambda over many windows as long as the paper's: stretches of several runs, of which each starts
/// a little different and ends, at the latest, where a periodic orbit captures it (b = 22 mm:
/// docs/paper.md).
struct Ensemble {
    static constexpr int runs = 12;
    static constexpr int windows_per_run = 11;  ///< the first holds the transient from rest
    static constexpr double window = 1690;
    static constexpr double tau_end = windows_per_run * window;

    std::vector<Exponents> windows;  ///< by qr
    /// (lambda1 - lambda3) T of raw_product in each window where both are numbers; none where it
    /// was not asked for.
    std::vector<double> raw_spreads;
    int captured = 0;  ///< runs that were chaotic until an orbit captured them
    /// lambda1 of the orbit that every run comes to without a chaotic transient.
    std::optional<double> periodic;

    /// Of the k-th exponent (0 to 3), over the windows where it is a number: a stick makes lambda3
    /// and lambda4 minus infinity.
    Moments lambda(int k) const;
};

/// Where each of so many random starts comes to, always the same ones: |x'|, |x| <= .008 and
/// |y'| <= .01 (m, and m per unit of tau), y anywhere in the cavity. Judged from tau = 1500 to
/// 3000.
std::vector<Regime> regimes_of_random_starts(const Parameters& parameters, int starts);

/// The runs that more than one chapter rests on: each is made when it is first asked for. `b` in m.
class Runs {
public:
    const Response& response(double b, Damping damping = Damping::closed_form);
    const Ensemble& ensemble(double b, Damping damping = Damping::closed_form);
    /// By the closed form's damping, with raw_spreads, which take half as long again.
    const Ensemble& ensemble_with_raw_product(double b);

private:
    using Key = std::pair<double, Damping>;
    std::map<Key, Response> responses_;
    std::map<Key, Ensemble> ensembles_;
};

}  // namespace vines::report
