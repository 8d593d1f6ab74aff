#include "core/identification/fitted_motion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "core/identification/oscillator_model.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// x is continuous at an impact: of the noise of one sample the fit may leave it that much of a
// jump. Far smaller, and the equations lose digits; larger, and the kink in x tells less of the
// moment.
constexpr double continuity_share = 0.05;
// Added to the diagonal of the normal equations, where a single sample adds about 1/noise^2, far
// above 1: what no sample says anything of comes out as zero, what one does is left as it is.
constexpr double ridge = 1e-9;
// A pulse spoils the acceleration over half of it on both sides of an impact, and that share of a
// sample's step more.
constexpr double pulse_margin = 0.1;
// A misfit of three quarters of the noise beside the noise: sqrt(1 + .75^2). Records with the
// assumed signal stay below 1.05.
constexpr double misfit_limit = 1.25;

/// One sample as the model sees it.
struct FitSample {
    std::size_t index, interval;  ///< its own, and that of its interval
    ModelRows rows;
    bool in_pulse;  ///< its acceleration is the pulse's
};

/// The normal equations N z = g of one interval's samples, z = its start and the forcing.
struct IntervalEquations {
    Eigen::Matrix4d N = Eigen::Matrix4d::Zero();
    Eigen::Vector4d g = Eigen::Vector4d::Zero();

    void add(const Eigen::Vector4d& row, double value, double sigma) {
        const Eigen::Vector4d scaled = row / sigma;
        N += scaled * scaled.transpose();
        g += scaled * (value / sigma);
    }
};

/// The normal equations of the whole record: two unknowns for each interval, then the two of the
/// forcing.
class JointEquations {
public:
    explicit JointEquations(std::size_t intervals)
        : unknowns_(static_cast<Eigen::Index>(2 * intervals + 2)),
          right_(Eigen::VectorXd::Zero(unknowns_)) {}

    void add(std::size_t i, const IntervalEquations& own) {
        const Eigen::Index at[4] = {
            static_cast<Eigen::Index>(2 * i), static_cast<Eigen::Index>(2 * i + 1), unknowns_ - 2,
            unknowns_ - 1};
        for (int j = 0; j < 4; ++j) {
            right_(at[j]) += own.g(j);
            for (int k = 0; k < 4; ++k) triplets_.emplace_back(at[j], at[k], own.N(j, k));
        }
    }
    /// x at the end of interval i (row) is x at the start of the next.
    void connect(std::size_t i, const Eigen::Vector4d& row, double weight) {
        Eigen::Matrix<double, 5, 1> all;
        all << row, -1;
        const Eigen::Index at[5] = {
            static_cast<Eigen::Index>(2 * i), static_cast<Eigen::Index>(2 * i + 1), unknowns_ - 2,
            unknowns_ - 1, static_cast<Eigen::Index>(2 * i + 2)};
        for (int j = 0; j < 5; ++j)
            for (int k = 0; k < 5; ++k)
                triplets_.emplace_back(at[j], at[k], weight * weight * all(j) * all(k));
    }
    Eigen::VectorXd solve() {
        // An interval without a sample, or a record that does not show the forcing, leaves its
        // unknowns at zero.
        for (Eigen::Index k = 0; k < unknowns_; ++k) triplets_.emplace_back(k, k, ridge);
        Eigen::SparseMatrix<double> N(unknowns_, unknowns_);
        N.setFromTriplets(triplets_.begin(), triplets_.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(N);
        // Without a factorisation solve() leaves its result unset. A motion of zero explains
        // nothing, and is seen to.
        if (solver.info() != Eigen::Success) return Eigen::VectorXd::Zero(unknowns_);
        const Eigen::VectorXd z = solver.solve(right_);
        return z.allFinite() ? z : Eigen::VectorXd(Eigen::VectorXd::Zero(unknowns_));
    }

private:
    const Eigen::Index unknowns_;
    std::vector<Eigen::Triplet<double>> triplets_;
    Eigen::VectorXd right_;
};

/// Of moments that ascend the interval that each falls into; at the start of one into that.
class Intervals {
public:
    explicit Intervals(const std::vector<double>& starts) : starts_(starts) {}
    std::size_t at(double tau) {
        while (i_ + 1 < starts_.size() && starts_[i_ + 1] <= tau) ++i_;
        return i_;
    }

private:
    const std::vector<double>& starts_;
    std::size_t i_ = 0;
};

/// What the model takes for interval i of a motion.
Eigen::Vector4d unknowns_of(const FittedMotion& m, std::size_t i) {
    return {m.x[i], m.x_dot[i], m.force_sin, m.force_cos};
}

/// Visits the samples of a record in order. Their rows would take four times the memory of the
/// record, and are made twice instead.
class FitSamples {
public:
    /// `starts`: of the intervals; a sample closer to an impact than `spoiled` lies in its pulse.
    FitSamples(
        const OscillatorModel& model, const MeasuredRecord& r, const std::vector<double>& starts,
        double spoiled)
        : model_(model),
          r_(r),
          starts_(starts),
          spoiled_(spoiled) {}

    std::size_t intervals() const { return starts_.size(); }

    template <class Visit>
    void each(const Visit& visit) const {
        Intervals intervals(starts_);
        for (std::size_t k = 0; k < r_.tau.size();) {
            const std::size_t i = intervals.at(r_.tau[k]);
            OscillatorModel::Interval interval(model_, starts_[i]);
            for (; k < r_.tau.size() && intervals.at(r_.tau[k]) == i; ++k) {
                const double since = r_.tau[k] - starts_[i];
                visit(FitSample{k, i, interval.at(since), in_pulse(i, r_.tau[k])});
            }
        }
    }

private:
    bool in_pulse(std::size_t i, double tau) const {
        return (i > 0 && tau - starts_[i] < spoiled_) ||
               (i + 1 < starts_.size() && starts_[i + 1] - tau < spoiled_);
    }

    const OscillatorModel& model_;
    const MeasuredRecord& r_;
    const std::vector<double>& starts_;
    const double spoiled_;
};

std::vector<IntervalEquations> equations_of(
    const MeasuredRecord& r, const RecordStatistics& statistics, const FitSamples& samples) {
    std::vector<IntervalEquations> equations(samples.intervals());
    samples.each([&](const FitSample& s) {
        if (!r.x.empty()) equations[s.interval].add(s.rows.x, r.x[s.index], statistics.x.noise);
        if (!r.x_ddot.empty() && !s.in_pulse)
            equations[s.interval].add(s.rows.x_ddot, r.x_ddot[s.index], statistics.x_ddot.noise);
    });
    return equations;
}

/// The model at the end of each interval but the last.
std::vector<ModelRows> ends_of(const OscillatorModel& model, const std::vector<double>& starts) {
    std::vector<ModelRows> ends;
    for (std::size_t k = 0; k + 1 < starts.size(); ++k)
        ends.push_back(model.at(starts[k], starts[k + 1] - starts[k]));
    return ends;
}

/// Sets the starts of all intervals and the forcing. `sigma`: of a jump of x at an impact.
void solve_together(
    const std::vector<IntervalEquations>& own, const std::vector<ModelRows>& ends, double sigma,
    FittedMotion& m) {
    JointEquations equations(own.size());
    for (std::size_t k = 0; k < own.size(); ++k) {
        equations.add(k, own[k]);
        if (k < ends.size()) equations.connect(k, ends[k].x, 1 / sigma);
    }
    const Eigen::VectorXd z = equations.solve();
    m.force_sin = z(z.size() - 2), m.force_cos = z(z.size() - 1);
    for (std::size_t k = 0; k < own.size(); ++k) {
        m.x.push_back(z(static_cast<Eigen::Index>(2 * k)));
        m.x_dot.push_back(z(static_cast<Eigen::Index>(2 * k + 1)));
    }
}

/// Sets each interval's own start, with the forcing of all; gives what it then knows of it: the
/// covariance of (x, x').
std::vector<Eigen::Matrix2d> solve_apart(
    const std::vector<IntervalEquations>& equations, FittedMotion& m) {
    const Eigen::Vector2d force(m.force_sin, m.force_cos);
    std::vector<Eigen::Matrix2d> covariance;
    for (const IntervalEquations& e : equations) {
        covariance.push_back(
            (e.N.topLeftCorner<2, 2>() + ridge * Eigen::Matrix2d::Identity()).inverse());
        const Eigen::Vector2d own =
            covariance.back() * (e.g.head<2>() - e.N.topRightCorner<2, 2>() * force);
        m.own_x.push_back(own(0));
        m.own_x_dot.push_back(own(1));
    }
    return covariance;
}

/// Sets what the motion is at the impacts, from both sides.
void meet_at_impacts(
    const OscillatorModel& model, const std::vector<ModelRows>& ends,
    const std::vector<Eigen::Matrix2d>& covariance, FittedMotion& m) {
    // An interval with hardly a sample says nothing.
    const auto error = [](double variance) {
        return variance > 0 ? std::sqrt(variance) : infinity;
    };
    for (std::size_t k = 0; k < ends.size(); ++k) {
        const Eigen::Vector4d before = unknowns_of(m, k),
                              own(m.own_x[k], m.own_x_dot[k], m.force_sin, m.force_cos);
        m.x_dot_before.push_back(ends[k].x_dot.dot(before));
        m.x_ddot_before.push_back(ends[k].x_ddot.dot(before));
        m.x_ddot_after.push_back(model.at(m.tau[k + 1], 0).x_ddot.dot(unknowns_of(m, k + 1)));
        m.x_jump.push_back(ends[k].x.dot(own) - m.own_x[k + 1]);
        m.x_jump_rate.push_back(ends[k].x_dot.dot(own) - m.own_x_dot[k + 1]);
        const Eigen::Vector2d row = ends[k].x.head<2>(), speed = ends[k].x_dot.head<2>();
        m.x_jump_error.push_back(error(row.dot(covariance[k] * row) + covariance[k + 1](0, 0)));
        m.x_dot_jump_error.push_back(
            error(speed.dot(covariance[k] * speed) + covariance[k + 1](1, 1)));
    }
}

/// What a fit leaves of a sensor over the noise of that sensor, which is seen beside the pulses. Of
/// the nine in ten that lie closest: a motion may be wrong in a part of the record, but a few odd
/// samples are no misfit.
double misfit_of(
    std::vector<double> residual, const SignalStatistics& signal,
    const std::vector<char>& spoiled) {
    // Of a normal distribution lie within that many standard deviations.
    constexpr double ninety_percent = 1.645;
    return quantile_of_moduli(std::move(residual), 0.9) / ninety_percent /
           elementary::hypot(signal.differences.noise(spoiled), signal.least_noise);
}

/// Sets what the motion leaves of the sensors.
void take_residuals(
    const MeasuredRecord& r, const RecordStatistics& statistics, const FitSamples& samples,
    FittedMotion& m) {
    std::vector<double> of_x, of_x_ddot;
    std::vector<char> spoiled(r.tau.size());
    of_x.reserve(r.x.size()), of_x_ddot.reserve(r.x_ddot.size());
    m.x_ddot_residual.resize(r.x_ddot.size());
    samples.each([&](const FitSample& s) {
        const Eigen::Vector4d unknowns = unknowns_of(m, s.interval);
        spoiled[s.index] = s.in_pulse;
        if (!r.x.empty()) of_x.push_back(r.x[s.index] - s.rows.x.dot(unknowns));
        if (r.x_ddot.empty()) return;
        const double left = r.x_ddot[s.index] - s.rows.x_ddot.dot(unknowns);
        m.x_ddot_residual[s.index] = left;
        if (!s.in_pulse) of_x_ddot.push_back(left);
    });
    if (!r.x.empty()) {
        m.noise_x = robust_deviation(of_x);
        m.misfit_x = misfit_of(std::move(of_x), statistics.x, spoiled);
    }
    if (!r.x_ddot.empty()) {
        m.noise_x_ddot = robust_deviation(of_x_ddot);
        m.misfit_x_ddot = misfit_of(std::move(of_x_ddot), statistics.x_ddot, spoiled);
    }
}

}  // namespace

FittedMotion fit_motion(
    const Parameters& p, const MeasuredRecord& r, const RecordStatistics& statistics,
    const std::vector<double>& impacts, double pulse) {
    const OscillatorModel model(p);
    FittedMotion m;
    m.tau = {r.tau.front()};
    m.tau.insert(m.tau.end(), impacts.begin(), impacts.end());
    const FitSamples samples(model, r, m.tau, 0.5 * pulse + pulse_margin * statistics.step);
    const std::vector<IntervalEquations> own = equations_of(r, statistics, samples);
    const std::vector<ModelRows> ends = ends_of(model, m.tau);
    const double noise = r.x.empty() ? statistics.x_ddot.noise : statistics.x.noise;
    solve_together(own, ends, continuity_share * noise, m);
    meet_at_impacts(model, ends, solve_apart(own, m), m);
    take_residuals(r, statistics, samples, m);
    return m;
}

OscillatorSeries motion_at(
    const Parameters& p, const FittedMotion& m, const std::vector<double>& moments) {
    const OscillatorModel model(p);
    OscillatorSeries series{moments, {}, {}, {}};
    for (auto* column : {&series.x, &series.x_dot, &series.x_ddot}) column->reserve(moments.size());
    Intervals intervals(m.tau);
    for (std::size_t k = 0; k < moments.size();) {
        const std::size_t i = intervals.at(moments[k]);
        OscillatorModel::Interval interval(model, m.tau[i]);
        const Eigen::Vector4d unknowns = unknowns_of(m, i);
        for (; k < moments.size() && intervals.at(moments[k]) == i; ++k) {
            const ModelRows rows = interval.at(moments[k] - m.tau[i]);
            series.x.push_back(rows.x.dot(unknowns));
            series.x_dot.push_back(rows.x_dot.dot(unknowns));
            series.x_ddot.push_back(rows.x_ddot.dot(unknowns));
        }
    }
    return series;
}

bool explains(const FittedMotion& m) {
    return !(m.misfit_x > misfit_limit) && !(m.misfit_x_ddot > misfit_limit);
}

}  // namespace vines
