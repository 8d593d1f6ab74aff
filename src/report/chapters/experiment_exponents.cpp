// Figs. 19 and 24 and section 5.2: the exponents of the measured responses, also with other R.
#include <fmt/format.h>

#include <limits>
#include <list>

#include "report/chapters/experiment.hpp"

namespace vines::report {

namespace {

/// Figs. 19 and 24: lambda1 by eq. (33) and by qr over the record, from the fitted motion and from
/// the paper's direct estimate.
void histories(Report& report, const Experiment& e, int figure, const std::string& which = "") {
    const auto curve = [&](const ExponentHistory& h, const char* colour, const char* label) {
        Curve c{.colour = colour, .label = label};
        for (std::size_t i = 0; i < h.tau.size(); ++i)
            c.add(h.tau[i] - h.tau.front(), h.lambda[i][0]);
        return c;
    };
    const DirectEstimate& direct = *e.result.direct;
    report.picture(
        fmt::format("fig{}", figure),
        fmt::format(
            "Fig. {}: lambda1 over the length of the record, by eq. (33) and by QR, from the "
            "fitted motion and from the paper's direct estimate{}",
            figure, which),
        {{.x_label = "tau",
          .y_label = "lambda1",
          .curves =
              {curve(e.history_by_eq_33(), colours[0], "(33)"),
               curve(e.result.exponents.all().qr_history(), colours[1], "qr"),
               curve(direct.exponents.longest().eigenvalues_history(), red, "(33), direct"),
               curve(direct.exponents.all().qr_history(), colours[2], "qr, direct")},
          .y_range = std::pair{-0.1, 0.25},
          .levels = {0}}},
        330);
}

double last(const ExponentHistory& h) { return h.lambda.back()[0]; }
/// lambda1 after the first tenth of the entries.
double early(const ExponentHistory& h) { return h.lambda[h.lambda.size() / 10][0]; }

/// Fraction of a history's time in which lambda1 is positive.
double positive_share(const ExponentHistory& h) {
    double share = 0;
    for (std::size_t i = 1; i < h.tau.size(); ++i)
        if (h.lambda[i][0] > 0) share += h.tau[i] - h.tau[i - 1];
    return share / (h.tau.back() - h.tau.front());
}

/// Fraction of a history's entries at which lambda1 is higher than at the entry before.
double rising_share(const ExponentHistory& h) {
    double rises = 0;
    for (std::size_t i = 1; i < h.tau.size(); ++i) rises += h.lambda[i][0] > h.lambda[i - 1][0];
    return rises / static_cast<double>(h.tau.size() - 1);
}

/// Fig. 19: the slow decay is that of a record that begins with the motion's start from rest.
void from_rest_on(Report& report, const Experiment& from_rest) {
    const ExponentHistory &found = from_rest.history_by_eq_33(),
                          &exact = from_rest.truth.exponents.eigenvalues_history();
    report.add_of_record(
        {"Fig. 19",
         "b = 9 mm, from rest on: fraction of the record's length over which lambda1 by "
         "(33) is positive",
         "positive in this short period"},
        {positive_share(found),
         fmt::format(
             "{:.2f} of tau = {:.0f}, from {:.4f} after a tenth of it to {:.4f}; with the first, "
             "weak impact, which the record does not show, {:.4f} to {:.4f}",
             positive_share(found), found.tau.back() - found.tau.front(), early(found), last(found),
             early(exact), last(exact))},
        {exactly(1),
         "all of it; in part: half. It depends on the record's length and on where it begins",
         Band{0.5, 1}},
        partly);
    report.add_of_record(
        {"Fig. 19", "the same: fraction of the impacts at which lambda1 by (33) rises",
         "decreasing continuously"},
        result("{:.2f}", rising_share(found)),
        {exactly(0), "none; in part: fewer than those at which it falls", Band{0, 0.5}}, partly);
}

/// Fig. 19 for a settled motion, also from the direct estimate: noise causes no decay.
void settled_motion(Report& report, const Experiment& settled, double of_figure_11) {
    const auto& direct = settled.result.direct->exponents.longest().eigenvalues_history();
    report.add_of_record(
        {"Fig. 19",
         "b = 9 mm, a motion that has settled for 20 s: lambda1 by (33) at the record's end",
         "positive"},
        {last(settled.history_by_eq_33()),
         fmt::format(
             "{:.4f} (from {:.4f} after a tenth of it); from the direct estimate {:.4f} (from "
             "{:.4f})",
             last(settled.history_by_eq_33()), early(settled.history_by_eq_33()), last(direct),
             early(direct))},
        {{0, infinity}, "positive"}, not_reproduced);
    const IdentifiedExponents& judged = settled.result.judged;
    report.add_of_record(
        {"Fig. 19",
         "the same: upper end of the 90 % interval of the limit of lambda1 (slope of lambda1 tau)",
         "it will approach zero"},
        {judged.slope.high,
         fmt::format(
             "{:.4f} to {:.4f}, slope {:.4f}; the true motion's {:.4f}", judged.slope.low,
             judged.slope.high, judged.slope.value, settled.truth.exponents.qr()[0])},
        {{0, infinity},
         "zero is in the interval; in part: as small as Fig. 11's exponent by eq. (1)",
         Band{of_figure_11, infinity}},
        partly);
}

/// Exponents of a record with transfer matrices of given parameters.
IdentifiedExponents judged_by(const Experiment& e, const Parameters& p) {
    const MeasuredExponents exponents(
        p, given_unknowns(p), e.result.found.impacts, e.result.continuity.stretches, qr_alone);
    return judge_exponents(exponents, e.result.found.impacts);
}
constexpr int following = 40;

/// late_change() of the true motion's lambda1 by (33), over following stretches of equal length.
std::vector<double> late_changes_after(const Experiment& e) {
    const Parameters& p = e.truth.parameters;
    const double T = e.truth.seconds * e.truth.omega0;
    std::list<Lyapunov> stretches;
    std::vector<Observer*> observers;
    double tau = e.truth.begin;
    for (int k = 0; k < following; ++k) {
        tau += T;
        observers.push_back(&stretches.emplace_back(
            p, Interval{tau, tau + T}, ExponentOptions{.eigenvalues = true}));
    }
    simulate(
        p, default_state(p), {.tau_end = tau + T, .max_impacts = std::numeric_limits<long>::max()},
        observers);
    std::vector<double> changes;
    for (Lyapunov& stretch : stretches)
        changes.push_back(late_change(stretch.product().eigenvalues_history(), 0));
    return changes;
}

constexpr const char* verdict_words[] = {"chaotic", "regular", "not decided", "none"};

const std::vector<std::pair<double, double>> other_walls = {{0.6, 0.6}, {0.7, 0.7},   {0.8, 0.8},
                                                            {0.9, 0.9}, {0.95, 0.95}, {0.8, 0.9},
                                                            {0.9, 0.8}, {0.7, 0.95},  {0.95, 0.7}};

}  // namespace

void exponents_of_regular_response(
    Report& report, const Experiment& settled, const Experiment& from_rest, double of_figure_11) {
    histories(report, from_rest, 19, ", of a motion from rest on");
    from_rest_on(report, from_rest);
    settled_motion(report, settled, of_figure_11);
}

void exponents_of_irregular_response(Report& report, const Experiment& e) {
    histories(report, e, 24);
    const IdentifiedExponents& judged = e.result.judged;
    Parameters closed_form = e.result.parameters;
    closed_form.damping = Damping::closed_form;
    report.add_of_record(
        {"Fig. 24", "b = 15 mm: lower end of the 90 % interval of lambda1, from the fitted motion",
         "the transient exponents are positive"},
        {judged.slope.low,
         fmt::format(
             "{:.4f} to {:.4f}, slope {:.4f}; from the direct estimate {:.4f}; with the damping of "
             "(19) to (21) {:.4f}; the true motion's {:.4f}",
             judged.slope.low, judged.slope.high, judged.slope.value,
             e.result.direct->exponents.all().qr()[0], judged_by(e, closed_form).slope.value,
             e.truth.exponents.qr()[0])},
        {{0, infinity}, "positive"});
    const Exponents lambda = e.result.exponents.all().qr();
    report.add_of_record(
        {"Fig. 24", "b = 15 mm: positive exponents (qr), from the fitted motion",
         "the transient exponents are positive", rounding_cause},
        {positive(lambda), fmt::format("{}: {}", positive(lambda), in_words(lambda))},
        {exactly(4), "all four, as in Fig. 5, with which the paper calls it consistent"},
        not_reproduced);
    const double change = late_change(e.history_by_eq_33(), 0),
                 typical_change = median(late_changes_after(e));
    Result stable(
        typical_change, fmt::format(
                            "{:.2f} in the record; true motion, {} following stretches of that "
                            "length: median {:.2f}",
                            change, following, typical_change));
    stable.statistic = "median";
    report.add_of_record(
        {"Fig. 24",
         "b = 15 mm: lambda1 by (33), second half of the record: its range without spikes "
         "over its last value",
         "almost already stable"},
        stable,
        {almost_constant.band, almost_constant.because + ". It depends on the record's length",
         almost_constant.partly},
        not_reproduced);
}

void vary_restitution(Report& report, const Experiment& irregular, const Experiment& regular) {
    Report::Rows rows;
    double same = 0;
    for (const Experiment* const e : {&regular, &irregular})
        for (const auto& [R_plus, R_minus] : other_walls) {
            Parameters p = e->result.parameters;
            p.R_plus = R_plus, p.R_minus = R_minus;
            const IdentifiedExponents judged = judged_by(*e, p);
            same += judged.verdict == e->result.judged.verdict;
            rows.push_back(
                {fmt::format("{:g}", 1000 * p.b), fmt::format("{:g}, {:g}", R_plus, R_minus),
                 fmt::format("{:.4f}", judged.slope.value),
                 fmt::format("{:.4f} to {:.4f}", judged.slope.low, judged.slope.high),
                 verdict_words[static_cast<std::size_t>(judged.verdict)]});
        }
    const auto all = static_cast<double>(rows.size());
    report.add_of_record(
        {"Section 5.2", "verdicts on the two records that stay the same with another assumed R",
         "the same conclusion"},
        {same, fmt::format("{} of {}", same, all)},
        {exactly(all), "all; in part: half or more", Band{all / 2, all}});
    report.table({"b (mm)", "assumed R", "slope", "90 % interval", "verdict"}, rows);
}

}  // namespace vines::report
