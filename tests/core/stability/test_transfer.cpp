#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "../support.hpp"
#include "core/stability/transfer.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("J has the moduli e^(-zeta s) twice and 1 twice, T has the determinant of both") {
    const Parameters p = table1(0.022, Damping::closed_form);
    TransferRecord transfers(p, 0, 1709);
    const Record run = record(p, default_state(p), 1709, 1000000, {&transfers});
    REQUIRE(transfers.transfers.size() + 1 == run.impacts.size());
    for (std::size_t i = 0; i < transfers.transfers.size(); ++i) {
        const ImpactTransfer& t = transfers.transfers[i];
        CHECK(t.tau == run.impacts[i + 1].tau);
        if (t.rank() < 4) continue;
        const double decay = std::exp(-p.zeta() * (t.tau - run.impacts[i].tau));
        const Moduli J = t.J_moduli(), T = t.T_moduli();
        CHECK(
            std::abs(J[0] - 1) + std::abs(J[1] - 1) + std::abs(J[2] - decay) +
                std::abs(J[3] - decay) <
            1e-13);
        // In a chatter entries of M grow as those of r: past 1e7 the moduli drown in them, and to
        // the plain solver, which splits the nearly defective pairs, long before.
        const double steepness = t.M.r().cwiseAbs().maxCoeff();
        if (std::isnan(T[0] + T[1] + T[2] + T[3])) {
            CHECK(steepness > 1e7);
            continue;
        }
        CHECK(T[0] * T[1] * T[2] * T[3] == doctest::Approx(decay * decay * 0.36).epsilon(1e-9));
        if (steepness > 100) continue;
        const Moduli plain = eigenvalue_moduli(t.T());
        for (int k = 0; k < 4; ++k) CHECK(T[k] == doctest::Approx(plain[k]).epsilon(1e-6));
    }
}

TEST_CASE("overdamped flights have two different moduli") {
    Parameters p = table1(0.01, Damping::equation_of_motion);
    p.lambda = 4 / p.epsilon;  // zeta = 2
    ImpactTransfer t{0, p.epsilon, {}, {leg_of(Flow::free(p), 0.7, false)}};
    const Moduli J = t.J_moduli();
    CHECK(J[2] == doctest::Approx(std::exp((-2 + std::sqrt(3)) * 0.7)));
    CHECK(J[3] == doctest::Approx(std::exp((-2 - std::sqrt(3)) * 0.7)));
}

TEST_CASE("after a stick J and T have rank two") {
    const Parameters p = table1(0.015, Damping::closed_form);
    TransferRecord transfers(p, 0, 100);
    const Record run = record(p, default_state(p), 100, 1000000, {&transfers});
    REQUIRE(run.sticks.size() == 1);
    bool found = false;
    for (const ImpactTransfer& t : transfers.transfers) {
        if (t.rank() == 4) continue;
        found = true;
        CHECK(t.J_moduli()[2] == 0);
        CHECK(t.T_moduli()[1] > 0);
        CHECK(t.T_moduli()[2] == 0);
    }
    CHECK(found);
}

TEST_CASE("the condition number of M is that of its singular values, and grows towards grazing") {
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
