#include "core/continuation/periodic_impacts.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

// Two halves of an orbit can be those of its parent if their flights differ by less than this.
constexpr double similar_half = 0.3;

// Terms of the series over a step of at most 1 over the fastest rate: the next is below 1e-19.
constexpr int arc_terms = 20;

/// Advances a solution over h, or a derivative of one: both obey the same linear equations. Adds up
/// what exceeds x + x' h and x'.
struct Excess {
    double x = 0, x_dot = 0;
};
Excess advance(Oscillation& o, const Flow::Coefficients& law, double h) {
    const auto [stiffness, damping, forcing, Omega] = law;
    Oscillation term = o;
    Excess excess;
    for (int n = 1; n <= arc_terms; ++n) {
        const double f = h / n;
        term = {
            f * term.x_dot,
            f * (forcing * term.sin_theta - stiffness * term.x - damping * term.x_dot),
            f * Omega * term.cos_theta, -f * Omega * term.sin_theta};
        if (n > 1) excess.x += term.x;
        excess.x_dot += term.x_dot;
        o.sin_theta += term.sin_theta;
        o.cos_theta += term.cos_theta;
    }
    o.x += o.x_dot * h + excess.x;
    o.x_dot += excess.x_dot;
    return excess;
}

/// Increase of x - y over a flight divided by its duration, without cancellation.
double mean_relative_speed(const Parameters& p, const OrbitFlight& f, const Arc& arc) {
    return f.relative_speed + arc.bend - 0.5 * p.gravity * f.s;
}

/// x' - y' at the end of a flight.
double relative_speed_at_end(const Parameters& p, const OrbitFlight& f, const Arc& arc) {
    return f.relative_speed + arc.gain - p.gravity * f.s;
}

/// x'' at the end of a flight, before the impact.
double x_ddot_at_end(const Flow::Coefficients& law, const Arc& arc) {
    return law[2] * arc.end.sin_theta - law[0] * arc.end.x - law[1] * arc.end.x_dot;
}

/// The flight after an impact at its end.
OrbitFlight after_impact(
    const Parameters& p, const OrbitFlight& f, const Arc& arc, int side, double approach) {
    const double R = p.restitution(side, std::abs(approach));
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

/// Carries derivatives over a flight and its impact. Returns that of x - y at the contact.
Eigen::RowVectorXd carry_derivatives(
    const Parameters& p, const Flow::Coefficients& law, const OrbitFlight& f, const Arc& arc,
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
    const Parameters& p, const Flow::Coefficients& law, const OrbitFlight& f, const Arc& arc,
    double approach, int side, Frame& transfer) {
    carry(transfer, Leg{arc.transfer, f.s, -law[1] * f.s, 1, false}, p.epsilon);
    const Impact impact =
        impact_at(p, {f.s, side, arc.end, approach}, x_ddot_at_end(law, arc), 0, p.gravity);
    transfer = saltation(p, impact).times(transfer);
}

/// The sequence whose double this is; empty if there is none.
std::optional<ImpactSequence> halved(const ImpactSequence& s) {
    const std::size_t half = s.size() / 2;
    if (s.mirrored || s.size() != 2 * half || s.half_cycles % 2 != 0) return std::nullopt;
    ImpactSequence one{{s.sides.begin(), s.sides.begin() + static_cast<long>(half)}};
    one.mirrored = s.sides[half] != s.sides[0];
    one.half_cycles = s.half_cycles / 2;
    if (one.mirrored != (one.half_cycles % 2 != 0) || one.doubled().sides != s.sides)
        return std::nullopt;
    return one;
}

}  // namespace

Arc arc_over(const Flow::Coefficients& law, const Oscillation& start, double s) {
    const auto [stiffness, damping, forcing, Omega] = law;
    const double rate = std::max({1.0, stiffness, damping, Omega});
    const double steps = std::ceil(s * rate), h = s / std::max(steps, 1.0);
    // The motion; the unforced motion from x' = 1; the derivative with respect to the phase.
    Oscillation motion = start, free{0, 1, 0, 0}, phase{0, 0, start.cos_theta, -start.sin_theta};
    Arc arc{};
    double before = 0;  // x' - x0' at the start of the step
    for (double k = 0; k < std::max(steps, 1.0); ++k) {
        const Excess excess = advance(motion, law, h);
        advance(free, law, h);
        advance(phase, law, h);
        arc.bend += before * h + excess.x;
        before += excess.x_dot;
    }
    arc.end = motion;
    arc.bend /= s;
    arc.gain = before;
    // The unforced motion from (x', x) = (0, 1) is u' + damping u.
    arc.transfer = {free.x_dot, -stiffness * free.x, free.x, free.x_dot + damping * free.x};
    arc.x_by_theta = phase.x;
    arc.x_dot_by_theta = phase.x_dot;
    return arc;
}

std::optional<OrbitValues> ImpactEquations::evaluated(
    const Unknowns& z, const Parameters& p, Eigen::MatrixXd* jacobian) const {
    if (p.friction != 0) return std::nullopt;
    const auto n = static_cast<Eigen::Index>(sequence().size());
    const Flow::Coefficients law = Flow::free_coefficients(p);
    OrbitFlight f = first_flight(z);
    Derivatives d = Derivatives::Zero(4, equations());
    d(0, 0) = 1, d(1, 1) = d(2, 2) = d(3, 3) = length();
    OrbitValues out{Eigen::VectorXd(equations()), {}, Frame::Identity()};
    for (Eigen::Index k = 0; k < n; ++k) {
        f.s = z(4 + k);
        if (!(f.s > 0)) return std::nullopt;
        const int side = sequence().side_after(static_cast<std::size_t>(k));
        const Arc arc = arc_over(law, f.oscillation(), f.s);
        const double approach = relative_speed_at_end(p, f, arc);
        // For a return to the same wall, the mean speed stands for x - y: it is not zero at s = 0.
        const double mean = mean_relative_speed(p, f, arc), of = f.side == side ? f.s : 1,
                     miss = f.side == side ? mean : (f.side - side) * p.b + mean * f.s;
        out.residual(k) = miss / length();
        out.approach.push_back(side * approach);
        carry_transfer(p, law, f, arc, approach, side, out.transfer);
        if (jacobian) {
            jacobian->row(k).head(equations()) =
                carry_derivatives(p, law, f, arc, approach, side, 4 + k, d) / (of * length());
            if (f.side == side) (*jacobian)(k, 4 + k) -= mean / (f.s * length());
        }
        f = after_impact(p, f, arc, side, approach);
    }
    const double sign = sequence().sign();
    out.transfer *= sign;
    out.residual.segment<3>(n) =
        Eigen::Vector3d(sign * f.x, sign * f.x_dot, sign * f.relative_speed) / length() -
        z.segment<3>(1);
    out.residual(n + 3) = f.theta - z(0) - sequence().half_cycles * std::numbers::pi;
    if (jacobian) {
        jacobian->block(n, 0, 3, equations()) = sign * d.bottomRows<3>() / length();
        jacobian->row(n + 3).head(equations()) = d.row(0);
        for (int i = 0; i < 3; ++i) (*jacobian)(n + i, 1 + i) -= 1;
        (*jacobian)(n + 3, 0) -= 1;
    }
    if (!out.residual.allFinite()) return std::nullopt;
    return out;
}

std::vector<OrbitFlight> ImpactEquations::flights(const Unknowns& z, const Parameters& p) const {
    const Flow::Coefficients law = Flow::free_coefficients(p);
    std::vector<OrbitFlight> all = {first_flight(z)};
    for (std::size_t i = 0; i < sequence().size(); ++i) {
        OrbitFlight& f = all.back();
        f.s = z(4 + static_cast<Eigen::Index>(i));
        const int side = sequence().side_after(i);
        const Arc arc = arc_over(law, f.oscillation(), f.s);
        all.push_back(after_impact(p, f, arc, side, relative_speed_at_end(p, f, arc)));
    }
    return all;
}

Oscillation OrbitFlight::oscillation() const {
    return {x, x_dot, elementary::sin(theta), elementary::cos(theta)};
}

OrbitFlight ImpactEquations::first_flight(const Unknowns& z) const {
    return {z(0), z(1) * length(), z(2) * length(), z(3) * length(), sequence().sides[0], 0};
}

OrbitGuess ImpactEquations::rotated(const Unknowns& z) const {
    const auto n = static_cast<Eigen::Index>(sequence().size());
    ImpactSequence next = sequence();
    for (std::size_t k = 0; k < next.size(); ++k) next.sides[k] = sequence().side_after(k);
    const OrbitFlight f = flights(z, *system(z))[1];
    Unknowns w = z;
    w.head<4>() << f.theta, f.x / length(), f.x_dot / length(), f.relative_speed / length();
    for (Eigen::Index k = 0; k < n; ++k) w(4 + k) = z(4 + (k + 1) % n);
    return {std::make_shared<ImpactEquations>(next, family(), length()), w};
}

std::shared_ptr<const OrbitEquations> ImpactEquations::doubled() const {
    return std::make_shared<ImpactEquations>(sequence().doubled(), family(), length());
}

Eigen::VectorXd ImpactEquations::twice(const Eigen::VectorXd& z) const {
    const auto n = static_cast<Eigen::Index>(sequence().size());
    Eigen::VectorXd w(z.size() + n);
    w << z.head(4 + n), z.segment(4, n), z.tail(z.size() - 4 - n);
    return w;
}

std::optional<OrbitGuess> ImpactEquations::half(const Unknowns& z) const {
    const auto one = halved(sequence());
    if (!one) return std::nullopt;
    const auto n = static_cast<Eigen::Index>(one->size());
    if (!((z.segment(4, n) - z.segment(4 + n, n)).cwiseAbs().maxCoeff() < similar_half))
        return std::nullopt;
    Unknowns half(z.size() - n);
    half << z.head(4), 0.5 * (z.segment(4, n) + z.segment(4 + n, n)), z.tail(1);
    return OrbitGuess{std::make_shared<ImpactEquations>(*one, family(), length()), half};
}

std::optional<OrbitGuess> ImpactEquations::changed(
    const Unknowns& z, const SequenceFault& fault) const {
    ImpactSequence one = sequence();
    const auto guess = [&](const Unknowns& of) {
        return OrbitGuess{std::make_shared<ImpactEquations>(one, family(), length()), of};
    };
    const auto k = static_cast<Eigen::Index>(fault.flight),
               n = static_cast<Eigen::Index>(one.size());
    Unknowns next;
    if (fault.kind == SequenceFault::Kind::contact) {
        if (!(fault.s > 0 && fault.s < z(4 + k))) return std::nullopt;
        one.sides.insert(one.sides.begin() + k + 1, fault.side);
        next.resize(z.size() + 1);
        next << z.head(4 + k), fault.s, z(4 + k) - fault.s, z.tail(z.size() - 5 - k);
        return guess(next);
    }
    if (fault.kind != SequenceFault::Kind::missing || n < 2) return std::nullopt;
    if (k + 1 == n) {  // the impact at which the sequence begins
        const OrbitGuess later = rotated(z);
        return later.equations->changed(later.z, {fault.kind, fault.flight - 1});
    }
    one.sides.erase(one.sides.begin() + k + 1);
    next.resize(z.size() - 1);
    next << z.head(4 + k), z(4 + k) + z(5 + k), z.tail(z.size() - 6 - k);
    return guess(next);
}

}  // namespace vines
