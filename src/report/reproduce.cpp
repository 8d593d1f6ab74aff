#include "report/reproduce.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>

#include "core/measures/manifold.hpp"
#include "core/measures/regime.hpp"
#include "core/stability/transfer.hpp"
#include "core/stability/windows.hpp"
#include "report/svg.hpp"

namespace vines::report {

namespace {

const char* const colours[] = {"#1f6fb2", "#2e8b57", "#b8780b", "#8e44ad"};
const char* const grey = "#8a939b";

std::string format(const char* pattern, auto... values) {
    char text[256];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

// The window of the paper's exponents (Table 2, first row); its other runs are about as long.
constexpr double window_end = 1708.9;

Parameters table1(double b, Damping damping = Damping::closed_form) {
    Parameters p;
    p.b = b;
    p.damping = damping;
    return p;
}

double median(std::vector<double> v) {
    if (v.empty()) return std::nan("");
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

std::pair<double, double> mean_and_deviation(const std::vector<double>& v) {
    double sum = 0, squares = 0;
    for (double x : v) sum += x;
    const double mean = sum / static_cast<double>(v.size());
    for (double x : v) squares += (x - mean) * (x - mean);
    return {mean, std::sqrt(squares / static_cast<double>(v.size() - 1))};
}

/// Everything about one run from the paper's initial state.
struct Response {
    Parameters p;
    SeriesRecord series;
    ImpactRecord impacts;
    TransferRecord transfers;
    HalfCycles half_cycles;
    Lyapunov lyapunov;
    Regime regime;

    Response(
        double b, Damping damping, double tau_end = window_end, double window_start = 0,
        double window = window_end)
        : p(table1(b, damping)),
          series(2 * std::numbers::pi / 32),
          transfers(p, 0, tau_end),
          half_cycles(p, 0, tau_end),
          lyapunov(p, window_start, window, {}) {
        ContactRecord contacts;
        StroboscopicRecord stroboscopic(p);
        Observer* const observers[] = {&series,   &impacts,  &transfers,   &half_cycles,
                                       &lyapunov, &contacts, &stroboscopic};
        const Outcome outcome = simulate(p, default_state(p), {tau_end, 1000000, {}}, observers);
        series.finish(outcome);
        regime = regime_of(
            p, default_state(p),
            {contacts, stroboscopic, 0, outcome.tau,
             verdict_by_exponents(growth_of(lyapunov.product()))});
    }

    int positive(const Exponents& lambda) const {
        return static_cast<int>(
            std::count_if(lambda.begin(), lambda.end(), [](double v) { return v > 0; }));
    }
};

/// lambda over many windows as long as the paper's: stretches of several runs, of which each starts
/// a little different and ends, at the latest, where a periodic orbit captures it (b = 22 mm:
/// section "b = 22 mm" of the README).
struct Ensemble {
    std::vector<Exponents> windows;
    /// (lambda1 - lambda3) T of raw_product in each window, where asked for.
    std::vector<double> raw_spreads;
    int captured = 0;
    /// lambda1 of the orbit that every run comes to without a chaotic transient.
    std::optional<double> periodic;

    /// Of the k-th exponent, over the windows where it is a number (a stick makes lambda3 and
    /// lambda4 minus infinity).
    double mean(int k) const { return moments(k).first; }
    double deviation(int k) const { return moments(k).second; }

private:
    std::pair<double, double> moments(int k) const {
        std::vector<double> values;
        for (const Exponents& w : windows)
            if (std::isfinite(w[k])) values.push_back(w[k]);
        return mean_and_deviation(values);
    }
};

Ensemble ensemble(double b, Damping damping, bool raw) {
    constexpr int runs = 12, windows = 11;
    constexpr double length = 1690;
    const Parameters p = table1(b, damping);
    Ensemble e;
    for (int run = 0; run < runs; ++run) {
        State start = default_state(p);
        start.y -= run * 1e-6 * b;
        Windows over(p, {true, false, raw, 256});
        for (int i = 0; i < windows; ++i) over.add(i * length, (i + 1) * length);
        Lyapunov whole(p, 0, length * windows, {true, false, false, 256});
        ContactRecord contacts;
        StroboscopicRecord stroboscopic(p);
        Observer* const observers[] = {&over, &whole, &contacts, &stroboscopic};
        simulate(p, start, {length * windows, 10000000, {}}, observers);
        const Regime regime = regime_of(
            p, start,
            {contacts, stroboscopic, 0, length * windows,
             verdict_by_exponents(growth_of(whole.product()))});
        const bool chaotic_before = regime.capture && regime.capture->chaotic_before == true;
        const double until =
            chaotic_before ? regime.capture->tau.value_or(length * windows) : length * windows;
        e.captured += chaotic_before;
        if (regime.orbit && !chaotic_before) e.periodic = regime.orbit->exponents(p)[0];
        for (int i = 1; i < windows; ++i) {  // the first holds the transient from rest
            if ((i + 1) * length > until) break;
            const TransferProduct& product = over.product(i);
            const Exponents lambda = product.qr();
            // A stick leaves lambda3 and lambda4 minus infinity in its window: lambda1 and lambda2
            // stand.
            if (std::isnan(lambda[0])) continue;
            e.windows.push_back(lambda);
            const Exponents unscaled = product.raw_product();
            if (raw && product.rank() == 4 && std::isfinite(unscaled[2]))
                e.raw_spreads.push_back(
                    (unscaled[0] - unscaled[2]) * (product.end_tau() - product.start_tau()));
        }
    }
    return e;
}

/// Which responses random starts come to: how many of each.
std::map<std::string, int> attractors(const Parameters& p, int starts) {
    std::mt19937_64 engine(2018);
    const auto uniform = [&](double from, double to) {
        return from + (to - from) * static_cast<double>(engine() >> 11) * 0x1p-53;
    };
    std::map<std::string, int> found;
    for (int i = 0; i < starts; ++i) {
        State start{uniform(-0.008, 0.008), uniform(-0.008, 0.008), uniform(-0.01, 0.01), 0};
        start.y = start.x + uniform(-p.b, p.b);
        ContactRecord contacts;
        StroboscopicRecord stroboscopic(p);
        Lyapunov lyapunov(p, 0, 3000, {true, false, false, 256});
        Observer* const observers[] = {&contacts, &stroboscopic, &lyapunov};
        const Outcome outcome = simulate(p, start, {3000, 1000000, {}}, observers);
        const Regime r = regime_of(
            p, start,
            {contacts, stroboscopic, 1500, outcome.tau,
             verdict_by_exponents(growth_of(lyapunov.product()))});
        const std::string word =
            !r.orbit ? std::string("irregular (Type ") + name_of(r.type) + ")"
                     : format(
                           "Type %s, %ld impacts in %d cycle%s, %s", name_of(r.type),
                           r.orbit->contacts, r.orbit->cycles, r.orbit->cycles > 1 ? "s" : "",
                           r.orbit->symmetric ? "symmetric" : "asymmetric");
        ++found[word];
    }
    return found;
}

std::string listed(const std::map<std::string, int>& counts) {
    std::string text;
    for (const auto& [word, n] : counts)
        text += (text.empty() ? "" : "; ") + std::to_string(n) + " x " + word;
    return text;
}

std::vector<double> millimetres(std::vector<double> v) {
    for (double& x : v) x *= 1000;
    return v;
}

Plot displacement(const Response& r, double to = 1e300) {
    Curve c;
    c.x = r.series.tau, c.y = millimetres(r.series.x);
    const auto n =
        static_cast<std::size_t>(std::upper_bound(c.x.begin(), c.x.end(), to) - c.x.begin());
    c.x.resize(n), c.y.resize(n);
    return {"tau", "x (mm)", {std::move(c)}};
}

Plot relative(const Response& r, double from, double to) {
    Curve c;
    std::size_t i = 0;
    const auto add = [&](double tau, double gap) {
        if (tau >= from && tau <= to) c.x.push_back(tau), c.y.push_back(1000 * gap);
    };
    // With the contacts between the samples.
    for (std::size_t k = 0; k < r.series.tau.size(); ++k) {
        for (; i < r.impacts.impacts.size() && r.impacts.impacts[i].tau <= r.series.tau[k]; ++i)
            add(r.impacts.impacts[i].tau, -r.impacts.impacts[i].side * r.p.b);
        add(r.series.tau[k], r.series.y[k] - r.series.x[k]);
    }
    Plot plot{"tau", "y - x (mm)", {c}};
    plot.levels = {-1000 * r.p.b, 1000 * r.p.b};
    return plot;
}

Curve history_curve(
    const ExponentHistory& h, int k, const std::string& colour, const std::string& label,
    const std::string& dash = "") {
    Curve c;
    c.colour = colour, c.label = label, c.dash = dash;
    for (std::size_t i = 0; i < h.tau.size(); ++i) {
        c.x.push_back(h.tau[i]);
        c.y.push_back(h.lambda[i][k]);
    }
    return c;
}

/// The paper's four curves, its rounding floor, and below them what holds.
std::vector<Plot> histories(const Response& r) {
    const TransferProduct& product = r.lyapunov.product();
    const ExponentHistory &raw = product.raw_product_history(), &qr = product.qr_history();
    double highest = 0;
    for (std::size_t i = raw.tau.size() / 8; i < raw.tau.size(); ++i)
        if (std::isfinite(raw.lambda[i][0])) highest = std::max(highest, raw.lambda[i][0]);
    const std::pair<double, double> range = {-0.4, std::max(0.1, 1.7 * highest)};
    Plot as_paper{"tau", "raw_product", {}}, reference{"tau", "qr", {}};
    for (int k = 0; k < 4; ++k) {
        const std::string label = "lambda" + std::to_string(k + 1);
        as_paper.curves.push_back(history_curve(raw, k, colours[k], label));
        reference.curves.push_back(history_curve(qr, k, colours[k], label));
    }
    Curve floor = history_curve(raw, 0, grey, "rounding floor", "5 4");
    for (std::size_t i = 0; i < floor.x.size(); ++i)
        floor.y[i] = rounding_floor(floor.y[i], floor.x[i] - product.start_tau());
    as_paper.curves.push_back(floor);
    for (Plot* p : {&as_paper, &reference}) p->y_range = range, p->levels = {0};
    return {as_paper, reference};
}

Plot moduli(
    const Response& r, const std::string& label, bool logarithmic, auto of,
    std::initializer_list<int> which = {0, 1, 2, 3}) {
    Plot plot{"tau", label, {}};
    plot.logarithmic = logarithmic;
    plot.levels = {1};
    for (int k : which) {
        Curve c;
        c.dots = true, c.colour = colours[k];
        for (const ImpactTransfer& t : r.transfers.transfers)
            c.x.push_back(t.tau), c.y.push_back(of(t)[k]);
        plot.curves.push_back(std::move(c));
    }
    return plot;
}

class Report {
public:
    explicit Report(std::string folder) : folder_(std::move(folder)) {
        if (!folder_.empty()) std::filesystem::create_directories(folder_);
    }

    void heading(const std::string& text) { body_ += "\n## " + text + "\n\n"; }
    void say(const std::string& text) { body_ += text + "\n\n"; }
    /// Plots of one picture share their abscissa.
    void picture(
        const std::string& name, const std::string& caption, const std::vector<Plot>& plots,
        int height = 210) {
        if (folder_.empty()) return;
        write(name + ".svg", svg(plots, 860, height));
        body_ += "![" + caption + "](" + name + ".svg)\n*" + caption + "*\n\n";
    }
    void find(Finding f) { result_.findings.push_back(std::move(f)); }

    Reproduction finish() {
        if (folder_.empty()) return std::move(result_);
        write(
            "report.md",
            "# Li, Lamarque, Seguy, Berlioz (2018), recomputed\n\n"
            "Figures 3 to 14 and Tables 1 to 3 of *Nonlinear Dynamics* 91, 2319-2330, each with "
            "the paper's number beside the one computed here. A row's verdict rests on "
            "a number and the band that it must lie in; `vines reproduce` fails when one leaves "
            "it.\n\n" +
                result_.table() + body_);
        return std::move(result_);
    }

private:
    void write(const std::string& name, const std::string& content) {
        const std::string path = (std::filesystem::path(folder_) / name).string();
        std::ofstream file(path, std::ios::binary);
        file << content;
        if (!file.flush()) throw std::runtime_error("cannot write " + path);
    }
    const std::string folder_;
    std::string body_;
    Reproduction result_;
};

/// Relative displacement from some moment on, and the exponents as in the paper and by QR.
void show(Report& report, const Response& r, const std::string& figure, double from) {
    const std::string name = "fig" + figure.substr(5),
                      at = figure + ", b = " + format("%g", 1000 * r.p.b) + " mm: ";
    report.picture(name + "a", at + "relative displacement", {relative(r, from, window_end)});
    report.picture(
        name + "b", at + "above, eq. (33) from the unscaled product as in the paper; below, by QR",
        histories(r));
}

const char* const with_closed_form = "reproduced with the closed-form damping";
const char* const rounding = "not reproduced: rounding";

void table_1(Report& report) {
    const Parameters p;
    report.find(
        {"Table 1", "epsilon", ".84 %", format("%.4f %%", 100 * p.epsilon), 100 * p.epsilon, 0.835,
         0.845, "reproduced"});
    report.find(
        {"Table 1", "lambda", "1.43", format("%.4f", p.lambda), p.lambda, 1.425, 1.435,
         "reproduced"});
}

/// Figs. 3 to 9 and Table 2: b = 22 mm.
void strongly_modulated(Report& report, const Ensemble& closed, const Ensemble& eom) {
    const Response r(0.022, Damping::closed_form), other(0.022, Damping::equation_of_motion);
    const TransferProduct& product = r.lyapunov.product();

    report.heading("Figs. 3 and 4: strongly modulated response, b = 22 mm (Type II)");
    Plot x = displacement(Response(0.022, Damping::closed_form, 5521.3));
    x.moments = {18.13, 1708.9};
    report.picture(
        "fig3",
        "Fig. 3: displacement of the linear oscillator; the window of Fig. 5 between the broken "
        "lines",
        {x});
    report.picture(
        "fig4", "Fig. 4: displacement and relative displacement, enlarged",
        {displacement(r, 600), relative(r, 0, 600)});
    report.find(
        {"Fig. 3", "regime", "Type II",
         std::string("Type ") + name_of(r.regime.type) +
             format(", %ld half cycles in step", r.regime.longest_synchronised),
         static_cast<double>(r.regime.type), static_cast<double>(RegimeType::II),
         static_cast<double>(RegimeType::II), "reproduced"});
    const double first = r.impacts.impacts.front().tau,
                 other_first = other.impacts.impacts.front().tau;
    report.find(
        {"Fig. 3", "first impact, tau_s", "18.1300",
         format("%.4f (%.4f by eq. (1))", first, other_first), first, 18.11, 18.15,
         with_closed_form});

    // "The amplitude of x increases with z < 2 ... decreases with z = 2": impacts of the cycles
    // before which it fell or rose.
    double rising = 0, falling = 0;
    long rising_cycles = 0, falling_cycles = 0;
    std::size_t impact = 0;
    for (std::size_t k = 3; k < r.half_cycles.points.size(); k += 2) {
        long n = 0;
        for (; impact < r.impacts.impacts.size() &&
               r.impacts.impacts[impact].tau <= r.half_cycles.tau[k];
             ++impact)
            ++n;
        const bool falls = r.half_cycles.points[k].C < r.half_cycles.points[k - 2].C;
        (falls ? falling : rising) += static_cast<double>(n);
        ++(falls ? falling_cycles : rising_cycles);
    }
    falling /= static_cast<double>(falling_cycles), rising /= static_cast<double>(rising_cycles);
    report.find(
        {"Fig. 4", "impacts per cycle while x falls / rises", "2 / below 2",
         format("%.2f / %.2f", falling, rising), falling - rising, 0.4, 2, "reproduced"});

    report.heading("Fig. 5: transient Lyapunov exponents, b = 22 mm");
    report.picture(
        "fig5", "Fig. 5: above, eq. (33) from the unscaled product as in the paper; below, by QR",
        histories(r), 230);
    const Exponents raw = product.raw_product(), qr = product.qr();
    report.find(
        {"Fig. 5", "positive exponents, as the paper computed", "4",
         std::to_string(r.positive(raw)) + " (raw_product)", double(r.positive(raw)), 4, 4,
         rounding});
    report.find(
        {"Fig. 5", "positive exponents", "4", std::to_string(r.positive(qr)) + " (qr)",
         double(r.positive(qr)), 1, 1, "not reproduced: their sum is negative"});
    const double sum = qr[0] + qr[1] + qr[2] + qr[3];
    report.find(
        {"Fig. 5", "sum of the exponents", "positive",
         format("%.4f, the sum rule to %.0e", sum, product.sum_rule_residual()),
         product.sum_rule_residual(), 0, 1e-11, "not reproduced: the sum is -2 zeta + 2 z_T ln R"});
    report.say(
        "The exponents add up to -2 zeta + (2/T) (sum of ln R), whatever the motion: they cannot "
        "all be positive. The unscaled product of transfer matrices becomes a matrix of rank one "
        "plus rounding, and what is printed as lambda3 is lambda1 - ln(1/2.2e-16)/T, the broken "
        "line. See it yourself: "
        "`curl -s 127.0.0.1:8080/v1/simulate -d "
        "'{\"preset\":\"fig5\",\"include\":[\"exponents\"]}' | jq '.exponents.raw_product.final, "
        ".exponents.raw_product.rounding_floor, .exponents.qr.final'`.");

    // The spikes: where the exponent of the exact product falls furthest below that of QR.
    const ExponentHistory &eigen = product.eigenvalues_history(), &reference = product.qr_history();
    std::vector<double> speeds;
    for (const Impact& i : r.impacts.impacts) speeds.push_back(std::abs(i.relative_speed_before));
    // Depth, relative speed ratio of the impact; the first few products are short.
    std::vector<std::pair<double, double>> dips;
    for (std::size_t i = 10; i < eigen.tau.size(); ++i)
        dips.emplace_back(
            (eigen.lambda[i][0] - reference.lambda[i][0]) * (eigen.tau[i] - product.start_tau()),
            speeds[i + 1] / median(speeds));
    std::sort(dips.begin(), dips.end());
    std::vector<double> at_dips, slow;
    for (std::size_t i = 0; i < 8; ++i) at_dips.push_back(dips[i].second);
    std::sort(dips.begin(), dips.end(), [](auto a, auto b) { return a.second < b.second; });
    const double spike = std::min_element(at_dips.begin(), at_dips.end())[0];
    double nearest = 0;
    for (std::size_t i = 0; i < 8; ++i)
        slow.push_back(dips[i].first), nearest = std::max(nearest, dips[i].second);
    report.find(
        {"Fig. 5", "relative speed (over its median) at the 8 deepest spikes",
         "spikes probably related to grazing",
         format(
             "%.2f at least; the 8 impacts nearest to grazing (below %.2f) have none", spike,
             nearest),
         spike, 0.3, 10, "not reproduced: the spikes are not grazing"});
    report.say(
        "The spikes come at ordinary impacts: the leading eigenvalue of the product passes through "
        "zero where its right and its left direction are orthogonal, which QR never sees. "
        "`relative_speed_ratio` in the answer's impacts tells how near to grazing each one is.");

    report.heading("Figs. 6 to 9: eigenvalues of J, M and T, b = 22 mm");
    report.picture(
        "fig6-8", "Figs. 6, 7, 8: moduli of the eigenvalues of J, M and T",
        {moduli(r, "|eig J|", false, [](const auto& t) { return t.J_moduli(); }),
         moduli(r, "|eig M|", false, [](const auto& t) { return t.M_moduli(); }),
         moduli(r, "|eig T|", true, [](const auto& t) { return t.T_moduli(); })},
        170);
    double J_error = 0, largest = 0;
    std::vector<double> M_errors;
    double tau_before = r.impacts.impacts.front().tau;
    for (const ImpactTransfer& t : r.transfers.transfers) {
        const Moduli J = t.J_moduli();
        if (t.rank() == 4)
            J_error = std::max(
                {J_error, std::abs(J[3] - std::exp(-r.p.zeta() * (t.tau - tau_before))),
                 std::abs(J[0] - 1), std::abs(J[1] - 1)});
        tau_before = t.tau;
        const Moduli M = eigenvalue_moduli(t.M.matrix());
        M_errors.push_back(std::max(
            {std::abs(M[0] - 1), std::abs(M[1] - 1), std::abs(M[2] - t.R), std::abs(M[3] - t.R)}));
        largest = std::max(largest, t.T_moduli()[0]);
    }
    report.find(
        {"Fig. 6", "moduli of J", "two below 1, two 1",
         format("e^(-zeta Delta tau) twice, 1 twice, to %.0e", J_error), J_error, 0, 1e-12,
         "reproduced"});
    report.find(
        {"Fig. 7", "moduli of M", "1, 1, R, R", format("1, 1, .6, .6 to %.0e", median(M_errors)),
         median(M_errors), 0, 1e-6, "reproduced"});
    report.find(
        {"Fig. 8", "largest modulus of T", "very large, above 1", format("%.1f", largest), largest,
         10, 1e4, "reproduced"});

    std::vector<double> in_step, out_of_step;
    std::vector<std::pair<double, double>> bands;
    for (const SynchronyStretch& s : r.regime.stretches)
        if (s.synchronised) bands.emplace_back(s.tau_start, s.tau_end);
    for (const ImpactTransfer& t : r.transfers.transfers)
        (std::any_of(
             bands.begin(), bands.end(),
             [&](auto b) { return t.tau > b.first && t.tau <= b.second; })
             ? in_step
             : out_of_step)
            .push_back(std::log(t.T_moduli()[0]));
    auto spread = [](std::vector<double> v) {
        std::sort(v.begin(), v.end());
        return v[3 * v.size() / 4] - v[v.size() / 4];
    };
    Plot fig9 = displacement(r),
         T1 = moduli(r, "|eig T|, largest", true, [](const auto& t) { return t.T_moduli(); }, {0});
    fig9.bands = T1.bands = bands;
    report.picture(
        "fig9", "Fig. 9: x and the largest modulus of T; synchronised stretches shaded",
        {fig9, T1});
    report.find(
        {"Fig. 9", "spread (quartiles of ln) of T's largest modulus, in step / not",
         "almost constant / changes a lot",
         format(
             "%.2f around %.2f / %.2f around %.2f", spread(in_step), std::exp(median(in_step)),
             spread(out_of_step), std::exp(median(out_of_step))),
         spread(out_of_step) / spread(in_step), 4, 1e3, "reproduced"});

    report.heading("Table 2: other windows, b = 22 mm");
    const auto [raw_mean, raw_deviation] = mean_and_deviation(closed.raw_spreads);
    const double printed[3][4] = {
        {18.1300, 1708.9, 0.1093, 0.08427},
        {1708.9, 3652.7, 0.1143, 0.09242},
        {3652.7, 5521.3, 0.1197, 0.1015}};
    for (const auto& [from, to, lambda1, lambda3] : printed) {
        const std::string where = format("Table 2, [%g, %g]", from, to);
        const double off = (lambda1 - closed.mean(0)) / closed.deviation(0),
                     off_eom = (lambda1 - eom.mean(0)) / eom.deviation(0);
        report.find(
            {where, "lambda1", format("%g", lambda1),
             format(
                 "%.3f +- %.3f over %zu windows (%.1f sd off; eq. (1): %.1f)", closed.mean(0),
                 closed.deviation(0), closed.windows.size(), off, off_eom),
             off, -2.5, 2.5, with_closed_form});
        const double printed_spread = (lambda1 - lambda3) * (to - from),
                     true_spread = (closed.mean(0) - closed.mean(2)) * (to - from);
        report.find(
            {where, "lambda3, as (lambda1 - lambda3) T",
             format("%.5f, %.1f", lambda3, printed_spread),
             format(
                 "rounding: 36.0 = ln(1/2.2e-16), raw_product %.1f +- %.1f; qr: %.0f, lambda3 = "
                 "%.3f +- %.3f",
                 raw_mean, raw_deviation, true_spread, closed.mean(2), closed.deviation(2)),
             (printed_spread - raw_mean) / (true_spread - raw_mean), -0.1, 0.1, rounding});
    }
    report.say(format(
        "%d of 12 runs up to tau = 18590 were captured by a periodic orbit with chatter; their "
        "windows end there.",
        closed.captured));
}

struct Row {
    double b, lambda1, lambda3;
};
constexpr Row printed_table_3[] = {{0.040, 0.1321, 0.1245},   {0.034, 0.1372, 0.127},
                                   {0.031, 0.1528, 0.1391},   {0.028, 0.1452, 0.1309},
                                   {0.025, 0.1138, 0.09727},  {0.022, 0.1093, 0.08427},
                                   {0.020, 0.1014, 0.0783},   {0.018, 0.06368, 0.03913},
                                   {0.017, 0.04703, 0.02043}, {0.0165, 0.03686, 0.01084}};

void table_3(
    Report& report, const std::map<double, Ensemble>& closed,
    const std::map<double, Ensemble>& eom) {
    report.heading("Table 3: exponents of the regimes");
    Curve paper, ours, by_equation;
    double chi2 = 0, chi2_eom = 0, lambda3_highest = -1e9;
    for (const Row& row : printed_table_3) {
        const Ensemble &c = closed.at(row.b), &e = eom.at(row.b);
        const double off = (row.lambda1 - c.mean(0)) / c.deviation(0),
                     off_eom = (row.lambda1 - e.mean(0)) / e.deviation(0);
        chi2 += off * off;
        if (!e.periodic) chi2_eom += off_eom * off_eom;
        for (auto [curve, mean, error] :
             {std::tuple(&paper, row.lambda1, 0.), std::tuple(&ours, c.mean(0), c.deviation(0)),
              std::tuple(&by_equation, e.mean(0), e.deviation(0))})
            curve->x.push_back(1000 * row.b), curve->y.push_back(mean),
                curve->error.push_back(error);
        report.find(
            {format("Table 3, b = %g mm", 1000 * row.b), "lambda1", format("%g", row.lambda1),
             format("%.3f +- %.3f (%.1f sd off); eq. (1): ", c.mean(0), c.deviation(0), off) +
                 (e.periodic ? format("periodic, %.4f", *e.periodic)
                             : format("%.3f +- %.3f (%.1f)", e.mean(0), e.deviation(0), off_eom)),
             off, -2.5, 2.5, with_closed_form});
        lambda3_highest = std::max(lambda3_highest, c.mean(2));
    }
    report.find(
        {"Table 3", "all ten lambda1: sum of squared deviations in sd", "-",
         format("%.1f; by eq. (1) %.0f for the seven that are chaotic by it", chi2, chi2_eom), chi2,
         1, 25, with_closed_form});
    report.find(
        {"Table 3", "lambda3", ".011 to .139, positive",
         format("negative: %.3f at most (means over windows without a stick)", lambda3_highest),
         lambda3_highest, -1, -0.005, rounding});
    paper.colour = "#b3261e", paper.label = "paper", paper.dots = true;
    ours.colour = colours[0], ours.label = "closed_form", ours.dots = true;
    by_equation.colour = grey, by_equation.label = "equation_of_motion", by_equation.dots = true;
    Plot plot{"b (mm)", "lambda1", {by_equation, ours, paper}};
    plot.levels = {0};
    report.picture(
        "table3",
        "Table 3: lambda1 of the paper, and mean and standard deviation over windows of 1690",
        {plot}, 330);
    report.say(
        "The equation of motion (1) has 2 zeta = epsilon lambda; the closed form (8)-(11) and the "
        "transfer matrix (19), (20) solve 2 zeta = 2 epsilon lambda. The printed numbers come from "
        "the latter. "
        "See it yourself: the same request with `\"damping\":\"closed_form\"` and "
        "`\"damping\":\"equation_of_motion\"`.");
}

void sparse(Report& report) {
    const Response r(0.040, Damping::closed_form);
    report.heading("Fig. 10: sparse impacts, b = 40 mm (Type I)");
    show(report, r, "Fig. 10", 0);
    report.find(
        {"Fig. 10", "regime", "Type I",
         std::string("Type ") + name_of(r.regime.type) + format(", z = %.2f", r.regime.z),
         static_cast<double>(r.regime.type), static_cast<double>(RegimeType::I),
         static_cast<double>(RegimeType::I), "reproduced"});
    const TransferProduct& product = r.lyapunov.product();
    report.find(
        {"Fig. 10", "positive exponents", "4",
         format(
             "%d (qr), %d (raw_product)", r.positive(product.qr()),
             r.positive(product.raw_product())),
         double(r.positive(product.qr())), 1, 1, rounding});
}

void symmetric(Report& report) {
    const Response r(0.015, Damping::closed_form);
    report.heading("Fig. 11: two symmetric impacts per cycle, b = 15 mm (Type III)");
    show(report, r, "Fig. 11", 1600);
    report.find(
        {"Fig. 11", "regime", "Type III",
         std::string("Type ") + name_of(r.regime.type) +
             (r.regime.orbit ? format(", the state returns to %.0e", r.regime.orbit->closure) : ""),
         static_cast<double>(r.regime.type), static_cast<double>(RegimeType::III),
         static_cast<double>(RegimeType::III), "reproduced"});
    const double lambda1 = r.regime.orbit ? r.regime.orbit->exponents(r.p)[0] : 1;
    report.find(
        {"Fig. 11", "exponents", "four negative, two almost zero",
         format("lambda1 = lambda2 = %.5f from the Floquet multipliers", lambda1), lambda1, -0.0182,
         -0.0174, "reproduced"});
    report.say(
        "A stick at the start of the run (tau = 11.8) makes lambda3 and lambda4 of the window from "
        "the first impact minus infinity; those of the orbit are -.1568 twice.");
}

/// A regime that the paper has at one b and that is found at another.
void elsewhere(
    Report& report, const std::string& figure, const std::string& regime, double b_paper,
    double b_here, RegimeType type, long contacts_per_cycle, bool any_symmetry) {
    const Response at_paper(b_paper, Damping::closed_form), here(b_here, Damping::closed_form);
    report.heading(
        figure + ": " + regime + ", b = " + format("%g", 1000 * b_paper) + " mm in the paper");
    constexpr int starts = 200;
    const auto found = attractors(at_paper.p, starts);
    double as_paper = 0;
    for (const auto& [word, n] : found)
        if (word.find("Type " + std::string(name_of(type)) + ",") == 0 &&
            (any_symmetry || word.find("asymmetric") != std::string::npos) &&
            word.find(format("%ld impacts in 1 cycle,", contacts_per_cycle)) != std::string::npos)
            as_paper += n;
    report.find(
        {figure, format("regime at b = %g mm", 1000 * b_paper), regime,
         format(
             "Type %s, z = %.2f; of %d random starts %.0f come to the paper's regime",
             name_of(at_paper.regime.type), at_paper.regime.z, starts, as_paper),
         as_paper, 0, 0,
         format(
             "not reproduced: %s at %g mm", at_paper.regime.orbit ? "symmetric" : "irregular",
             1000 * b_paper)});
    report.say(
        "Where " + std::to_string(starts) + " random starts at b = " +
        format("%g", 1000 * b_paper) + " mm end: " + listed(found) + ".");
    const double z = here.regime.type == type ? here.regime.z : -1;
    report.find(
        {figure, format("regime at b = %g mm", 1000 * b_here), regime,
         format(
             "Type %s, z = %.2f, largest multiplier %.4f", name_of(here.regime.type), here.regime.z,
             here.regime.orbit ? std::abs(here.regime.orbit->multipliers[0]) : NAN),
         z, double(contacts_per_cycle), double(contacts_per_cycle),
         format("reproduced with the closed-form damping, at %g mm", 1000 * b_here)});
    show(report, here, figure, 1600);
}

void irregular(Report& report) {
    const Response r(0.003, Damping::closed_form);
    report.heading("Fig. 14: irregular, about three impacts per cycle, b = 3 mm (Type VI)");
    show(report, r, "Fig. 14", 1600);
    report.find(
        {"Fig. 14", "regime", "Type VI, between 3 and 4 impacts per cycle",
         std::string("Type ") + name_of(r.regime.type) + format(", z = %.2f", r.regime.z),
         static_cast<double>(r.regime.type), static_cast<double>(RegimeType::VI),
         static_cast<double>(RegimeType::VI), "reproduced, with slightly fewer impacts"});
    const Exponents lambda = r.lyapunov.product().qr();
    report.find(
        {"Fig. 14", "lambda1", "positive",
         format("%.3f, %d positive", lambda[0], r.positive(lambda)), lambda[0], 0.1, 0.3,
         "reproduced"});
}

}  // namespace

bool Reproduction::holds() const {
    return std::all_of(
        findings.begin(), findings.end(), [](const Finding& f) { return f.holds(); });
}

std::string Reproduction::table() const {
    std::string text =
        "| of the paper | quantity | paper | here | verdict | its number | band |\n| --- | --- | "
        "--- | --- | --- | --- | --- |\n";
    for (const Finding& f : findings)
        text += "| " + f.where + " | " + f.what + " | " + f.paper + " | " + f.here + " | " +
                (f.holds() ? "" : "**OUT OF BAND** ") + f.verdict + " | " +
                format("%.4g", f.number) + " | " + format("%g to %g", f.low, f.high) + " |\n";
    return text;
}

Reproduction reproduce(const std::string& folder) {
    Report report(folder);
    std::map<double, Ensemble> closed, eom;
    for (const Row& row : printed_table_3) {
        closed[row.b] = ensemble(row.b, Damping::closed_form, row.b == 0.022);
        eom[row.b] = ensemble(row.b, Damping::equation_of_motion, false);
    }
    table_1(report);
    strongly_modulated(report, closed.at(0.022), eom.at(0.022));
    sparse(report);
    symmetric(report);
    elsewhere(report, "Fig. 12", "Type IV", 0.008, 0.0065, RegimeType::IV, 2, false);
    elsewhere(report, "Fig. 13", "Type V", 0.004, 0.0046, RegimeType::V, 3, true);
    irregular(report);
    table_3(report, closed, eom);
    return report.finish();
}

}  // namespace vines::report
