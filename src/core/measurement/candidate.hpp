// What may be an impact, as long as it is not known which are.
#pragma once

#include <vector>

#include "core/measurement/joint_fit.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

struct Candidate {
    double tau = 0;
    double jump = 0;         ///< of x'; 0: not known
    double height = 0;       ///< of its event in the acceleration; 0: none is seen
    double event = 0;        ///< the moment of that
    double improvement = 0;  ///< by its kink, in variances
    double pulse_tau = 0, pulse_error = infinity;  ///< as in ImpactMoment
    Border border = Border::impact;
    bool sticks = false;  ///< as in ImpactMoment
    /// By the run of what is identified (hidden_contacts.hpp), which says the wall: it need not
    /// show. 0: by no run.
    int predicted_side = 0;

    bool is_impact() const { return border == Border::impact; }
    bool is_predicted() const { return predicted_side != 0; }
};

/// Of |jump|; NaN of none.
double typical_jump(const std::vector<Candidate>& candidates);

/// Typically, of the jump of x' to the height of its event; 0 where none is seen.
double jump_to_height(const std::vector<Candidate>& candidates);

void sort_by_time(std::vector<Candidate>& candidates);

/// So near to an impact, in tau, there is no other one that could be seen: the mass would have to
/// be turned around in that time.
inline constexpr double beside_impact = 0.25;

}  // namespace vines
