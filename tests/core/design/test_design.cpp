#include "core/design/design.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "../support.hpp"
#include "core/measures/energy.hpp"
#include "core/measures/extremes.hpp"
#include "core/motion/load.hpp"

using namespace vines;
using namespace vines::test;

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

/// 2 kg at 8 Hz, damping 1 %, 40 g to spend, base acceleration 5 m/s^2 from 7 to 9 Hz.
DesignPlan machine() {
    SiParameters si;
    si.m1 = 2, si.m2 = 0.04;
    si.k1 = si.m1 * (two_pi * 8) * (two_pi * 8);
    si.c1 = 2 * 0.01 * std::sqrt(si.k1 * si.m1);
    DesignPlan plan;
    plan.host = {si, Damping::equation_of_motion, [](double f) {
                     return 5 / ((two_pi * f) * (two_pi * f));
                 }};
    plan.f = {7, 9};
    plan.b = {0.02, 0.08};
    plan.R = {0.2};
    plan.m2 = {si.m2};
    plan.b_count = 8, plan.f_count = 5;
    plan.transient_cycles = 30, plan.cycles = 40;
    return plan;
}

double largest(const Host& host, const LinearAbsorber& t, const Interval& band, int parts = 20000) {
    double most = 0;
    for (int k = 0; k <= parts; ++k)
        most = std::max(
            most, linear_response(
                      host, t, Objective::x_max, band.from + (band.to - band.from) * k / parts));
    return most;
}

/// Extremes of a run by dense sampling.
Extremes sampled(const Parameters& p, const State& start, double tau_end) {
    struct Sampler : Observer {
        explicit Sampler(const Parameters& parameters) : p(parameters) {}
        void on_stretch(const Stretch& s) override {
            for (int k = 0; k <= 2000; ++k) {
                const double at = s.duration * k / 2000, tau = s.tau + at;
                found.x_acceleration = std::max(found.x_acceleration, std::abs(s.x_ddot(at)));
                const double base =
                    p.load ? s.forces->base.at(at) : p.epsilon * p.G * std::sin(p.Omega * tau);
                found.x_relative = std::max(found.x_relative, std::abs(s.at(at).x - base));
            }
        }
        void on_impact(const Impact& i) override {
            found.impact_speed =
                std::max(found.impact_speed, std::abs(i.x_dot_before - i.y_dot_before));
            found.impulse =
                std::max(found.impulse, p.epsilon * std::abs(i.y_dot_after - i.y_dot_before));
            ++found.impact_rate;
        }
        const Parameters& p;
        Extremes found;
    } sampler(p);
    Observer* const observers[] = {&sampler};
    simulate(p, start, {.tau_end = tau_end}, observers);
    sampler.found.impact_rate /= tau_end;
    return sampler.found;
}

}  // namespace

TEST_CASE("extremes are those of dense samples and of all impacts") {
    for (const double Omega : {0.7, 1.0, 1.9})
        for (const bool slides : {false, true}) {
            CAPTURE(Omega);
            CAPTURE(slides);
            Parameters p =
                table1(0.012, slides ? Damping::equation_of_motion : Damping::closed_form);
            p.Omega = Omega;
            p.lambda = 20;
            if (slides) p.gravity = 0.002, p.friction = 0.001;
            ExtremesRecord record(p, {0, 60});
            Observer* const observers[] = {&record};
            simulate(p, default_state(p), {.tau_end = 60}, observers);
            const Extremes dense = sampled(p, default_state(p), 60);
            const Extremes exact = record.result({0, 60});
            CHECK(exact.x_acceleration == doctest::Approx(dense.x_acceleration).epsilon(1e-5));
            CHECK(exact.x_acceleration >= dense.x_acceleration * (1 - 1e-12));
            CHECK(exact.x_relative == doctest::Approx(dense.x_relative).epsilon(1e-5));
            CHECK(exact.x_relative >= dense.x_relative * (1 - 1e-12));
            CHECK(exact.impact_speed == doctest::Approx(dense.impact_speed).epsilon(1e-12));
            CHECK(exact.impulse == doctest::Approx(dense.impulse).epsilon(1e-12));
            CHECK(exact.impact_rate == dense.impact_rate);
            CHECK((exact.impulse > 0) == slides);
        }
}

TEST_CASE("without absorber and with the best tuned mass damper the largest x is 99 and 17.7 mm") {
    const DesignPlan plan = machine();
    RunControl control;
    const LinearAbsorber best = best_tuned_mass_damper(
        2, 0.04, [&](const LinearAbsorber& t) { return largest(plan.host, t, plan.f, 200); }, 2,
        control);
    CHECK(largest(plan.host, {}, plan.f) == doctest::Approx(0.0990).epsilon(1e-3));
    const double least = largest(plan.host, best, plan.f);
    CHECK(least == doctest::Approx(0.0177).epsilon(3e-3));
    CHECK(least < largest(plan.host, den_hartog(2, 0.04), plan.f));
    // No other one near it is better.
    for (const double frequency : {0.99, 1.0, 1.01})
        for (const double damping : {0.9, 1.0, 1.1})
            CHECK(
                largest(
                    plan.host,
                    {0.04, frequency * best.frequency_ratio, damping * best.damping_ratio},
                    plan.f) >= least * (1 - 1e-4));
}

TEST_CASE("Den Hartog's damper has two equal peaks on an undamped host") {
    Host host = machine().host;
    host.si.c1 = 0;
    host.base_amplitude = [](double) { return 1e-3; };
    const LinearAbsorber t = den_hartog(host.si.m1, 0.1);
    const auto x = [&](double f) { return linear_response(host, t, Objective::x_max, f); };
    const double low = band_maximum(x, {5, 7.6}).value, high = band_maximum(x, {7.6, 10}).value;
    CHECK(low == doctest::Approx(high).epsilon(0.01));
    // sqrt(1 + 2/mu) times the base's amplitude.
    CHECK(low == doctest::Approx(1e-3 * std::sqrt(1 + 2 / 0.05)).epsilon(0.01));
}

TEST_CASE("where the objective is a mean, the alternatives are compared by their means") {
    DesignPlan plan = machine();
    plan.mean = true, plan.default_set = false, plan.b_count = 4;
    const auto designed = [&] {
        RunControl control;
        return *find_design(plan, 2, control, [](const DesignPoint&) {});
    };
    const Design d = designed();
    const auto mean = [&](const LinearAbsorber& t) {
        double sum = 0;
        for (int k = 0; k < 17; ++k)
            sum += linear_response(plan.host, t, Objective::x_max, 7 + k / 8.0);
        return sum / 17;
    };
    CHECK(d.without.value == doctest::Approx(mean({})));
    CHECK(d.with_tuned_mass_damper.value == doctest::Approx(mean(d.tuned_mass_damper)));
    CHECK(d.with_tuned_mass_damper.value < d.with_den_hartog.value);
    CHECK(d.best.objective < d.without.value);
    plan.amplitude_ratio = 0.5;
    plan.tolerances = {{Toleranced::R, true, false, 0.2, 0}}, plan.samples = {0};
    const Design range = designed();
    CHECK(range.samples.at(0).point.objective == doctest::Approx(range.best.objective));
    const double share = range.without.value / d.without.value;
    CHECK(share > 0.5);
    CHECK(share < 1);
}

TEST_CASE("linear responses to a load settle on those to its frequency") {
    Host host = machine().host;
    host.si.c1 *= 5;
    constexpr double f = 8.4;
    host.load = [&](const SiParameters& si) {
        return std::make_shared<const Load>(
            std::vector<LoadHarmonic>{{host.base_amplitude(f), two_pi * f / si.omega0(), 0.3}});
    };
    for (const double m2 : {0.0, 0.04})
        for (const Damping damping : {Damping::equation_of_motion, Damping::closed_form})
            for (const Objective objective :
                 {Objective::x_max, Objective::x_rms, Objective::x_relative_max,
                  Objective::x_acceleration_max}) {
                host.damping = damping;
                const LinearAbsorber t{m2, 0.97, 0.1};
                // x of a load is relative to the base.
                const double relative = linear_response(host, t, Objective::x_relative_max, f);
                CHECK(
                    linear_response(
                        host, host.load(host.si).get(), t, objective, Interval{400, 600}) ==
                    doctest::Approx(
                        objective == Objective::x_acceleration_max
                            ? linear_response(host, t, objective, f)
                            : relative / (objective == Objective::x_rms ? std::sqrt(2.0) : 1))
                        // The window of an rms is no whole number of cycles.
                        .epsilon(
                            objective == Objective::x_rms                ? 2e-3
                            : objective == Objective::x_acceleration_max ? 3e-4
                                                                         : 1e-6));
            }
}

TEST_CASE(
    "a design under a shock is the best of runs from rest, and beats its neighbours" *
    doctest::test_suite("long")) {
    DesignPlan plan = machine();
    plan.host.load = [](const SiParameters& si) {
        const double duration = 0.03 * si.omega0(), rate = std::numbers::pi / duration;
        return std::make_shared<const Load>(
            LoadKind::base_acceleration, 30 / (si.omega0() * si.omega0()), duration,
            [rate](double tau) {
                Polynomial theta;
                theta.add(0, rate * tau), theta.add(1, rate);
                return theta;
            });
    };
    plan.objective = Objective::x_relative_max;
    plan.f = {}, plan.f_count = 1, plan.default_set = false;
    plan.transient_cycles = 0, plan.b = {0.005, 0.08}, plan.b_count = 20;
    RunControl control;
    const auto d = find_design(plan, 2, control, [](const DesignPoint&) {});
    REQUIRE(d);
    CHECK(d->complete);
    const auto load = plan.host.load(plan.host.si);
    const auto with = [&](double b) {
        Parameters p;
        p.epsilon = plan.host.si.m2 / plan.host.si.m1;
        p.lambda = 2 * 0.01 / p.epsilon;
        p.Omega = 1, p.G = 0, p.load = load, p.b = b, p.R_plus = p.R_minus = 0.2;
        return sampled(p, default_state(p), plan.cycles * p.cycle()).x_relative;
    };
    CHECK(d->best.objective == doctest::Approx(with(d->best.b)).epsilon(1e-4));
    for (int k = 0; k < 20; ++k)
        CHECK(with(0.005 * std::pow(16, k / 19.0)) > 0.98 * d->best.objective);
    CHECK(d->with_tuned_mass_damper.value < 1.001 * d->without.value);
    // Without absorber: the same run with a cavity that the ball never crosses.
    Parameters alone;
    alone.epsilon = 0.02, alone.lambda = 1, alone.Omega = 1, alone.G = 0, alone.load = load;
    alone.b = 100;
    CHECK(
        d->without.value ==
        doctest::Approx(sampled(alone, {}, plan.cycles * alone.cycle()).x_relative).epsilon(1e-3));
}

TEST_CASE(
    "a design under a load that is stopped while dampers are tuned has the best absorber alone" *
    doctest::test_suite("long")) {
    DesignPlan plan = machine();
    plan.host.load = [](const SiParameters&) {
        return std::make_shared<const Load>(std::vector<LoadHarmonic>{{1e-3, 1, 0}});
    };
    plan.f = {}, plan.f_count = 1, plan.default_set = false;
    plan.b_count = 3;
    struct Control : RunControl {
        bool stop_or_yield() override { return left == 0; }
        std::atomic<int> left = 1000;
    } control;
    int tried = 0;
    const auto whole = find_design(plan, 1, control, [&](const DesignPoint&) { ++tried; });
    REQUIRE(whole);
    CHECK(whole->complete);
    control.left = tried;
    const auto d = find_design(plan, 1, control, [&](const DesignPoint&) { --control.left; });
    REQUIRE(d);
    CHECK_FALSE(d->complete);
    CHECK(d->best.b == whole->best.b);
    CHECK(d->without.value == whole->without.value);
    CHECK(std::isnan(d->with_tuned_mass_damper.value));
}

TEST_CASE(
    "after an impulse the time to a tenth of the energy is that of a free decay" *
    doctest::test_suite("long")) {
    Host host = machine().host;
    host.base_amplitude = nullptr, host.initial_velocity = 0.5;
    const double omega0 = host.si.omega0(), zeta = 0.01;
    // exp(-2 rate tau) = 0.1, to the energy's ripple within a period; the closed form damps twice.
    for (const Damping damping : {Damping::equation_of_motion, Damping::closed_form}) {
        host.damping = damping;
        const double rate = damping == Damping::closed_form ? 2 * zeta : zeta;
        CHECK(
            linear_response(host, nullptr, {}, Objective::decay_time, Interval{0, 1000}) ==
            doctest::Approx(std::log(10) / (2 * rate * omega0)).epsilon(0.01));
    }
    DesignPlan plan = machine();
    plan.host = host;
    plan.host.damping = Damping::equation_of_motion;
    plan.objective = Objective::decay_time, plan.amplitude_ratio = 0.5;
    plan.f = {}, plan.f_count = 1, plan.default_set = false;
    plan.b = {0.0005, 0.02}, plan.b_count = 20, plan.cycles = 60;
    RunControl control;
    const auto d = find_design(plan, 2, control, [](const DesignPoint&) {});
    REQUIRE(d);
    CHECK(d->best.objective < 0.5 * d->without.value);
    CHECK(d->with_tuned_mass_damper.value < 0.5 * d->without.value);
    // The worst of both ends of the range, by runs of their own.
    double worst = 0;
    for (const double a : {0.5, 1.0}) {
        Parameters p;
        p.epsilon = 0.02, p.lambda = 1, p.G = 0, p.Omega = 1;
        p.b = d->best.b, p.R_plus = p.R_minus = 0.2;
        Decay decay(p, 0);
        Observer* const observers[] = {&decay};
        State start = default_state(p);
        start.x_dot = a * 0.5 / omega0;
        simulate(p, start, {.tau_end = 60 * p.cycle()}, observers);
        worst = std::max(worst, *decay.times.tenth / omega0);
    }
    CHECK(d->best.objective >= worst * (1 - 1e-9));
    CHECK(d->best.objective < 1.5 * worst);
}

TEST_CASE("a design's response does not exceed its worst case, and no other tried b is better") {
    const DesignPlan plan = machine();
    RunControl control;
    std::vector<DesignPoint> tried;
    const auto design =
        find_design(plan, 2, control, [&](const DesignPoint& p) { tried.push_back(p); });
    REQUIRE(design);
    CHECK(design->complete);
    CHECK(design->without.value == doctest::Approx(0.0990).epsilon(1e-3));  // 5 / (2 zeta omega0^2)
    CHECK(design->best.objective < 0.75 * design->without.value);
    CHECK(tried.size() > 8);
    // The first 8 are the coarse row; the others were tried at all frequencies.
    for (std::size_t k = 8; k < tried.size(); ++k)
        CHECK(tried[k].objective >= design->best.objective);
    for (const DesignResponse& r : design->response) {
        CHECK(r.worst <= design->best.objective * 1.02);
        CHECK(r.best <= r.worst);
    }
    CHECK(design->at_worst.x_max == doctest::Approx(design->best.objective).epsilon(0.02));
}

TEST_CASE(
    "a brute-force search of 10,000 points finds no b that is better by more than 2 %" *
    doctest::test_suite("long")) {
    DesignPlan plan = machine();
    plan.b_count = 20, plan.f_count = 21, plan.default_set = false;
    plan.transient_cycles = 60, plan.cycles = 100;
    RunControl control;
    const auto design = find_design(plan, 2, control, [](const DesignPoint&) {});
    REQUIRE(design);
    PointOptions options{.transient_cycles = 60, .cycles = 100, .max_impacts = 20000};
    options.amplitudes_alone = true;
    double least = infinity;
    for (int i = 0; i < 125; ++i) {
        double worst = 0;
        const double b = 0.02 * std::pow(4, i / 124.0);
        for (int j = 0; j < 81 && worst < least; ++j) {
            SiParameters si = plan.host.si;
            si.f = 7 + 2.0 * j / 80, si.F = plan.host.base_amplitude(si.f);
            Parameters p;
            p.epsilon = si.epsilon(), p.lambda = si.lambda(), p.G = si.G(), p.Omega = si.Omega();
            p.R_plus = p.R_minus = 0.2, p.b = b;
            worst = std::max(worst, measure(p, default_state(p), options, {}).x_max);
        }
        least = std::min(least, worst);
    }
    CHECK(design->best.objective < 1.02 * least);
}

TEST_CASE(
    "a design for a range of amplitudes has the objective of its worst amplitude" *
    doctest::test_suite("long")) {
    DesignPlan plan = machine();
    plan.b_count = 5;
    plan.amplitude_ratio = 0.5;
    RunControl control;
    const auto design = find_design(plan, 2, control, [](const DesignPoint& p) {
        CHECK(p.amplitude <= 1);
        CHECK(p.amplitude >= 0.5 * (1 - 1e-9));
    });
    REQUIRE(design);
    // One map answers for all amplitudes: smaller ones are larger b, scaled.
    DesignPlan one = plan;
    one.amplitude_ratio = 1;
    one.b = {design->best.b, 1.001 * design->best.b};
    one.b_count = 2;
    one.host.base_amplitude = [&](double f) {
        return design->best.amplitude * plan.host.base_amplitude(f);
    };
    const auto alone = find_design(one, 2, control, [](const DesignPoint&) {});
    REQUIRE(alone);
    CHECK(alone->best.objective == doctest::Approx(design->best.objective).epsilon(0.02));
}

TEST_CASE("a stopped design returns the best absorber so far, or none") {
    struct Stopping : RunControl {
        bool stop_or_yield() override { return runs >= after; }
        std::size_t after = 0;
    } control;
    const DesignPlan plan = machine();
    CHECK_FALSE(find_design(plan, 1, control, [](const DesignPoint&) {}));
    control.after = design_runs(plan) + 20;
    double least = infinity;
    const auto design = find_design(
        plan, 1, control, [&](const DesignPoint& p) { least = std::min(least, p.objective); });
    REQUIRE(design);
    CHECK_FALSE(design->complete);
    CHECK(design->best.objective == least);
    CHECK(design->with_tuned_mass_damper.value == doctest::Approx(0.0177).epsilon(3e-3));
}

TEST_CASE("a sample depends on the seed and its index alone, and follows its distributions") {
    const SiParameters si;
    const BuiltAbsorber nominal{si, 0.02, 0.6};
    const Tolerance R{Toleranced::R, true, false, 0.6, 0.3},
        f0{Toleranced::f0, false, true, 0.9, 1.1}, c1{Toleranced::c1, true, true, 1, 0.1};
    const auto R_of = [&](const std::vector<Tolerance>& tolerances, std::size_t k) {
        return drawn(tolerances, nominal, 7, k).R;
    };
    constexpr std::size_t count = 20000;
    double sum_f0 = 0, squares_f0 = 0, sum_c1 = 0, squares_c1 = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const BuiltAbsorber a = drawn({f0, c1, R}, nominal, 7, k);
        if (k < 100) CHECK(a.R == R_of({R}, k));
        CHECK(a.R >= 0);
        CHECK(a.R <= 1);
        CHECK(a.b == nominal.b);
        const double f = a.si.f0() / si.f0() - 1, c = a.si.c1 / si.c1 - 1;
        CHECK(std::abs(f) <= 0.1 * (1 + 1e-9));
        sum_f0 += f, squares_f0 += f * f, sum_c1 += c, squares_c1 += c * c;
    }
    // Within four standard errors.
    CHECK(std::abs(sum_f0) / count < 4 * 0.058 / std::sqrt(count));
    CHECK(squares_f0 / count == doctest::Approx(0.01 / 3).epsilon(0.03));
    CHECK(std::abs(sum_c1) / count < 4 * 0.1 / std::sqrt(count));
    CHECK(squares_c1 / count == doctest::Approx(0.01).epsilon(0.04));
    CHECK(R_of({R}, 3) != R_of({R}, 4));
    CHECK(drawn({R}, nominal, 8, 3).R != R_of({R}, 3));
}

TEST_CASE("quantiles lie between the values") {
    CHECK(quantile({1, 2, 4}, 0.5) == 2);
    CHECK(quantile({1, 2, 4}, 0.75) == 3);
    CHECK(quantile({1, 2, infinity}, 0.5) == 2);
    CHECK(quantile({1, 2, infinity}, 0.75) == infinity);
    CHECK(quantile({3}, 0.95) == 3);
}

TEST_CASE(
    "a sample's objective is the worst case of runs with its values, in every part of them" *
    doctest::test_suite("long")) {
    DesignPlan plan = machine();
    plan.b = {0.05, 0.05};
    plan.b_count = 1;
    plan.default_set = false;
    plan.tolerances = {
        {Toleranced::f0, true, true, 1, 0.01},
        {Toleranced::b, false, false, 0.03, 0.06},
        {Toleranced::R, true, false, 0.2, 0.05}};
    plan.samples = {0, 1, 2, 3, 4};
    const auto samples_of = [](const DesignPlan& some) {
        RunControl control;
        auto design = find_design(some, 2, control, [](const DesignPoint&) {});
        std::ranges::sort(design->samples, {}, &ToleranceSample::index);
        return design->samples;
    };
    const std::vector<ToleranceSample> all = samples_of(plan);
    REQUIRE(all.size() == 5);
    PointOptions options{.transient_cycles = 30, .cycles = 40, .max_impacts = 8000};
    for (const ToleranceSample& s : all) {
        const auto x_max_at = [&](double f) {
            SiParameters si = s.built.si;
            si.f = f, si.F = plan.host.base_amplitude(f);
            Parameters p;
            p.epsilon = si.epsilon(), p.lambda = si.lambda(), p.G = si.G(), p.Omega = si.Omega();
            p.R_plus = p.R_minus = s.built.R, p.b = s.built.b;
            return measure(p, default_state(p), options, {}).x_max;
        };
        CHECK(s.point.objective == x_max_at(s.point.f));
        // There are more frequencies around that of the best.
        for (int j = 0; j < plan.f_count; ++j)
            CHECK(s.point.objective >= x_max_at(7 + 2.0 * j / (plan.f_count - 1)));
        REQUIRE(s.worst);
        CHECK(s.worst->x_max == s.point.objective);
    }
    DesignPlan as_planned = plan;
    as_planned.tolerances = {{Toleranced::R, true, false, 0.2, 0}};
    as_planned.samples = {0};
    RunControl control;
    const auto exact = find_design(as_planned, 2, control, [](const DesignPoint&) {});
    CHECK(exact->samples[0].point.objective == exact->best.objective);
    plan.samples = {1, 4};
    const std::vector<ToleranceSample> part = samples_of(plan);
    REQUIRE(part.size() == 2);
    CHECK(part[0].point.objective == all[1].point.objective);
    CHECK(part[1].point.objective == all[4].point.objective);
}
