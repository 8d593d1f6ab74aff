#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/identify.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// How a record is taken: what the sensors add to the true motion.
struct Sensors {
    double rate = 2048;            ///< Hz
    double seconds = 20;
    double pulse = 0.8e-3;         ///< s: each impact is a half sine of the acceleration
    double noise_x = 2e-6, noise_a = 0.05;  ///< m, m/s^2
};

struct Measurement {
    Parameters parameters;
    double omega0;
    MeasuredRecord record;
    std::vector<Impact> impacts;
};

/// Box-Muller on an engine whose sequence is the same everywhere.
double normal(std::mt19937_64& engine) {
    const double u = uniform(engine, 1e-300, 1), v = uniform(engine, 0, 1);
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

/// Table 4's oscillator with its absorber, measured after 20 s of transient.
Measurement measured(double b, double R_plus, double R_minus, const Sensors& sensors) {
    const SiParameters si{4.168, 3.02, 11.47e3, 0.032, 0, 0};
    Measurement m{{}, si.omega0(), {}, {}};
    Parameters& p = m.parameters;
    p.epsilon = si.epsilon(), p.lambda = si.lambda(), p.G = 0.01, p.b = b, p.R_plus = R_plus, p.R_minus = R_minus;
    const double begin = 20 * m.omega0, step = m.omega0 / sensors.rate, end = begin + sensors.seconds * m.omega0, pulse = sensors.pulse * m.omega0;
    SeriesRecord series(step);
    const Record run = record(p, default_state(p), end, 1000000, {&series});
    std::mt19937_64 engine(5);
    std::size_t next = 0;
    for (std::size_t k = 0; k < series.tau.size(); ++k) {
        const double tau = series.tau[k];
        if (tau < begin) continue;
        double a = -series.x[k] - 2 * p.zeta() * series.x_dot[k] + p.epsilon * p.A() * std::sin(p.Omega * tau + p.phi());
        while (next < run.impacts.size() && run.impacts[next].tau < tau - pulse) ++next;
        for (std::size_t i = next; i < run.impacts.size() && run.impacts[i].tau < tau + pulse; ++i)
            if (std::abs(tau - run.impacts[i].tau) < 0.5 * pulse)
                a += (run.impacts[i].x_dot_after - run.impacts[i].x_dot_before) * 0.5 * std::numbers::pi / pulse * std::cos(std::numbers::pi * (tau - run.impacts[i].tau) / pulse);
        m.record.tau.push_back(tau);
        m.record.x.push_back(series.x[k] + sensors.noise_x * normal(engine));
        m.record.x_ddot.push_back(a + sensors.noise_a / (m.omega0 * m.omega0) * normal(engine));
    }
    for (const Impact& i : run.impacts) if (i.tau > begin && i.tau < end) m.impacts.push_back(i);
    return m;
}

struct Result {
    RefinedImpacts refined;
    Identification found;
    double lambda1;
    IdentifiedExponents judged;
};

Result identified(const Measurement& m) {
    RefinedImpacts refined = refine_impacts(m.parameters, m.record, find_spikes(m.record, 6).spikes, 6);
    Identification found = identify_impacts(m.parameters, refined.motion, refined.side, refined.pulse);
    Parameters p = m.parameters;
    p.R_plus = found.plus.R, p.R_minus = found.minus.R;
    TransferProduct product(p.epsilon, {true, false, false, 20000});
    append_identified(p, found, product);
    return {std::move(refined), std::move(found), product.qr()[0], judge_exponents(p, product.qr_history(), product.start_tau())};
}

/// lambda1 of the true impacts: what a perfect identification would give.
double true_lambda1(const Measurement& m) {
    Lyapunov lyapunov(m.parameters, m.impacts.front().tau, m.impacts.back().tau, {true, false, false, 256});
    record(m.parameters, default_state(m.parameters), m.impacts.back().tau, 1000000, {&lyapunov});
    return lyapunov.product().qr()[0];
}

void check(const Measurement& m, const Result& r) {
    REQUIRE(r.refined.tau.size() >= 0.99 * static_cast<double>(m.impacts.size()));
    double amplitude = 0;
    for (const Impact& i : m.impacts) amplitude = std::max(amplitude, std::abs(i.x_dot_before));
    std::vector<double> off, speeds;
    for (std::size_t k = 0; k < r.refined.tau.size(); ++k) {
        const Impact* nearest = &m.impacts[0];
        for (const Impact& i : m.impacts) if (std::abs(i.tau - r.refined.tau[k]) < std::abs(nearest->tau - r.refined.tau[k])) nearest = &i;
        off.push_back(std::abs(nearest->tau - r.refined.tau[k]) / m.omega0);
        CHECK(off.back() < 2.5e-4);  // none is false
        CHECK(r.refined.side[k] == nearest->side);
        speeds.push_back(std::max(std::abs(r.refined.motion.x_dot_before[k] - nearest->x_dot_before), std::abs(r.refined.motion.x_dot[k + 1] - nearest->x_dot_after)) / amplitude);
    }
    std::sort(off.begin(), off.end());
    std::sort(speeds.begin(), speeds.end());
    CHECK(off[off.size() * 9 / 10] < 1e-4);
    CHECK(speeds[speeds.size() * 95 / 100] < 0.02);
    CHECK(std::abs(r.found.plus.R - m.parameters.R_plus) < 0.02);
    CHECK(std::abs(r.found.minus.R - m.parameters.R_minus) < 0.02);
    CHECK(r.found.b_fitted == doctest::Approx(m.parameters.b).epsilon(0.01));
    CHECK(r.refined.motion.noise_x > 0);
}

}  // namespace

TEST_CASE("from a regular response every impact, the restitution of each wall and lambda1 are found") {
    for (const auto& R : {std::pair(0.85, 0.85), std::pair(0.6, 0.9)}) {
        CAPTURE(R.first);
        Sensors sensors;
        sensors.seconds = 12;
        const Measurement m = measured(0.009, R.first, R.second, sensors);
        const Result r = identified(m);
        check(m, r);
        CHECK(std::abs(r.lambda1 - true_lambda1(m)) < 0.002);
        CHECK(r.judged.verdict == Verdict::regular);
    }
}

TEST_CASE("from a chaotic response lambda1 is found within 15 %, whatever the walls, the noise, the pulse and the sampling") {
    struct Case {
        double R_plus, R_minus;
        Sensors sensors;
    };
    for (const Case& c : {Case{0.85, 0.85, {}}, Case{0.7, 0.9, {}}, Case{0.85, 0.85, {2048, 20, 2e-3, 2e-6, 0.05}}, Case{0.85, 0.85, {1000, 20, 2e-3, 2e-6, 0.05}},
                          Case{0.85, 0.85, {5000, 20, 0.4e-3, 2e-6, 0.05}}, Case{0.85, 0.85, {4096, 20, 0.5e-3, 5e-6, 0.1}}}) {
        CAPTURE(c.sensors.rate);
        CAPTURE(c.sensors.pulse);
        const Measurement m = measured(0.015, c.R_plus, c.R_minus, c.sensors);
        const Result r = identified(m);
        check(m, r);
        CHECK(r.lambda1 == doctest::Approx(true_lambda1(m)).epsilon(0.15));
        CHECK(r.judged.verdict == Verdict::chaotic);
        CHECK(r.refined.pulse / m.omega0 == doctest::Approx(c.sensors.pulse).epsilon(0.25));
    }
}

TEST_CASE("an impact whose pulse falls between two samples is found by the kink of the displacement") {
    const Measurement m = measured(0.015, 0.85, 0.85, {1024, 20, 0.8e-3, 2e-6, 0.05});
    const std::vector<Spike> spikes = find_spikes(m.record, 6).spikes;
    CHECK(static_cast<double>(spikes.size()) < 0.95 * static_cast<double>(m.impacts.size()));
    const Result r = identified(m);
    long found = 0;
    for (const Impact& i : m.impacts)
        found += std::any_of(r.refined.tau.begin(), r.refined.tau.end(), [&](double tau) { return std::abs(tau - i.tau) < 5e-4 * m.omega0; });
    CHECK(static_cast<double>(found) > 0.93 * static_cast<double>(m.impacts.size()));
    CHECK(r.lambda1 == doctest::Approx(true_lambda1(m)).epsilon(0.15));
    CHECK(r.judged.verdict == Verdict::chaotic);
}

TEST_CASE("noise alone has no spikes") {
    Sensors sensors;
    sensors.seconds = 12;
    const Measurement m = measured(0.5, 0.85, 0.85, sensors);  // the walls are out of reach
    CHECK(m.impacts.empty());
    CHECK(find_spikes(m.record, 6).spikes.empty());
}

TEST_CASE("a picked spike without a jump of the velocity is dropped, and one picked twice is left out") {
    Sensors sensors;
    sensors.seconds = 12;
    const Measurement m = measured(0.009, 0.85, 0.85, sensors);
    std::vector<Spike> spikes = find_spikes(m.record, 6).spikes;
    const std::size_t all = spikes.size();
    Spike none = spikes[40];
    none.tau += 0.6 * (spikes[41].tau - spikes[40].tau);
    spikes.push_back(none);
    const RefinedImpacts refined = refine_impacts(m.parameters, m.record, spikes, 0);
    CHECK(refined.dropped.size() == 1);
    CHECK(refined.tau.size() == all);
}

TEST_CASE("a missing impact makes its neighbours inconsistent, and they are left out with a reason") {
    Sensors sensors;
    sensors.seconds = 12;
    const Measurement m = measured(0.009, 0.85, 0.85, sensors);
    std::vector<Spike> spikes = find_spikes(m.record, 6).spikes;
    spikes.erase(spikes.begin() + 50);
    const RefinedImpacts refined = refine_impacts(m.parameters, m.record, spikes, 0);
    const Identification found = identify_impacts(m.parameters, refined.motion, refined.side, refined.pulse);
    CHECK_FALSE(found.impacts[49].fault.empty());
    CHECK_FALSE(found.impacts[50].fault.empty());
    CHECK(found.impacts[40].fault.empty());
    CHECK(std::abs(found.plus.R - 0.85) < 0.02);
}

TEST_CASE("the b that fits the momentum is found though a wrong one is given") {
    Sensors sensors;
    sensors.seconds = 12;
    Measurement m = measured(0.009, 0.85, 0.85, sensors);
    m.parameters.b = 0.011;
    CHECK(identified(m).found.b_fitted == doctest::Approx(0.009).epsilon(0.02));
}
