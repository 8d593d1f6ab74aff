#include <doctest/doctest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <array>
#include <cmath>
#include <limits>

#include "../support.hpp"
#include "core/stability/exterior.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// The 2x2 minors of a matrix, in the order of Area.
Eigen::Matrix<double, 6, 6> second_minors(const Matrix4& m) {
    constexpr int pairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    Eigen::Matrix<double, 6, 6> minors;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) {
            const auto [r, s] = pairs[i];
            const auto [c, d] = pairs[j];
            minors(i, j) = m(r, c) * m(s, d) - m(r, d) * m(s, c);
        }
    return minors;
}

/// The signed 3x3 minors, which transport a Volume's normal.
Matrix4 cofactors(const Matrix4& m) {
    Matrix4 minors;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            Eigen::Matrix3d rest;
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) rest(r, c) = m(r + (r >= i), c + (c >= j));
            minors(i, j) = ((i + j) % 2 ? -1 : 1) * rest.determinant();
        }
    return minors;
}

/// The matrices that transport areas and volumes, column by column.
template <class... Way>
Eigen::Matrix<double, 6, 6> area_matrix(const Way&... way) {
    Eigen::Matrix<double, 6, 6> m;
    for (int k = 0; k < 6; ++k) m.col(k) = carried(Area(Area::Unit(k)), way...);
    return m;
}
template <class... Way>
Matrix4 volume_matrix(const Way&... way) {
    Matrix4 m;
    for (int k = 0; k < 4; ++k) m.col(k) = carried(Volume(Volume::Unit(k)), way...);
    return m;
}

/// A flight or a sticking phase of one part.
enum class Kind { flight, sticking, resting };

Leg random_leg(std::mt19937_64& engine, const Parameters& p, Kind kind) {
    Leg leg = leg_of(
        kind == Kind::flight ? *Flow::shared_free(p) : *Flow::shared_sticking(p),
        uniform(engine, 0, 0.5), kind == Kind::sticking);
    leg.resting = kind == Kind::resting;
    return leg;
}

Saltation random_strike(std::mt19937_64& engine, Parameters p) {
    if (p.R_plus > 0 && engine() % 2) p.table_plus = p.table_minus = random_table(engine, 0.5);
    const auto u = [&] { return uniform(engine, -1, 1); };
    if (engine() % 3 == 0) return saltation(p.epsilon, Slip{0, u()});
    const double angle = u();
    Contact c{0, u() < 0 ? -1 : 1, {u(), u(), std::sin(angle), std::cos(angle)}, 0};
    c.relative_speed = c.side * uniform(engine, 0.1, 1);
    const Impact impact = impact_at(p, c, u(), 0);
    return saltation(p, impact);
}

}  // namespace

TEST_CASE("areas and volumes are transported by the minors of J and M") {
    std::mt19937_64 engine(6);
    for (int n = 0; n < 300; ++n) {
        const Parameters p = random_system(engine).parameters;
        const Leg leg = random_leg(engine, p, static_cast<Kind>(n % 3));
        Frame J = Frame::Identity();
        carry(J, leg, p.epsilon);
        CHECK((area_matrix(leg, p.epsilon) - second_minors(J)).norm() < 1e-12 * J.squaredNorm());
        CHECK(
            (volume_matrix(leg, p.epsilon) - cofactors(J)).norm() < 1e-12 * std::pow(J.norm(), 3));
        const Saltation M = random_strike(engine, p);
        const Matrix4 m = M.matrix();
        CHECK((area_matrix(M) - second_minors(m)).norm() < 1e-12 * m.squaredNorm());
        CHECK((volume_matrix(M) - cofactors(m)).norm() < 1e-12 * std::pow(m.norm(), 3));
    }
}

TEST_CASE("areas and volumes are transported like the deviations that span them") {
    std::mt19937_64 engine(5);
    for (int n = 0; n < 300; ++n) {
        System s = random_system(engine);
        const Parameters& p = s.parameters;
        Contact c{
            0,
            n % 2 ? 1 : -1,
            {uniform(engine, -1, 1), uniform(engine, -1, 1), std::sin(n), std::cos(n)},
            0};
        c.relative_speed = c.side * uniform(engine, 0.1, 1);
        const Impact impact = impact_at(p, c, uniform(engine, -1, 1), 0);
        const Saltation M = saltation(p, impact);
        const Leg leg = random_leg(engine, p, static_cast<Kind>(n % 3));
        Eigen::Matrix4d v;
        for (int i = 0; i < 16; ++i) v(i / 4, i % 4) = uniform(engine, -1, 1);
        auto area = [](const Eigen::Matrix4d& of) {
            Area w;
            int k = 0;
            for (int i = 0; i < 4; ++i)
                for (int j = i + 1; j < 4; ++j) w(k++) = of(i, 0) * of(j, 1) - of(j, 0) * of(i, 1);
            return w;
        };
        auto volume = [](Eigen::Matrix4d of) {
            Eigen::Vector4d normal;
            for (int i = 0; i < 4; ++i) {
                of.col(3) = Eigen::Vector4d::Unit(i);
                normal(i) = of.determinant();
            }
            return Volume(normal);
        };
        Frame after_leg = v;
        carry(after_leg, leg, p.epsilon);
        const Eigen::Matrix4d after_impact = M.matrix() * v;
        CHECK(
            (carried(area(v), leg, p.epsilon) - area(after_leg)).norm() <
            1e-12 * (1 + after_leg.squaredNorm()));
        CHECK(
            (carried(volume(v), leg, p.epsilon) - volume(after_leg)).norm() <
            1e-12 * (1 + std::pow(after_leg.norm(), 3)));
        CHECK(
            (carried(area(v), M) - area(after_impact)).norm() <
            1e-12 * (1 + after_impact.squaredNorm()));
        CHECK(
            (carried(volume(v), M) - volume(after_impact)).norm() <
            1e-12 * (1 + std::pow(after_impact.norm(), 3)));
    }
}

TEST_CASE("the sizes of a flag are those of a QR factorisation at every impact") {
    std::mt19937_64 engine(9);
    for (const double b : {0.022, 0.015, 0.003}) {
        const Parameters p = table1(b, Damping::closed_form);
        Flag flag;
        Matrix4 frame = Matrix4::Identity();
        std::array<double, 4> sizes = {1, 1, 1, 1};
        double impacts = 1;
        for (int n = 0; n < 30; ++n) {
            const Leg leg = random_leg(engine, p, Kind::flight);
            const Saltation M = random_strike(engine, p);
            flag.pass(leg, p.epsilon);
            flag.strike(M);
            const Eigen::HouseholderQR<Matrix4> factors(
                M.matrix() * transfer_of(leg, p.epsilon) * frame);
            frame = factors.householderQ();
            double all = 1;
            for (int k = 0; k < 4; ++k) sizes[k] *= all *= std::abs(factors.matrixQR()(k, k));
            const auto squares = flag.squares();
            impacts *= std::abs(M.determinant());
            CHECK(flag.determinant * impacts == doctest::Approx(sizes[3]).epsilon(1e-9).scale(0));
            for (int k = 0; k < 3; ++k)
                CHECK(std::sqrt(squares[k]) == doctest::Approx(sizes[k]).epsilon(1e-9).scale(0));
            for (const double separation : flag.separations()) CHECK(separation < 1e-12);
        }
        Flag apart = flag;
        apart.deviation += 1e-6 * apart.deviation.norm() * Eigen::Vector4d(1, -2, 3, 1);
        CHECK(apart.separations()[0] > 1e-8);
        apart = flag;
        apart.volume += 1e-6 * apart.volume.norm() * Eigen::Vector4d(1, -2, 3, 1);
        CHECK(apart.separations()[1] > 1e-8);
    }
}

TEST_CASE(
    "the parts of a leg shrink nothing by more than e^-4, and their product is the complete "
    "flight") {
    Parameters p = table1(0.02, Damping::closed_form);
    p.lambda = 2 / p.epsilon;  // zeta = 2
    const Flow flow = *Flow::shared_free(p);
    for (const double duration : {0.1, 3.0, 8.0}) {
        const Leg leg = leg_of(flow, duration, false);
        CHECK(static_cast<double>(leg.parts) * leg.duration == doctest::Approx(duration));
        CHECK(flow.fastest_decay() * leg.duration <= most_contraction * (1 + 1e-15));
        CHECK(leg.log_det == doctest::Approx(-2 * p.zeta() * leg.duration));
        const Transfer whole = flow.transfer(duration);
        const Matrix4 J = transfer_of(leg, p.epsilon);
        CHECK(J(0, 0) == doctest::Approx(whole.a11).epsilon(1e-12));
        CHECK(J(1, 1) == doctest::Approx(whole.a22).epsilon(1e-12));
        CHECK(J(3, 2) == doctest::Approx(duration));
    }
    CHECK(leg_of(flow, 8, false).parts > leg_of(flow, 3, false).parts);
}

TEST_CASE("the moduli of a product are those of its matrix while double precision resolves them") {
    const Parameters p = table1(0.022, Damping::closed_form);
    std::mt19937_64 engine(7);
    PowerProduct product(p.epsilon);
    Matrix4 plain = Matrix4::Identity();
    for (int n = 0; n < 3; ++n) {
        const Leg leg = random_leg(engine, p, Kind::flight);
        const Saltation M = random_strike(engine, p);
        product.pass(leg);
        product.strike(M);
        plain = M.matrix() * transfer_of(leg, p.epsilon) * plain;
    }
    CHECK(product.rank() == 4);
    const Moduli moduli = eigenvalue_moduli(plain), logs = product.log_moduli();
    for (int k = 0; k < 4; ++k)
        CHECK(std::exp(logs[k]) == doctest::Approx(moduli[k]).epsilon(1e-6));
}

TEST_CASE("an impact with R = 0 leaves rank 3, sticking rank 2, and lost rank does not return") {
    const Parameters p = table1(0.022, Damping::closed_form);
    std::mt19937_64 engine(8);
    Parameters soft = p;
    soft.R_plus = soft.R_minus = 0;
    PowerProduct product(p.epsilon);
    product.strike(random_strike(engine, soft));
    CHECK(product.rank() == 3);
    product.pass(random_leg(engine, p, Kind::sticking));
    CHECK(product.rank() == 2);
    product.strike(random_strike(engine, p));
    CHECK(product.rank() == 2);
    const Moduli logs = product.log_moduli();
    CHECK(std::isfinite(logs[1]));
    CHECK(logs[2] == -std::numeric_limits<double>::infinity());
    CHECK(logs[3] == logs[2]);
}
