// Search for the impacts of a record: initial candidates, a joint fit, then rounds that drop false
// impacts and add overlooked ones until nothing changes.
#pragma once

#include "core/measurement/hidden_contacts.hpp"
#include "core/measurement/joint_fit.hpp"
#include "core/measurement/pulse_template.hpp"
#include "core/stability/lyapunov.hpp"

namespace vines {

struct FoundImpacts {
    JointFit fit;
    bool with_mass = false;     ///< the mass was part of the fit: its R and b are fitted
    std::vector<TimeGap> gaps;  ///< gaps of the record that can hide an impact
    PulseTemplate pulse;
    PulseExtent extent{0, 0};
    long unseen = 0;              ///< impacts without a visible pulse
    std::vector<double> dropped;  ///< times of pulses, or given times, without a jump of x'
    HiddenContactLimits hidden_contact_limits;
    bool settled = false;  ///< the last round neither dropped nor added an impact
};

/// Why a record permits no verdict.
enum class Doubt {
    not_settled,      ///< the search for impacts did not converge: FoundImpacts::settled
    unexplained,      ///< the fitted motion does not explain the record
    pulses_disagree,  ///< many pulses without an impact, and many impacts without a pulse
    impacts_differ,   ///< R or the momentum error scatters between impacts
    b_disagrees,      ///< the momentum balance contradicts the given b
    no_forcing        ///< for a list: no forcing leads from each impact to the next
};

/// A record of the oscillator, or a list of impacts, with what is known about the system.
struct Measurement {
    Parameters parameters;  ///< R is used only if R_given; for a record G is fitted
    bool R_given = false;
    MeasuredRecord record = {};             ///< empty if the impacts are given with their states
    std::vector<double> impact_times = {};  ///< known times of impacts, in tau; empty: detect them
    std::vector<IdentifiedImpact> impacts = {};  ///< with complete_impacts(); replaces a record
    std::vector<Doubt> doubts = {};              ///< known doubts about these impacts
    double threshold = 6;      ///< of a spike, in standard deviations of the noise
    FixedUnknowns fixed = {};  ///< unknowns of the fit that keep their given values
    KnownForcing forcing = {};
    std::vector<double> mains = {};  ///< frequencies of the mains, like Omega
    GivenUncertainty uncertainty = {};
    ExponentOptions estimators = {};
    ExponentOptions direct_estimators = qr_alone;  ///< for the paper's direct estimate

    bool is_record() const { return impacts.empty(); }
    double step() const;  ///< mean sampling interval of the record, in tau
};

/// The impacts of a record. Fewer than two impacts if nothing resembles one. Throws
/// IdentificationStopped.
FoundImpacts find_impacts(const Measurement& measurement, IdentificationProgress& progress);

}  // namespace vines
