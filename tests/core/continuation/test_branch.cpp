#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../support.hpp"
#include "core/continuation/branch.hpp"
#include "core/continuation/periodic_impacts.hpp"
#include "core/measures/energy.hpp"
#include "core/measures/manifold.hpp"
#include "core/stability/orbit.hpp"

using namespace vines;
using namespace vines::test;

namespace {

struct Recorded : BranchSink {
    struct Point {
        int branch;
        OrbitPoint orbit;
    };
    struct Special {
        int branch;
        SpecialPoint point;
    };
    std::vector<BranchStart> branches;
    std::vector<Point> points;
    std::vector<Special> specials;

    void branch(const BranchStart& start) override { branches.push_back(start); }
    void point(int branch, const OrbitPoint& point) override { points.push_back({branch, point}); }
    void special(int branch, const SpecialPoint& special) override {
        specials.push_back({branch, special});
    }
    /// The parameter at the first special point of this kind; NaN if there is none.
    double at(SpecialKind kind) const {
        for (const Special& s : specials)
            if (s.point.kind == kind) return s.point.orbit.parameters[0];
        return vines::nan;
    }
    /// Reasons of the ends, by branch.
    std::vector<BranchEnd> ends() const {
        std::vector<BranchEnd> all;
        for (const Special& s : specials)
            if (s.point.end) all.push_back(*s.point.end);
        return all;
    }
};

using Change = std::function<void(Parameters&, double)>;

void change_b(Parameters& p, double b) { p.b = b; }
void change_R(Parameters& p, double R) { p.R_plus = p.R_minus = R; }

/// The orbit on which a system settles from the default start.
std::optional<PeriodicOrbit> settled_orbit(const Parameters& p, int cycles) {
    const State s = simulate(p, default_state(p), {1000 * p.cycle(), 1000000, {}}, {}).state;
    return find_orbit(p, s, cycles, scale_of(p, {&s, 1}), 0.5, {});
}

Recorded continued(
    const Parameters& p, const Change& change, double at, double from, double to, int switches = 0,
    int cycles = 1) {
    BranchPlan plan{
        .family =
            {[&](const std::vector<double>& values) {
                 Parameters changed = p;
                 change(changed, values[0]);
                 return is_physical(changed) ? std::optional(changed) : std::nullopt;
             },
             {{from, to}}},
        .switches = switches};
    const auto orbit = settled_orbit(p, cycles);
    REQUIRE(orbit);
    const double length = scale_of(p, whole_cycle_states(p, *orbit)).x;
    const auto start = orbit_start(p, *orbit, length, plan.family, {at});
    REQUIRE(start);
    Recorded recorded;
    CHECK(follow_branches(plan, *start, recorded));
    return recorded;
}

Recorded table1_by_b(int switches = 0) {
    return continued(table1(0.015, Damping::closed_form), change_b, 0.015, 0.004, 0.03, switches);
}

/// Each point's state lies on an orbit of the simulated motion with its multipliers and measures,
/// up to multipliers of size `most`: next to grazing the simulation has few digits of larger ones.
void check_points(
    const Recorded& r, const std::function<Parameters(double)>& system_at, double most = 1e4) {
    int checked = 0;
    for (const auto& [branch, orbit] : r.points) {
        const double value = orbit.parameters[0];
        CAPTURE(value);
        const Parameters p = system_at(value);
        if (elementary::modulus(orbit.multipliers[0]) > most) continue;
        ++checked;
        const State& s = orbit.measures.at_whole_cycle;
        const auto found =
            find_orbit(p, s, orbit.sequence.cycles(), scale_of(p, {&s, 1}), 1e-6, {});
        REQUIRE(found);
        CHECK(found->contacts == orbit.sequence.impacts());
        CHECK(found->sticks == orbit.sequence.sticks * (orbit.sequence.mirrored ? 2 : 1));
        if (orbit.sequence.mirrored) CHECK(found->symmetric);
        for (int k = 0; k < 2; ++k)
            CHECK(
                elementary::modulus(found->multipliers[k]) ==
                doctest::Approx(elementary::modulus(orbit.multipliers[k])).epsilon(1e-6));
        Energy energy(p, {0, orbit.sequence.cycles() * p.cycle()});
        follow(p, s, 0, orbit.sequence.cycles() * p.cycle(), {}, {&energy});
        const EnergyBalance balance = energy.balance({0, orbit.sequence.cycles() * p.cycle()});
        CHECK(orbit.measures.x_max == doctest::Approx(balance.peak).epsilon(1e-7));
        CHECK(orbit.measures.x_rms == doctest::Approx(balance.rms).epsilon(1e-7));
        CHECK(
            *orbit.measures.share_impacts == doctest::Approx(*balance.share_impacts).epsilon(1e-6));
    }
    CHECK(checked > 20);
}

}  // namespace

TEST_CASE("an arc is the flow's motion, and its derivatives are differences of arcs") {
    for (const auto damping : {Damping::equation_of_motion, Damping::closed_form}) {
        Parameters p = table1(0.015, damping);
        p.Omega = 1.07;
        const Flow::Coefficients law = Flow::free_coefficients(p);
        const Flow flow = *Flow::shared_free(p);
        const Oscillation start{0.002, -0.003, std::sin(0.7), std::cos(0.7)};
        for (const double s : {1e-7, 0.3, 3.1, 12.0}) {
            CAPTURE(s);
            const Arc arc = arc_over(law, start, s);
            const Oscillation end = flow.after(start, s);
            const Transfer transfer = flow.transfer(s);
            CHECK(std::abs(arc.end.x - end.x) < 1e-16);
            CHECK(std::abs(arc.end.x_dot - end.x_dot) < 1e-16);
            CHECK(std::abs(arc.end.sin_theta - end.sin_theta) < 1e-14);
            CHECK(std::abs(arc.transfer.a11 - transfer.a11) < 1e-13);
            CHECK(std::abs(arc.transfer.a12 - transfer.a12) < 1e-13);
            CHECK(std::abs(arc.transfer.a21 - transfer.a21) < 1e-13);
            CHECK(std::abs(arc.transfer.a22 - transfer.a22) < 1e-13);
            CHECK(std::abs(arc.bend * s - (end.x - start.x - start.x_dot * s)) < 1e-16);
            const auto turned = [&](double by) {
                return arc_over(
                    law, {start.x, start.x_dot, std::sin(0.7 + by), std::cos(0.7 + by)}, s);
            };
            const double h = 1e-5;
            const Arc more = turned(h), less = turned(-h);
            CHECK(std::abs((more.end.x - less.end.x) / (2 * h) - arc.x_by_theta) < 1e-11);
            CHECK(
                std::abs((more.end.x_dot - less.end.x_dot) / (2 * h) - arc.x_dot_by_theta) < 1e-11);
        }
        // The bend of a short flight: x''/2 s, to its own relative accuracy.
        CHECK(
            arc_over(law, start, 1e-9).bend ==
            doctest::Approx(0.5e-9 * flow.acceleration(start)).epsilon(1e-8));
    }
}

TEST_CASE("the Jacobian matrix of an orbit's equations is their difference quotient") {
    Parameters p = table1(0.0052, Damping::closed_form);
    std::mt19937_64 engine(7);
    p.table_plus = random_table(engine, 0.01);
    p.gravity = 4e-4;
    const ParameterFamily family{
        [&](const std::vector<double>& values) {
            Parameters changed = p;
            changed.Omega = values[0];
            return std::optional(changed);
        },
        {{0, 0.2}}};
    for (const bool mirrored : {false, true}) {
        // Not an orbit: the equations hold for any unknowns.
        const ImpactEquations equations({{1, -1, -1}, mirrored, mirrored ? 3 : 2}, family, 0.003);
        Unknowns z(8);
        z << 0.4, 0.7, -0.9, -1.1, 2.1, 1.7, 2.4, 1 / 0.2;
        Eigen::MatrixXd J;
        const auto at = equations.values(z, &J);
        REQUIRE(at);
        for (Eigen::Index c = 0; c < 8; ++c) {
            CAPTURE(c);
            Unknowns more = z, less = z;
            more(c) += 1e-6;
            less(c) -= 1e-6;
            const Eigen::VectorXd quotient =
                (equations.values(more)->residual - equations.values(less)->residual) / 2e-6;
            CHECK((J.col(c) - quotient).cwiseAbs().maxCoeff() < 2e-8 * (1 + quotient.norm()));
        }
    }
}

// Values of the closed form in docs/physics.md, computed with 30 digits.
TEST_CASE("the limits of the symmetric motion of Table 1 are those of its closed form") {
    const Recorded r = table1_by_b();
    CHECK(std::abs(r.at(SpecialKind::symmetry_breaking) - 7.046736303e-3) < 1e-12);
    CHECK(std::abs(r.at(SpecialKind::torus) - 16.286026400e-3) < 1e-12);
    CHECK(std::abs(r.at(SpecialKind::fold) - 17.274734144e-3) < 1e-12);
    // The unstable part ends where the ball rests in the middle and the oscillator's free amplitude
    // is b: both impacts become grazing contacts.
    CHECK(
        std::abs(r.at(SpecialKind::grazing) - *free_amplitude(table1(0.01, Damping::closed_form))) <
        1e-10);
    CHECK(r.ends() == std::vector{BranchEnd::last_impact, BranchEnd::range});
}

TEST_CASE("points are orbits of the simulated motion, with its multipliers") {
    const Recorded r = table1_by_b(1);
    CHECK(r.points.size() > 100);
    check_points(r, [](double b) { return table1(b, Damping::closed_form); });
}

TEST_CASE("branches under gravity, with unequal walls or with R of the speed are orbits, too") {
    const Parameters base = table1(0.012, Damping::closed_form);
    const auto with = [&](const Change& change) {
        return [&, change](double value) {
            Parameters p = base;
            change(p, value);
            return p;
        };
    };
    const Change gravity = [](Parameters& p, double g) { p.gravity = g; },
                 R_plus = [](Parameters& p, double R) { p.R_plus = R; };
    const Recorded falling = continued(base, gravity, 0, -1e-3, 3e-3);
    check_points(falling, with(gravity));
    CHECK(falling.points.back().orbit.parameters[0] != 0);
    for (const auto& [branch, orbit] : falling.points) CHECK(!orbit.sequence.mirrored);
    check_points(continued(base, R_plus, base.R_plus, 0.5, 0.7), with(R_plus));
    // R of the speed.
    std::mt19937_64 engine(11);
    Parameters tabled = base;
    tabled.table_plus = tabled.table_minus = random_table(engine, 0.02);
    const Change other_b = [&](Parameters& p, double b) { (p = tabled).b = b; };
    check_points(continued(tabled, other_b, 0.012, 0.008, 0.02), with(other_b));
}

TEST_CASE("a branch that begins at a broken symmetry returns to it, and is found from elsewhere") {
    const Recorded whole = table1_by_b(1);
    const auto begun =
        std::ranges::find(whole.branches, SpecialKind::symmetry_breaking, &BranchStart::at);
    REQUIRE(begun != whole.branches.end());
    const auto flip = std::ranges::find_if(whole.specials, [&](const auto& s) {
        return s.branch == begun->number && s.point.kind == SpecialKind::flip;
    });
    REQUIRE(flip != whole.specials.end());
    const Recorded twin =
        continued(table1(0.0065, Damping::closed_form), change_b, 0.0065, 0.0052, 0.02);
    CHECK(std::abs(twin.at(SpecialKind::flip) - flip->point.orbit.parameters[0]) < 1e-13);
    CHECK(std::abs(twin.at(SpecialKind::symmetry_breaking) - 7.046736303e-3) < 1e-12);
    CHECK(twin.ends() == std::vector{BranchEnd::parent, BranchEnd::range});
}

TEST_CASE("below a flip the motion settles on twice the period, above it on the period") {
    const Recorded r =
        continued(table1(0.0065, Damping::closed_form), change_b, 0.0065, 0.0054, 0.007);
    const double b = r.at(SpecialKind::flip);
    const auto period = [&](double at) {
        const Parameters p = table1(at, Damping::closed_form);
        const State s = simulate(p, default_state(p), {40000 * p.cycle(), 10000000, {}}, {}).state;
        const auto once = follow(p, s, 0, p.cycle(), {}),
                   again = follow(p, s, 0, 2 * p.cycle(), {});
        return distance(*again, s, scale_of(p, {&s, 1})) > 1e-9  ? 0
               : distance(*once, s, scale_of(p, {&s, 1})) < 1e-9 ? 1
                                                                 : 2;
    };
    CHECK(period(b + 4e-7) == 1);
    CHECK(period(b - 4e-7) == 2);
}

TEST_CASE("flips lie where a multiplier of the simulated motion passes -1, within 1e-8 m") {
    int flips = 0;
    for (const double R : {0.45, 0.5, 0.55, 0.6, 0.65, 0.7}) {
        Parameters p = table1(0.0065, Damping::closed_form);
        p.R_plus = p.R_minus = R;
        for (const auto& special : continued(p, change_b, 0.0065, 0.004, 0.02, 1).specials) {
            const SpecialPoint& point = special.point;
            const double b = point.orbit.parameters[0];
            if (point.kind != SpecialKind::flip || point.orbit.sequence.impacts() > 3) continue;
            const auto beyond = [&](double at) {
                p.b = at;
                const State& s = point.orbit.measures.at_whole_cycle;
                const auto orbit =
                    find_orbit(p, s, point.orbit.sequence.cycles(), scale_of(p, {&s, 1}), 0.1, {});
                REQUIRE(orbit);
                const auto most = std::ranges::min(
                    orbit->multipliers, {}, [](const auto& m) { return m.real(); });
                return most.real() < -1;
            };
            CHECK(beyond(b - 1e-8) != beyond(b + 1e-8));
            ++flips;
        }
    }
    CHECK(flips >= 10);
}

TEST_CASE("for a light ball the symmetric motion has the limits of the slow invariant manifold") {
    Parameters p = table1(0.01, Damping::closed_form);
    p.epsilon = 1e-8;
    p.lambda = 2 * 0.01 / p.epsilon;
    p.G *= 0.007 / *free_amplitude(p);
    const double fold = manifold_b(p.R_plus, 0.007), b = 0.4 * fold;
    p.b = b;
    const Recorded r = continued(p, change_b, b, 0.1 * fold, 2 * fold);
    CHECK(r.at(SpecialKind::fold) == doctest::Approx(fold).epsilon(1e-5));
    const double broken = r.at(SpecialKind::symmetry_breaking);
    CHECK(
        manifold_symmetry_breaking(p.R_plus, 1, broken).C == doctest::Approx(0.007).epsilon(1e-5));
}

TEST_CASE("where a contact becomes grazing the branch continues with one impact more") {
    const Recorded r =
        continued(table1(0.0065, Damping::closed_form), change_b, 0.0065, 0.004, 0.007);
    const auto grazing = std::ranges::find_if(
        r.specials, [](const auto& s) { return s.point.kind == SpecialKind::grazing; });
    REQUIRE(grazing != r.specials.end());
    CHECK(grazing->point.impacts_after == grazing->point.orbit.sequence.impacts() + 1);
    // Found from the other side, where the impact exists.
    const Recorded other =
        continued(table1(0.005, Damping::closed_form), change_b, 0.005, 0.004, 0.007);
    const auto lost = std::ranges::find_if(
        other.specials, [](const auto& s) { return s.point.kind == SpecialKind::grazing; });
    REQUIRE(lost != other.specials.end());
    CHECK(lost->point.orbit.sequence.impacts() == grazing->point.impacts_after);
    CHECK(std::abs(lost->point.orbit.parameters[0] - grazing->point.orbit.parameters[0]) < 1e-10);
    // No orbit of these branches has more impacts.
    for (const auto& recorded : {r, other})
        for (const auto& [branch, orbit] : recorded.points) CHECK(orbit.sequence.impacts() <= 3);
}

TEST_CASE("sticking begins at the same b from both sides, and in simulated runs") {
    const double R = 0.2;
    const auto system = [&](double b) {
        Parameters p = table1(b, Damping::closed_form);
        p.R_plus = p.R_minus = R;
        return p;
    };
    Recorded sticking = continued(system(0.002), change_b, 0.002, 0.0015, 0.03),
             free = continued(system(0.006), change_b, 0.006, 0.0015, 0.03, 1);
    const double birth = sticking.at(SpecialKind::stick);
    CHECK(std::abs(free.at(SpecialKind::stick) - birth) < 1e-12);
    CHECK(sticking.ends() == std::vector{BranchEnd::last_impact, BranchEnd::range});
    // Next to the birth a simulation may not stick.
    std::erase_if(sticking.points, [&](const auto& p) {
        return std::abs(p.orbit.parameters[0] - birth) < 1e-7;
    });
    check_points(sticking, system, 100);
    const auto sticks = [&](double b) {
        const auto orbit = settled_orbit(system(b), 1);
        REQUIRE(orbit);
        return orbit->sticks;
    };
    CHECK(sticks(birth - 1e-9) == 2);
    CHECK(sticks(birth + 1e-9) == 0);
}

TEST_CASE("a branch with R = 0 continues where the ball no longer sticks") {
    const auto system = [](double b) {
        Parameters p = table1(b, Damping::closed_form);
        p.R_plus = p.R_minus = 0;
        return p;
    };
    const Recorded r = continued(system(0.004), change_b, 0.004, 0.002, 0.03);
    check_points(r, system);
    const Recorded other = continued(system(0.009), change_b, 0.009, 0.002, 0.03);
    CHECK(std::abs(r.at(SpecialKind::stick) - other.at(SpecialKind::stick)) < 1e-13);
    CHECK(std::abs(r.at(SpecialKind::torus) - other.at(SpecialKind::torus)) < 1e-12);
}

TEST_CASE("branches under friction are orbits of the simulated motion, also along the friction") {
    Parameters base = table1(0.012, Damping::closed_form);
    base.friction = 1e-4;
    const auto by_b = [&](double b) {
        Parameters p = base;
        p.b = b;
        return p;
    };
    const Recorded whole = continued(base, change_b, 0.012, 0.0055, 0.016, 1);
    check_points(whole, by_b);
    const auto broken =
        std::ranges::find(whole.branches, SpecialKind::symmetry_breaking, &BranchStart::at);
    REQUIRE(broken != whole.branches.end());
    CHECK(std::ranges::any_of(whole.points, [&](const auto& p) {
        return p.branch == broken->number && p.orbit.stable() && !p.orbit.sequence.mirrored;
    }));
    const Change change = [](Parameters& p, double friction) { p.friction = friction; };
    base.friction = 0;
    const Recorded r = continued(base, change, 0, 0, 3e-4);
    check_points(r, [&](double friction) {
        Parameters p = base;
        p.friction = friction;
        return p;
    });
    CHECK(r.ends() == std::vector{BranchEnd::range, BranchEnd::range});
}

TEST_CASE(
    "under friction a branch passes edges where slips change, and ends where the ball grazes" *
    doctest::test_suite("long")) {
    Parameters base = table1(0.006, Damping::equation_of_motion);
    base.epsilon = 0.03;
    base.lambda = 2.0 / 3;
    const auto with = [&base](double friction, double F) {
        Parameters p = base;
        p.friction = friction;
        p.G = F / p.epsilon;
        return p;
    };
    const Change change = [](Parameters& p, double Omega) { p.Omega = Omega; };
    Parameters p = with(6.3369e-5, 5e-4);
    p.Omega = 13.0 / 14;
    const Recorded past = continued(p, change, p.Omega, p.Omega, 0.95);
    check_points(past, [&p](double Omega) {
        Parameters q = p;
        q.Omega = Omega;
        return q;
    });
    CHECK(past.at(SpecialKind::stick) == doctest::Approx(13.0076145 / 14).epsilon(1e-8));
    CHECK(past.ends() == std::vector{BranchEnd::range, BranchEnd::range});
    p = with(1.26737e-4, 2e-4);
    p.Omega = 1;
    // The last impacts become grazing contacts, next to which multipliers grow beyond all limits.
    const Recorded grazing = continued(p, change, 1, 0.8, 1.3);
    CHECK(grazing.points.size() < 500);
    CHECK(grazing.ends().size() >= 2);
    for (const Recorded::Special& s : grazing.specials)
        if (s.point.end) CHECK(s.point.orbit.measures.share_impacts.value_or(1) < 1e-8);
}

TEST_CASE("a branch that returns to its start is reported once, as closed") {
    Parameters p = table1(0.015, Damping::closed_form);
    const Recorded r =
        continued(p, [](Parameters& q, double Omega) { q.Omega = Omega; }, 1, 0.9, 1.1);
    CHECK(r.ends() == std::vector{BranchEnd::closed});
    CHECK(std::ranges::count_if(r.specials, [](const auto& s) {
              return s.point.kind == SpecialKind::fold;
          }) == 2);
}

TEST_CASE("folds and tori are the same along b and along R") {
    const Recorded by_R = continued(table1(0.015, Damping::closed_form), change_R, 0.6, 0.1, 0.95);
    for (const auto kind : {SpecialKind::fold, SpecialKind::torus}) {
        Parameters p = table1(0.015, Damping::closed_form);
        const double R = by_R.at(kind);
        REQUIRE(R < 0.6);
        // From an orbit at that R, for a b at which it is stable.
        p.R_plus = p.R_minus = R;
        p.b = 0.012;
        const Recorded by_b = continued(p, change_b, 0.012, 0.008, 0.02);
        CHECK(std::abs(by_b.at(kind) - 0.015) < 1e-12);
    }
}

TEST_CASE("a branch reaches the end of its range, R = 1 or just past a special point") {
    Parameters p = table1(0.012, Damping::closed_form);
    p.R_plus = p.R_minus = 0.8;
    const Recorded r = continued(p, change_R, 0.8, 0, 1);
    CHECK(r.ends() == std::vector{BranchEnd::range, BranchEnd::range});
    CHECK(r.points.back().orbit.parameters[0] == 1);
    // The torus bifurcation is at 16.2860264e-3.
    const Recorded past =
        continued(table1(0.015, Damping::closed_form), change_b, 0.015, 0.0149, 16.2860265e-3);
    CHECK(std::abs(past.at(SpecialKind::torus) - 16.286026400e-3) < 1e-12);
    CHECK(past.ends() == std::vector{BranchEnd::range, BranchEnd::range});
}

TEST_CASE("an orbit begins a branch also if its flights are longer than its first cycle") {
    Parameters p = table1(0.029981, Damping::closed_form);
    p.R_plus = p.R_minus = 0.05;
    const Recorded r =
        continued(p, [](Parameters& q, double Omega) { q.Omega = Omega; }, 1, 0.999, 1.001, 0, 3);
    CHECK(r.points[0].orbit.sequence.cycles() == 3);
    CHECK(r.points[0].orbit.sequence.impacts() == 2);
}

TEST_CASE("limits of points and a stop request end a computation") {
    const Parameters p = table1(0.015, Damping::closed_form);
    BranchPlan plan{
        .family =
            {[&](const std::vector<double>& values) {
                 Parameters changed = p;
                 changed.b = values[0];
                 return std::optional(changed);
             },
             {{0.005, 0.025}}},
        .most_points = 5};
    const auto orbit = settled_orbit(p, 1);
    REQUIRE(orbit);
    const auto start = orbit_start(p, *orbit, 0.003, plan.family, {p.b});
    REQUIRE(start);
    Recorded few;
    CHECK(follow_branches(plan, *start, few));
    CHECK(few.ends() == std::vector{BranchEnd::most_points, BranchEnd::most_points});
    CHECK(few.points.size() <= 10);
    int calls = 0;
    plan.stop = [&] { return ++calls > 3; };
    Recorded stopped;
    CHECK(!follow_branches(plan, *start, stopped));
    CHECK(stopped.ends().empty());
}
