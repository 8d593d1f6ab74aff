// Questions left open by the paper: the borders of the regimes; the steady state at 22 mm.
#include <fmt/ranges.h>

#include <cmath>

#include "report/report.hpp"
#include "report/runs.hpp"

namespace vines::report {

namespace {

/// The equidistant b, mm, at which the regime of a long run is so.
std::vector<double> mm_where(double from, double to, int steps, Damping damping, auto&& is_so) {
    std::vector<double> b, found;
    const auto mm = [&](int i) { return from + (to - from) * i / steps; };
    for (int i = 0; i <= steps; ++i) b.push_back(mm(i) / 1000);
    const std::vector<Regime> regimes = long_regimes(b, damping);
    for (int i = 0; i <= steps; ++i)
        if (is_so(regimes[static_cast<std::size_t>(i)])) found.push_back(mm(i));
    return found;
}

std::string listed(const std::vector<double>& numbers) {
    return numbers.empty() ? "none" : fmt::format("{:g}", fmt::join(numbers, ", "));
}

void sparse_and_modulated(Report& report) {
    const auto of_type_I = [](Damping damping) {
        return mm_where(
            31, 34, 12, damping, [](const Regime& r) { return r.type == RegimeType::I; });
    };
    const auto lowest = [](const std::vector<double>& mm) { return mm.empty() ? nan : mm.front(); };
    const std::vector<double> here = of_type_I(Damping::closed_form),
                              other = of_type_I(Damping::equation_of_motion);
    report.add(
        {"Table 3", "31 to 34 mm in steps of .25, runs of 17,000: lowest b of Type I",
         "II at 31, I at 34"},
        {lowest(here), lowest(other),
         fmt::format("at {}; by eq. (1) {}", listed(here), listed(other))},
        {{31.25, 34}, "between the two"}, ClaimVerdict::by_closed_form);
}

/// "Then b is decreased to 0.004 m, three impacts per cycle is obtained": the b at which it is.
void three_impacts(Report& report) {
    const auto where = [](Damping damping) {
        return listed(mm_where(3, 9, 60, damping, [](const Regime& r) {
            return r.type == RegimeType::V && r.orbit->contacts == 3L * r.orbit->cycles;
        }));
    };
    report.paragraph(fmt::format(
        "Three impacts per cycle, periodic (Type V, Fig. 13), for b from 3 to 9 mm in steps of .1, "
        "runs of 17,000: at {} mm; by eq. (1) at {} mm.",
        where(Damping::closed_form), where(Damping::equation_of_motion)));
}

/// Tests whether the chaos at b = 22 mm is a (long) transient.
void captures(Report& report, RunCache& runs) {
    const Ensemble& e = runs.ensemble(0.022, WindowsOf::tau_1690);
    const auto captured = std::ssize(e.capture_tau);
    report.paragraph(fmt::format(
        "\"In this period, the transient response has disappeared\" (of Fig. 5): of {} runs at b = "
        "22 mm to tau = {:g} a periodic orbit captures {}, at tau = {:.0f}, which were chaotic "
        "until then by lambda1 and its standard error; the other {} are chaotic to their ends. "
        "Runs of this length do not decide whether their chaos persists.",
        Ensemble::runs, Ensemble::tau_end, captured, fmt::join(e.capture_tau, ", "),
        Ensemble::runs - captured));
}

}  // namespace

void open_questions(Report& report, RunCache& runs) {
    report.heading("What the paper leaves open");
    captures(report, runs);
    sparse_and_modulated(report);
    three_impacts(report);
    report.paragraph(
        "Without a row in the table: Fig. 1, a drawing; (12) to (24), which the row on Fig. 2 "
        "uses, as it does (27) at both walls; that velocity differences fall by R at an impact "
        "(Fig. 7), an eigenvalue of M; that Fig. 24 and Fig. 5 are \"consistent\", for which the "
        "paper gives no measure (each has its own rows); that irregular impacts are the \"common "
        "base\" of all chaotic regimes (section 6), of which one is tested (section 4.1); friction "
        "and the walls' materials (section 6), which are in no equation.");
    report.heading("Misprints in the paper");
    report.paragraph(
        "Below eq. (1) lambda_1 stands for lambda, the damping. In (7) tau = 0 stands for tau_0. "
        "The forced part of (8) to (10) is that of (6) for tau_0 = 0 alone: elsewhere its phase is "
        "Omega tau_0 + phi. By (26) M_i belongs to the impact at tau_(i+1), so the products (31), "
        "(32) end there; in (33) u_i is u_k. (37) and (38) are the derivatives of the state "
        "variables, as columns. (41) is another condition than (40), not a simpler form of it. "
        "\"When b is further increased\" before Fig. 14: b falls from 4 to 3 mm. \"The evolution "
        "of eigenvalues\" of Fig. 13 is that of exponents. Epsilon of Table 4 is .77 %. b = 0.09 m "
        "below Fig. 17 is 0.009 m, |x - b| = b below Fig. 23 is |x - y| = b.");
}

}  // namespace vines::report
