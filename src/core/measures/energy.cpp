#include "core/measures/energy.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/motion/last_used.hpp"

namespace vines {

namespace {

// Gauss-Legendre on [0, 1] with five nodes: right for polynomials up to degree 9. Over one cell, 2
// pi/42 of the faster frequency, what it leaves of x'^2 is below 1e-16.
struct Node {
    double at, weight;
};
constexpr std::array<Node, 5> gauss = {
    {{0.046910077030668004, 0.11846344252809454},
     {0.23076534494715845, 0.23931433524968324},
     {0.5, 0.28444444444444444},
     {0.76923465505284155, 0.23931433524968324},
     {0.95308992296933200, 0.11846344252809454}}};

// Nobody waits for a decay that takes longer, in tau.
constexpr double longest_decay = 1e6;

// A moment is bisected to some ulps of tau.
constexpr double moment_rounding = 1e-15;

Eigen::Vector4d vector(const Oscillation& o) { return {o.x, o.x_dot, o.sin_theta, o.cos_theta}; }

}  // namespace

Quadrature::Integrals& Quadrature::Integrals::operator+=(const Integrals& more) {
    x_squared += more.x_squared;
    x_dot_squared += more.x_dot_squared;
    x_dot_sin += more.x_dot_sin;
    return *this;
}

Quadrature::Quadrature(const Flow& flow) : flow_(flow) {
    const Oscillation unit[4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    // The forms of one cell, in the state at its start.
    Forms cell{Form::Zero(), Form::Zero(), Form::Zero()};
    for (const Node& node : gauss) {
        const double d = node.at * flow.cell(), weight = node.weight * flow.cell();
        Eigen::Vector4d x, x_dot, sin;
        for (int j = 0; j < 4; ++j) {
            const Oscillation o = flow.along(flow.series(unit[j]), unit[j], d);
            x(j) = o.x, x_dot(j) = o.x_dot, sin(j) = o.sin_theta;
        }
        cell.x_squared += weight * x * x.transpose();
        cell.x_dot_squared += weight * x_dot * x_dot.transpose();
        cell.x_dot_sin += weight * x_dot * sin.transpose();
    }
    from_start_.push_back({Form::Zero(), Form::Zero(), Form::Zero()});
    for (int k = 0; k < Flow::cells; ++k) {
        Eigen::Matrix4d over;
        for (int j = 0; j < 4; ++j) over.col(j) = vector(flow.at(unit[j], k));
        const Forms& before = from_start_.back();
        from_start_.push_back(
            {before.x_squared + over.transpose() * cell.x_squared * over,
             before.x_dot_squared + over.transpose() * cell.x_dot_squared * over,
             before.x_dot_sin + over.transpose() * cell.x_dot_sin * over});
    }
}

std::shared_ptr<const Quadrature> Quadrature::shared(const Flow& flow) {
    thread_local LastUsed<Flow::Coefficients, Quadrature> quadratures;
    return quadratures.get(flow.coefficients(), [&flow] { return Quadrature(flow); });
}

Quadrature::Integrals Quadrature::over_part(const Oscillation& start, double duration) const {
    const Flow::Series series = flow_.series(start);
    Integrals sum;
    for (const Node& node : gauss) {
        const Oscillation o = flow_.along(series, start, node.at * duration);
        sum.x_squared += node.weight * o.x * o.x;
        sum.x_dot_squared += node.weight * o.x_dot * o.x_dot;
        sum.x_dot_sin += node.weight * o.x_dot * o.sin_theta;
    }
    sum.x_squared *= duration, sum.x_dot_squared *= duration, sum.x_dot_sin *= duration;
    return sum;
}

Quadrature::Integrals Quadrature::over_grid(const Oscillation& start, int cells) const {
    const Eigen::Vector4d z = vector(start);
    const Forms& f = from_start_[cells];
    return {z.dot(f.x_squared * z), z.dot(f.x_dot_squared * z), z.dot(f.x_dot_sin * z)};
}

Quadrature::Integrals Quadrature::over(Oscillation o, double duration) const {
    Integrals sum;
    for (; duration > flow_.reach(); duration -= flow_.reach()) {
        sum += over_grid(o, Flow::cells);
        o = flow_.at(o, Flow::cells);
    }
    const int cells = static_cast<int>(duration / flow_.cell());
    sum += over_grid(o, cells);
    return sum += over_part(flow_.at(o, cells), std::max(0.0, duration - cells * flow_.cell()));
}

double energy_of(const Parameters& p, const State& s) {
    return 0.5 * (s.x_dot * s.x_dot + s.x * s.x + p.epsilon * s.y_dot * s.y_dot);
}

Energy::Energy(const Parameters& p, double tau_start, double tau_end)
    : parameters_(p),
      tau_start_(tau_start),
      tau_end_(tau_end),
      free_(Quadrature::shared(*Flow::shared_free(p))) {}

void Energy::on_stretch(const Stretch& stretch) {
    const double from = std::max(0.0, tau_start_ - stretch.tau),
                 to = std::min(stretch.duration, tau_end_ - stretch.tau);
    if (!(from < to)) return;
    if (stretch.stuck_side != 0 && !stuck_)
        stuck_ = Quadrature::shared(*Flow::shared_stuck(parameters_));
    if (duration_ == 0) start_ = energy_of(parameters_, stretch.at(from));
    const Oscillation begin = from > 0 ? stretch.flow.after(stretch.start, from) : stretch.start;
    integrals_ += (stretch.stuck_side == 0 ? free_ : stuck_)->over(begin, to - from);
    peak_ = std::max(peak_, excursion(stretch.flow, begin, to - from).peak);
    duration_ += to - from;
    end_ = energy_of(parameters_, stretch.at(to));
}

void Energy::on_impact(const Impact& i) {
    if (i.tau > tau_end_) return;
    // Belongs to what was before, as does the rounding of a stretch that ended a trifle later.
    if (i.tau <= tau_start_) {
        integrals_ = {};
        duration_ = peak_ = 0;
        return;
    }
    const double w = i.relative_speed_before, loss = (1 - i.R * i.R) * w * w * parameters_.epsilon /
                                                     (2 * (1 + parameters_.epsilon));
    impacts_ += loss;
    end_ -= loss;
}

double Energy::input() const {
    return parameters_.epsilon * parameters_.A() * integrals_.x_dot_sin;
}
double Energy::damper() const { return 2 * parameters_.zeta() * integrals_.x_dot_squared; }
double Energy::rms() const {
    return duration_ > 0 ? std::sqrt(integrals_.x_squared / duration_) : 0;
}

EnergyBalance balance_of(const Parameters& p, const Energy& e, const Interval& window) {
    const double dissipated = e.impacts() + e.damper();
    return {
        .window = window,
        .input = p.G == 0 ? 0 : e.input(),
        .damper = e.damper(),
        .impacts = e.impacts(),
        .stored = e.stored(),
        .residual = e.residual(),
        .at_start = e.at_start(),
        .at_end = e.at_end(),
        .share_impacts = ratio(e.impacts(), dissipated),
        .rms = e.rms(),
        .peak = e.peak()};
}

std::optional<double> ratio(double of, double to) {
    return to > 0 ? std::optional(of / to) : std::nullopt;
}

std::optional<double> free_amplitude(const Parameters& p) {
    const double detuning = (1 - p.Omega) * (1 + p.Omega),
                 D = detuning * detuning + 4 * p.zeta() * p.zeta() * p.Omega * p.Omega;
    if (D == 0) return std::nullopt;
    return p.epsilon * p.A() / std::sqrt(D);
}

double unattached_rms(const Parameters& p, const State& start, double duration) {
    const Quadrature::Integrals sum =
        Quadrature::shared(*Flow::shared_free(p))
            ->over({start.x, start.x_dot, std::sin(p.phi()), std::cos(p.phi())}, duration);
    return std::sqrt(sum.x_squared / duration);
}

Unattached unattached(const Parameters& p, const State& start, double tau_start, double tau_end) {
    const auto table = Flow::shared_free(p);
    const Flow& flow = *table;
    const Oscillation o{start.x, start.x_dot, std::sin(p.phi()), std::cos(p.phi())};
    const Oscillation begin = flow.after(o, tau_start);
    const double duration = tau_end - tau_start;
    return {
        duration > 0
            ? std::sqrt(Quadrature::shared(flow)->over(begin, duration).x_squared / duration)
            : 0,
        excursion(flow, begin, duration).peak, free_amplitude(p)};
}

namespace {

/// Where an energy that does not rise falls to a level between 0 and `high`, after tau_start: by
/// bisection.
template <class EnergyAt>
double moment_of(EnergyAt energy_at, double level, double high, double tau_start) {
    double low = 0;
    while (high - low > moment_rounding * (tau_start + high)) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        (energy_at(middle) > level ? low : high) = middle;
    }
    return tau_start + high;
}

}  // namespace

Decay::Decay(const Parameters& p, double tau_start, std::vector<double> shares)
    : tau(shares.size()),
      parameters_(p),
      tau_start_(tau_start),
      shares_(std::move(shares)) {}

void Decay::on_stretch(const Stretch& stretch) {
    const double from = tau_start_ - stretch.tau;
    if (from > stretch.duration) return;
    auto energy_at = [&](double s) { return energy_of(parameters_, stretch.at(s)); };
    if (!at_start_) at_start_ = energy_at(std::max(0.0, from));
    const double end = energy_at(stretch.duration);
    for (std::size_t k = 0; k < shares_.size(); ++k) {
        const double level = shares_[k] * *at_start_;
        if (!tau[k] && end <= level)
            tau[k] =
                std::max(tau_start_, moment_of(energy_at, level, stretch.duration, stretch.tau));
    }
}

std::vector<std::optional<double>> unattached_decay(
    const Parameters& p, const State& start, double tau_start, const std::vector<double>& shares) {
    std::vector<std::optional<double>> tau(shares.size());
    const Flow flow(1, 2 * p.zeta(), 0, p.Omega);
    const Oscillation begin = flow.after({start.x, start.x_dot, 0, 1}, tau_start);
    auto energy_at = [&](double s) {
        const Oscillation o = flow.after(begin, s);
        return 0.5 * (o.x * o.x + o.x_dot * o.x_dot);
    };
    if (p.zeta() == 0 || energy_at(0) == 0) return tau;
    for (std::size_t k = 0; k < shares.size(); ++k) {
        const double level = shares[k] * energy_at(0);
        double high = 1;
        while (energy_at(high) > level && high < longest_decay) high *= 2;
        if (high < longest_decay) tau[k] = moment_of(energy_at, level, high, tau_start);
    }
    return tau;
}

}  // namespace vines
