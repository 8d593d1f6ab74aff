#include "core/stability/lyapunov.hpp"

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
// their logarithms out: a third of double's exponents, so that the next factors stay in its range.
constexpr double least_product = 1e-100, most_product = 1e100;
constexpr double rounding = std::numeric_limits<double>::epsilon();
// Where many impacts magnify it, it is not always at its worst, nor of one sign: of 1500 strongly
// damped systems, most with chatters, a whole ulp withholds ten whose exponents are right to 1e-7,
// a tenth of one withholds one.
constexpr double typical_rounding = 0.1 * rounding;
// The sine of an angle that should be none, far above what rounding leaves of it.
constexpr double widest_gap = 1e-6;
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

/// The same in descending order, NaN behind: over a short window, or one of strong damping, the
/// deviations need not have turned into that order.
Exponents descending(Exponents logs, int rank, double T) {
    for (int k = 1; k < rank; ++k)
        for (int j = k; j > 0 && (logs[j] > logs[j - 1] || std::isnan(logs[j - 1])); --j)
            std::swap(logs[j], logs[j - 1]);
    return per_time(logs, rank, T);
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
    explicit Qr(std::size_t history) : thinned(history) {}

    Flag flag;
    std::array<double, 4> taken{};  // logarithms that were taken out of its four sizes
    double log_det = 0;             // of the flights by the law: -2 zeta s
    double R_product = 1, log_R = 0;
    /// What rounding may have changed of the logarithms of length, area and volume.
    std::array<double, 3> lost{};
    int unseen = 0;  // impacts since the sizes were looked at
    Thinned thinned;

    void pass(const Leg& leg, double epsilon) {
        for (long k = 0; k < leg.parts; ++k) {
            flag.pass(leg, epsilon);
            log_det += leg.log_det;
            if (leg.parts > 1 || leg.stuck) rescale();
        }
    }

    void strike(const Saltation& M) {
        // Others, with a flight of one part, let no size grow by more than 1e17 (where the flight
        // lasts 1e10), nor shrink by more than 1e10.
        const double steepness = std::abs(M.turn_x) + std::abs(M.turn_y);
        if (M.R < 1e-3 || steepness > 1e6) return strike_strongly(M, steepness);
        flag.strike(M);
        for (double& share : lost) share += rounding;
        R_product *= M.R;
        if (++unseen == 4) rescale();
    }

    /// x - y and x' - y' of a deviation are known to an ulp of x and x', of areas and volumes
    /// alike, and M magnifies that by its entries: what this is of the sizes behind it.
    void strike_strongly(const Saltation& M, double steepness) {
        rescale();
        const auto before = flag.squares();
        flag.strike(M);
        const auto after = flag.squares();
        for (int k = 0; k < 3; ++k)
            lost[k] += before[k] > 0 ? typical_rounding *
                                           (1 + (1 + steepness) * std::sqrt(before[k] / after[k]))
                                     : 0;
        log_R += elementary::log(M.R);
        rescale();
    }

    /// Keeps the sizes within the range of double; what has lost its rank stays zero.
    void rescale() {
        unseen = 0;
        const auto squares = flag.squares();
        auto keep = [](double square, auto& size, double& log) {
            if (is_in_range(square) || square == 0) return;
            log += 0.5 * elementary::log(square);
            size *= 1 / std::sqrt(square);
        };
        keep(squares[0], flag.deviation, taken[0]);
        keep(squares[1], flag.area, taken[1]);
        keep(squares[2], flag.volume.normal, taken[2]);
        auto take = [](double& product, double& log) {
            if (is_in_range(std::abs(product)) || product == 0) return;
            log += elementary::log(std::abs(product));
            product = product < 0 ? -1 : 1;
        };
        take(flag.determinant, taken[3]);
        take(R_product, log_R);
    }

    double log_det_found() const { return taken[3] + elementary::log(std::abs(flag.determinant)); }

    /// Growth of the first deviation, and by how much the next ones make that of area, volume and
    /// determinant larger: the diagonal of R.
    Exponents logs(int rank) const {
        const auto squares = flag.squares();
        Exponents logs{};
        double before = 0;
        for (int k = 0; k < rank; ++k) {
            const double sum = k < 3 ? taken[k] + 0.5 * elementary::log(squares[k])
                                     : log_det_found() + 2 * (log_R + elementary::log(R_product));
            logs[k] = sum - before;
            before = sum;
        }
        return logs;
    }

    /// By how much each of the four sums misses: the angles by which parts of the flag have come
    /// apart, and the determinants their law. Where rounding may have changed one by more than
    /// `most`, that.
    std::array<double, 4> misses(int rank, double most) const {
        const auto squares = flag.squares();
        const auto gaps = flag.gaps();
        std::array<double, 4> misses{};
        for (int k = 0; k < std::min(rank, 3); ++k) {
            if (!(lost[k] <= most)) misses[k] = lost[k];
            if (!(squares[k] > 0)) misses[k] = infinity;
        }
        for (int k = 1; k < std::min(rank, 3); ++k) {
            // Which of the two is wrong a gap does not tell.
            const double gap = gaps[k - 1] <= widest_gap ? gaps[k - 1] : infinity;
            misses[k - 1] = std::max(misses[k - 1], gap), misses[k] = std::max(misses[k], gap);
        }
        if (rank == 4) misses[3] = std::abs(log_det_found() - log_det);
        return misses;
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

    void multiply(std::span<const Leg> legs, const Saltation& M, double epsilon) {
        Matrix4 J = Matrix4::Identity();
        for (const Leg& leg : legs) J = transfer_of(leg, epsilon) * J;
        product = M.matrix() * J * product;  // T_n ... T_1, eq. (30)
    }

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

void TransferProduct::append(std::span<const Leg> legs, const Saltation& M, double tau) {
    end_ = tau;
    ++impacts_;
    auto record = [&](auto& estimator, auto exponents) {
        if (!estimator.thinned.wants_next()) return estimator.thinned.skip();
        estimator.thinned.push(tau, exponents());
    };
    for (const Leg& leg : legs) {
        if (leg.stuck) rank_ = 2;
        if (qr_) qr_->pass(leg, epsilon_);
        if (powers_) powers_->product.pass(leg);
    }
    if (M.R == 0) rank_ = std::min(rank_, 3);
    if (qr_) {
        qr_->strike(M);
        record(*qr_, [&] { return descending(qr_->logs(rank_), rank_, tau - start_); });
    }
    if (powers_) {
        powers_->product.strike(M);
        record(*powers_, [&] { return eigenvalues(); });
    }
    if (raw_) {
        raw_->multiply(legs, M, epsilon_);
        record(*raw_, [&] { return raw_product(); });
    }
}

Exponents TransferProduct::qr() const {
    if (!qr_) return no_exponents;
    const double T = end_ - start_;
    Exponents logs = qr_->logs(rank_);
    const auto misses = qr_->misses(rank_, most_residual * (end_ - start_));
    // The k-th exponent is the difference of two sums. Where one is not known, it is not known
    // either which place the ones behind it have among the others.
    for (int k = 0; k < rank_; ++k)
        if (!(misses[k] <= most_residual * T)) {
            std::fill(logs.begin() + k, logs.begin() + rank_, nan);
            break;
        }
    return descending(logs, rank_, T);
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
    const auto misses = qr_->misses(rank_, most_residual * (end_ - start_));
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
    else product_.append(since_impact_.legs(), saltation(parameters_, impact), impact.tau);
    since_impact_.reset();
}

}  // namespace vines
