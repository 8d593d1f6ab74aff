#include "core/continuation/periodic_impacts.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/elementary.hpp"
#include "core/stability/exterior.hpp"

namespace vines {

namespace {

// Step of the central differences, in units of the parameter: errors of 1e-11 each from truncation
// and rounding.
constexpr double parameter_step = 1e-5;

// Terms of the series over a step whose length times the fastest rate is at most 1: the first
// omitted one is below 1e-19.
constexpr int arc_terms = 20;

/// A solution, or a derivative of one: both obey the same linear equations.
struct ArcColumn {
    double x, x_dot, sin, cos;
};

/// Advances a column over h. Adds up what exceeds x + x' h and x'.
struct Excess {
    double x = 0, x_dot = 0;
};
Excess advance(ArcColumn& c, const Flow::Coefficients& law, double h) {
    const auto [stiffness, damping, forcing, Omega] = law;
    ArcColumn term = c;
    Excess excess;
    for (int n = 1; n <= arc_terms; ++n) {
        const double f = h / n;
        term = {
            f * term.x_dot, f * (forcing * term.sin - stiffness * term.x - damping * term.x_dot),
            f * Omega * term.cos, -f * Omega * term.sin};
        if (n > 1) excess.x += term.x;
        excess.x_dot += term.x_dot;
        c.sin += term.sin;
        c.cos += term.cos;
    }
    c.x += c.x_dot * h + excess.x;
    c.x_dot += excess.x_dot;
    return excess;
}

using BetweenImpacts = OrbitEquations::BetweenImpacts;

/// Increase of x - y over a flight divided by its duration, without cancellation.
double mean_relative_speed(const Parameters& p, const BetweenImpacts& f, const Arc& arc) {
    return f.relative_speed + arc.bend - 0.5 * p.gravity * f.s;
}

/// x' - y' at the end of a flight.
double relative_speed_at_end(const Parameters& p, const BetweenImpacts& f, const Arc& arc) {
    return f.relative_speed + arc.gain - p.gravity * f.s;
}

/// x'' at the end of a flight, before the impact.
double x_ddot_at_end(const Flow::Coefficients& law, const Arc& arc) {
    return law[2] * arc.end.sin_theta - law[0] * arc.end.x - law[1] * arc.end.x_dot;
}

/// The flight after an impact at its end.
BetweenImpacts after_impact(
    const Parameters& p, const BetweenImpacts& f, const Arc& arc, int side, double approach,
    double R) {
    return {
        f.theta + p.Omega * f.s,
        arc.end.x,
        arc.end.x_dot - (1 + R) * p.epsilon / (1 + p.epsilon) * approach,
        -R * approach,
        side,
        0};
}

/// Derivatives of (theta, x, x', x' - y') as rows, by the unknowns.
using Derivatives = Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::RowMajor>;

/// Carries derivatives over a flight and its impact; `approach` is x' - y' before it. Returns the
/// derivative of x - y at the contact.
Eigen::RowVectorXd carry_derivatives(
    const Parameters& p, const Flow::Coefficients& law, const BetweenImpacts& f, const Arc& arc,
    double approach, int side, Eigen::Index s_column, Derivatives& d) {
    const Transfer& a = arc.transfer;
    const Eigen::RowVectorXd theta = d.row(0), x = d.row(1), x_dot = d.row(2), r = d.row(3);
    Eigen::RowVectorXd x_end = a.a22 * x + a.a21 * x_dot + arc.x_by_theta * theta,
                       x_dot_end = a.a12 * x + a.a11 * x_dot + arc.x_dot_by_theta * theta;
    Eigen::RowVectorXd gap = f.s * r + x_end - x - f.s * x_dot;
    x_end(s_column) += arc.end.x_dot;
    x_dot_end(s_column) += x_ddot_at_end(law, arc);
    gap(s_column) += approach;
    Eigen::RowVectorXd approach_rate = r + x_dot_end - x_dot;
    approach_rate(s_column) -= p.gravity;
    const double R_speed = p.restitution_derivative(side, std::abs(approach));
    d.row(0)(s_column) += p.Omega;
    d.row(1) = x_end;
    d.row(2) = x_dot_end - (1 + R_speed) * p.epsilon / (1 + p.epsilon) * approach_rate;
    d.row(3) = -R_speed * approach_rate;
    return gap;
}

/// Applies the transfer matrix of a flight and its impact (30).
void carry_transfer(
    const Parameters& p, const Flow::Coefficients& law, const BetweenImpacts& f, const Arc& arc,
    double approach, int side, Frame& transfer) {
    carry(transfer, Leg{arc.transfer, f.s, -law[1] * f.s, 1, false}, p.epsilon);
    const Impact impact =
        impact_at(p, {f.s, side, arc.end, approach}, x_ddot_at_end(law, arc), 0, p.gravity);
    transfer = saltation(p, impact).times(transfer);
}

}  // namespace

Arc arc_over(const Flow::Coefficients& law, const Oscillation& start, double s) {
    const auto [stiffness, damping, forcing, Omega] = law;
    const double rate = std::max({1.0, stiffness, damping, Omega});
    const double steps = std::ceil(s * rate), h = s / std::max(steps, 1.0);
    // The motion; the unforced motion from x' = 1; the derivative with respect to the phase.
    ArcColumn motion{start.x, start.x_dot, start.sin_theta, start.cos_theta}, free{0, 1, 0, 0},
        phase{0, 0, start.cos_theta, -start.sin_theta};
    Arc arc{};
    double before = 0;  // x' - x0' at the start of the step
    for (double k = 0; k < std::max(steps, 1.0); ++k) {
        const Excess excess = advance(motion, law, h);
        advance(free, law, h);
        advance(phase, law, h);
        arc.bend += before * h + excess.x;
        before += excess.x_dot;
    }
    arc.end = {motion.x, motion.x_dot, motion.sin, motion.cos};
    arc.bend /= s;
    arc.gain = before;
    // The unforced motion from (x', x) = (0, 1) is u' + damping u.
    arc.transfer = {free.x_dot, -stiffness * free.x, free.x, free.x_dot + damping * free.x};
    arc.x_by_theta = phase.x;
    arc.x_dot_by_theta = phase.x_dot;
    return arc;
}

ImpactSequence ImpactSequence::rotated() const {
    ImpactSequence next = *this;
    for (std::size_t k = 0; k < size(); ++k) next.sides[k] = side_after(k);
    return next;
}

ImpactSequence ImpactSequence::doubled() const {
    ImpactSequence twice{sides, false, 2 * half_cycles};
    for (const int side : sides) twice.sides.push_back(mirrored ? -side : side);
    return twice;
}

OrbitEquations::OrbitEquations(
    ImpactSequence sequence, const ParameterFamily& family, double length)
    : sequence_(std::move(sequence)),
      family_(family),
      length_(length) {}

std::vector<double> OrbitEquations::parameters(const Unknowns& z) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < family_.ranges.size(); ++i)
        values.push_back(z(equations() + static_cast<Eigen::Index>(i)) * family_.unit(i));
    return values;
}

std::optional<Parameters> OrbitEquations::system(const Unknowns& z) const {
    return family_.system_at(parameters(z));
}

std::optional<OrbitValues> OrbitEquations::values(
    const Unknowns& z, Eigen::MatrixXd* jacobian) const {
    const auto p = system(z);
    if (!p) return std::nullopt;
    if (jacobian) jacobian->setZero(equations(), unknowns());
    auto at = evaluated(z, *p, jacobian);
    if (!at || !jacobian) return at;
    for (Eigen::Index c = equations(); c < unknowns(); ++c) {
        // One-sided at the end of a parameter's range.
        Unknowns beside = z;
        Eigen::VectorXd difference = Eigen::VectorXd::Zero(equations());
        double width = 0;
        for (const double side : {1.0, -1.0}) {
            beside(c) = z(c) + side * parameter_step;
            const auto other = values(beside);
            difference += side * (other ? other->residual : at->residual);
            if (other) width += parameter_step;
        }
        if (width == 0) return std::nullopt;
        jacobian->col(c) = difference / width;
    }
    return at;
}

std::optional<OrbitValues> OrbitEquations::evaluated(
    const Unknowns& z, const Parameters& p, Eigen::MatrixXd* jacobian) const {
    const auto n = static_cast<Eigen::Index>(sequence_.size());
    const Flow::Coefficients law = Flow::free_coefficients(p);
    BetweenImpacts f = first_flight(z);
    Derivatives d = Derivatives::Zero(4, equations());
    d(0, 0) = 1, d(1, 1) = d(2, 2) = d(3, 3) = length_;
    OrbitValues out{Eigen::VectorXd(equations()), {}, Frame::Identity()};
    for (Eigen::Index k = 0; k < n; ++k) {
        f.s = z(4 + k);
        if (!(f.s > 0)) return std::nullopt;
        const int side = sequence_.side_after(static_cast<std::size_t>(k));
        const Arc arc = arc_over(law, f.oscillation(), f.s);
        const double approach = relative_speed_at_end(p, f, arc),
                     R = p.restitution(side, std::abs(approach));
        // For a return to the same wall, the mean speed stands for x - y: it is not zero at s = 0.
        const double mean = mean_relative_speed(p, f, arc), of = f.side == side ? f.s : 1,
                     miss = f.side == side ? mean : (f.side - side) * p.b + mean * f.s;
        out.residual(k) = miss / length_;
        out.approach.push_back(side * approach);
        carry_transfer(p, law, f, arc, approach, side, out.transfer);
        if (jacobian) {
            jacobian->row(k).head(equations()) =
                carry_derivatives(p, law, f, arc, approach, side, 4 + k, d) / (of * length_);
            if (f.side == side) (*jacobian)(k, 4 + k) -= mean / (f.s * length_);
        }
        f = after_impact(p, f, arc, side, approach, R);
    }
    const double sign = sequence_.sign();
    out.transfer *= sign;
    out.residual.segment<3>(n) =
        Eigen::Vector3d(sign * f.x, sign * f.x_dot, sign * f.relative_speed) / length_ -
        z.segment<3>(1);
    out.residual(n + 3) = f.theta - z(0) - sequence_.half_cycles * std::numbers::pi;
    if (jacobian) {
        jacobian->block(n, 0, 3, equations()) = sign * d.bottomRows<3>() / length_;
        jacobian->row(n + 3).head(equations()) = d.row(0);
        for (int i = 0; i < 3; ++i) (*jacobian)(n + i, 1 + i) -= 1;
        (*jacobian)(n + 3, 0) -= 1;
    }
    if (!out.residual.allFinite()) return std::nullopt;
    return out;
}

std::vector<OrbitEquations::BetweenImpacts> OrbitEquations::flights(
    const Unknowns& z, const Parameters& p) const {
    const Flow::Coefficients law = Flow::free_coefficients(p);
    std::vector<BetweenImpacts> all = {first_flight(z)};
    for (std::size_t i = 0; i < sequence_.size(); ++i) {
        BetweenImpacts& f = all.back();
        f.s = z(4 + static_cast<Eigen::Index>(i));
        const int side = sequence_.side_after(i);
        const Arc arc = arc_over(law, f.oscillation(), f.s);
        const double approach = relative_speed_at_end(p, f, arc);
        all.push_back(
            after_impact(p, f, arc, side, approach, p.restitution(side, std::abs(approach))));
    }
    return all;
}

Oscillation OrbitEquations::BetweenImpacts::oscillation() const {
    return {x, x_dot, elementary::sin(theta), elementary::cos(theta)};
}

OrbitEquations::BetweenImpacts OrbitEquations::first_flight(const Unknowns& z) const {
    return {z(0), z(1) * length_, z(2) * length_, z(3) * length_, sequence_.sides[0], 0};
}

Unknowns OrbitEquations::rotated(const Unknowns& z) const {
    const auto n = static_cast<Eigen::Index>(sequence_.size());
    const Parameters p = *system(z);
    const BetweenImpacts f = flights(z, p)[1];
    Unknowns next = z;
    next.head<4>() << f.theta, f.x / length_, f.x_dot / length_, f.relative_speed / length_;
    for (Eigen::Index k = 0; k < n; ++k) next(4 + k) = z(4 + (k + 1) % n);
    return next;
}

}  // namespace vines
