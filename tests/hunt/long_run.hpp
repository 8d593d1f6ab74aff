// The judge: a run twenty times as long as the one that is judged, with its own search for periods
// and its own largest exponent. Of the code it judges it uses the trajectory alone.
#pragma once

#include <vector>

#include "core/motion/simulate.hpp"

namespace vines::hunt {

class LongRun {
public:
    /// Runs from tau = 0 over so many forcing cycles, or over fewer where it stays on a periodic
    /// orbit or takes too many impacts.
    LongRun(const Parameters& parameters, const State& start, int cycles);

    int cycles() const { return cycles_; }  ///< that the run has come to
    /// Forcing cycles after which the state at cycle `at` and those of two periods before it had
    /// returned; 0: none of up to 400.
    int period_at(int at) const;
    /// Whether nearly all states of a stretch are next to those some cycles before: it may be an
    /// unstable orbit, but no chaos.
    bool returns_all_along(int from, int to) const;
    /// How far the state at cycle `at` is from that `period` cycles before, in units of the
    /// motion's size there.
    double miss(int at, int period) const;
    /// The first cycle from which on the run stays within a distance of the periodic motion of so
    /// many cycles that it ends on.
    int captured_from(int period, double distance) const;
    /// Whether that motion is its own mirror image half a period later.
    bool ends_symmetric(int period) const;
    /// Impacts of a period, and whether anything sticks in it.
    struct PeriodContacts {
        int impacts, sticks;
    };
    PeriodContacts contacts_at_end(int period) const;

    /// ln of the growth of a deviation from one cycle to another.
    double growth(int from, int to) const;
    struct Exponent {
        double lambda1, error;  ///< of the mean of 20 blocks
    };
    Exponent exponent(int from, int to) const;

private:
    /// What each component of a state is measured by, around a cycle.
    struct Scale {
        double x, y_dot, gap;
    };
    int complete_cycles() const;
    Scale scale_at(int cycle) const;
    double distance(const State& a, const State& b, const Scale& scale) const;
    const State& at_cycle(int k) const { return states_[2 * static_cast<std::size_t>(k)]; }

    Parameters parameters_;
    int cycles_ = 0;
    std::vector<State> states_;          // at half cycles
    std::vector<double> growth_;         // ln of the growth up to cycle k
    std::vector<int> impacts_, sticks_;  // in cycle k
};

}  // namespace vines::hunt
