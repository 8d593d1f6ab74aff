// Finite-time Lyapunov exponents of a sequence of transfer matrices, by three estimators.
//
//   qr           Benettin: growth of the length, area, volume and determinant spanned by one to
//                four deviations under T_i = M_i J_i (30), which is the diagonal of R in a QR
//                factorisation at every impact. The reference.
//   eigenvalues  ln|eigenvalues of T_n ... T_1| / T, eq. (33), all four accurate over any window:
//                the largest eigenvalue of each exterior power of the product (PowerProduct).
//   raw_product  (33) as the paper computed it: the product in double precision, unscaled. It soon
//                becomes a matrix of rank one plus rounding, and near T = 709/lambda1 it overflows.
//
// Sum rule, exact from impact to impact without sticking: the four exponents sum to -2 zeta + 1/T *
// (sum of ln |det M| over the impacts), R^2 for a constant R.
//
// Sticking leaves only the deviations of the centre of mass (rank 2); an impact with R = 0 removes
// that of x - y (rank 3). From then on the exponents beyond the rank are minus infinity.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/stability/exterior.hpp"

namespace vines {

/// Exponents per unit of tau; -infinity beyond the rank, NaN if not converged.
using Exponents = std::array<double, 4>;
inline constexpr Exponents no_exponents = {nan, nan, nan, nan};

/// minus_infinity: rank was lost; not_converged: fewer than two impacts, or overflow (raw_product).
enum class Status { ok, minus_infinity, not_converged };
Status status_of(double exponent);

/// Fewest entries that a history holds before it is thinned.
inline constexpr std::size_t shortest_history = 256;
/// Limit for the history of `eigenvalues`: each entry needs three eigenvalue problems.
inline constexpr std::size_t most_eigenvalue_entries = 2048;

struct ExponentHistory {
    std::vector<double> tau;
    std::vector<Exponents> lambda;  ///< over the window from its first impact to tau

    /// Stride to the shortest history of the run, the one that conclusions use.
    std::size_t coarse_stride() const;
};

/// Estimators to run, and length of their histories (at least shortest_history; 0: only the
/// shortest history of qr). `eigenvalues` keeps at most most_eigenvalue_entries.
struct ExponentOptions {
    bool qr = false, eigenvalues = false, raw_product = false;
    std::size_t history = 20000;
};

/// Sufficient for verdicts, regimes and standard errors.
inline constexpr ExponentOptions qr_alone = {.qr = true, .history = shortest_history};
inline constexpr ExponentOptions all_estimators = {
    .qr = true, .eigenvalues = true, .raw_product = true};

/// The product of the transfer matrices of one window, with its estimators.
class TransferProduct {
public:
    TransferProduct(double epsilon, const ExponentOptions& options);
    ~TransferProduct();
    TransferProduct(TransferProduct&&) noexcept;

    /// Starts the window at the impact at tau, whose own matrices are not part of it.
    void start(double tau) { start_ = end_ = tau, impacts_ = 1; }
    /// Appends the legs from the previous impact to the one at tau, and its M.
    void append(std::span<const Leg> legs, const Saltation& M, double tau);
    /// Projects the deviations onto those of the centre of mass, as a sticking phase does.
    void end_sticking();

    const ExponentOptions& options() const { return options_; }
    double start_tau() const { return start_; }
    double end_tau() const { return end_; }
    long impacts() const { return impacts_; }  ///< in the window, including the first
    int rank() const { return rank_; }
    /// Largest error of qr (lyapunov.cpp), per unit of tau; NaN without qr or with one impact.
    double sum_rule_residual() const;
    /// At the last impact, descending; NaN if unavailable. In qr(), NaN from the first exponent on
    /// whose error can exceed `most_residual`.
    Exponents qr() const;
    Exponents eigenvalues() const;
    Exponents raw_product() const;
    const ExponentHistory& qr_history() const;
    const ExponentHistory& eigenvalues_history() const;
    const ExponentHistory& raw_product_history() const;

private:
    struct Estimators;
    const double epsilon_;
    const ExponentOptions options_;
    double start_ = 0, end_ = 0;
    long impacts_ = 0;
    int rank_ = 4;
    std::unique_ptr<Estimators> estimators_;
};

/// Largest residual of an exponent that is still reported (TransferProduct::qr), per unit of tau.
inline constexpr double most_residual = 1e-6;

/// Value of the smaller exponents of raw_product due to rounding: lambda1 - ln(1/2.2e-16)/T.
double rounding_floor(double lambda1, double T);

/// Feeds the matrices from the first impact in a window to the last into a product.
class Lyapunov : public TransferObserver {
public:
    Lyapunov(const Parameters& parameters, const Interval& window, const ExponentOptions& options)
        : TransferObserver(parameters, window),
          product_(parameters.epsilon, options) {}

    /// Call these after the run.
    const TransferProduct& product();
    TransferProduct take() {
        product();
        return std::move(product_);
    }

private:
    void on_first_impact(const Impact& impact) override {
        product_.start(impact.tau);
        side_ = impact.side;
    }
    void on_transfer(const Impact&, const Saltation& M, std::span<const Leg> legs) override;

    TransferProduct product_;
    /// The last impacts are the end of a chatter, whose large entries of M let rounding separate
    /// the deviations: a window that ends there gets its exponents by end_sticking().
    bool chatters_ = false;
    bool steep_ = false;  ///< the last M has such entries
    int side_ = 0;
};

/// Exponents of many windows of one run; each window receives events only while it is open.
class WindowedExponents : public Observer {
public:
    WindowedExponents(const Parameters& parameters, const ExponentOptions& options)
        : parameters_(parameters),
          options_(options) {}
    /// Adds a window; call it before the run. Products are numbered in the order of these calls.
    void add(const Interval& window) { windows_.emplace_back(parameters_, window, options_); }

    void on_stretch(const Stretch& stretch) override {
        for (Lyapunov* w : open_) w->on_stretch(stretch);
    }
    void on_slip(const Slip& slip) override {
        for (Lyapunov* w : open_) w->on_slip(slip);
    }
    void on_impact(const Impact&) override;

    std::size_t size() const { return windows_.size(); }
    /// Call these after the run.
    const TransferProduct& product(std::size_t i) { return windows_[i].product(); }
    TransferProduct take(std::size_t i) { return windows_[i].take(); }

private:
    const Parameters parameters_;
    const ExponentOptions options_;
    std::vector<Lyapunov> windows_;
    // Windows not yet open, latest start first; filled at the first impact.
    std::vector<Lyapunov*> waiting_;
    std::vector<Lyapunov*> open_;
    bool begun_ = false;
};

}  // namespace vines
