#include "core/measurement/joint_equations.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/measurement/robust.hpp"

namespace vines {

namespace {

constexpr Eigen::Index globals = unknowns, sensed = sensed_unknowns;
// Entries of a column: an interval is coupled with two others, five times and all globals.
constexpr int entries_of_column = 32;
// Relative to the ridge of the intervals: times in tau are far larger than positions in m.
constexpr double ridge_of_others = 1e-4;

}  // namespace

JointEquations::JointEquations(std::size_t intervals, double ridge)
    : ridge_(ridge),
      intervals_(static_cast<Eigen::Index>(intervals)),
      size_(3 * intervals_ - 1 + globals),
      own_(intervals),
      matrix_(size_, size_),
      right_(Eigen::VectorXd::Zero(size_)) {}

double& JointEquations::entry(Eigen::Index row, Eigen::Index column) {
    // Not in the constructor: a copy of a matrix has no space for entries.
    if (matrix_.isCompressed())
        matrix_.reserve(Eigen::VectorXi::Constant(size_, entries_of_column));
    return matrix_.coeffRef(row, column);
}

void JointEquations::add(
    std::size_t interval, const Eigen::RowVector2d& by_start, const UnknownRow& by_unknowns,
    double left, double weight, const Eigen::VectorXd* by_effects) {
    OfInterval& e = own_[interval];
    e.N.noalias() += weight * by_start.transpose() * by_start;
    e.C.noalias() += weight * by_start.transpose() * by_unknowns;
    e.g.noalias() += (weight * left) * by_start.transpose();
    N_.noalias() += weight * by_unknowns.transpose() * by_unknowns;
    g_.noalias() += (weight * left) * by_unknowns.transpose();
    if (!by_effects) return;
    effects.mixed.middleRows<2>(start_of(interval)) +=
        weight * by_start.transpose() * by_effects->transpose();
    effects.mixed.middleRows<sensed>(unknown_at(0)) +=
        weight * by_unknowns.transpose() * by_effects->transpose();
    add_squares(*by_effects, left, weight);
}

void JointEquations::collect_effects(Eigen::Index sizes) {
    effects.mixed = Eigen::MatrixXd::Zero(size_, sizes);
    effects.squares = Eigen::MatrixXd::Zero(sizes, sizes);
    effects.right = Eigen::VectorXd::Zero(sizes);
}

void JointEquations::add_squares(const Eigen::VectorXd& by_effects, double left, double weight) {
    effects.squares.selfadjointView<Eigen::Lower>().rankUpdate(by_effects, weight);
    effects.right += weight * left * by_effects;
}

void JointEquations::add(
    const std::vector<Term>& row, double left, double weight, const Eigen::VectorXd* by_effects) {
    if (by_effects) add_squares(*by_effects, left, weight);
    for (const Term& a : row) {
        if (by_effects) effects.mixed.row(a.at) += weight * a.by * by_effects->transpose();
        right_(a.at) += weight * a.by * left;
        for (const Term& b : row)
            if (b.at <= a.at) entry(a.at, b.at) += weight * a.by * b.by;
    }
}

void JointEquations::append(
    const UnknownRow& by_unknowns, double times, std::vector<Term>& row) const {
    for (std::size_t k = 0; k < sensed_unknowns; ++k) {
        const double by = by_unknowns(static_cast<Eigen::Index>(k));
        if (by != 0) row.push_back({unknown_at(k), times * by});
    }
}

void JointEquations::gather() {
    const Eigen::Index first = unknown_at(0);
    for (std::size_t i = 0; i < own_.size(); ++i) {
        const Eigen::Index at = start_of(i);
        for (Eigen::Index j = 0; j < 2; ++j) {
            right_(at + j) += own_[i].g(j);
            for (Eigen::Index k = 0; k <= j; ++k) entry(at + j, at + k) += own_[i].N(j, k);
            for (Eigen::Index k = 0; k < sensed; ++k) entry(first + k, at + j) += own_[i].C(j, k);
        }
    }
    for (Eigen::Index j = 0; j < sensed; ++j) {
        right_(first + j) += g_(j);
        for (Eigen::Index k = 0; k <= j; ++k) entry(first + j, first + k) += N_(j, k);
    }
    for (Eigen::Index k = 0; k < size_; ++k)
        entry(k, k) += k < 2 * intervals_ ? ridge_ : ridge_of_others * ridge_;
}

namespace {

/// Diagonal of the inverse Z of L D L^T from the entries of Z on the pattern of L, last column
/// first (Takahashi, Fagan and Chen, 1973): Z = D^-1 L^-1 + (1 - L^T) Z. The rows of a column are
/// in ascending order, and a column's rows below row i are among the rows of column i.
Eigen::VectorXd inverse_diagonal(const Eigen::SparseMatrix<double>& L, const Eigen::VectorXd& D) {
    const int *begin = L.outerIndexPtr(), *row = L.innerIndexPtr();
    const double* l = L.valuePtr();
    std::vector<double> z(static_cast<std::size_t>(L.nonZeros()));
    Eigen::VectorXd diagonal(D.size());
    std::vector<double> sums;
    for (Eigen::Index j = D.size(); j-- > 0;) {
        const int first = begin[j], last = begin[j + 1];
        sums.assign(static_cast<std::size_t>(last - first), 0);
        for (int a = first; a < last; ++a) {
            sums[static_cast<std::size_t>(a - first)] += l[a] * diagonal(row[a]);
            int q = begin[row[a]];
            for (int b = a + 1; b < last; ++b) {
                while (row[q] < row[b]) ++q;
                const double mixed = z[static_cast<std::size_t>(q)];
                sums[static_cast<std::size_t>(a - first)] += l[b] * mixed;
                sums[static_cast<std::size_t>(b - first)] += l[a] * mixed;
            }
        }
        diagonal(j) = 1 / D(j);
        for (int a = first; a < last; ++a) {
            z[static_cast<std::size_t>(a)] = -sums[static_cast<std::size_t>(a - first)];
            diagonal(j) -= l[a] * z[static_cast<std::size_t>(a)];
        }
    }
    return diagonal;
}

}  // namespace

bool JointEquations::solve() {
    gather();
    matrix_.makeCompressed();
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix_);
    matrix_ = {};
    if (solver.info() != Eigen::Success) return false;
    step = solver.solve(right_);
    if (effects.mixed.size() > 0) effects.solved = solver.solve(effects.mixed);
    const Eigen::VectorXd variances =
        inverse_diagonal(solver.matrixL().nestedExpression(), solver.vectorD());
    const auto error_of = [&](Eigen::Index entry) {
        return std::sqrt(variances(solver.permutationP().indices()(entry)));
    };
    for (std::size_t k = 0; k < unknowns; ++k) errors[k] = error_of(unknown_at(k));
    for (std::size_t k = 0; k + 1 < own_.size(); ++k) time_errors.push_back(error_of(time_of(k)));
    return step.allFinite() && variances.allFinite();
}

namespace {

// Lower bounds relative to the typical jump and the typical approach speed: no real impact follows
// eqs. (36) and (4) more closely.
constexpr double least_momentum = 2e-4, least_restitution = 5e-4;

using Borders = std::vector<FittedBorder>;

/// The flight of the mass between impacts p and p + 1.
class MassFlight {
public:
    MassFlight(const JointFitState& state, const Borders& impacts, std::size_t p)
        : p_(p),
          duration_(impacts[p + 1].tau - impacts[p].tau),
          walls_(impacts[p + 1].side - impacts[p].side),
          y_dot_(
              (impacts[p + 1].x - impacts[p].x - state.fit.values[Unknown::b] * walls_) /
              duration_),
          // Moving an impact's time also changes x there.
          by_first_((y_dot_ - impacts[p].x_dot_after) / duration_),
          by_last_((impacts[p + 1].x_dot_after - y_dot_) / duration_) {}

    double y_dot() const { return y_dot_; }
    /// Appends the derivatives of y', multiplied by `times`.
    void add_to(
        std::vector<JointEquations::Term>& row, const JointFitState& state, double times) const {
        const JointEquations& e = state.equations;
        row.push_back({e.start_of(p_ + 1), -times / duration_});
        row.push_back({e.start_of(p_ + 2), times / duration_});
        row.push_back({e.time_of(p_), times * by_first_});
        row.push_back({e.time_of(p_ + 1), times * by_last_});
        if (walls_ != 0 && !state.fit.fixed[Unknown::b])
            row.push_back({e.unknown_at(Unknown::b), -times * walls_ / duration_});
    }

private:
    const std::size_t p_;
    const double duration_, walls_, y_dot_, by_first_, by_last_;
};

/// Residuals of momentum and restitution at an impact, in m per unit of tau.
struct MassResidual {
    std::size_t impact;
    double momentum, restitution;
    double jump, approach;   ///< jump of x', and x' - y' before the impact
    double R, R_derivative;  ///< R w, over w and by w = |approach|
};

/// Residuals of the impacts whose flights on both sides are known.
std::vector<MassResidual> mass_residuals(const JointFitState& state, const Borders& impacts) {
    std::vector<MassResidual> residuals;
    for (std::size_t i = 1; i + 1 < impacts.size(); ++i) {
        const FittedBorder& m = impacts[i];
        if (!m.flies || impacts[i - 1].side == 0 || impacts[i + 1].side == 0) continue;
        const double before = MassFlight(state, impacts, i - 1).y_dot() + m.braked_before,
                     after = MassFlight(state, impacts, i).y_dot() + m.braked_after,
                     approach = m.x_dot_before - before, w = std::abs(approach),
                     fitted = state.fit.values[restitution_at(m.side)];
        const Parameters& p = state.parameters;
        const bool is_given = p.table_of(m.side) != nullptr;
        const double R = is_given ? p.restitution(m.side, w) : fitted,
                     derivative = is_given ? p.restitution_derivative(m.side, w) : fitted;
        residuals.push_back(
            {i, m.jump() + state.fit.epsilon * (after - before),
             m.x_dot_after - after + R * approach, m.jump(), approach, R, derivative});
    }
    return residuals;
}

/// Adds the equations of one impact. Weights are inverse variances.
void add_mass_rows(
    JointFitState& state, const Borders& impacts, const MassResidual& r, double momentum_weight,
    double restitution_weight) {
    JointEquations& e = state.equations;
    const std::size_t i = r.impact;
    const FittedBorder& m = impacts[i];
    const Unknown wall = restitution_at(m.side);
    const MassFlight first(state, impacts, i - 1), second(state, impacts, i);
    Eigen::VectorXd by_effects;
    const auto add = [&](double by_after, double by_before, double by_first, double by_second,
                         double by_R, double residual, double weight) {
        if (state.effects) {
            by_effects = by_before * m.before_by_effects;
            by_effects(state.effects->first_of(Effect::friction)) +=
                by_first * state.effects->flight(i - 1, -1) +
                by_second * state.effects->flight(i, 1);
            by_effects(state.effects->first_of(Effect::R_varies)) +=
                by_R * (std::abs(r.approach) - state.effects->mean_speed);
            if (const Eigen::Index at = state.effects->first_of(Effect::given_mass_ratio); at >= 0)
                by_effects(at) +=
                    by_second == state.fit.epsilon ? (r.momentum - r.jump) / state.fit.epsilon : 0;
        }
        std::vector<JointEquations::Term> row = {
            {e.start_of(i + 1) + 1, by_after},
            {e.start_of(i), by_before * m.before_by_start(0)},
            {e.start_of(i) + 1, by_before * m.before_by_start(1)},
            {e.time_of(i), by_after * m.x_ddot_after + by_before * m.x_ddot_before}};
        e.append(m.before_by_unknowns, by_before, row);
        first.add_to(row, state, by_first);
        second.add_to(row, state, by_second);
        if (by_R != 0 && !state.fit.fixed[wall]) row.push_back({e.unknown_at(wall), by_R});
        e.add(row, -residual, weight, state.effects ? &by_effects : nullptr);
    };
    const double R = r.R_derivative, epsilon = state.fit.epsilon;
    add(1, -1, -epsilon, epsilon, 0, r.momentum, momentum_weight);
    add(1, R, -R, -1, r.approach, r.restitution, restitution_weight);
}

}  // namespace

void add_mass_flights(JointFitState& state, const Borders& borders) {
    const std::vector<MassResidual> residuals = mass_residuals(state, borders);
    const auto jump = [](const MassResidual& r) { return std::abs(r.jump); };
    const auto speed = [](const MassResidual& r) { return std::abs(r.approach); };
    const std::vector<double> speeds = values_of(residuals, speed);
    if (state.effects && !speeds.empty())
        state.effects->mean_speed =
            std::accumulate(speeds.begin(), speeds.end(), 0.0) / static_cast<double>(speeds.size());
    // The scatter of the residuals, with a lower bound since no wall is perfectly constant.
    const double of_momentum = std::max(
                     robust_deviation(values_of(residuals, &MassResidual::momentum)),
                     least_momentum * median(values_of(residuals, jump))),
                 of_restitution = std::max(
                     robust_deviation(values_of(residuals, &MassResidual::restitution)),
                     least_restitution * median(speeds));
    for (const MassResidual& r : residuals)
        add_mass_rows(
            state, borders, r, state.weight(r.momentum, of_momentum, of_momentum),
            state.weight(r.restitution, of_restitution, of_restitution));
}

}  // namespace vines
