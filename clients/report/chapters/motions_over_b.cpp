// The motions over the paper's range of b: what runs from its start come to, and the branches of
// periodic orbits, stable and unstable, on which the regular ones lie. Questions left open by the
// paper: the borders of the regimes, and the steady state at 22 mm.
#include <fmt/ranges.h>

#include <cmath>
#include <map>

#include "core/continuation/branch.hpp"
#include "core/sweep/point.hpp"
#include "report/claims.hpp"

namespace vines::report {

namespace {

// m; of_start: two symmetric impacts per cycle attract with either damping (Fig. 11).
constexpr double from = 0.004, to = 0.042, of_start = 0.015, step = 0.00025;

/// Branches as curves of the amplitude, mm over mm.
class BranchCurves : public BranchSink {
public:
    void branch(const BranchStart&) override {
        for (Curve* curve : {&stable, &unstable}) curve->add(nan, nan);
        last_ = nullptr;
    }
    void point(int, const OrbitPoint& orbit) override {
        Curve* const curve = orbit.stable() ? &stable : &unstable;
        add(*curve, orbit);
        if (last_ && last_ != curve) {  // to the point where the stability changes
            add(*last_, orbit);
            last_->add(nan, nan);
        }
        last_ = curve;
    }
    void special(int branch, const SpecialPoint& s) override {
        if (s.kind != SpecialKind::end) add(specials[s.kind], s.orbit);
        // The two directions of the first branch.
        if (branch < 2) of_symmetric.try_emplace(s.kind, s);
    }
    double mm(SpecialKind kind) const { return 1000 * of_symmetric.at(kind).orbit.parameters[0]; }

    Curve stable{.colour = colours[0], .label = "stable orbit"},
        unstable{.colour = colours[0], .label = "unstable orbit", .dash = "4 3"};
    std::map<SpecialKind, Curve> specials;
    std::map<SpecialKind, SpecialPoint> of_symmetric;  ///< the first of each kind

private:
    static void add(Curve& curve, const OrbitPoint& orbit) {
        curve.add(1000 * orbit.parameters[0], 1000 * orbit.measures.x_max);
    }

    Curve* last_ = nullptr;  // of the branch
};

/// The branches from the symmetric motion (Fig. 11), and those where its symmetry breaks.
BranchCurves branches(Damping damping) {
    const Parameters p = table1(of_start, damping);
    const State settled = simulate(p, default_state(p), {1000 * p.cycle(), 100000, {}}, {}).state;
    const State scale = scale_of(p, {&settled, 1});
    const auto orbit = find_orbit(p, settled, 1, scale, 0.5, {});
    const BranchPlan plan{
        .family =
            {[damping](const std::vector<double>& b) {
                 return std::optional(table1(b[0], damping));
             },
             {{from, to}}},
        .switches = 1};
    BranchCurves curves;
    follow_branches(plan, *orbit_start(p, *orbit, scale.x, plan.family, {of_start}), curves);
    return curves;
}

/// The amplitudes of runs from the paper's start.
Curve runs_over_b() {
    const auto count = static_cast<std::size_t>(std::lround((to - from) / step)) + 1;
    const auto b_of = [](std::size_t i) { return from + static_cast<double>(i) * step; };
    PointOptions options;
    options.transient_cycles = 500;
    options.cycles = 300;
    options.amplitudes_alone = true;
    const std::vector<double> x_max = in_parallel(count, [&](std::size_t i) {
        const Parameters p = table1(b_of(i), Damping::closed_form);
        return measure(p, default_state(p), options, {}).x_max;
    });
    Curve curve{.colour = grey, .label = "runs", .dots = true};
    for (std::size_t i = 0; i < count; ++i) curve.add(1000 * b_of(i), 1000 * x_max[i]);
    return curve;
}

std::string compared_with_runs(double b) {
    constexpr double offset = 0.0001;  // m
    const std::vector<Regime> runs = long_regimes({b - offset, b + offset}, Damping::closed_form);
    return fmt::format(
        "from the paper's start Type {} .1 mm below it, {} .1 mm above", name_of(runs[0].type),
        name_of(runs[1].type));
}

void symmetric_impacts(Report& report, const BranchCurves& here) {
    const BranchCurves other = branches(Damping::equation_of_motion);
    const double end = here.mm(SpecialKind::torus), other_end = other.mm(SpecialKind::torus),
                 half_angle = 0.5 * *here.of_symmetric.at(SpecialKind::torus).angle;
    report.add(
        {"Fig. 11, Table 3",
         "b at which two symmetric impacts per cycle cease to attract (end of Type III), mm",
         "III at 15, II at 16.5"},
        {end, other_end,
         "{:.6f}: a pair {:.4f} +- {:.4f}i leaves the unit circle, as at a torus bifurcation; "
         "{}; by eq. (1) {:.6f}",
         end, std::cos(half_angle), std::sin(half_angle), compared_with_runs(end / 1000),
         other_end},
        {{15, 16.5}, "between the two"}, by_closed_form);
    report.paragraph(fmt::format(
        "Where two symmetric impacts per cycle (Fig. 11) become asymmetric (Fig. 12), a multiplier "
        "of half a cycle is -1 and the symmetry breaks: at b = {:.6f} mm, by eq. (1) at {:.6f} mm. "
        "By the closed form the motion exists up to b = {:.6f} mm, where it meets a slower one in "
        "a fold.",
        here.mm(SpecialKind::symmetry_breaking), other.mm(SpecialKind::symmetry_breaking),
        here.mm(SpecialKind::fold)));
}

}  // namespace

void motions_over_b(Report& report, RunCache&) {
    report.heading("The motions over b");
    const BranchCurves found = branches(Damping::closed_form);
    symmetric_impacts(report, found);
    std::vector<Curve> curves = {runs_over_b(), found.unstable, found.stable};
    std::vector<std::string> places;
    std::size_t colour = 1;
    for (const auto& [kind, points] : found.specials) {
        std::string name = name_of(kind);
        std::ranges::replace(name, '_', ' ');
        for (const double b : points.x) places.push_back(fmt::format("{} at {:.6f}", name, b));
        curves.push_back(points);
        curves.back().dots = true;
        curves.back().label = name;
        curves.back().colour = kind == SpecialKind::fold ? red : colours[colour++ % 4];
    }
    report.paragraph(fmt::format(
        "Branches of periodic orbits that contain the symmetric motion of Fig. 11, with the "
        "damping of the closed form, and the amplitudes of runs from the paper's start, {:g} to "
        "{:g} mm. Special points, mm: {}. Where the runs leave the branches their motions are "
        "chaotic or quasi-periodic.",
        1000 * from, 1000 * to, fmt::join(places, ", ")));
    report.picture(
        "motions",
        "Largest |x| over b: runs from the paper's start (dots) and the orbits that exist (solid: "
        "stable, broken: unstable)",
        {{.x_label = "b (mm)", .y_label = "largest |x| (mm)", .curves = curves}}, 330);
}

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

void borders(Report& report) {
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
        {lowest(here), lowest(other), "at {}; by eq. (1) {}", listed(here), listed(other)},
        {{31.25, 34}, "between the two"}, by_closed_form);
    // "Then b is decreased to 0.004 m, three impacts per cycle is obtained": the b at which it is.
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
    borders(report);
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
