#include "core/lyapunov.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/compound.hpp"

namespace vines {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr Exponents no_exponents = {nan, nan, nan, nan};

/// A history that thins itself: when full it drops every second entry and from then on takes every second impact.
class Thinned {
public:
    explicit Thinned(std::size_t capacity) : capacity_(std::max<std::size_t>(capacity, 256)) {}

    bool wants_next() const { return seen_ % stride_ == 0; }
    void skip() { ++seen_; }
    void push(double tau, const Exponents& lambda) {
        if (history_.tau.size() == capacity_) thin();
        if (!wants_next()) return skip();
        skip();
        history_.tau.push_back(tau);
        history_.lambda.push_back(lambda);
    }
    const ExponentHistory& history() const { return history_; }

private:
    void thin() {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < history_.tau.size(); i += 2, ++kept) {
            history_.tau[kept] = history_.tau[i];
            history_.lambda[kept] = history_.lambda[i];
        }
        history_.tau.resize(kept);
        history_.lambda.resize(kept);
        stride_ *= 2;
    }

    std::size_t capacity_, seen_ = 0, stride_ = 1;
    ExponentHistory history_;
};

/// logs / T, with -infinity beyond the rank.
Exponents per_time(const Exponents& logs, int rank, double T) {
    Exponents lambda;
    for (int k = 0; k < 4; ++k) lambda[k] = k >= rank ? -infinity : T > 0 ? logs[k] / T : nan;
    return lambda;
}

const ExponentHistory& none() {
    static const ExponentHistory empty;
    return empty;
}

}  // namespace

Status status_of(double exponent) {
    return std::isnan(exponent) ? Status::not_converged : std::isinf(exponent) ? Status::minus_infinity : Status::ok;
}

double rounding_floor(double lambda1, double T) { return lambda1 + std::log(std::numeric_limits<double>::epsilon()) / T; }

Exponents standard_error(const ExponentHistory& h, double start) {
    // Blocks are longer than the memory of the motion for a run of some hundred impacts, and 20 of them give the error to 16 %.
    const int blocks = std::min<int>(20, static_cast<int>(h.tau.size() / 4));
    if (blocks < 8) return no_exponents;
    const double length = (h.tau.back() - start) / blocks;
    std::vector<Exponents> means;
    double tau_before = start;
    Exponents log_before{};
    std::size_t i = 0;
    for (int block = 1; block <= blocks; ++block) {
        const double end = block == blocks ? h.tau.back() : start + block * length;
        const std::size_t from = i;
        while (i < h.tau.size() && h.tau[i] <= end) ++i;
        if (i == from || h.tau[i - 1] <= tau_before) continue;
        Exponents mean;
        for (int k = 0; k < 4; ++k) {
            const double log = h.lambda[i - 1][k] * (h.tau[i - 1] - start);
            mean[k] = (log - log_before[k]) / (h.tau[i - 1] - tau_before);
            log_before[k] = log;
        }
        tau_before = h.tau[i - 1];
        means.push_back(mean);
    }
    if (means.size() < 8) return no_exponents;
    const double n = static_cast<double>(means.size());
    Exponents error;
    for (int k = 0; k < 4; ++k) {
        double sum = 0, squares = 0;
        for (const Exponents& m : means) sum += m[k];
        for (const Exponents& m : means) squares += (m[k] - sum / n) * (m[k] - sum / n);
        error[k] = std::isfinite(sum) ? std::sqrt(squares / (n - 1) / n) : nan;
    }
    return error;
}

Verdict verdict_of(double lambda1, double error) {
    if (lambda1 > verdict_sigmas * error) return Verdict::chaotic;
    if (lambda1 < -verdict_sigmas * error) return Verdict::regular;
    return Verdict::not_decided;
}

struct TransferProduct::Qr {
    // Above this |r| (it is x''/(x'- - y'-)) the columns of M Q hide each other: a volume of them computed from the sums would
    // have a relative error of |r|^2 ulp. Below, that error is under 1e-12.
    static constexpr double steep = 100;

    explicit Qr(std::size_t history) : thinned(history) {}

    Matrix4 frame = Matrix4::Identity();
    Exponents growth = {1, 1, 1, 1};  // lengths since the last logarithm was taken
    Exponents logs{};
    Thinned thinned;

    void grow(int k, double length) {
        growth[k] *= length;
        if (!(growth[k] > 1e-100 && growth[k] < 1e100)) take_logarithm(k);
    }
    void take_logarithm(int k) {
        logs[k] += std::log(growth[k]);
        growth[k] = 1;
    }
    /// Leaves no trace, so that the result does not depend on how often it was asked for.
    Exponents logarithms() const {
        Exponents sum = logs;
        for (int k = 0; k < 4; ++k) sum[k] += std::log(growth[k]);
        return sum;
    }

    /// Gram-Schmidt on the first columns; the exponents grow by their lengths.
    void orthonormalise(int columns) {
        for (int k = 0; k < columns; ++k) {
            Eigen::Vector4d q = frame.col(k);
            for (int j = 0; j < k; ++j) q -= frame.col(j).dot(q) * frame.col(j);
            const double length = q.norm();
            frame.col(k) = q * (1 / length);
            grow(k, length);
        }
    }

    void append(const Matrix4& J, const Saltation& M, double R, int rank) {
        frame = J * frame;
        if (M.r.cwiseAbs().maxCoeff() > steep && rank == 4 && R > 0) {
            orthonormalise(4);
            shear(M);
            frame = M.S * frame;
        } else {
            frame = M.times(frame);
        }
        orthonormalise(rank);
    }

    /// Replaces the orthonormal frame Q by the orthonormal factor of (1 + rho g^T) Q = Q (1 + p a^T), rho = S^-1 r, p = Q^T rho,
    /// a = Q^T g. The Gram determinant of its first k columns is, written so that nothing cancels,
    /// V_k^2 = (1 + sum_{j<=k} p_j a_j)^2 + (sum_{j<=k} a_j^2)(sum_{j>k} p_j^2): the lengths are V_k/V_{k-1}. The whole sum,
    /// p^T a = rho^T g, does not depend on Q: it is r_2 - r_4, where no large entry is left to cancel.
    void shear(const Saltation& M) {
        const Eigen::Vector4d p = frame.transpose() * (M.S.inverse() * M.r), a = frame.transpose() * gap_gradient();
        double before = 1, dot = 1, head = 0;
        for (int k = 0; k < 4; ++k) {
            dot = k < 3 ? dot + p(k) * a(k) : 1 + M.r(1) - M.r(3);
            head += a(k) * a(k);
            const double volume = std::sqrt(dot * dot + head * p.tail(3 - k).squaredNorm());
            grow(k, volume / before);
            before = volume;
        }
        const Eigen::HouseholderQR<Matrix4> factors(Matrix4::Identity() + p * a.transpose());
        frame = frame * Matrix4(factors.householderQ());
    }
};

struct TransferProduct::Compounds {
    explicit Compounds(std::size_t history) : thinned(std::min<std::size_t>(history, 2048)) {}

    CompoundProduct product;
    Thinned thinned;
};

struct TransferProduct::Raw {
    explicit Raw(std::size_t history) : thinned(history) {}

    Matrix4 product = Matrix4::Identity();
    Thinned thinned;

    Exponents exponents(double T) const {
        if (!(T > 0) || !product.allFinite()) return no_exponents;
        const Eigen::EigenSolver<Matrix4> solver(product, false);
        if (solver.info() != Eigen::Success) return no_exponents;
        Exponents lambda;
        for (int k = 0; k < 4; ++k) lambda[k] = std::log(std::abs(solver.eigenvalues()(k))) / T;
        std::sort(lambda.begin(), lambda.end(), std::greater<>());
        return lambda;
    }
};

TransferProduct::TransferProduct(const ExponentOptions& o) {
    if (o.qr) qr_ = std::make_unique<Qr>(o.history);
    if (o.eigenvalues) compounds_ = std::make_unique<Compounds>(o.history);
    if (o.raw_product) raw_ = std::make_unique<Raw>(o.history);
}
TransferProduct::~TransferProduct() = default;
TransferProduct::TransferProduct(TransferProduct&&) noexcept = default;

void TransferProduct::start(double tau) {
    start_ = end_ = tau;
    impacts_ = 1;
}

void TransferProduct::append(const Matrix4& J, int rank, const Saltation& M, double R, double tau) {
    end_ = tau;
    ++impacts_;
    rank_ = std::min({rank_, rank, R > 0 ? 4 : 3});
    log_det_impacts_ += 2 * std::log(R);
    auto record = [&](auto& estimator, auto exponents) {
        if (!estimator.thinned.wants_next()) return estimator.thinned.skip();
        estimator.thinned.push(tau, exponents());
    };
    if (qr_) {
        qr_->append(J, M, R, rank_);
        record(*qr_, [&] { return qr(); });
    }
    if (compounds_) {
        compounds_->product.append(J, M, R, rank_);
        record(*compounds_, [&] { return eigenvalues(); });
    }
    if (raw_) {
        raw_->product = M.matrix() * J * raw_->product;
        record(*raw_, [&] { return raw_product(); });
    }
}

Exponents TransferProduct::qr() const { return qr_ ? per_time(qr_->logarithms(), rank_, end_ - start_) : no_exponents; }
Exponents TransferProduct::eigenvalues() const { return compounds_ ? per_time(compounds_->product.log_moduli(rank_), rank_, end_ - start_) : no_exponents; }
Exponents TransferProduct::raw_product() const { return raw_ ? raw_->exponents(end_ - start_) : no_exponents; }
const ExponentHistory& TransferProduct::qr_history() const { return qr_ ? qr_->thinned.history() : none(); }
const ExponentHistory& TransferProduct::eigenvalues_history() const { return compounds_ ? compounds_->thinned.history() : none(); }
const ExponentHistory& TransferProduct::raw_product_history() const { return raw_ ? raw_->thinned.history() : none(); }

double TransferProduct::sum_rule_residual(double zeta) const {
    if (!qr_ || rank_ < 4 || impacts_ < 2) return nan;
    const Exponents lambda = qr();
    const double sum = lambda[0] + lambda[1] + lambda[2] + lambda[3];
    return std::abs(sum + 2 * zeta - log_det_impacts_ / (end_ - start_));
}

Lyapunov::Lyapunov(const Parameters& parameters, double tau_start, double tau_end, const ExponentOptions& options)
    : parameters_(parameters), tau_start_(tau_start), tau_end_(tau_end), product_(options) {}

void Lyapunov::on_stretch(const Stretch& stretch) {
    if (product_.impacts() > 0) since_impact_.extend(stretch, parameters_.epsilon);  // the window has begun
}

void Lyapunov::on_impact(const Impact& impact) {
    if (impact.tau < tau_start_ || impact.tau > tau_end_) return;
    if (product_.impacts() == 0)
        product_.start(impact.tau);
    else
        product_.append(since_impact_.matrix(), since_impact_.rank(), saltation(parameters_, impact), impact.R, impact.tau);
    since_impact_.reset();
}

}  // namespace vines
