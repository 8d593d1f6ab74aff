#include "core/stability/exterior.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/elementary.hpp"
#include "core/motion/special_values.hpp"
#include "core/stability/linear.hpp"

namespace vines {

namespace {

// A product's spectral radius below this share of its norm is made of rounding as much as of the
// product.
constexpr double least_radius = 1e-8;

}  // namespace

namespace {

double parts_of(const Flow& flow, double duration) {
    return std::max(1.0, std::ceil(flow.fastest_decay() * duration / most_contraction));
}

}  // namespace

Leg leg_of(const Flow& flow, double duration, bool stuck) {
    const double parts = parts_of(flow, duration), part = duration / parts;
    return {flow.transfer(part), part, -flow.damping() * part, static_cast<long>(parts), stuck};
}

Leg leg_of(const Stretch& s) {
    const bool stuck = s.stuck_side != 0;
    if (!s.transfer || parts_of(s.flow, s.duration) > 1) return leg_of(s.flow, s.duration, stuck);
    return {*s.transfer, s.duration, -s.flow.damping() * s.duration, 1, stuck};
}

namespace {

/// By rows.
template <class Deviations>
void carry_rows(Deviations& d, const Leg& leg, double epsilon) {
    const auto& [a11, a12, a21, a22] = leg.oscillator;
    using Row = Eigen::Matrix<double, 1, Deviations::ColsAtCompileTime>;
    Row x_dot = d.row(0), x = d.row(1);
    if (leg.stuck) {
        const double nu = 1 / (1 + epsilon), mu = epsilon * nu;
        x_dot = nu * x_dot + mu * d.row(2);
        x = nu * x + mu * d.row(3);
    }
    d.row(0) = a11 * x_dot + a12 * x;
    d.row(1) = a21 * x_dot + a22 * x;
    if (leg.stuck) d.row(2) = d.row(0), d.row(3) = d.row(1);
    else d.row(3) += leg.duration * d.row(2);
}

}  // namespace

void carry(Frame& deviations, const Leg& leg, double epsilon) {
    carry_rows(deviations, leg, epsilon);
}
void carry(Eigen::Vector4d& deviation, const Leg& leg, double epsilon) {
    carry_rows(deviation, leg, epsilon);
}

Matrix4 transfer_of(const Leg& leg, double epsilon) {
    Frame J = Frame::Identity();
    for (long k = 0; k < leg.parts; ++k) carry(J, leg, epsilon);
    return J;
}

namespace {

/// Of one part, which shrinks too little for the difference to lose digits.
double determinant(const Transfer& a) { return a.a11 * a.a22 - a.a12 * a.a21; }

}  // namespace

Area carried(const Area& w, const Leg& leg, double epsilon) {
    const auto& [a11, a12, a21, a22] = leg.oscillator;
    const double det = determinant(leg.oscillator);
    Area out;
    if (leg.stuck) {
        // The area of the two deviations of the centre of mass, (nu x' + mu y') and (nu x + mu y),
        // as x' = y', x = y.
        const double nu = 1 / (1 + epsilon), mu = epsilon * nu;
        const double area = det * (nu * nu * w(0) + nu * mu * (w(2) - w(3)) + mu * mu * w(5));
        out << area, 0, area, -area, 0, area;
        return out;
    }
    // J is the oscillator's block beside [1 0; s 1] of the free mass.
    const double s = leg.duration, w03 = w(2) + s * w(1), w13 = w(4) + s * w(3);
    out << det * w(0), a11 * w(1) + a12 * w(3), a11 * w03 + a12 * w13, a21 * w(1) + a22 * w(3),
        a21 * w03 + a22 * w13, w(5);
    return out;
}

Volume carried(const Volume& volume, const Leg& leg) {
    if (leg.stuck) return {Eigen::Vector4d::Zero()};
    // det(J) J^-T n
    const auto& [a11, a12, a21, a22] = leg.oscillator;
    const Eigen::Vector4d& n = volume.normal;
    const double det = determinant(leg.oscillator);
    return {
        {a22 * n(0) - a21 * n(1), a11 * n(1) - a12 * n(0), det * (n(2) - leg.duration * n(3)),
         det * n(3)}};
}

Area carried(const Area& w, const Saltation& M, double R) {
    // (S + r g^T) w = S w + r ^ S (i_g w), with i_g w what g = (0, 1, 0, -1) leaves of w. S mixes
    // x' and y' alone, and its determinant is -R.
    const double p = M.S(0, 0), q = M.S(0, 2), u = M.S(2, 0), v = M.S(2, 2);
    const double g0 = w(2) - w(0), g1 = w(4), g2 = w(3) + w(5), g3 = w(4);
    const double s0 = p * g0 + q * g2, s2 = u * g0 + v * g2;
    const Eigen::Vector4d& r = M.r;
    Area out;
    out << p * w(0) - q * w(3) + r(0) * g1 - r(1) * s0, -R * w(1) + r(0) * s2 - r(2) * s0,
        p * w(2) + q * w(5) + r(0) * g3 - r(3) * s0, v * w(3) - u * w(0) + r(1) * s2 - r(2) * g1,
        w(4) + r(1) * g3 - r(3) * g1, u * w(2) + v * w(5) + r(2) * g3 - r(3) * s2;
    return out;
}

Volume carried(const Volume& volume, const Saltation& M, double R) {
    // det(M) M^-T n. With g^T S^-1 = g^T and det(M) = R^2 that is R (R S^-1)^T n + g (R S^-1 r).n,
    // for R = 0 as well.
    const double p = M.S(0, 0), q = M.S(0, 2), u = M.S(2, 0), v = M.S(2, 2);
    const Eigen::Vector4d &n = volume.normal, &r = M.r;
    const double along = (q * r(2) - v * r(0)) * n(0) + R * r(1) * n(1) +
                         (u * r(0) - p * r(2)) * n(2) + R * r(3) * n(3);
    return {
        {R * (u * n(2) - v * n(0)), R * R * n(1) + along, R * (q * n(0) - p * n(2)),
         R * R * n(3) - along}};
}

template <int n>
void PowerProduct::Scaled<n>::rescale() {
    const double norm = matrix.norm();
    if (norm == 0) return;
    matrix /= norm;
    log_scale += elementary::log(norm);
}

/// ln of the largest modulus of an eigenvalue.
template <int n>
double PowerProduct::Scaled<n>::log_radius() const {
    if (!matrix.allFinite()) return nan;
    const double radius = eigenvalues_of(matrix).unaryExpr(&elementary::modulus).maxCoeff();
    return radius > least_radius ? log_scale + elementary::log(radius) : nan;
}

void PowerProduct::pass(const Leg& leg) {
    if (leg.stuck) rank_ = 2;
    for (long count = 0; count < leg.parts; ++count) {
        Frame first = first_.matrix;
        carry(first, leg, epsilon_);
        first_.matrix = first;
        first_.rescale();
        for (int k = 0; k < 6; ++k)
            second_.matrix.col(k) = carried(Area(second_.matrix.col(k)), leg, epsilon_);
        second_.rescale();
        if (rank_ < 3) continue;
        for (int k = 0; k < 4; ++k)
            third_.matrix.col(k) = carried(Volume{third_.matrix.col(k)}, leg).normal;
        third_.rescale();
        log_det_ += leg.log_det;
    }
}

void PowerProduct::strike(const Saltation& M, double R) {
    if (R == 0) rank_ = std::min(rank_, 3);
    first_.matrix = M.times(first_.matrix);
    first_.rescale();
    for (int k = 0; k < 6; ++k) second_.matrix.col(k) = carried(Area(second_.matrix.col(k)), M, R);
    second_.rescale();
    if (rank_ < 3) return;
    for (int k = 0; k < 4; ++k)
        third_.matrix.col(k) = carried(Volume{third_.matrix.col(k)}, M, R).normal;
    third_.rescale();
    log_det_ += 2 * elementary::log(R);
}

Moduli PowerProduct::log_moduli() const {
    const double one = first_.log_radius(), two = second_.log_radius(),
                 three = rank_ >= 3 ? third_.log_radius() : 0;
    Moduli logs = {one, two - one, three - two, log_det_ - three};
    for (int k = rank_; k < 4; ++k) logs[k] = -infinity;
    return logs;
}

}  // namespace vines
