// Qr carries a Flag (exterior.hpp). Before its four sizes leave the range of double, their
// logarithms are extracted: the cumulative sums of T lambda_k. Each sum has an error estimate: the
// angles by which rounding has separated the three subspaces, the accumulated rounding of steep
// impacts (near grazing, or with a tiny R), and at rank 4 the deviation of the determinant from its
// exact value (the sum rule). An exponent is reported only if its error is at most most_residual.
#include "core/stability/lyapunov.hpp"

#include <algorithm>
#include <cmath>

#include "core/stability/linear.hpp"

namespace vines {

namespace {

// The squares of length, area and volume, and the determinants, are kept within these bounds, a
// third of the exponent range of double: logarithms are extracted.
constexpr double least_product = 1e-100, most_product = 1e100;
constexpr double rounding = std::numeric_limits<double>::epsilon();
// Typical rounding error per impact. Among 1500 strongly damped systems a full ulp withholds the
// exponents of ten, which are accurate to 1e-7; a tenth of an ulp those of one.
constexpr double typical_rounding = 0.1 * rounding;
// Sine of an angle that should be zero, far above the effect of rounding.
constexpr double widest_separation = 1e-6;
bool is_in_range(double product) { return product > least_product && product < most_product; }

/// Size of the entries of M that grow without bound near grazing; large above `steep`.
double steepness_of(const Saltation& M) { return std::abs(M.r_x) + std::abs(M.r_y); }
constexpr double steep = 1e6;

/// A history that thins itself: when full it drops every second entry and from then on takes every
/// second impact. With capacity 0 it stays empty.
class ThinnedHistory {
public:
    explicit ThinnedHistory(std::size_t capacity)
        : capacity_(capacity > 0 ? std::max(capacity, shortest_history) : 0) {}

    /// Calls exponents() if its result is to be kept.
    template <class Compute>
    void add(double tau, const Compute& exponents) {
        if (wants_next() && history.tau.size() == capacity_) thin();
        if (wants_next()) {
            history.tau.push_back(tau);
            history.lambda.push_back(exponents());
        }
        ++seen_;
    }
    ExponentHistory history;

private:
    bool wants_next() const { return capacity_ > 0 && seen_ % stride_ == 0; }
    void thin() {
        const auto halve = [](auto& column) {
            std::size_t kept = 0;
            for (std::size_t i = 0; i < column.size(); i += 2) column[kept++] = column[i];
            column.resize(kept);
        };
        halve(history.tau), halve(history.lambda);
        stride_ *= 2;
    }

    std::size_t capacity_, seen_ = 0, stride_ = 1;
};

/// logs / T, with -infinity beyond the rank.
Exponents per_time(const Exponents& logs, int rank, double T) {
    Exponents lambda;
    for (int k = 0; k < 4; ++k) lambda[k] = k >= rank ? -infinity : T > 0 ? logs[k] / T : nan;
    return lambda;
}

/// The same in descending order, NaN last: over a short window they are not yet ordered.
Exponents descending(Exponents logs, int rank, double T) {
    for (int k = 1; k < rank; ++k)
        for (int j = k; j > 0 && (logs[j] > logs[j - 1] || std::isnan(logs[j - 1])); --j)
            std::swap(logs[j], logs[j - 1]);
    return per_time(logs, rank, T);
}

struct Qr {
    Flag flag;
    std::array<double, 4> extracted_logs{};  // logarithms extracted from its four sizes
    double log_det = 0;                      // exact: -2 zeta times the duration of the flights
    // Product of the determinants of the impacts, and the logarithm extracted from it.
    double determinant_product = 1, log_determinants = 0;
    /// Variances of the rounding errors in the logarithms of length, area and volume.
    std::array<double, 3> rounding_variances{};
    int since_rescale = 0;  // impacts since the last rescaling

    void pass(const Leg& leg, double epsilon) {
        for (long k = 0; k < leg.parts; ++k) {
            flag.pass(leg, epsilon);
            log_det += leg.log_det;
            if (leg.parts > 1 || leg.sticking) rescale();
        }
        if (leg.slip != 1) strike_magnified(slip_of(leg, epsilon), 0);
    }

    void strike(const Saltation& M) {
        const double steepness = steepness_of(M);
        if (std::min(M.R, std::abs(M.R_speed)) < 1e-3 || steepness > steep)
            return strike_magnified(M, steepness);
        // Within these limits an impact and a flight of one part let no size grow by more than 1e17
        // (for a flight of duration 1e10) or shrink by more than 1e10.
        flag.strike(M);
        for (double& variance : rounding_variances) variance += rounding * rounding;
        determinant_product *= M.determinant();
        if (++since_rescale == 4) rescale();
    }

    /// Impact with large entries of M, or with a tiny R: M magnifies errors of an ulp of x and x'
    /// in the gaps x - y and x' - y' of deviations, areas and volumes.
    void strike_magnified(const Saltation& M, double steepness) {
        rescale();
        const auto before = flag.squares();
        flag.strike(M);
        const auto after = flag.squares();
        for (int k = 0; k < 3; ++k) {
            if (!(before[k] > 0)) continue;
            const double error =
                typical_rounding * (1 + (1 + steepness) * std::sqrt(before[k] / after[k]));
            rounding_variances[k] += error * error;
        }
        log_determinants += elementary::log(std::abs(M.R)) + elementary::log(std::abs(M.R_speed));
        rescale();
    }

    /// Keeps the sizes within the range of double; zero after loss of rank stays zero.
    void rescale() {
        since_rescale = 0;
        const auto squares = flag.squares();
        auto keep = [](double square, auto& size, double& log) {
            if (is_in_range(square) || square == 0) return;
            log += 0.5 * elementary::log(square);
            size *= 1 / std::sqrt(square);
        };
        keep(squares[0], flag.deviation, extracted_logs[0]);
        keep(squares[1], flag.area, extracted_logs[1]);
        keep(squares[2], flag.volume, extracted_logs[2]);
        auto take = [](double& product, double& log) {
            if (is_in_range(std::abs(product)) || product == 0) return;
            log += elementary::log(std::abs(product));
            product = product < 0 ? -1 : 1;
        };
        take(flag.determinant, extracted_logs[3]);
        take(determinant_product, log_determinants);
    }

    double log_det_carried() const {
        return extracted_logs[3] + elementary::log(std::abs(flag.determinant));
    }

    /// ln r_kk of the triangular factor: growth of the first deviation, then additional growth.
    Exponents logs(int rank) const {
        const auto squares = flag.squares();
        Exponents logs{};
        double before = 0;
        for (int k = 0; k < rank; ++k) {
            // The impacts' determinants are kept apart for the comparison in errors().
            const double sum = k < 3 ? extracted_logs[k] + 0.5 * elementary::log(squares[k])
                                     : log_det_carried() + log_determinants +
                                           elementary::log(std::abs(determinant_product));
            logs[k] = sum - before;
            before = sum;
        }
        return logs;
    }

    /// Errors of the four cumulative sums of logarithms, infinity if unknown: the larger of the
    /// angles to the neighbours, the rounding if that exceeds `most`, the error of the determinant.
    std::array<double, 4> errors(int rank, double most) const {
        const auto squares = flag.squares();
        const auto separations = flag.separations();
        std::array<double, 4> errors{};
        for (int k = 0; k < std::min(rank, 3); ++k) {
            const double rounded = std::sqrt(rounding_variances[k]);
            if (!(rounded <= most)) errors[k] = rounded;
            if (!(squares[k] > 0)) errors[k] = infinity;
        }
        for (int k = 1; k < std::min(rank, 3); ++k) {
            // The angle does not show which of the two neighbours is inaccurate.
            const double separation =
                separations[k - 1] <= widest_separation ? separations[k - 1] : infinity;
            errors[k - 1] = std::max(errors[k - 1], separation);
            errors[k] = std::max(errors[k], separation);
        }
        if (rank == 4) errors[3] = std::abs(log_det_carried() - log_det);
        return errors;
    }
};

struct RawProduct {
    Matrix4 product = Matrix4::Identity();

    void multiply(std::span<const Leg> legs, const Saltation& M, double epsilon) {
        product = M.matrix() * transfer_of(legs, epsilon) * product;  // T_n ... T_1, eq. (30)
    }

    Exponents exponents(double T) const {
        if (!(T > 0) || !product.allFinite()) return no_exponents;
        const Eigenvalues eigenvalues = eigenvalues_of(product);
        if (!Eigen::Map<const Eigen::Vector4cd>(eigenvalues.data()).allFinite())
            return no_exponents;
        Exponents lambda;
        for (int k = 0; k < 4; ++k)
            lambda[k] = elementary::log(elementary::modulus(eigenvalues[k])) / T;  // (33)
        std::ranges::sort(lambda, std::greater<>());
        return lambda;
    }
};

}  // namespace

Status status_of(double exponent) {
    return exponent == -infinity     ? Status::minus_infinity
           : std::isfinite(exponent) ? Status::ok
                                     : Status::not_converged;
}

std::size_t ExponentHistory::coarse_stride() const {
    std::size_t stride = 1;
    while ((tau.size() + stride - 1) / stride > shortest_history) stride *= 2;
    return stride;
}

double rounding_floor(double lambda1, double T) {
    return lambda1 + elementary::log(std::numeric_limits<double>::epsilon()) / T;
}

/// The requested estimators and their histories.
struct TransferProduct::Estimators {
    ThinnedHistory qr_history, powers_history, raw_history;
    std::optional<Qr> qr = {};
    std::optional<PowerProduct> powers = {};
    std::optional<RawProduct> raw = {};
};

TransferProduct::TransferProduct(double epsilon, const ExponentOptions& o)
    : epsilon_(epsilon),
      options_(o),
      estimators_(new Estimators{
          ThinnedHistory(std::max(o.history, shortest_history)),
          ThinnedHistory(std::min(o.history, most_eigenvalue_entries)),
          ThinnedHistory(o.history)}) {
    if (o.qr) estimators_->qr.emplace();
    if (o.eigenvalues) estimators_->powers.emplace(epsilon);
    if (o.raw_product) estimators_->raw.emplace();
}
TransferProduct::~TransferProduct() = default;
TransferProduct::TransferProduct(TransferProduct&&) noexcept = default;

void TransferProduct::append(std::span<const Leg> legs, const Saltation& M, double tau) {
    auto& [qr_history, powers_history, raw_history, qr, powers, raw] = *estimators_;
    end_ = tau;
    ++impacts_;
    for (const Leg& leg : legs) {
        if (leg.sticking) rank_ = 2;  // only the two deviations of the centre of mass remain
        if (leg.resting || leg.slip == 0) rank_ = std::min(rank_, 3);
        if (qr) qr->pass(leg, epsilon_);
        if (powers) powers->pass(leg);
    }
    if (M.is_singular()) rank_ = std::min(rank_, 3);  // R = 0: x' - y' = 0 after it
    if (qr) {
        qr->strike(M);
        qr_history.add(
            tau, [&] { return descending(estimators_->qr->logs(rank_), rank_, tau - start_); });
    }
    if (powers) {
        powers->strike(M);
        powers_history.add(tau, [&] { return eigenvalues(); });
    }
    if (raw) {
        raw->multiply(legs, M, epsilon_);
        raw_history.add(tau, [&] { return raw_product(); });
    }
}

void TransferProduct::end_sticking() {
    const auto& e = estimators_;
    const Leg projection{{}, 0, 0, 1, true};
    rank_ = 2;
    if (e->qr) e->qr->pass(projection, epsilon_);
    if (e->powers) e->powers->pass(projection);
    if (e->raw) e->raw->product = transfer_of(projection, epsilon_) * e->raw->product;
}

Exponents TransferProduct::qr() const {
    const auto& qr = estimators_->qr;
    if (!qr) return no_exponents;
    const double T = end_ - start_;
    Exponents logs = qr->logs(rank_);
    const auto errors = qr->errors(rank_, most_residual * T);
    // A difference of two sums: if one is unknown, so is the order of all following exponents.
    for (int k = 0; k < rank_; ++k)
        if (!(errors[k] <= most_residual * T)) {
            std::fill(logs.begin() + k, logs.begin() + rank_, nan);
            break;
        }
    return descending(logs, rank_, T);
}
Exponents TransferProduct::eigenvalues() const {
    const auto& powers = estimators_->powers;
    return powers ? per_time(powers->log_moduli(), rank_, end_ - start_) : no_exponents;
}
Exponents TransferProduct::raw_product() const {
    const auto& raw = estimators_->raw;
    return raw ? raw->exponents(end_ - start_) : no_exponents;
}
const ExponentHistory& TransferProduct::qr_history() const {
    return estimators_->qr_history.history;
}
const ExponentHistory& TransferProduct::eigenvalues_history() const {
    return estimators_->powers_history.history;
}
const ExponentHistory& TransferProduct::raw_product_history() const {
    return estimators_->raw_history.history;
}

double TransferProduct::sum_rule_residual() const {
    if (!estimators_->qr || impacts_ < 2) return nan;
    const auto errors = estimators_->qr->errors(rank_, most_residual * (end_ - start_));
    return *std::ranges::max_element(errors) / (end_ - start_);
}

void Lyapunov::on_transfer(const Impact& impact, const Saltation& M, std::span<const Leg> legs) {
    product_.append(legs, M, impact.tau);
    const bool is_steep = steepness_of(M) > steep;
    chatters_ = is_steep && steep_ && impact.side == side_;  // on the way to sticking
    steep_ = is_steep;
    side_ = impact.side;
}

const TransferProduct& Lyapunov::product() {
    // Ended within a chatter, whose last impacts have lost all accuracy: it counts as sticking.
    if (chatters_ && !(product_.sum_rule_residual() <= most_residual)) product_.end_sticking();
    chatters_ = false;
    return product_;
}

void WindowedExponents::on_impact(const Impact& impact) {
    if (!begun_) {
        for (Lyapunov& w : windows_) waiting_.push_back(&w);
        std::ranges::sort(
            waiting_, std::greater<>(), [](const Lyapunov* w) { return w->window().from; });
        begun_ = true;
    }
    for (; !waiting_.empty() && waiting_.back()->window().from <= impact.tau; waiting_.pop_back())
        open_.push_back(waiting_.back());
    std::erase_if(open_, [&](const Lyapunov* w) { return w->window().to < impact.tau; });
    for (Lyapunov* w : open_) w->on_impact(impact);
}

}  // namespace vines
