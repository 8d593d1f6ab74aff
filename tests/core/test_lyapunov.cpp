#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "support.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// lambda1 over consecutive windows of one run.
struct Windows {
    double mean, deviation, standard_error;
};
Windows windows(double b, int count, double length, double start) {
    const Parameters p = table1(b, Damping::closed_form);
    Lyapunov lyapunov(p, start, 1e9, {true, false, false, 1000000});
    record(p, default_state(p), start + (count + 1) * length, 10000000, {&lyapunov});
    const ExponentHistory& h = lyapunov.product().qr_history();
    const double from = lyapunov.product().start_tau();
    double sum = 0, squares = 0, log_before = 0, tau_before = from;
    std::size_t i = 0;
    int n = 0;
    for (int k = 1; k <= count; ++k) {
        while (i + 1 < h.tau.size() && h.tau[i + 1] <= from + k * length) ++i;
        if (h.tau[i] <= tau_before) continue;  // a sparse response may fly through a whole window: it joins the next one
        ++n;
        const double log = h.lambda[i][0] * (h.tau[i] - from), mean = (log - log_before) / (h.tau[i] - tau_before);
        log_before = log;
        tau_before = h.tau[i];
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / n, deviation = std::sqrt(squares / n - mean * mean);
    return {mean, deviation, deviation / std::sqrt(n)};
}

}  // namespace

TEST_CASE("lambda1 over 100 windows of 1700 is the known one of each response") {
    const std::pair<double, double> chaotic[] = {{0.034, 0.149}, {0.025, 0.120}, {0.017, 0.049}, {0.003, 0.189}};
    for (const auto& known : chaotic) {
        const double b = known.first, lambda1 = known.second;
        CAPTURE(b);
        const Windows w = windows(b, 100, 1700, 1700);
        CHECK(std::abs(w.mean - lambda1) < 4 * w.standard_error);
        CHECK(w.standard_error < 0.003);
    }
    const std::pair<double, double> periodic[] = {{0.015, -0.0178}, {0.008, -0.0132}};
    for (const auto& known : periodic) {
        const double b = known.first, lambda1 = known.second;
        CAPTURE(b);
        CHECK(std::abs(windows(b, 100, 1700, 1700).mean - lambda1) < 1e-4);
    }
}

TEST_CASE("the sum rule holds to 1e-10 in every window without a stick") {
    int free_of_sticks = 0;
    for (double b : {0.040, 0.034, 0.028, 0.025, 0.022, 0.018, 0.0165, 0.015, 0.008, 0.0046, 0.003})
        for (Damping damping : {Damping::closed_form, Damping::equation_of_motion}) {
            const Parameters p = table1(b, damping);
            std::vector<std::unique_ptr<Lyapunov>> all;
            std::vector<Observer*> observers;
            for (int k = 0; k < 30; ++k) {
                all.push_back(std::make_unique<Lyapunov>(p, 1700.0 * k, 1700.0 * (k + 1), ExponentOptions{true, false, false, 256}));
                observers.push_back(all.back().get());
            }
            record(p, default_state(p), 1700 * 30, 1000000, observers);
            for (const auto& l : all) {
                if (l->product().rank() < 4) continue;
                ++free_of_sticks;
                CHECK(l->product().sum_rule_residual(p.zeta()) < 1e-10);
            }
        }
    CHECK(free_of_sticks > 300);
}

TEST_CASE("the sum rule holds through nearly grazing impacts, where entries of M reach 1e8") {
    std::mt19937_64 engine(9);
    const Parameters p = table1(0.022, Damping::closed_form);
    for (double speed : {1e-4, 1e-6, 1e-8, 1e-10}) {
        TransferProduct product({true, true, false, 256});
        product.start(0);
        double tau = 0;
        for (int n = 0; n < 300; ++n) {
            const double s = uniform(engine, 0.5, 5);
            tau += s;
            Contact c{0, n % 2 ? 1 : -1, {uniform(engine, -.005, .005), uniform(engine, -.005, .005), std::sin(n), std::cos(n)}, 0};
            c.relative_speed = c.side * (n % 10 == 0 ? speed : uniform(engine, 0.002, 0.02));
            const Impact i = impact_at(p, c, Flow::free(p).acceleration(c.lo), tau);
            product.append(free_transfer(Flow::free(p).transfer(s), s), 4, saltation(p, i), i.R, tau);
        }
        CAPTURE(speed);
        CHECK(product.sum_rule_residual(p.zeta()) < 1e-10);
    }
}

TEST_CASE("J and M carry a deviation as the trajectory itself does") {
    // Central differences of whole runs over several impacts against the product of the matrices.
    std::mt19937_64 engine(21);
    int compared = 0;
    for (int n = 0; n < 400 && compared < 100; ++n) {
        System s = random_system(engine);
        s.parameters.R_plus = uniform(engine, 0.3, 1);
        s.parameters.R_minus = uniform(engine, 0.3, 1);
        const Parameters& p = s.parameters;
        const Record run = record(p, s.start, 40, 4);
        if (run.impacts.size() < 4 || !run.sticks.empty()) continue;
        bool steep = false;
        for (const Impact& i : run.impacts) steep = steep || std::abs(i.x_ddot_before / i.relative_speed_before) > 20;
        if (steep) continue;
        const double tau = run.impacts.back().tau + 1e-3;

        Matrix4 product = Matrix4::Identity();
        double before = 0;
        for (const Impact& i : run.impacts) {
            product = saltation(p, i).matrix() * free_transfer(Flow::free(p).transfer(i.tau - before), i.tau - before) * product;
            before = i.tau;
        }
        product = free_transfer(Flow::free(p).transfer(tau - before), tau - before) * product;

        Matrix4 differences;
        const double d = 1e-7;
        bool same_impacts = true;
        for (int k = 0; k < 4; ++k) {
            Eigen::Vector4d end[2];
            for (int sign : {0, 1}) {
                State moved = s.start;
                double* const part[4] = {&moved.x_dot, &moved.x, &moved.y_dot, &moved.y};
                *part[k] += sign ? d : -d;
                if (std::abs(moved.x - moved.y) > p.b) same_impacts = false;
                if (!same_impacts) break;
                const Record other = record(p, moved, tau);
                same_impacts = same_impacts && other.impacts.size() == 4;
                end[sign] << other.outcome.state.x_dot, other.outcome.state.x, other.outcome.state.y_dot, other.outcome.state.y;
            }
            if (!same_impacts) break;
            differences.col(k) = (end[1] - end[0]) / (2 * d);
        }
        if (!same_impacts) continue;
        ++compared;
        CHECK((differences - product).norm() < 1e-4 * product.norm());
    }
    CHECK(compared >= 60);
}

TEST_CASE("a deviation through a stick is that of the trajectory: only the centre of mass is left") {
    const Parameters p = table1(0.015, Damping::closed_form);
    const State start{0.0003, -0.004, 0, -0.004 - 0.015 + 2e-5};  // just before a chatter that presses at x - y = +b
    struct Product : Observer {
        explicit Product(const Parameters& parameters) : p(parameters) {}
        void on_stretch(const Stretch& s) override {
            const Transfer t = s.flow.transfer(s.duration);
            m = (s.stuck_side ? stuck_transfer(t, p.epsilon) : free_transfer(t, s.duration)) * m;
        }
        void on_impact(const Impact& i) override { m = saltation(p, i).matrix() * m; }
        const Parameters& p;
        Matrix4 m = Matrix4::Identity();
    } product(p);
    const double tau = 4;
    const Record run = record(p, start, tau, 100000, {&product});
    REQUIRE(run.sticks.size() == 1);
    REQUIRE(run.sticks[0].tau_end < tau);
    Matrix4 differences;
    const double d = 1e-7;
    for (int k = 0; k < 4; ++k) {
        Eigen::Vector4d end[2];
        for (int sign : {0, 1}) {
            State moved = start;
            double* const part[4] = {&moved.x_dot, &moved.x, &moved.y_dot, &moved.y};
            *part[k] += sign ? d : -d;
            const State s = record(p, moved, tau).outcome.state;
            end[sign] << s.x_dot, s.x, s.y_dot, s.y;
        }
        differences.col(k) = (end[1] - end[0]) / (2 * d);
    }
    CHECK((differences - product.m).norm() < 1e-6 * product.m.norm());
}

TEST_CASE("on a periodic orbit the eigenvalues estimator and QR agree with the orbit's multipliers") {
    // closed form, b = 15 mm: two symmetric impacts a cycle once the transient is over.
    const Parameters p = table1(0.015, Damping::closed_form);
    const Record run = record(p, default_state(p), 6000);
    const std::size_t last = run.impacts.size() - 1;
    Matrix4 cycle = Matrix4::Identity();
    for (std::size_t k = last - 1; k <= last; ++k) {
        const double s = run.impacts[k].tau - run.impacts[k - 1].tau;
        cycle = saltation(p, run.impacts[k]).matrix() * free_transfer(Flow::free(p).transfer(s), s) * cycle;
    }
    const double period = run.impacts[last].tau - run.impacts[last - 2].tau;
    CHECK(period == doctest::Approx(2 * 3.14159265358979323846).epsilon(1e-9));
    Eigen::Vector4d multipliers = Eigen::EigenSolver<Matrix4>(cycle, false).eigenvalues().cwiseAbs().array().log() / period;
    std::sort(multipliers.begin(), multipliers.end(), std::greater<>());

    Lyapunov lyapunov(p, run.impacts[last - 401].tau - 1e-6, 6001, {});
    record(p, default_state(p), 6000, 1000000, {&lyapunov});
    const Exponents eigenvalues = lyapunov.product().eigenvalues(), qr = lyapunov.product().qr();
    for (int k = 0; k < 4; ++k) {
        CHECK(std::abs(eigenvalues[k] - multipliers(k)) < 1e-8);  // 200 whole cycles: the same number exactly
        CHECK(std::abs(qr[k] - multipliers(k)) < 0.01);           // QR differs by what the frame takes to turn in
    }
}

TEST_CASE("raw_product shows the paper's four positive exponents, three of them its rounding floor") {
    const Parameters p = table1(0.022, Damping::closed_form);
    Lyapunov lyapunov(p, 0, 1709, {});
    record(p, default_state(p), 1709, 100000, {&lyapunov});
    const TransferProduct& product = lyapunov.product();
    const Exponents raw = product.raw_product(), qr = product.qr();
    const double floor = rounding_floor(raw[0], product.end_tau() - product.start_tau());
    CHECK(raw[2] > 0);
    CHECK(std::abs(raw[2] - floor) < 0.01);
    CHECK(qr[0] > 0.06);
    CHECK(qr[0] < 0.15);
    CHECK(qr[1] < 0);
    CHECK(std::abs(raw[0] - product.eigenvalues()[0]) < 1e-9);
}

TEST_CASE("raw_product beyond the range of double has no value, eigenvalues and qr have") {
    const Parameters p = table1(0.034, Damping::closed_form);
    Lyapunov lyapunov(p, 0, 20000, {});
    record(p, default_state(p), 20000, 100000, {&lyapunov});
    CHECK(status_of(lyapunov.product().raw_product()[0]) == Status::not_converged);
    CHECK(std::abs(lyapunov.product().eigenvalues()[0] - lyapunov.product().qr()[0]) < 1e-3);
}

TEST_CASE("after a stick two exponents are minus infinity, after R = 0 one is") {
    Parameters p = table1(0.015, Damping::closed_form);
    Lyapunov stick(p, 0, 1709, {});
    record(p, default_state(p), 1709, 100000, {&stick});
    const Exponents qr = stick.product().qr(), eigenvalues = stick.product().eigenvalues();
    for (const Exponents& e : {qr, eigenvalues}) {
        CHECK(status_of(e[0]) == Status::ok);
        CHECK(status_of(e[1]) == Status::ok);
        CHECK(status_of(e[2]) == Status::minus_infinity);
        CHECK(status_of(e[3]) == Status::minus_infinity);
    }
    CHECK(std::isnan(stick.product().sum_rule_residual(p.zeta())));
    Lyapunov before(p, 0, 70, {});
    record(p, default_state(p), 1709, 100000, {&before});
    CHECK(before.product().rank() == 4);

    p.b = 0.1;
    p.R_plus = p.R_minus = 0;
    Lyapunov plastic(p, 0, 1e9, {});
    const Record run = record(p, {0.02, 0, 0.05, 0}, 30, 100000, {&plastic});
    if (run.sticks.empty() && run.impacts.size() > 1) CHECK(plastic.product().rank() == 3);
}

TEST_CASE("a window with fewer than two impacts has no exponents") {
    const Parameters p = table1(0.022, Damping::closed_form);
    Lyapunov lyapunov(p, 0, 20, {});
    record(p, default_state(p), 100, 100000, {&lyapunov});
    CHECK(lyapunov.product().impacts() == 1);
    CHECK(status_of(lyapunov.product().qr()[0]) == Status::not_converged);
    CHECK(status_of(lyapunov.product().eigenvalues()[0]) == Status::not_converged);
}

TEST_CASE("a thinned history keeps every second, fourth, ... impact and ends near the end") {
    const Parameters p = table1(0.008, Damping::closed_form);
    Lyapunov full(p, 0, 1e9, {true, false, false, 100000}), thin(p, 0, 1e9, {true, false, false, 256});
    record(p, default_state(p), 3000, 100000, {&full, &thin});
    const ExponentHistory &f = full.product().qr_history(), &t = thin.product().qr_history();
    CHECK(f.tau.size() == static_cast<std::size_t>(full.product().impacts() - 1));
    CHECK(t.tau.size() <= 256);
    for (std::size_t k = 0; k < t.tau.size(); ++k) {
        CHECK(t.tau[k] == f.tau[4 * k]);
        CHECK(std::abs(t.lambda[k][0] - f.lambda[4 * k][0]) < 1e-12);
    }
}

TEST_CASE("the standard error of one window covers the spread between windows") {
    const Windows w = windows(0.025, 100, 1700, 1700);
    const Parameters p = table1(0.025, Damping::closed_form);
    Lyapunov lyapunov(p, 1700, 3400, {true, false, false, 20000});
    record(p, default_state(p), 3400, 100000, {&lyapunov});
    const double error = standard_error(lyapunov.product().qr_history(), lyapunov.product().start_tau())[0];
    CHECK(error > 0.5 * w.deviation);
    CHECK(error < 2 * w.deviation);
}
