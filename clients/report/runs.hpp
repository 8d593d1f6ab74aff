// Runs of the paper's system (Table 1) from its initial state and from others.
#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/analysis/analysis.hpp"
#include "core/sweep/parallel.hpp"
#include "program/process.hpp"
#include "report/statistics.hpp"

namespace vines::report {

/// End of the window of the paper's exponents (Table 2, first row), tau.
inline constexpr double window_end = 1708.9;

Parameters table1(double b, Damping damping);  ///< Table 1 with the clearance b, m

double positive(const Exponents& lambda);  ///< number of exponents above zero

/// One run from the paper's initial state, or slightly beside it.
struct PaperRun {
    Parameters parameters;
    Analysis run;  ///< 32 samples per cycle; exponents from the first impact on

    const Regime& regime() const { return *run.regime; }
    const TransferProduct& product() const { return run.exponents->product; }
    std::string type() const { return std::string("Type ") + name_of(regime().type); }
};
/// Results with the damping of the closed form, and with that of eq. (1).
template <class Results>
struct Both {
    const Results &here, &by_equation;
};
using BothRuns = Both<PaperRun>;

/// A run from the paper's initial state or another one.
PaperRun run_until(
    const Parameters& parameters, double tau_end, const Parts& parts,
    const ExponentOptions& estimators = qr_alone, const std::optional<State>& start = {});

/// The results of make(0) to make(count - 1), computed on all cores.
template <class Make>
auto in_parallel(std::size_t count, const Make& make) {
    using Made = decltype(make(count));
    std::vector<std::optional<Made>> made(count);
    parallel(count, cores(), nullptr, [&](std::size_t k) { made[k].emplace(make(k)); });
    std::vector<Made> results;
    for (auto& result : made) results.push_back(std::move(*result));
    return results;
}

/// Common property of an ensemble's windows.
enum class WindowsOf {
    tau_1690,     ///< equal length, as in Table 2
    contacts_400  ///< equal number of contacts, as in Table 3 (chapters/table_3.cpp)
};
inline constexpr double window_tau = 1690;
inline constexpr std::size_t window_contacts = 400;

/// Exponents over many windows. The windows follow each other in several runs with slightly
/// different starts; a run ends, at the latest, where a periodic orbit captures it (b = 22 mm:
/// docs/paper.md). The transient from rest, up to tau = 1690, is left out.
struct Ensemble {
    static constexpr int runs = 12;
    static constexpr double tau_end = 11 * window_tau;

    struct Window {
        double T;
        Exponents qr;
        double raw_spread;  ///< (lambda1 - lambda3) T by raw_product; NaN if not finite
    };
    std::vector<Window> windows;
    std::vector<double> capture_tau;  ///< times at which an orbit captured a chaotic run
    /// lambda1 of the orbit that every run reaches without a chaotic transient.
    std::optional<double> periodic;

    /// Moments of the k-th exponent (0 to 3) over the windows in which it is finite: a sticking
    /// phase makes lambda3 and lambda4 minus infinity.
    Moments lambda(int k) const;
    Moments raw_spread() const;
    Moments duration() const;
};

using BothEnsembles = Both<Ensemble>;

/// Regimes reached from random starts (the same ones in every call): |x'|, |x| <= .008 and |y'| <=
/// .01 (m, and m per unit of tau), y anywhere in the cavity. Judged from tau = 1500 to 3000.
std::vector<Regime> regimes_of_random_starts(const Parameters& parameters, std::size_t starts);

/// Regimes at several b (m) from the paper's initial state, from tau = 1709 to ten times that.
std::vector<Regime> long_regimes(const std::vector<double>& b, Damping damping);

/// A quantity of several chaotic runs: its value for the paper's start, median and quartiles.
struct Typical {
    double first, median, lower_quartile, upper_quartile;

    std::string in_words(int decimals) const;
};
/// Statistics of `number` over RunCache::neighbours(). Median and quartiles ignore NaN.
template <class Number>
Typical typical(const std::vector<PaperRun>& runs, Number number) {
    std::vector<double> values;
    for (const PaperRun& r : runs) values.push_back(number(r));
    const double first = values.front();
    std::erase_if(values, [](double v) { return std::isnan(v); });
    return {first, median(values), quantile(values, 0.25), quantile(values, 0.75)};
}

/// Runs that several chapters use; each is computed at its first use. `b` in m.
class RunCache {
public:
    /// The run to window_end, with all parts, exponents by all estimators.
    const PaperRun& paper_run(double b, Damping damping = Damping::closed_form);
    BothRuns both(double b) { return {paper_run(b), paper_run(b, Damping::equation_of_motion)}; }
    /// That run and others from slightly different starts, which soon differ, like runs on other
    /// computers. Only series, moduli, regime, and the exponents by qr and raw_product.
    const std::vector<PaperRun>& neighbours(double b, Damping damping = Damping::closed_form);
    const Ensemble& ensemble(double b, WindowsOf size, Damping damping = Damping::closed_form);
    BothEnsembles both_ensembles(double b, WindowsOf size) {
        return {ensemble(b, size), ensemble(b, size, Damping::equation_of_motion)};
    }

private:
    std::map<std::pair<double, Damping>, PaperRun> responses_;
    std::map<std::pair<double, Damping>, std::vector<PaperRun>> neighbours_;
    std::map<std::tuple<double, WindowsOf, Damping>, Ensemble> ensembles_;
};

}  // namespace vines::report
