// Reference for verdicts: a run twenty times as long as the one under test, with its own search for
// periods and its own largest exponent. It shares only the trajectory with the code under test.
#pragma once

#include <vector>

#include "core/motion/simulate.hpp"

namespace vines::hunt {

class LongRun {
public:
    /// Runs from tau = 0 over `cycles` forcing cycles, or fewer if it stays on a periodic orbit or
    /// has too many impacts.
    LongRun(const Parameters& parameters, const State& start, int cycles);

    int cycles() const { return cycles_; }  ///< completed
    const State& at_cycle(int k) const { return states_[2 * static_cast<std::size_t>(k)]; }
    /// Smallest period in forcing cycles, up to 400, with which the states up to cycle `at` have
    /// returned for two periods; 0: none.
    int period_at(int at) const;
    /// Returns whether nearly all states of an interval are close to those a fixed number of cycles
    /// before: possibly an unstable orbit, but not chaos.
    bool returns_throughout(int from, int to) const;
    /// Distance of the state at cycle `at` from that `period` cycles before, relative to the size
    /// of the motion.
    double miss(int at, int period) const;
    /// First cycle from which the run stays within a distance of its final periodic motion of this
    /// period.
    int captured_from(int period, double distance) const;
    /// Returns whether the final motion is its own mirror image half a period later.
    bool ends_symmetric(int period) const;
    /// Number of impacts and of sticking phases per period.
    struct PeriodContacts {
        int impacts, sticks;
    };
    PeriodContacts contacts_at_end(int period) const;

    /// ln of the growth of a deviation between two cycles.
    double growth(int from, int to) const;
    /// Largest growth of a deviation from any cycle to any later one, as a logarithm. `sustained`:
    /// without its three largest cycles, and zero unless it grows in each quarter of that time.
    struct Rise {
        double whole, sustained;
    };
    Rise rise(int from, int to) const;
    /// Distance of the last state from the closest one of the cycles from `from` on, relative to
    /// the size of the motion, without the cycle before.
    double closest_return(int from) const;
    struct Exponent {
        double lambda1, error;  ///< standard error of the mean of 20 blocks
    };
    Exponent exponent(int from, int to) const;

private:
    /// Units of a state's components around a cycle.
    struct Scale {
        double x, y_dot, gap;
    };
    int complete_cycles() const;
    Scale scale_at(int cycle) const;
    double distance(const State& a, const State& b, const Scale& scale) const;

    Parameters parameters_;
    int cycles_ = 0;
    std::vector<State> states_;          // at half cycles
    std::vector<double> growth_;         // ln of the growth up to cycle k
    std::vector<int> impacts_, sticks_;  // in cycle k
};

}  // namespace vines::hunt
