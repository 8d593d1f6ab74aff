#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "../support.hpp"
#include "core/stability/exterior.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE(
    "J has the moduli e^(-zeta s) twice and 1 twice, and det T = det M det J = R^2 e^(-2 zeta s)") {
    const Parameters p = table1(0.022, Damping::closed_form);
    TransferRecord transfers(p, {0, 1709});
    const Record run = record(p, default_state(p), 1709, 1000000, {&transfers});
    REQUIRE(transfers.entries.size() + 1 == run.impacts.size());
    for (std::size_t i = 0; i < transfers.entries.size(); ++i) {
        const ImpactTransfer& t = transfers.entries[i];
        CHECK(t.tau == run.impacts[i + 1].tau);
        if (std::ranges::any_of(t.legs, &Leg::sticking)) continue;
        const double decay = std::exp(-p.zeta() * (t.tau - run.impacts[i].tau));
        const Moduli J = t.J_moduli(), T = t.T_moduli();
        CHECK(
            std::abs(J[0] - 1) + std::abs(J[1] - 1) + std::abs(J[2] - decay) +
                std::abs(J[3] - decay) <
            1e-13);
        // Near grazing, as in a chatter, the entries of M grow with those of r, eq. (27). Beyond
        // 1e7 T_moduli() returns NaN, since rounding dominates. The general eigenvalue solver
        // splits the nearly defective pairs; it is compared up to 100 only.
        const double steepness = t.M.r().cwiseAbs().maxCoeff();
        if (std::isnan(T[0] + T[1] + T[2] + T[3])) {
            CHECK(steepness > 1e7);
            continue;
        }
        CHECK(
            T[0] * T[1] * T[2] * T[3] ==
            doctest::Approx(decay * decay * p.R_plus * p.R_minus).epsilon(1e-9));
        if (steepness > 100) continue;
        const Moduli plain = eigenvalue_moduli(t.T());
        for (int k = 0; k < 4; ++k) CHECK(T[k] == doctest::Approx(plain[k]).epsilon(1e-6));
    }
}

TEST_CASE("overdamped flights have two different decaying moduli") {
    Parameters p = table1(0.01, Damping::equation_of_motion);
    p.lambda = 4 / p.epsilon;  // zeta = 2
    ImpactTransfer t{0, p.epsilon, {}, {leg_of(*Flow::shared_free(p), 0.7, false)}};
    const Moduli J = t.J_moduli();
    CHECK(J[2] == doctest::Approx(std::exp((-2 + std::sqrt(3)) * 0.7)));
    CHECK(J[3] == doctest::Approx(std::exp((-2 - std::sqrt(3)) * 0.7)));
}

TEST_CASE("after sticking J and T have rank two") {
    const Parameters p = table1(0.015, Damping::closed_form);
    TransferRecord transfers(p, {0, 100});
    const Record run = record(p, default_state(p), 100, 1000000, {&transfers});
    REQUIRE(run.sticks.size() == 1);
    bool found = false;
    for (const ImpactTransfer& t : transfers.entries) {
        if (std::ranges::none_of(t.legs, &Leg::sticking)) continue;
        found = true;
        CHECK(t.J_moduli()[2] == 0);
        CHECK(t.T_moduli()[1] > 0);
        CHECK(t.T_moduli()[2] == 0);
    }
    CHECK(found);
}

TEST_CASE("the condition number of M is that of the Frobenius norm, and grows towards grazing") {
    const Parameters p = table1(0.022, Damping::closed_form);
    Impact i = record(p, default_state(p), 100).impacts[2];
    double before = 0;
    for (double speed : {1.0, 1e-2, 1e-4, 1e-6}) {
        i.relative_speed_before = speed * 0.01;
        const Saltation m = saltation(p, i);
        const Matrix4 M = m.matrix();
        CHECK(m.condition() >= before);
        if (speed > 1e-3)
            CHECK(m.condition() == doctest::Approx(M.norm() * M.inverse().norm()).epsilon(1e-6));
        before = m.condition();
    }
    CHECK(before > 1e8);
    i.R = 0;
    CHECK(std::isinf(saltation(p, i).condition()));
}

TEST_CASE("J and M transport a deviation as the trajectory does") {
    // Central differences of runs over several impacts against the product of the matrices.
    std::mt19937_64 engine(21);
    int compared = 0;
    for (int n = 0; n < 400 && compared < 100; ++n) {
        System s = random_system(engine);
        s.parameters.R_plus = uniform(engine, 0.3, 1);
        s.parameters.R_minus = uniform(engine, 0.3, 1);
        if (n % 2) s.parameters.table_plus = random_table(engine, 0.02);
        const Parameters& p = s.parameters;
        const Record run = record(p, s.start, 40, 4);
        if (run.impacts.size() < 4 || !run.sticks.empty()) continue;
        bool steep = false;
        for (const Impact& i : run.impacts)
            // Steep impacts amplify d beyond the linear range.
            steep = steep || std::abs(i.x_ddot_before / i.relative_speed_before) > 20;
        if (steep) continue;
        const double tau = run.impacts.back().tau + 1e-3;

        Matrix4 product = Matrix4::Identity();
        double before = 0;
        for (const Impact& i : run.impacts) {
            product = saltation(p, i).matrix() *
                      transfer_of(leg_of(*Flow::shared_free(p), i.tau - before, false), p.epsilon) *
                      product;
            before = i.tau;
        }
        product =
            transfer_of(leg_of(*Flow::shared_free(p), tau - before, false), p.epsilon) * product;

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
                end[sign] << other.outcome.state.x_dot, other.outcome.state.x,
                    other.outcome.state.y_dot, other.outcome.state.y;
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

TEST_CASE(
    "a deviation through sticking agrees with the trajectory: only the centre of mass remains") {
    const Parameters p = table1(0.015, Damping::closed_form);
    // Just before a chatter at x - y = +b.
    const State start{.x_dot = 0.0003, .x = -0.004, .y_dot = 0, .y = -0.004 - 0.015 + 2e-5};
    struct Product : Observer {
        explicit Product(const Parameters& parameters) : p(parameters) {}
        void on_stretch(const Stretch& s) override {
            m = transfer_of(leg_of(s.flow, s.duration, s.sticking_side != 0), p.epsilon) * m;
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
