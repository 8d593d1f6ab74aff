#include "core/continuation/branch_node.hpp"

#include <cmath>
#include <span>

namespace vines {

namespace {

// A multiplier with a smaller imaginary part counts as real; moduli of a pair on the unit circle
// differ from 1 by less than `on_circle`.
constexpr double least_imaginary = 1e-7, on_circle = 1e-6;
// Arclengths of the first step onto another branch, in the order of trial.
constexpr double first_arcs[] = {1e-3, 1e-4, 1e-2, 1e-5, 1e-6};
// The same past the birth of a sticking phase: grazing contacts accumulate there.
constexpr double shortest_first[] = {1e-7, 1e-6, 1e-5, 1e-4, 1e-3};
// Largest residual of an orbit's equations.
constexpr double largest_residual = 1e-10;
// Two halves of an orbit are equal up to this.
constexpr double equal_halves = 1e-6;
// Secant steps towards a doubling, and the step after which only rounding remains.
constexpr int most_secants = 20;
constexpr double last_secant = 1e-15;

double doubling_test(const Eigenvalues& m) {
    std::complex<double> product = 1;
    for (const auto& value : m) product *= value + 1.0;
    return product.real();
}

/// The node at a point; empty without one, or if it is no orbit.
std::optional<BranchNode> node_of(
    std::shared_ptr<const OrbitEquations> equations, std::optional<CurvePoint> at) {
    if (!at) return std::nullopt;
    const auto values = equations->values(at->z);
    // Next to grazing a return map has no derivative: Newton's method can end beside the orbit.
    if (!values || !(values->residual.cwiseAbs().maxCoeff() < largest_residual))
        return std::nullopt;
    const Eigenvalues m = eigenvalues_of(values->transfer);
    const double fold = at->tangent(at->tangent.size() - 1);  // changes sign at one
    return BranchNode{std::move(equations), std::move(*at), values->approach, m, fold,
                      doubling_test(m),     torus_test(m)};
}

/// The node at arclength h from a, in the direction of its tangent.
std::optional<BranchNode> node_after(
    const std::shared_ptr<const OrbitEquations>& equations, const CurvePoint& a, double h) {
    const Eigen::VectorXd guess = a.z + h * a.tangent;
    return node_of(
        equations, point_in_plane(as_curve(*equations), guess, a.tangent, a.tangent.dot(a.z) + h));
}

/// The first result of use(node) for steps from a guess along the branch, in both directions.
template <class Use>
std::optional<BranchNode> next_to(
    const OrbitGuess& guess, std::span<const double> arcs, const Use& use) {
    Eigen::VectorXd residual;
    Eigen::MatrixXd J;
    if (!as_curve(*guess.equations)(guess.z, residual, &J)) return std::nullopt;
    // Any vector that is not orthogonal to the tangent finds it.
    const auto tangent = tangent_of(J, Eigen::VectorXd::LinSpaced(guess.z.size(), 0.3, 1.1));
    if (!tangent) return std::nullopt;
    for (const double h : arcs)
        for (const double side : {1.0, -1.0})
            if (auto node = node_after(guess.equations, {guess.z, side * *tangent}, h))
                if (std::optional<BranchNode> found = use(*node)) return found;
    return std::nullopt;
}

/// The node unless it is no orbit.
std::optional<BranchNode> checked(std::optional<BranchNode> node) {
    if (node && node->check().fault) node.reset();
    return node;
}

}  // namespace

double torus_test(const Eigenvalues& m) {
    std::complex<double> product = 1;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j) product *= m[i] * m[j] - 1.0;
    return product.real();
}

CurveEquations as_curve(const OrbitEquations& equations) {
    return [&equations](const Unknowns& z, Eigen::VectorXd& residual, Eigen::MatrixXd* J) {
        auto values = equations.values(z, J);
        if (!values) return false;
        residual = std::move(values->residual);
        return true;
    };
}

std::optional<std::complex<double>> BranchNode::unit_pair() const {
    for (const auto& m : multipliers)
        if (m.imag() > least_imaginary && std::abs(elementary::modulus(m) - 1) < on_circle)
            return m;
    return std::nullopt;
}

std::optional<BranchNode> BranchNode::after(double h) const { return node_after(equations, at, h); }

std::optional<BranchNode> node_at_parameter(
    const OrbitGuess& guess, double parameter, int direction) {
    Unknowns z = guess.z;
    const Eigen::VectorXd along = direction * Eigen::VectorXd::Unit(z.size(), z.size() - 1);
    z(z.size() - 1) = parameter;
    return node_of(
        guess.equations,
        point_in_plane(as_curve(*guess.equations), z, along, direction * parameter));
}

bool repeats_itself(const OrbitGuess& orbit) {
    const auto half = orbit.equations->half(orbit.z);
    return half && (half->equations->twice(half->z) - orbit.z).cwiseAbs().maxCoeff() < equal_halves;
}

std::optional<BranchNode> doubled_branch(const BranchNode& node) {
    const auto doubled = node.equations->doubled();
    const Unknowns z = node.equations->twice(node.at.z);
    Eigen::VectorXd residual;
    Eigen::MatrixXd J;
    if (!as_curve(*doubled)(z, residual, &J)) return std::nullopt;
    // The equations are neutral in two directions: along the branch, and away from it.
    Eigen::MatrixXd bordered(J.cols(), J.cols());
    bordered << J, node.equations->twice(node.at.tangent).transpose();
    const CurvePoint from{z, smallest_singular_vector(bordered)};
    if (!from.tangent.allFinite()) return std::nullopt;
    for (const double h : first_arcs) {
        auto away = node_after(doubled, from, h);
        if (away && away->at.tangent.dot(from.tangent) > 0.5 && !away->check().fault) return away;
    }
    return std::nullopt;
}

std::optional<BranchNode> parent_orbit(const BranchNode& near, double within) {
    const auto half = near.equations->half(near.at.z);
    if (!half) return std::nullopt;
    double p = near.parameter(), step = 1e-6;
    auto a = node_at_parameter(*half, p, 1);
    for (int k = 0; k < most_secants && a; ++k) {
        auto b = node_at_parameter(a->guess(), p + step, 1);
        if (!b) return std::nullopt;
        p += step;
        const double change = b->doubling - a->doubling;
        step = change == 0 ? 0 : -b->doubling * step / change;
        a = std::move(b);
        if (!(std::abs(step) < 1)) return std::nullopt;
        if (std::abs(step) > last_secant) continue;
        if (!((half->equations->twice(a->at.z) - near.at.z).norm() < within)) return std::nullopt;
        return a;
    }
    return std::nullopt;
}

std::optional<BranchNode> beyond_by_return(const BranchNode& last, bool sticking) {
    const auto from = last.equations->by_return(last.at.z, last.approach);
    if (!from) return std::nullopt;
    return next_to(*from, shortest_first, [&](const BranchNode& node) -> std::optional<BranchNode> {
        auto beyond = from->equations->by_return(node.at.z, node.approach);
        if (!beyond) return std::nullopt;
        const ImpactSequence& after = beyond->equations->sequence();
        if (after.is_like(last.equations->sequence())) return std::nullopt;
        if (sticking && after.sticks == 0) return std::nullopt;
        if (after.sticks == 0) {
            auto by_impacts = impacts_of(*beyond);
            if (by_impacts) beyond = std::move(by_impacts);
        }
        const int direction = node.parameter() > last.parameter() ? 1 : -1;
        return checked(node_at_parameter(*beyond, node.parameter(), direction));
    });
}

std::optional<BranchNode> beyond_event(const BranchNode& last, const SequenceFault& fault) {
    if (const auto changed = last.equations->changed(last.at.z, fault))
        return next_to(*changed, first_arcs, checked);
    const bool by_return = last.is_return() || fault.kind == SequenceFault::Kind::stick;
    return by_return ? beyond_by_return(last, false) : std::nullopt;
}

}  // namespace vines
