#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "../support.hpp"
#include "core/measures/energy.hpp"
#include "core/measures/rhythm.hpp"
#include "core/motion/load.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("the energy balance closes to rounding, whatever the system and the window") {
    std::mt19937_64 engine(31);
    double worst = 0;
    for (int i = 0; i < 300; ++i) {
        System s = random_system(engine);
        if (i % 3 == 0) s.parameters.table_plus = random_table(engine, 0.02);
        const double from = uniform(engine, 0, 40), to = from + uniform(engine, 1, 100);
        Energy energy(s.parameters, {from, to});
        record(s.parameters, s.start, 150, 5000, {&energy});
        const double turnover = std::abs(energy.balance({}).input) + energy.balance({}).damper +
                                energy.balance({}).impacts + energy.balance({}).at_start +
                                energy.balance({}).at_end;
        if (turnover > 0) worst = std::max(worst, std::abs(energy.balance({}).residual) / turnover);
    }
    CHECK(worst < 1e-12);
}

TEST_CASE("the residual of Table 1 is below 1e-9 of the input, also with sticking") {
    for (double b : {0.015, 0.022, 0.004}) {
        const Parameters p = table1(b, Damping::closed_form);
        Energy energy(p, {0, 1709});
        record(p, default_state(p), 1709, 1000000, {&energy});
        CHECK(energy.balance({}).input > 0);
        CHECK(std::abs(energy.balance({}).residual) < 1e-12 * energy.balance({}).input);
    }
}

TEST_CASE("an impact at the border of two windows belongs to the first alone") {
    Parameters p;
    p.b = 0.0088, p.G = 0.0284, p.R_plus = p.R_minus = 0.367, p.Omega = 0.98, p.epsilon = 0.03356,
    p.lambda = 2.064;
    Energy whole(p, {0, 100});
    const Record run = record(p, default_state(p), 100, 1000000, {&whole});
    REQUIRE(run.impacts.size() > 20);
    for (const Impact& i : run.impacts) {
        Energy before(p, {0, i.tau}), after(p, {i.tau, 100});
        record(p, default_state(p), 100, 1000000, {&before, &after});
        CHECK(
            before.balance({}).impacts + after.balance({}).impacts ==
            doctest::Approx(whole.balance({}).impacts).epsilon(1e-12));
        CHECK(
            before.balance({}).input + after.balance({}).input ==
            doctest::Approx(whole.balance({}).input).epsilon(1e-10));
        CHECK(std::abs(after.balance({}).residual) < 1e-12 * whole.balance({}).input);
    }
}

TEST_CASE("rms and peak of x are those of dense samples") {
    const Parameters p = table1(0.022, Damping::equation_of_motion);
    Energy energy(p, {100, 400});
    SeriesRecord series(1e-3);
    record(p, default_state(p), 400, 1000000, {&energy, &series});
    double squares = 0, peak = 0;
    long n = 0;
    for (std::size_t i = 0; i < series.series.tau.size(); ++i) {
        if (series.series.tau[i] < 100) continue;
        squares += series.series.x[i] * series.series.x[i];
        peak = std::max(peak, std::abs(series.series.x[i]));
        ++n;
    }
    CHECK(energy.duration() == doctest::Approx(300));
    CHECK(
        energy.balance({}).rms ==
        doctest::Approx(std::sqrt(squares / static_cast<double>(n))).epsilon(1e-5));
    CHECK(energy.balance({}).peak >= peak);
    CHECK(energy.balance({}).peak == doctest::Approx(peak).epsilon(1e-6));
}

TEST_CASE("from rest the rms is right however short the window and slow the forcing") {
    for (const double Omega : {0.01, 0.1, 1.0})
        for (const double tau_end : {0.003, 0.01, 0.1, 6.3, 30.0, 100.0}) {
            Parameters p = table1(0.022, Damping::equation_of_motion);
            p.Omega = Omega;
            p.b = 10;  // no impact
            const State rest{0, 0, 0, 0};
            Energy energy(p, {0, tau_end});
            record(p, rest, tau_end, 1000, {&energy});
            CAPTURE(Omega);
            CAPTURE(tau_end);
            CHECK(
                energy.balance({}).rms ==
                doctest::Approx(unattached(p, rest, {0, tau_end}).rms).epsilon(1e-11).scale(0));
            CHECK(
                std::abs(energy.balance({}).residual) <
                1e-11 * energy.balance({}).damper + 1e-11 * energy.balance({}).at_end);
        }
}

TEST_CASE("a window that begins at the last impact has the energy after it") {
    const Parameters p = table1(0.015, Damping::closed_form);
    const Impact last = record(p, default_state(p), 1000, 20).impacts.back();
    Energy energy(p, {last.tau, 1000});
    record(p, default_state(p), 1000, 20, {&energy});
    CHECK(energy.duration() == 0);
    CHECK(energy.balance({}).at_end == energy.balance({}).at_start);
    CHECK(
        energy.balance({}).at_end ==
        energy_of(p, {last.x_dot_after, last.x, last.y_dot_after, last.x - last.side * p.b}));
}

TEST_CASE("without absorber the oscillator reaches its steady amplitude") {
    for (double Omega : {0.4, 1.0, 2.3}) {
        Parameters p = table1(0.022, Damping::closed_form);
        p.Omega = Omega;
        const Unattached u = unattached(p, {}, {5000, 6000});
        REQUIRE(u.amplitude);
        CHECK(u.peak == doctest::Approx(*u.amplitude).epsilon(1e-9));
        CHECK(u.rms == doctest::Approx(*u.amplitude / std::sqrt(2)).epsilon(1e-2));
    }
    Parameters undamped = table1(0.022, Damping::closed_form);
    undamped.lambda = 0;
    CHECK_FALSE(unattached(undamped, {}, {0, 10}).amplitude);
}

TEST_CASE("without absorber the motion under a load can be stopped") {
    Parameters p = table1(0.022, Damping::closed_form);
    p.G = 0;
    p.load = std::make_shared<const Load>(std::vector<LoadHarmonic>{{1.7e-4, 1, 0}});
    CHECK(unattached(p, {}, {0, 1000}).rms > 0);
    const Unattached stopped = unattached(p, {}, {0, 1e9}, [] { return true; });
    CHECK(std::isnan(stopped.rms));
    CHECK(std::isnan(stopped.peak));
}

TEST_CASE("an impact with which a run begins is part of its energy") {
    Parameters p;
    p.epsilon = 0.05, p.lambda = 0.4, p.b = 0.01, p.R_plus = p.R_minus = 0.5;
    const State start{0.02, 0.01, -0.02, 0};
    for (const double gravity : {0.0, 1e-4}) {
        p.gravity = gravity;
        Energy energy(p, {0, 6});
        ImpactRecord impacts;
        record(p, start, 6, 1000, {&energy, &impacts});
        REQUIRE(impacts.entries[0].tau == 0);
        double lost = 0;
        for (const Impact& i : impacts.entries)
            lost += (1 - i.R * i.R) * i.relative_speed_before * i.relative_speed_before *
                    p.epsilon / (2 * (1 + p.epsilon));
        const EnergyBalance balance = energy.balance({0, 6});
        CHECK(balance.impacts == doctest::Approx(lost).epsilon(1e-12));
        CHECK(balance.at_start == doctest::Approx(energy_of(p, start)).epsilon(1e-12));
        CHECK(std::abs(balance.residual) < 1e-12 * balance.at_start);
    }
}

TEST_CASE("under gravity a decay is that of the energy above rest") {
    Parameters p;
    p.epsilon = 0.05, p.lambda = 0.4, p.b = 0.02, p.G = 0;
    const State start{0, 0.002, 0, 0.0195};
    for (const double gravity : {0.01, -0.01}) {
        p.gravity = gravity;
        // At rest the ball lies on the lower wall.
        const double weight = p.epsilon * gravity, side = gravity > 0 ? 1 : -1;
        const double at_rest = energy_of(p, {0, weight, 0, weight + side * p.b});
        Decay decay(p, 0);
        record(p, start, 300, 100000, {&decay});
        REQUIRE(decay.times.tenth);
        for (const double change : {-1e-9, 1e-9}) {
            const State s = simulate(p, start, {*decay.times.tenth + change, 100000, {}}, {}).state;
            const double left = (energy_of(p, s) - at_rest) / (energy_of(p, start) - at_rest);
            CHECK((left > 0.1) == (change < 0));
        }
    }
}

TEST_CASE("a system at rest has no time at which half of its energy is left") {
    Parameters p = table1(0.022, Damping::equation_of_motion);
    p.G = 0;
    Decay decay(p, 0);
    record(p, {0, 0, 0, 0}, 100, 1000, {&decay});
    CHECK_FALSE(decay.times.half);
    CHECK_FALSE(decay.times.tenth);
}

TEST_CASE("a free decay passes half and a tenth of its energy at the reported times") {
    Parameters p = table1(0.022, Damping::equation_of_motion);
    p.G = 0;
    const State start{0, 0.02, 0, 0.005};
    Decay decay(p, 0), cut(p, 0);
    record(p, start, 1000, 1000000, {&decay});
    REQUIRE(decay.times.half);
    REQUIRE(decay.times.tenth);
    // The run ends between both times.
    record(p, start, 0.5 * (*decay.times.half + *decay.times.tenth), 1000000, {&cut});
    CHECK(cut.times.half == decay.times.half);
    CHECK_FALSE(cut.times.tenth);
    for (const double fraction : {0.5, 0.1}) {
        // Just before, the energy is above the level; then at or below it (an impact can cross it).
        const double tau = fraction == 0.5 ? *decay.times.half : *decay.times.tenth,
                     level = fraction * energy_of(p, start);
        CHECK(energy_of(p, simulate(p, start, {tau - 1e-9, 1000000, {}}, {}).state) > level);
        CHECK(energy_of(p, simulate(p, start, {tau + 1e-9, 1000000, {}}, {}).state) <= level);
    }
    // Alone, the oscillator needs longer.
    Parameters alone = p;
    alone.b = 10;
    Decay slow(alone, 0);
    record(alone, start, 1000, 1000000, {&slow});
    CHECK(*slow.times.half > *decay.times.half);
    CHECK(*slow.times.half == doctest::Approx(std::log(2) / (2 * p.zeta())).epsilon(0.01));
}

TEST_CASE("the standard errors of x_rms, the fraction of impacts and z are those of many windows") {
    const Parameters p = table1(0.025, Damping::closed_form);
    const double length = 1000 * p.cycle();
    constexpr int windows = 200;
    struct Sum {
        double value = 0, square = 0, variance = 0;
        std::vector<std::array<double, 2>> all{};  // values and errors
        void add(double v, double error) {
            value += v, square += v * v, variance += error * error;
            all.push_back({v, error});
        }
        /// Stated error over the standard deviation.
        double ratio() const { return std::sqrt(variance / (square - value * value / windows)); }
    } rms, share, z;
    State state = default_state(p);
    for (int k = 0; k < windows; ++k) {
        Energy energy(p, {0, length});
        Rhythm rhythm(p, {0, length}, 0);
        Observer* const observers[] = {&energy, &rhythm};
        state = simulate(p, state, {length, 100000, {}}, observers).state;
        const ContactCounts counts = rhythm.finish({0, length});
        const EnergyBalance e = energy.balance({0, length});
        rms.add(e.rms, e.rms_error);
        share.add(*e.share_impacts, e.share_impacts_error);
        z.add(counts.z_overall, counts.z_error);
    }
    for (const Sum& s : {rms, share, z}) {
        CHECK(s.ratio() > 0.75);
        CHECK(s.ratio() < 1.25);
        // Nominally 10 of 200 lie outside their 95 % intervals.
        const auto outside = std::ranges::count_if(s.all, [&](const auto& window) {
            return std::abs(window[0] - s.value / windows) > 2.776 * window[1];
        });
        CHECK(outside < 20);
    }
}

TEST_CASE("windows of fewer than 32 cycles have no standard errors") {
    const Parameters p = table1(0.025, Damping::closed_form);
    Energy energy(p, {0, 31.5 * p.cycle()});
    Rhythm rhythm(p, {0, 31.5 * p.cycle()}, 0);
    record(p, default_state(p), 31.5 * p.cycle(), 100000, {&energy, &rhythm});
    const ContactCounts counts = rhythm.finish({0, 31.5 * p.cycle()});
    CHECK(std::isnan(energy.balance({}).rms_error));
    CHECK(std::isnan(counts.z_error));
}

TEST_CASE("the smallest peak in a cycle includes the last whole cycle, however its end rounds") {
    Parameters p = table1(0.03, Damping::equation_of_motion);
    p.G = 0.001;
    const State start{0, 0.02, 0, 0.02};
    for (int cycles = 2; cycles < 40; ++cycles) {
        CAPTURE(cycles);
        CyclePeaks peaks({0, cycles * p.cycle()}, p.cycle()),
            longer({0, (cycles + 0.01) * p.cycle()}, p.cycle());
        record(p, start, cycles * p.cycle(), 100000, {&peaks});
        record(p, start, (cycles + 0.01) * p.cycle(), 100000, {&longer});
        CHECK(peaks.least() == doctest::Approx(longer.least()).epsilon(1e-12));
    }
}

TEST_CASE("the smallest peak in a cycle is that of dense samples") {
    for (const double b : {0.003, 0.022, 0.04}) {
        const Parameters p = table1(b, Damping::closed_form);
        const double from = 50.3, to = from + 60.5 * p.cycle();
        CyclePeaks cycle_peaks({from, to}, p.cycle());
        SeriesRecord series(p.cycle() / 2000);
        record(p, default_state(p), to, 100000, {&cycle_peaks, &series});
        std::vector<double> peaks(60);
        for (std::size_t i = 0; i < series.series.tau.size(); ++i) {
            const double cycle = std::floor((series.series.tau[i] - from) / p.cycle());
            if (cycle < 0 || cycle >= 60) continue;
            double& peak = peaks[static_cast<std::size_t>(cycle)];
            peak = std::max(peak, std::abs(series.series.x[i]));
        }
        CHECK(
            cycle_peaks.least() == doctest::Approx(*std::ranges::min_element(peaks)).epsilon(1e-5));
    }
}
