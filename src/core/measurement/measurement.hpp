// Evaluation of a measurement of the oscillator (section 5 of the paper), a record or a list of
// impacts with their states: impacts, R, exponents and the verdict, with two results for comparison
// (the paper's direct estimate, and a run of the identified system).
//
// The joint fit (unknowns.hpp, joint_fit.hpp) gives the oscillator's motion on both sides of each
// detected impact (search.hpp). The jumps of x' and the flights of the mass between its contacts, y
// = x - side b, give y', R and the transfer matrices; if the mass was part of the fit, R and b are
// the fitted ones.
//
// Dimensionless time: tau = omega0 t, velocities in m per unit of tau, accelerations per tau^2.
#pragma once

#include <optional>
#include <vector>

#include "core/measurement/hidden_contacts.hpp"
#include "core/measurement/joint_fit.hpp"
#include "core/measurement/measured_exponents.hpp"

namespace vines {

/// Why a measurement permits no verdict.
enum class Doubt {
    not_settled,       ///< the search for impacts did not converge: FoundImpacts::settled
    unexplained,       ///< the fitted motion does not explain the record
    pulses_disagree,   ///< many pulses without an impact, and many impacts without a pulse
    impacts_differ,    ///< R or the momentum error scatters between impacts
    hidden_uncertain,  ///< with hidden contacts the residual shows several effects at once
    b_disagrees,       ///< the momentum balance contradicts the given b
    no_forcing         ///< for a list: no forcing leads from each impact to the next
};

/// A record of the oscillator, or a list of impacts, with what is known about the system.
struct Measurement {
    Parameters parameters;  ///< R is used only if R_given; for a record G is fitted
    bool R_given = false;
    MeasuredRecord record = {};             ///< empty if the impacts are given with their states
    std::vector<double> impact_times = {};  ///< known times of impacts, in tau; empty: detect them
    IdentifiedImpacts impacts = {};         ///< with complete_impacts(); replaces a record
    std::optional<ListedForcing> listed_forcing = {};  ///< that of these impacts
    std::vector<Doubt> doubts = {};                    ///< known doubts about these impacts
    double threshold = 6;      ///< of a spike, in standard deviations of the noise
    FixedUnknowns fixed = {};  ///< unknowns of the fit that keep their given values
    KnownForcing forcing = {};
    std::vector<double> mains = {};  ///< frequencies of the mains, like Omega
    GivenUncertainty uncertainty = {};
    BallLaws laws = {};             ///< fitted from those of the parameters and of R_slope
    RestitutionSlope R_slope = {};  ///< of walls without a table
    ExponentOptions estimators = {};
    ExponentOptions direct_estimators = qr_alone;  ///< for the paper's direct estimate

    bool is_record() const { return impacts.empty(); }
    double step() const;  ///< mean sampling interval of the record, in tau
};

struct ImpactSearch;

/// The pulse of an impact as the sensors show it, with all effects of sensor, filter and mounting:
/// the average of all pulses of the record, aligned at their impacts. Acceleration per unit jump of
/// x', by the time since the impact.
class PulseTemplate {
public:
    /// Empty template.
    PulseTemplate() = default;
    /// From the last fit's impacts with a certain jump, at these times.
    PulseTemplate(const ImpactSearch& s, const std::vector<double>& times);

    bool empty() const { return value_.empty(); }
    double at(double s) const;
    /// Standard deviation of single pulses from the template at s, per unit jump.
    double scatter(double s) const;
    /// Error that the template adds to the time of an impact: it is aligned by the impacts whose
    /// samples lie next to each other in it, and these by the displacement.
    double time_error() const { return time_error_; }
    /// Length of a half sine with the same width at half height, in tau.
    double length() const;
    /// Time from the impact to the pulse's maximum, in tau.
    double delay() const;

private:
    double begin_ = 0, spacing_ = 1, bin_ = 1, time_error_ = 0;
    std::vector<double> value_, scatter_;
};

/// The impacts of a record.
struct FoundImpacts {
    JointFit fit;
    bool with_mass = false;      ///< the mass was part of the fit: its R and b are fitted
    std::vector<Interval> gaps;  ///< gaps of the record that can hide an impact
    PulseTemplate pulse;
    PulseExtent extent{0, 0};
    long unseen = 0;              ///< impacts without a visible pulse
    std::vector<double> dropped;  ///< times of pulses, or given times, without a jump of x'
    HiddenContactLimits hidden_contact_limits;
    bool settled = false;  ///< the last round neither dropped nor added an impact
};

/// Thrown for a record with fewer than two visible impacts.
struct TooFewImpacts {
    long seen;
};

/// Why no b is fitted.
enum class BFault {
    none,
    no_flight,  ///< no impact has a neighbour on the other wall
    negative,   ///< b would be negative
    scattered,  ///< the impacts give different values
    doubtful    ///< the record or its impacts leave a doubt
};

struct Identification {
    IdentifiedImpacts impacts;
    Restitution plus, minus;
    /// The b that satisfies the momentum balance best, m; NaN if none does. Its standard error; NaN
    /// if the mass was not part of the fit, since the impacts' errors are not independent.
    double b_fitted = nan, b_error = nan;
    BFault b_fault = BFault::none;
};

/// Whether the given b agrees with the fitted one within 3 % or five standard errors, if there is.
bool b_agrees(const Parameters& parameters, const Identification& identification);

/// The paper's direct estimate: velocities from differences, and the results that follow.
struct DirectEstimate {
    Identification found;
    Exponents lambda;  ///< qr, without faulty impacts
    /// From the same impacts as MeasurementResult::exponents, faulty ones included.
    std::vector<KnownStretch> stretches;
    MeasuredExponents exponents;
};

/// The laws of the ball as fitted.
struct FittedLaws {
    double friction, friction_error;  ///< m
    RestitutionSlope R;               ///< speed: the mean one, at which the walls' R applies
    double R_slope_error;
    double chi_square;  ///< decrease of the sum of squares from the laws that were given
};

/// Run of the identified system over the record's time, from the first impact of known state.
struct ForwardRun {
    double start;                 ///< tau of that impact
    std::vector<Impact> impacts;  ///< in the record's tau
    Exponents lambda;             ///< qr
};

struct MeasurementResult {
    /// With the R of each wall; for a record also with the fitted Omega and G, and with the fitted
    /// b if it contradicts the given one.
    Parameters parameters;
    Identification found;
    std::optional<FoundImpacts> refined;  ///< for a record
    /// Empty unless they are fitted, if the fit does not settle, or where b is withheld.
    std::optional<FittedLaws> laws = {};
    Continuity continuity;
    MeasuredExponents exponents;
    IdentifiedExponents judged;
    std::vector<Doubt> doubts;  ///< reasons why no verdict is possible
    std::optional<DirectEstimate> direct;
    std::optional<ForwardRun> forward;
};

/// Needs at least two `impacts` or a record. Throws TooFewImpacts and IdentificationStopped.
MeasurementResult evaluate_measurement(
    const Measurement& measurement, const IdentificationWatch& watch = {});

}  // namespace vines
