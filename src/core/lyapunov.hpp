// Transient Lyapunov exponents of a sequence of transfer matrices, by three estimators.
//
//   qr           Benettin's: orthonormal deviations carried by T_i = M_i J_i (30), a QR factorisation at every impact.
//                The reference.
//   eigenvalues  ln|eigenvalues of T_n ... T_1| / T, eq. (33), all four moduli right over any window: the largest
//                eigenvalue of each compound matrix of the product (its k-th compound has the k-fold products of its
//                eigenvalues), each product scaled as it grows.
//   raw_product  (33) as the paper computed it: the product in double precision, unscaled. After a while it is a matrix
//                of rank one plus rounding: its third and fourth "exponents" are lambda1 - ln(1/2.2e-16)/T, the
//                rounding floor, and near T = 709/lambda1 it overflows.
//
// Sum rule, exact from impact to impact while nothing sticks: the four exponents add up to
// -2 zeta + 2/T * (sum of ln R over the impacts). Its residual checks `qr`.
//
// A stick leaves only the deviations of the centre of mass (rank 2), an impact with R = 0 leaves none of x - y (rank 3):
// from there on the exponents beyond the rank are minus infinity.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/transfer.hpp"

namespace vines {

using Exponents = std::array<double, 4>;  ///< per unit of tau; -infinity beyond the rank, NaN where not converged

/// ok: a number; minus_infinity: rank was lost; not_converged: fewer than two impacts in the window, or a product beyond
/// the range of double (raw_product).
enum class Status { ok, minus_infinity, not_converged };
Status status_of(double exponent);

struct ExponentHistory {
    std::vector<double> tau;
    std::vector<Exponents> lambda;  ///< of the window from its first impact to tau
};

/// Standard errors of the four exponents from the means of up to 20 blocks of equal length; NaN with fewer than 8 blocks of
/// at least 4 entries of the history each, and where there is no number.
Exponents standard_error(const ExponentHistory& history, double start);

/// What a finite run says about the sign of lambda1. chaotic or regular: at least `verdict_sigmas` standard errors from zero.
enum class Verdict { chaotic, regular, not_decided };
inline constexpr double verdict_sigmas = 3;
/// `error` as of standard_error(); NaN: not decided.
Verdict verdict_of(double lambda1, double error);

/// Which estimators to run, and how many entries their histories may have (at least 256). Longer ones are thinned to
/// every second, fourth, ... impact; `eigenvalues` keeps at most 2048, for each costs three eigenvalue problems.
struct ExponentOptions {
    bool qr = true, eigenvalues = true, raw_product = true;
    std::size_t history = 20000;
};

/// The product of the transfer matrices of one window, as the estimators see it.
class TransferProduct {
public:
    explicit TransferProduct(const ExponentOptions& options);
    ~TransferProduct();
    TransferProduct(TransferProduct&&) noexcept;

    /// Starts the window at the impact at tau (whose own matrices do not belong to it).
    void start(double tau);
    /// J over a flight, or over flights and stuck phases (then rank is 2), followed by the impact's M at tau.
    void append(const Matrix4& J, int rank, const Saltation& M, double R, double tau);

    double start_tau() const { return start_; }
    double end_tau() const { return end_; }
    long impacts() const { return impacts_; }        ///< of the window, the first included
    int rank() const { return rank_; }
    /// |sum of qr's exponents - the sum rule|, dimensionless; NaN without qr, rank 4 or two impacts.
    double sum_rule_residual(double zeta) const;
    /// The exponents at the last impact; NaN where there are none.
    Exponents qr() const;
    Exponents eigenvalues() const;
    Exponents raw_product() const;
    const ExponentHistory& qr_history() const;
    const ExponentHistory& eigenvalues_history() const;
    const ExponentHistory& raw_product_history() const;

private:
    struct Qr;
    struct Compounds;
    struct Raw;
    double start_ = 0, end_ = 0, log_det_impacts_ = 0;
    long impacts_ = 0;
    int rank_ = 4;
    std::unique_ptr<Qr> qr_;
    std::unique_ptr<Compounds> compounds_;
    std::unique_ptr<Raw> raw_;
};

/// The exponent that rounding puts in place of a smaller one in raw_product: lambda1 - ln(1/2.2e-16)/T.
double rounding_floor(double lambda1, double T);

/// Feeds the matrices of a run into a product, from the first impact at or after tau_start to the last at or before tau_end.
class Lyapunov : public Observer {
public:
    Lyapunov(const Parameters& parameters, double tau_start, double tau_end, const ExponentOptions& options);

    void on_stretch(const Stretch&) override;
    void on_impact(const Impact&) override;

    const TransferProduct& product() const { return product_; }

private:
    const Parameters parameters_;
    const double tau_start_, tau_end_;
    Passage since_impact_;
    TransferProduct product_;
};

}  // namespace vines
