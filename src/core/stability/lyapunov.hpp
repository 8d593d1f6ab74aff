// Finite-time Lyapunov exponents of a sequence of transfer matrices, by three estimators.
//
//   qr           Benettin: growth of the length, area, volume and determinant spanned by one to
//                four deviations under T_i = M_i J_i (30), which is the diagonal of R in a QR
//                factorisation at every impact. The reference.
//   eigenvalues  ln|eigenvalues of T_n ... T_1| / T, eq. (33), all four moduli accurate over any
//                window: the largest eigenvalue of each exterior power of the product (the k-th has
//                the k-fold products of its eigenvalues), each product rescaled as it grows.
//   raw_product  (33) as the paper computed it: the product in double precision, unscaled. It soon
//                becomes a matrix of rank one plus rounding: its third and fourth "exponents" are
//                lambda1 - ln(1/2.2e-16)/T, the rounding floor, and near T = 709/lambda1 it
//                overflows.
//
// Sum rule, exact from impact to impact without sticking: the four exponents sum to -2 zeta + 1/T *
// (sum of ln |det M| over the impacts), R^2 for a constant R.
//
// Sticking leaves only the deviations of the centre of mass (rank 2); an impact with R = 0 removes
// that of x - y (rank 3). From then on the exponents beyond the rank are minus infinity, and the
// sum rule does not apply. At rank 4 the product of the flights' determinants is compared with it.
// At any rank, rounding that M magnifies (near grazing, or with a tiny R) is added up, and the
// deviation must lie in the plane of the area, and that plane in the space of the volume
// (exterior.hpp, Flag), although each is transported separately.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/stability/exterior.hpp"

namespace vines {

/// Exponents per unit of tau; -infinity beyond the rank, NaN if not converged.
using Exponents = std::array<double, 4>;
inline constexpr Exponents no_exponents = {nan, nan, nan, nan};

/// ok: a number; minus_infinity: rank was lost; not_converged: fewer than two impacts in the
/// window, or a product beyond the range of double (raw_product).
enum class Status { ok, minus_infinity, not_converged };
Status status_of(double exponent);

/// Fewest entries that a history holds before it is thinned.
inline constexpr std::size_t shortest_history = 256;
/// Limit for the history of `eigenvalues`: each entry needs three eigenvalue problems.
inline constexpr std::size_t most_eigenvalue_entries = 2048;

struct ExponentHistory {
    std::vector<double> tau;
    std::vector<Exponents> lambda;  ///< over the window from its first impact to tau

    /// Stride that reduces this history to the shortest history of the same run. Conclusions use
    /// only those entries and therefore do not depend on the requested length.
    std::size_t coarse_stride() const;
};

/// Estimators to run, and length of their histories (at least shortest_history; 0: only the
/// shortest history of qr, which its standard error needs). Longer histories are thinned to every
/// second, fourth, ... impact; `eigenvalues` keeps at most most_eigenvalue_entries.
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
    void start(double tau);
    /// Appends the legs from the previous impact to the one at tau, and its M.
    void append(std::span<const Leg> legs, const Saltation& M, double tau);
    /// Ends the window with the start of a sticking phase at its last impact: projects the
    /// deviations onto those of the centre of mass.
    void end_sticking();

    const ExponentOptions& options() const { return options_; }
    double start_tau() const { return start_; }
    double end_tau() const { return end_; }
    long impacts() const { return impacts_; }  ///< in the window, including the first
    int rank() const { return rank_; }
    /// Largest deviation of qr, per unit of tau: from the sum rule (at rank 4), between length,
    /// area and volume, and, if above `most_residual`, the accumulated rounding. NaN without qr or
    /// with fewer than two impacts.
    double sum_rule_residual() const;
    /// The exponents at the last impact, descending; NaN if unavailable. In qr(), NaN from the
    /// first exponent on whose error can exceed `most_residual`.
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

/// Observer that feeds the matrices of a run into a product, from the first impact at or after
/// tau_start to the last at or before tau_end.
class Lyapunov : public TransferObserver {
public:
    Lyapunov(
        const Parameters& parameters, double tau_start, double tau_end,
        const ExponentOptions& options)
        : TransferObserver(parameters, tau_start, tau_end),
          product_(parameters.epsilon, options) {}

    /// Call these after the run.
    const TransferProduct& product();
    TransferProduct take() {
        product();
        return std::move(product_);
    }

private:
    void on_first_impact(const Impact&) override;
    void on_transfer(const Impact&, const Saltation& M, std::span<const Leg> legs) override;

    TransferProduct product_;
    /// The last impacts are the end of a chatter: their large entries of M let rounding separate
    /// the deviations, until the sticking phase that follows projects them. A window that ends
    /// before that gets its exponents by the same projection.
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
    void add(double tau_start, double tau_end);

    void on_stretch(const Stretch&) override;
    void on_slip(const Slip&) override;
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
