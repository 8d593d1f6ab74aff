// A second run that starts a little off, beside the run itself: the trajectory difference of Fig. 2
// and eqs. (13) to (15), and what the linear theory says of its length.
//
// The distance is the Euclidean length of the difference of both states, (x', x, y', y), taken
// through impacts. Between the two moments at which both runs have their k-th impact the plain
// difference is of the size of the velocities' jump and says nothing of how far they have diverged.
// There the run that has struck first is continued as if it had not struck yet: up to the second
// moment that is delta Phi^- of Fig. 2, behind it delta Phi^+, and no sample has to be left out.
// The tangent vector is taken the same way.
//
// Of a chatter the k-th impacts belong together as well, however many one run is ahead. Where it
// ends in a stick, what one of them still has left of it before it sticks belongs to the stick: by
// then the plain difference is as small as the deviation, and it is taken until both are stuck.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/motion/record.hpp"
#include "core/stability/transfer.hpp"

namespace vines {

/// A perturbed run and its reference agree with the linear theory while the distance is that of the
/// tangent vector to this share.
inline constexpr double linear_share = 0.1;
/// A slope over fewer impacts would be that of single ones.
inline constexpr long fewest_linear_impacts = 3;

/// A random direction of length `size` in the space of (x', x, y', y): the same on every machine.
State random_difference(std::uint64_t seed, double size);
State displaced(const State& start, const State& difference);
State difference_of(const State& to, const State& from);
/// Euclidean, in (x', x, y', y).
double length_of(const State& difference);

/// A contact as two runs are compared by it: an impact, or a stick that begins.
struct ComparedContact {
    double tau;
    int side;
    bool stick;
    bool pressed;         ///< of an impact: whether its wall presses (side x'' > 0)
    double release;       ///< of a stick: its end
    Oscillation before;   ///< of an impact: the oscillator before it
    double y_dot_before;  ///< of an impact: the free mass before it
    State deviation;      ///< of an impact: the tangent vector before it, if one is carried
};

/// Writes down the contacts of a run, and carries a tangent vector from its start on, by J (18),
/// (19) and M (26), (27), or the projection of a stick.
class ComparedContacts : public Observer {
public:
    /// `deviation`: the tangent vector at the start; zero where none is asked for.
    ComparedContacts(const Parameters& parameters, const State& deviation);
    void on_stretch(const Stretch&) override;
    void on_impact(const Impact&) override;
    void on_stick(const StickStart&) override;
    void on_release(double tau) override { contacts.back().release = tau; }

    std::vector<ComparedContact> contacts;

protected:
    const Parameters parameters_;
    Eigen::Vector4d deviation_;
};

/// The same, with the motion and the length of the tangent vector at tau = 0, step, 2 step, ... and
/// at the end of the run.
class ComparedRun : public ComparedContacts {
public:
    ComparedRun(const Parameters& parameters, double step, const State& deviation)
        : ComparedContacts(parameters, deviation),
          series_(step) {}
    void on_stretch(const Stretch&) override;
    void finish(const Outcome& outcome);
    /// Follows the contacts for a cycle more: what the other run has just before the end, this one
    /// may have just behind it.
    void look_ahead(const Outcome& outcome);

    const Series& series() const { return series_.series; }
    Series take_series() { return std::move(series_.series); }
    std::vector<double> tangent;  ///< lengths, at the moments of the series

private:
    SeriesRecord series_;
};

/// The stretch in which the distance follows the linear theory, from the reference's first impact
/// on, and how ln(distance) grows over it, per unit of tau.
struct LinearStretch {
    Interval tau;
    double slope;    ///< of ln(distance), by least squares
    double lambda1;  ///< qr, from the stretch's first impact to its last; NaN if interrupted
};

struct Perturbation {
    State start;      ///< the difference that the second run starts with
    Outcome outcome;  ///< of the second run
    Series series;    ///< of the second run, at the reference's moments
    std::vector<TangentContact> impacts;
    /// At the moments of the series: the distance as above, and the length of the tangent vector.
    std::vector<double> distance, tangent;
    /// The moment from which on the impacts of both no longer correspond (one meets the other wall,
    /// or has an impact that the other never has), and the distance is the plain one; none where
    /// they do to the end.
    std::optional<double> parted;
    std::optional<LinearStretch> linear;
    /// How far the linear theory holds, and over how many impacts of the reference.
    double linear_until;
    long linear_impacts;
};

/// The run from displaced(start, difference) beside `reference`, which has observed the run from
/// `start` with their difference as its tangent vector and is finish()ed; `outcome` is that run's.
/// Both starts lie in the cavity. limits: of the second run, which ends with the first one at the
/// latest.
Perturbation perturbation_of(
    const Parameters& parameters, const State& start, const State& difference,
    ComparedRun& reference, const Outcome& outcome, Limits limits, double step);

}  // namespace vines
