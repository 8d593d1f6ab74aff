// Trajectory difference (Fig. 2, eqs. (13) to (15)): a second run that starts slightly displaced,
// and the linear theory's prediction of its distance, the Euclidean length of the difference of the
// states (x', x, y', y).
//
// Between the times of the two runs' k-th impacts the plain difference has the size of the velocity
// jump and does not measure their divergence. There the run that struck first is continued as if it
// had not struck: up to the second time the difference is delta Phi^- of Fig. 2, afterwards delta
// Phi^+. The tangent vector is treated in the same way. The k-th impacts of a chatter correspond
// even if one run is several impacts ahead. If the chatter ends in a sticking phase, the impacts
// that one run still has before it sticks belong to that phase: the plain difference is used until
// both runs stick.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/motion/record.hpp"
#include "core/stability/exterior.hpp"

namespace vines {

/// Largest difference of distance and tangent that agrees with the linear theory, relative.
inline constexpr double linear_share = 0.1;
/// Fewer impacts give the slope of single impacts, not of the motion.
inline constexpr long fewest_linear_impacts = 3;

/// Contacts of a run that are recorded, 21 MB; the second run has at most half as many impacts.
inline constexpr std::size_t most_compared = 200'000;

/// Random direction of length `size` in the space of (x', x, y', y); identical on every machine.
State random_difference(std::uint64_t seed, double size);
inline State displaced(const State& start, const State& difference) {
    return state_of(vector_of(start) + vector_of(difference));
}
inline State difference_of(const State& to, const State& from) {
    return state_of(vector_of(to) - vector_of(from));
}
double length_of(const State& difference);  ///< Euclidean length in (x', x, y', y)

/// A contact as used to compare two runs: an impact, or the begin of a sticking phase.
struct ComparedContact {
    double tau;
    int side;
    bool stick;
    bool pressed;             ///< impact: the wall presses the ball (side x'' > 0)
    double release;           ///< sticking phase: its end
    Oscillation before = {};  ///< impact: the oscillator before it
    double y_dot_before = 0;  ///< impact: the ball before it
    State deviation = {};     ///< impact: the tangent vector before it, if carried
};

/// Records the contacts of a run and carries a tangent vector along it. Samples the motion and the
/// vector's length at tau = 0, step, 2 step, ... and at the end of the run.
class ComparedRun : public Observer {
public:
    /// `deviation`: the tangent vector at the start; zero if not needed. `step`: 0 for no samples.
    ComparedRun(const Parameters& parameters, double step, const State& deviation)
        : parameters_(parameters),
          deviation_(vector_of(deviation)),
          step_(step) {}
    void on_stretch(const Stretch&) override;
    void on_impact(const Impact&) override;
    void on_stick(const StickStart& s) override {
        add({.tau = s.tau, .side = s.side, .stick = true, .pressed = true, .release = s.tau});
    }
    void on_release(double tau) override {
        if (!is_cut_) contacts.back().release = tau;
    }
    void finish(const Outcome& outcome) {
        series_.finish(outcome);
        if (tangent.size() < series().tau.size()) tangent.push_back(deviation_.norm());
    }
    /// Records one more cycle, where impacts of the other run can have their counterparts; returns
    /// the time up to which these are known.
    double look_ahead(const Outcome& outcome);

    const Series& series() const { return series_.series; }
    Series take_series() { return std::move(series_.series); }
    std::vector<ComparedContact> contacts;
    std::vector<double> tangent;  ///< lengths, at the times of the series

private:
    void add(const ComparedContact& contact) {
        is_cut_ = is_cut_ || contacts.size() >= most_compared;
        if (!is_cut_) contacts.push_back(contact);
    }

    const Parameters parameters_;
    Eigen::Vector4d deviation_;
    const double step_;
    bool is_cut_ = false;  // contacts.size() is most_compared, and there were more
    SeriesRecord series_{step_};
};

/// Interval over which the distance follows the linear theory, from the first impact on.
struct LinearStretch {
    Interval tau;
    double slope;    ///< of ln(distance), by least squares
    double lambda1;  ///< by qr, from the interval's first impact to its last; NaN if interrupted
};

struct Perturbation {
    State start;      ///< initial difference of the second run
    Outcome outcome;  ///< of the second run
    Series series;    ///< of the second run, at the reference's times
    std::vector<ContactEvent> impacts;
    /// At the times of the series: the distance as defined above, and the tangent vector's length.
    std::vector<double> distance, tangent;
    /// Time from which the impacts of both runs no longer correspond (opposite walls, or one
    /// without a counterpart) and the distance is the plain one; empty if never.
    std::optional<double> parted;
    std::optional<LinearStretch> linear;
    /// End of the agreement with the linear theory, and the reference's impacts up to there.
    double linear_until;
    long linear_impacts;
};

/// Compares the run from displaced(start, difference), within `limits`, with `reference`, which
/// observed the run from `start` to `outcome` with that difference as tangent vector.
Perturbation perturbation_of(
    const Parameters& parameters, const State& start, const State& difference,
    ComparedRun& reference, const Outcome& outcome, Limits limits, double step);

}  // namespace vines
