// Transient Lyapunov exponents of a sequence of transfer matrices, by three estimators.
//
//   qr           Benettin's: how length, area, volume and determinant of one to four deviations
//                grow that are carried by T_i = M_i J_i (30): as the diagonal of R in a QR
//                factorisation at every impact. The reference.
//   eigenvalues  ln|eigenvalues of T_n ... T_1| / T, eq. (33), all four moduli right over any
//                window: the largest eigenvalue of each exterior power of the product (the k-th
//                has the k-fold products of its eigenvalues), each product scaled as it grows.
//   raw_product  (33) as the paper computed it: the product in double precision, unscaled. After a
//                while it is a matrix of rank one plus rounding: its third and fourth "exponents"
//                are lambda1 - ln(1/2.2e-16)/T, the rounding floor, and near T = 709/lambda1 it
//                overflows.
//
// Sum rule, exact from impact to impact while nothing sticks: the four exponents add up to
// -2 zeta + 2/T * (sum of ln R over the impacts).
//
// A stick leaves only the deviations of the centre of mass (rank 2), an impact with R = 0 leaves
// none of x - y (rank 3): from there on the exponents beyond the rank are minus infinity, and the
// rule says nothing. At rank 4 the determinants of the flights, multiplied up, are held against it.
// At any rank what rounding may have changed is added up where M magnifies it (near grazing, or
// with a tiny R), and the deviation must lie in the plane of the area, and that in the space of the
// volume (exterior.hpp, Flag), though each is carried by itself.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/stability/transfer.hpp"

namespace vines {

/// Per unit of tau; -infinity beyond the rank, NaN where not converged.
using Exponents = std::array<double, 4>;

/// ok: a number; minus_infinity: rank was lost; not_converged: fewer than two impacts in the
/// window, or a product beyond the range of double (raw_product).
enum class Status { ok, minus_infinity, not_converged };
Status status_of(double exponent);

/// A history holds at least so many entries before it is thinned.
inline constexpr std::size_t shortest_history = 256;
/// Of `eigenvalues`: each costs three eigenvalue problems.
inline constexpr std::size_t most_eigenvalue_entries = 2048;

struct ExponentHistory {
    std::vector<double> tau;
    std::vector<Exponents> lambda;  ///< of the window from its first impact to tau

    /// Every how many entries the shortest history of the same run would hold: what is concluded
    /// from a history rests on those alone, and so does not depend on how long it was asked to be.
    std::size_t coarse_stride() const;
};

/// Which estimators to run, and how many entries their histories may have (at least
/// shortest_history; 0: none but qr's shortest one, which its standard error rests on). Longer ones
/// are thinned to every second, fourth, ... impact; `eigenvalues` keeps at most
/// most_eigenvalue_entries.
struct ExponentOptions {
    bool qr = false, eigenvalues = false, raw_product = false;
    std::size_t history = 20000;
};

/// What verdicts, regimes and standard errors rest on, where no history is shown.
inline constexpr ExponentOptions qr_alone = {.qr = true, .history = shortest_history};
inline constexpr ExponentOptions all_estimators = {
    .qr = true, .eigenvalues = true, .raw_product = true};

/// The product of the transfer matrices of one window, as the estimators see it.
class TransferProduct {
public:
    TransferProduct(double epsilon, const ExponentOptions& options);
    ~TransferProduct();
    TransferProduct(TransferProduct&&) noexcept;

    /// Starts the window at the impact at tau (whose own matrices do not belong to it).
    void start(double tau);
    /// The legs from the impact before to the impact at tau, and its M.
    void append(std::span<const Leg> legs, const Saltation& M, double tau);

    double start_tau() const { return start_; }
    double end_tau() const { return end_; }
    long impacts() const { return impacts_; }  ///< of the window, the first included
    int rank() const { return rank_; }
    /// By how much qr misses the sum rule (at rank 4), or its parts have come apart, or, if that is
    /// more than `most_residual`, rounding may have changed them: the largest, per unit of tau. NaN
    /// without qr or two impacts.
    double sum_rule_residual() const;
    /// The exponents at the last impact, descending; NaN where there are none, or from the first on
    /// that may be wrong by more than `most_residual`.
    Exponents qr() const;
    Exponents eigenvalues() const;
    Exponents raw_product() const;
    const ExponentHistory& qr_history() const;
    const ExponentHistory& eigenvalues_history() const;
    const ExponentHistory& raw_product_history() const;

private:
    struct Qr;
    struct Powers;
    struct Raw;
    const double epsilon_;
    double start_ = 0, end_ = 0;
    long impacts_ = 0;
    int rank_ = 4;
    std::unique_ptr<Qr> qr_;
    std::unique_ptr<Powers> powers_;
    std::unique_ptr<Raw> raw_;
};

/// An exponent whose sum rule misses by more is not shown (TransferProduct::qr).
inline constexpr double most_residual = 1e-6;

/// The exponent that rounding puts in place of a smaller one in raw_product:
/// lambda1 - ln(1/2.2e-16)/T.
double rounding_floor(double lambda1, double T);

/// Feeds the matrices of a run into a product, from the first impact at or after tau_start to the
/// last at or before tau_end.
class Lyapunov : public Observer {
public:
    Lyapunov(
        const Parameters& parameters, double tau_start, double tau_end,
        const ExponentOptions& options);

    void on_stretch(const Stretch&) override;
    void on_impact(const Impact&) override;

    const TransferProduct& product() const { return product_; }
    /// After the run.
    TransferProduct take() { return std::move(product_); }

private:
    const Parameters parameters_;
    const double tau_start_, tau_end_;
    Passage since_impact_;
    TransferProduct product_;
};

}  // namespace vines
