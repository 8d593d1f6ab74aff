// The paper's system (Table 1) run from its initial state and from others: all that the chapters
// ask of the simulation.
#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/analysis/analysis.hpp"
#include "report/statistics.hpp"

namespace vines::report {

/// The window of the paper's exponents ends here (Table 2, first row); its other runs are about as
/// long.
inline constexpr double window_end = 1708.9;

/// For parallel(): of the machine.
int all_threads();

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

/// What the windows of an ensemble have in common.
enum class WindowsOf {
    tau_1690,     ///< their length: Table 2's
    contacts_400  ///< how many contacts they hold: Table 3's (chapters/table_3.cpp)
};
inline constexpr double window_tau = 1690;
inline constexpr std::size_t window_contacts = 400;

/// The exponents over many windows: stretches of several runs, of which each starts a little
/// different and ends, at the latest, where a periodic orbit captures it (b = 22 mm:
/// docs/paper.md). What begins before tau = 1690 is left out: it holds the transient from rest.
struct Ensemble {
    static constexpr int runs = 12;
    static constexpr double tau_end = 11 * window_tau;

    struct Window {
        double T;
        Exponents qr;
        /// (lambda1 - lambda3) T of raw_product; NaN where one of them is none.
        double raw_spread;
    };
    std::vector<Window> windows;
    std::vector<double> capture_tau;  ///< of each run that was chaotic until an orbit captured it
    /// lambda1 of the orbit that every run comes to without a chaotic transient.
    std::optional<double> periodic;

    /// Of the k-th exponent (0 to 3), over the windows where it is a number: a stick makes lambda3
    /// and lambda4 minus infinity.
    Moments lambda(int k) const;
    Moments raw_spread() const;
    Moments duration() const;
};

/// Where each of so many random starts comes to, always the same ones: |x'|, |x| <= .008 and
/// |y'| <= .01 (m, and m per unit of tau), y anywhere in the cavity. Judged from tau = 1500 to
/// 3000.
std::vector<Regime> regimes_of_random_starts(const Parameters& parameters, int starts);

/// The regimes at several b (m) from the paper's initial state, over ten times its window without
/// the first tenth.
std::vector<Regime> long_regimes(const std::vector<double>& b, Damping damping);

/// By the closed form's damping and ten times as long, for what one window has too little of: the
/// series, the moduli and the regime alone. `b` in m.
Response long_response(double b);

/// A number of each of several chaotic runs, which are samples of one motion: that of the first,
/// which is the paper's, and what is typical.
struct Typical {
    double first, median, lower_quartile, upper_quartile;

    std::string in_words(int decimals) const;
};
/// NaN is left out of the median and the quartiles; `runs` of Runs::neighbours().
template <class Number>
Typical typical(const std::vector<Response>& runs, Number number) {
    std::vector<double> values;
    for (const Response& r : runs) values.push_back(number(r));
    const double first = values.front();
    std::erase_if(values, [](double v) { return std::isnan(v); });
    return {first, median(values), quantile(values, 0.25), quantile(values, 0.75)};
}

/// The runs that more than one chapter rests on: each is made when it is first asked for. `b` in m.
class Runs {
public:
    const Response& response(double b, Damping damping = Damping::closed_form);
    /// That run and those of starts beside it: where the motion is chaotic, each of them soon is
    /// another one, as that of another computer is. Series, moduli and regime alone, and the
    /// exponents by qr and raw_product.
    const std::vector<Response>& neighbours(double b, Damping damping = Damping::closed_form);
    const Ensemble& ensemble(double b, WindowsOf size, Damping damping = Damping::closed_form);

private:
    std::map<std::pair<double, Damping>, Response> responses_;
    std::map<std::pair<double, Damping>, std::vector<Response>> neighbours_;
    std::map<std::tuple<double, WindowsOf, Damping>, Ensemble> ensembles_;
};

}  // namespace vines::report
