#include "core/stability/lyapunov.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/motion/elementary.hpp"
#include "core/motion/special_values.hpp"
#include "core/stability/linear.hpp"

namespace vines {

namespace {

// Products of lengths, and squares of areas and volumes, are kept within these bounds by taking
// their logarithms out: a third of double's exponents, so that the next factor stays in its range.
constexpr double least_product = 1e-100, most_product = 1e100;
bool is_in_range(double product) { return product > least_product && product < most_product; }

constexpr Exponents no_exponents = {nan, nan, nan, nan};

/// A history that thins itself: when full it drops every second entry and from then on takes every
/// second impact. Of capacity 0 it stays empty.
class Thinned {
public:
    explicit Thinned(std::size_t capacity)
        : capacity_(capacity > 0 ? std::max(capacity, shortest_history) : 0) {}

    bool wants_next() const { return capacity_ > 0 && seen_ % stride_ == 0; }
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
    return std::isnan(exponent)   ? Status::not_converged
           : std::isinf(exponent) ? Status::minus_infinity
                                  : Status::ok;
}

double rounding_floor(double lambda1, double T) {
    return lambda1 + elementary::log(std::numeric_limits<double>::epsilon()) / T;
}

struct TransferProduct::Qr {
    // Above this |r| (it is x''/(x'- - y'-)) the columns of M Q hide each other: a volume of them
    // computed from the sums would have a relative error of |r|^2 ulp. Below, that error is under
    // 1e-12.
    static constexpr double steep = 100;
    // Below this R the columns hide each other as well: by R an impact shrinks deviations of
    // x' - y'.
    static constexpr double dull = 0.02;

    explicit Qr(std::size_t history) : thinned(history) {}

    /// A product since its last logarithm was taken, and the logarithms.
    struct Growth {
        double product = 1, logs = 0;
        void grow(double factor) {
            product *= factor;
            if (!is_in_range(product)) {
                logs += elementary::log(product);
                product = 1;
            }
        }
        double logarithm() const { return logs + elementary::log(product); }
    };

    /// Deviations that span what the first one, two, three and four of them have become, and the
    /// growth that was taken out of them.
    struct Columns {
        Frame frame = Frame::Identity();
        std::array<Growth, 4> lengths;

        /// Gram-Schmidt on the first columns; the exponents grow by their lengths.
        void orthonormalise(int count) {
            Matrix4 base = frame;  // by columns
            for (int k = 0; k < count; ++k) {
                Eigen::Vector4d q = base.col(k);
                for (int j = 0; j < k; ++j) q -= base.col(j).dot(q) * base.col(j);
                const double length = q.norm();
                base.col(k) = q * (1 / length);
                lengths[k].grow(length);
            }
            if (count < 4) base.rightCols(4 - count).setZero();
            frame = base;
        }
    };
    Columns columns;
    // How far the columns may be from orthonormal: a bound of their condition number, the product
    // of those of the matrices since Gram-Schmidt. That takes, with its chain of four roots and
    // four divisions, as long as the rest of an impact, so that two or three share it. The bound is
    // generous; what it lets pass costs the last of the four lengths four to six digits of sixteen.
    static constexpr double most_skewed = 1e6;
    double skewed = 1;
    // What the first two and three deviations span, from the exterior powers; and the determinant.
    Area area = Area::Unit(0);
    Volume volume{Eigen::Vector4d::UnitW()};
    double log_area = 0, log_volume = 0;  // what was taken out of them
    double log_det = 0;                   // of the legs
    Growth impacts_det;                   // of the impacts
    Thinned thinned;

    void orthonormalise(int rank) {
        columns.orthonormalise(rank);
        skewed = 1;
    }
    /// Before a matrix of such a condition number.
    void skew(double by, int rank) {
        if (skewed * by > most_skewed) orthonormalise(rank);
        skewed *= by;
    }

    /// Deviations of x' - y' shrunk by `factor`, x' + epsilon y' and the positions kept: S for
    /// factor -R.
    void shrink(double factor, double epsilon) {
        const double nu = 1 / (1 + epsilon), mu = epsilon * nu;
        Frame& frame = columns.frame;
        const Eigen::RowVector4d relative = (1 - factor) * (frame.row(0) - frame.row(2));
        frame.row(0) -= mu * relative;
        frame.row(2) += nu * relative;
    }

    /// M = (I + r g^T) S, for g^T S = g^T. First S, in parts of which none shrinks by more than
    /// e^-most_contraction; then the shear.
    void strike_apart(const Saltation& M, double R, double epsilon, int rank) {
        const double parts = R > 0
                                 ? std::max(1.0, std::ceil(-elementary::log(R) / most_contraction))
                                 : 1,
                     part = elementary::pow(R, 1 / parts);
        for (int k = 1; k < parts; ++k) {
            shrink(part, epsilon);
            orthonormalise(rank);
        }
        shrink(-part, epsilon);
        orthonormalise(rank);
        shear(M.r, R, rank);
    }

    /// Replaces the orthonormal columns Q by an orthonormal base of (I + r g^T) Q = Q + r a^T with
    /// a = Q^T g. With p = Q^T r the Gram determinant of the first k columns is, written so that
    /// nothing cancels,
    ///
    ///     V_k^2 = (1 + sum_{j<=k} p_j a_j)^2 + (sum_{j<=k} a_j^2) |r - sum_{j<=k} p_j q_j|^2:
    ///
    /// the lengths are V_k/V_{k-1}. Of all four columns it is the determinant 1 + g^T r = -R.
    void shear(const Eigen::Vector4d& r, double R, int rank) {
        Frame& frame = columns.frame;
        const Eigen::Vector4d a = frame.transpose() * wall_normal(), p = frame.transpose() * r;
        Eigen::Vector4d rest = r;
        double before = 1, dot = 1, head = 0;
        for (int k = 0; k < rank; ++k) {
            dot += p(k) * a(k);
            head += a(k) * a(k);
            rest -= p(k) * frame.col(k);
            const double spanned_volume =
                k < 3 ? std::sqrt(dot * dot + head * rest.squaredNorm()) : R;
            columns.lengths[k].grow(spanned_volume / before);
            before = spanned_volume;
        }
        const Eigen::HouseholderQR<Matrix4> factors(frame + r * a.transpose());
        frame = factors.householderQ();
    }

    void pass(const Leg& leg, double epsilon, int rank) {
        const bool is_strong = leg.parts > 1 || leg.stuck;
        const auto& [a11, a12, a21, a22] = leg.oscillator;
        // [1 0; s 1] of the free mass beside the oscillator's block.
        const double s = leg.duration, condition = (2 + s * s) / (a11 * a22 - a12 * a21);
        for (long k = 0; k < leg.parts; ++k) {
            if (is_strong) orthonormalise(rank);
            else skew(condition, rank);
            carry(columns.frame, leg, epsilon);
            area = carried(area, leg, epsilon);
            if (rank > 2) volume = carried(volume, leg);
            rescale(rank);
            log_det += leg.log_det;
        }
        if (is_strong) orthonormalise(rank);
    }

    void strike(const Saltation& M, double R, double epsilon, int rank) {
        if (R < dull || M.r.cwiseAbs().maxCoeff() > steep) {
            orthonormalise(rank);
            strike_apart(M, R, epsilon, rank);
        } else {
            // |g|^2 = 2, and the determinants of I + r g^T and of S are -R.
            const double stretch = 1 + std::sqrt(2 * M.r.squaredNorm());
            skew(stretch * stretch / R, rank);
            columns.frame = M.times(columns.frame);
        }
        area = carried(area, M, R);
        if (rank > 2) volume = carried(volume, M, R);
        rescale(rank);
        impacts_det.grow(R * R);
    }

    /// Keeps area and volume within the range of double.
    void rescale(int rank) {
        auto keep = [](auto& of, double& log) {
            const double squared = of.squaredNorm();
            if (is_in_range(squared)) return;
            log += 0.5 * elementary::log(squared);
            of *= 1 / std::sqrt(squared);
        };
        keep(area, log_area);
        if (rank > 2) keep(volume.normal, log_volume);
    }

    struct Sums {
        Exponents logs{};
        /// By how much the sum of the first logarithms misses the area, the volume, the
        /// determinant.
        std::array<double, 4> misses{};
    };
    Sums sums(int rank) const {
        Sums s;
        double sum = 0;
        Columns now = columns;
        now.orthonormalise(rank);
        for (int k = 0; k < rank; ++k) {
            s.logs[k] = now.lengths[k].logarithm();
            sum += s.logs[k];
            if (k == 1)
                s.misses[k] =
                    std::abs(sum - (log_area + 0.5 * elementary::log(area.squaredNorm())));
            if (k == 2)
                s.misses[k] = std::abs(
                    sum - (log_volume + 0.5 * elementary::log(volume.normal.squaredNorm())));
            if (k == 3) s.misses[k] = std::abs(sum - (log_det + impacts_det.logarithm()));
        }
        return s;
    }
};

struct TransferProduct::Powers {
    Powers(double epsilon, std::size_t history)
        : product(epsilon),
          thinned(std::min(history, most_eigenvalue_entries)) {}

    PowerProduct product;
    Thinned thinned;
};

struct TransferProduct::Raw {
    explicit Raw(std::size_t history) : thinned(history) {}

    Matrix4 product = Matrix4::Identity();
    Thinned thinned;

    Exponents exponents(double T) const {
        if (!(T > 0) || !product.allFinite()) return no_exponents;
        const Eigen::Vector4cd eigenvalues = eigenvalues_of(product);
        if (!eigenvalues.allFinite()) return no_exponents;
        Exponents lambda;
        for (int k = 0; k < 4; ++k)
            lambda[k] = elementary::log(elementary::modulus(eigenvalues(k))) / T;  // (33)
        std::sort(lambda.begin(), lambda.end(), std::greater<>());
        return lambda;
    }
};

TransferProduct::TransferProduct(double epsilon, const ExponentOptions& o) : epsilon_(epsilon) {
    if (o.qr) qr_ = std::make_unique<Qr>(std::max(o.history, shortest_history));
    if (o.eigenvalues) powers_ = std::make_unique<Powers>(epsilon, o.history);
    if (o.raw_product) raw_ = std::make_unique<Raw>(o.history);
}
TransferProduct::~TransferProduct() = default;
TransferProduct::TransferProduct(TransferProduct&&) noexcept = default;

void TransferProduct::start(double tau) {
    start_ = end_ = tau;
    impacts_ = 1;
}

void TransferProduct::append(std::span<const Leg> legs, const Saltation& M, double R, double tau) {
    end_ = tau;
    ++impacts_;
    auto record = [&](auto& estimator, auto exponents) {
        if (!estimator.thinned.wants_next()) return estimator.thinned.skip();
        estimator.thinned.push(tau, exponents());
    };
    Matrix4 J = Matrix4::Identity();
    for (const Leg& leg : legs) {
        if (leg.stuck) rank_ = 2;
        if (qr_) qr_->pass(leg, epsilon_, rank_);
        if (powers_) powers_->product.pass(leg);
        if (raw_) J = transfer_of(leg, epsilon_) * J;
    }
    if (R == 0) rank_ = std::min(rank_, 3);
    if (qr_) {
        qr_->strike(M, R, epsilon_, rank_);
        record(*qr_, [&] { return qr(); });
    }
    if (powers_) {
        powers_->product.strike(M, R);
        record(*powers_, [&] { return eigenvalues(); });
    }
    if (raw_) {
        raw_->product = M.matrix() * J * raw_->product;  // T_n ... T_1, eq. (30)
        record(*raw_, [&] { return raw_product(); });
    }
}

Exponents TransferProduct::qr() const {
    if (!qr_) return no_exponents;
    const double T = end_ - start_;
    auto [logs, misses] = qr_->sums(rank_);
    // The k-th exponent is the difference of two sums.
    for (int k = 1; k < rank_; ++k)
        if (!(std::max(misses[k], misses[k - 1]) <= most_residual * T)) logs[k] = nan;
    // Over a short window, or one of strong damping, the columns need not have turned into
    // descending order.
    for (int k = 1; k < rank_; ++k)
        for (int j = k; j > 0 && (logs[j] > logs[j - 1] || std::isnan(logs[j - 1])); --j)
            std::swap(logs[j], logs[j - 1]);
    return per_time(logs, rank_, T);
}
Exponents TransferProduct::eigenvalues() const {
    return powers_ ? per_time(powers_->product.log_moduli(), rank_, end_ - start_) : no_exponents;
}
Exponents TransferProduct::raw_product() const {
    return raw_ ? raw_->exponents(end_ - start_) : no_exponents;
}
const ExponentHistory& TransferProduct::qr_history() const {
    return qr_ ? qr_->thinned.history() : none();
}
const ExponentHistory& TransferProduct::eigenvalues_history() const {
    return powers_ ? powers_->thinned.history() : none();
}
const ExponentHistory& TransferProduct::raw_product_history() const {
    return raw_ ? raw_->thinned.history() : none();
}

double TransferProduct::sum_rule_residual() const {
    if (!qr_ || impacts_ < 2) return nan;
    const auto misses = qr_->sums(rank_).misses;
    return *std::max_element(misses.begin(), misses.end()) / (end_ - start_);
}

Lyapunov::Lyapunov(
    const Parameters& parameters, double tau_start, double tau_end, const ExponentOptions& options)
    : parameters_(parameters),
      tau_start_(tau_start),
      tau_end_(tau_end),
      product_(parameters.epsilon, options) {}

void Lyapunov::on_stretch(const Stretch& stretch) {
    if (product_.impacts() > 0) since_impact_.extend(stretch);  // the window has begun
}

void Lyapunov::on_impact(const Impact& impact) {
    if (impact.tau < tau_start_ || impact.tau > tau_end_) return;
    if (product_.impacts() == 0) product_.start(impact.tau);
    else
        product_.append(since_impact_.legs(), saltation(parameters_, impact), impact.R, impact.tau);
    since_impact_.reset();
}

}  // namespace vines
