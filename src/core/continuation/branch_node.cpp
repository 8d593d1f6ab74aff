#include "core/continuation/branch_node.hpp"

#include <cmath>

#include "core/motion/elementary.hpp"
#include "core/stability/linear.hpp"

namespace vines {

namespace {

// A multiplier with a smaller imaginary part counts as real; moduli of a pair on the unit circle
// differ from 1 by less than `on_circle`.
constexpr double least_imaginary = 1e-7, on_circle = 1e-6;
// Arclengths of the first step onto another branch, in the order of trial.
constexpr double first_arcs[] = {1e-3, 1e-4, 1e-2, 1e-5, 1e-6};
// Two halves of an orbit can be those of its parent if they differ by less than this, in rad.
constexpr double similar_half = 0.3, equal_halves = 1e-6;
// Secant steps towards a doubling, and the step after which only rounding remains.
constexpr int most_secants = 20;
constexpr double last_secant = 1e-15;

double doubling_test(const Eigenvalues& m) {
    std::complex<double> product = 1;
    for (const auto& value : m) product *= value + 1.0;
    return product.real();
}

/// Unknowns of the doubled orbit, or a tangent of them: the flights twice.
Eigen::VectorXd twice(const Eigen::VectorXd& v, std::size_t flights) {
    const auto n = static_cast<Eigen::Index>(flights);
    Eigen::VectorXd w(v.size() + n);
    w << v.head(4 + n), v.segment(4, n), v.tail(v.size() - 4 - n);
    return w;
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

double torus_test(const Eigenvalues& m) {
    std::complex<double> product = 1;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j) product *= m[i] * m[j] - 1.0;
    return product.real();
}

std::optional<std::complex<double>> BranchNode::unit_pair() const {
    for (const auto& m : multipliers)
        if (m.imag() > least_imaginary && std::abs(elementary::modulus(m) - 1) < on_circle)
            return m;
    return std::nullopt;
}

CurveEquations as_curve(const OrbitEquations& equations) {
    return [&equations](const Unknowns& z, Eigen::VectorXd& residual, Eigen::MatrixXd* J) {
        auto values = equations.values(z, J);
        if (!values) return false;
        residual = std::move(values->residual);
        return true;
    };
}

std::optional<BranchNode> node_of(const OrbitEquations& equations, std::optional<CurvePoint> at) {
    if (!at) return std::nullopt;
    const auto values = equations.values(at->z);
    if (!values) return std::nullopt;
    const Eigenvalues m = eigenvalues_of(values->transfer);
    const double fold = at->tangent(at->tangent.size() - 1);
    return BranchNode{std::move(*at), values->approach, m, fold, doubling_test(m), torus_test(m)};
}

std::optional<BranchNode> node_after(
    const OrbitEquations& equations, const CurvePoint& a, double h) {
    const Eigen::VectorXd guess = a.z + h * a.tangent;
    return node_of(
        equations, point_in_plane(as_curve(equations), guess, a.tangent, a.tangent.dot(a.z) + h));
}

std::optional<BranchNode> node_at_parameter(
    const OrbitEquations& equations, const Unknowns& z, double parameter, int direction) {
    const Eigen::VectorXd along = direction * Eigen::VectorXd::Unit(z.size(), z.size() - 1);
    Unknowns guess = z;
    guess(z.size() - 1) = parameter;
    return node_of(
        equations, point_in_plane(as_curve(equations), guess, along, direction * parameter));
}

bool repeats_itself(const OrbitEquations& equations, const Unknowns& z) {
    const auto half = halved(equations.sequence());
    const auto n = half ? static_cast<Eigen::Index>(half->size()) : 0;
    return n > 0 && (z.segment(4, n) - z.segment(4 + n, n)).cwiseAbs().maxCoeff() < equal_halves;
}

std::optional<Relative> doubled_branch(const OrbitEquations& equations, const BranchNode& node) {
    const std::size_t n = equations.sequence().size();
    const OrbitEquations doubled(
        equations.sequence().doubled(), equations.family(), equations.length());
    const Unknowns z = twice(node.at.z, n);
    Eigen::VectorXd residual;
    Eigen::MatrixXd J;
    if (!as_curve(doubled)(z, residual, &J)) return std::nullopt;
    // The equations are neutral in two directions: along the branch, and away from it.
    Eigen::MatrixXd bordered(J.cols(), J.cols());
    bordered << J, twice(node.at.tangent, n).transpose();
    const CurvePoint from{z, smallest_singular_vector(bordered)};
    if (!from.tangent.allFinite()) return std::nullopt;
    for (const double h : first_arcs) {
        auto away = node_after(doubled, from, h);
        if (away && away->at.tangent.dot(from.tangent) > 0.5 &&
            !check_orbit(doubled, away->at.z, away->approach).fault)
            return Relative{doubled, std::move(*away)};
    }
    return std::nullopt;
}

std::optional<Relative> parent_orbit(
    const OrbitEquations& equations, const BranchNode& near, double within) {
    const auto sequence = halved(equations.sequence());
    if (!sequence) return std::nullopt;
    const auto n = static_cast<Eigen::Index>(sequence->size());
    const Unknowns& z = near.at.z;
    if (!((z.segment(4, n) - z.segment(4 + n, n)).cwiseAbs().maxCoeff() < similar_half))
        return std::nullopt;
    const OrbitEquations equations_of_half(*sequence, equations.family(), equations.length());
    Unknowns half(z.size() - n);
    half << z.head(4), 0.5 * (z.segment(4, n) + z.segment(4 + n, n)), z.tail(1);
    double p = near.parameter(), step = 1e-6;
    auto a = node_at_parameter(equations_of_half, half, p, 1);
    for (int k = 0; k < most_secants && a; ++k) {
        auto b = node_at_parameter(equations_of_half, a->at.z, p + step, 1);
        if (!b) return std::nullopt;
        p += step;
        const double change = b->doubling - a->doubling;
        step = change == 0 ? 0 : -b->doubling * step / change;
        a = std::move(b);
        if (!(std::abs(step) < 1)) return std::nullopt;
        if (std::abs(step) > last_secant) continue;
        if (!((twice(a->at.z, static_cast<std::size_t>(n)) - z).norm() < within))
            return std::nullopt;
        return Relative{equations_of_half, std::move(*a)};
    }
    return std::nullopt;
}

std::optional<OrbitStart> changed_sequence(
    const OrbitEquations& equations, const Unknowns& at, const SequenceFault& fault) {
    ImpactSequence sequence = equations.sequence();
    Unknowns z = at;
    auto k = static_cast<Eigen::Index>(fault.flight);
    const auto n = static_cast<Eigen::Index>(sequence.size());
    Unknowns next;
    if (fault.kind == SequenceFault::Kind::contact) {
        if (!(fault.s > 0 && fault.s < z(4 + k))) return std::nullopt;
        sequence.sides.insert(sequence.sides.begin() + k + 1, fault.side);
        next.resize(z.size() + 1);
        next << z.head(4 + k), fault.s, z(4 + k) - fault.s, z.tail(z.size() - 5 - k);
        return OrbitStart{sequence, next};
    }
    if (fault.kind != SequenceFault::Kind::missing || n < 2) return std::nullopt;
    if (k + 1 == n) {
        // The impact at which the sequence begins.
        z = equations.rotated(z);
        sequence = sequence.rotated();
        k = n - 2;
    }
    sequence.sides.erase(sequence.sides.begin() + k + 1);
    next.resize(z.size() - 1);
    next << z.head(4 + k), z(4 + k) + z(5 + k), z.tail(z.size() - 6 - k);
    return OrbitStart{sequence, next};
}

std::optional<Relative> beyond_grazing(
    const OrbitEquations& equations, const BranchNode& last, const SequenceFault& fault) {
    const auto changed = changed_sequence(equations, last.at.z, fault);
    if (!changed) return std::nullopt;
    const OrbitEquations next(changed->sequence, equations.family(), equations.length());
    Eigen::VectorXd residual;
    Eigen::MatrixXd J;
    if (!as_curve(next)(changed->z, residual, &J)) return std::nullopt;
    // Any vector that is not orthogonal to the tangent finds it.
    const auto tangent = tangent_of(J, Eigen::VectorXd::LinSpaced(changed->z.size(), 0.3, 1.1));
    if (!tangent) return std::nullopt;
    for (const double h : first_arcs)
        for (const double side : {1.0, -1.0}) {
            auto node = node_after(next, {changed->z, side * *tangent}, h);
            if (node && !check_orbit(next, node->at.z, node->approach).fault)
                return Relative{next, std::move(*node)};
        }
    return std::nullopt;
}

}  // namespace vines
