// Basins of attraction: the motions to which starts in a box lead, their fractions, and the
// roughness of the boundaries.
//
// The first starts are measured like points of a sweep. Around each stable orbit that they find, a
// neighbourhood is tested: motions from random states on its surface must approach the orbit. Other
// runs end as soon as they enter a neighbourhood at a whole cycle; runs that enter none are
// measured, too. A name follows from the motion alone (core/measures/attractor.hpp), so that it
// does not depend on which motions were known.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>

#include "core/sweep/sweep.hpp"

namespace vines {

/// The motions that a system is known to have.
class KnownMotions {
public:
    /// From measured motions of the system; `stop` ends the tests early.
    KnownMotions(
        const Parameters& parameters, const std::vector<PointResult>& motions,
        const StopRequest& stop);

    /// The motion to which a state at a whole cycle leads; null if unknown.
    const PointResult* reached_from(const State& at_whole_cycle) const;
    /// Gives an irregular motion the name of a known one if both have the same statistics.
    void name_as_known(PointResult& motion) const;

private:
    struct Neighbourhood {
        std::vector<State> centres;  ///< the orbit at whole cycles
        State scale;
        double radius;  ///< in units of the scale, see distance()
        PointResult motion;
    };
    const Parameters parameters_;
    std::vector<Neighbourhood> orbits_;
    std::vector<PointResult> others_;
};

/// Ranges of x_dot0, x0, y_dot0, y0; one of no width is a fixed value.
using StartBox = std::array<Interval, 4>;

/// `count` starts in the box and in the cavity: a low-discrepancy sequence (Roberts' additive
/// recurrence), shifted by the seed. Fewer if the box hardly meets the cavity.
std::vector<State> starts_in(
    const StartBox& box, const Parameters& parameters, std::size_t count, std::uint64_t seed);

struct BasinPlan {
    std::size_t count;  ///< starts for each value
    std::uint64_t seed;
    std::size_t pairs;  ///< for each distance of the uncertainty exponent
    /// Values of a swept parameter, ascending or descending; one if none is swept.
    std::vector<double> values;
    std::vector<StartBox> boxes;  ///< for each value; the same components vary
    std::function<std::optional<PointSystem>(double value)> system_at;
};

/// An estimate with its standard error.
struct Estimate {
    double value, error;
};

/// Wilson's 95 % interval of the fraction of k among n.
Interval binomial_interval(double k, double n);

/// The starts that lead to one motion.
struct Basin {
    PointResult motion;
    std::size_t starts;
    double fraction;
    Interval interval;          ///< 95 % of the fraction, Wilson's
    std::optional<int> branch;  ///< the same number for the same branch of orbits
};

/// Basins for one value of the parameter.
struct BasinsAt {
    double value;
    std::size_t starts, not_decided;
    std::vector<Basin> basins;  ///< the largest first
    /// Mean over cells of the box of the entropy -sum p ln p of the motions' fractions (Daza et
    /// al., 2016), over all cells and over those with several motions; empty if there is none.
    std::optional<Estimate> entropy, boundary_entropy;
    std::size_t cells;
    /// Exponent alpha of the fraction ~ distance^alpha of pairs of starts that lead to different
    /// motions; empty if fewer than three distances have such pairs.
    std::optional<Estimate> uncertainty_exponent;
    std::vector<double> distances, uncertain;  ///< in units of the box's widths; fractions
};

/// Collects the results of all starts. Numbers of starts: value + start * values.
class Basins {
public:
    /// Calls poll() for each value.
    explicit Basins(BasinPlan plan, const std::function<void()>& poll = [] {});

    /// Finds the motions that are known from then on. Throws Stopped.
    void explore(int threads, const PointOptions& options, RunControl& control);
    /// Starts found for the value that has fewest.
    std::size_t fewest_starts() const {
        return std::ranges::min(starts_, {}, [](const auto& own) { return own.size(); }).size();
    }
    /// The system of a start, with the known motions; empty without a start.
    std::optional<PointSystem> system_of(const Place& place) const;
    void add(std::size_t line, const PointResult& result);  ///< from any thread
    /// Counts a start that led to the motion `name` in an earlier computation. False for the first
    /// one of each motion, which is to be computed again, since that gives the motion's measures.
    bool restore(std::size_t line, const std::string& name);
    bool is_complete() const;  ///< all starts are added or restored
    /// Runs neighbours of the first starts for the exponents. Throws Stopped.
    void run_pairs(int threads, const PointOptions& options, RunControl& control);
    /// The result for each value, from the starts so far.
    std::vector<BasinsAt> result() const;

private:
    /// A motion, from the first line that leads to it, whatever the order of the runs.
    struct Found {
        std::size_t line;
        PointResult motion;
    };
    struct Pair {
        std::size_t line;
        int distance;
        bool differs;
    };
    std::size_t values() const { return plan_.values.size(); }
    BasinsAt basins_at(std::size_t value) const;
    void add_entropy(std::size_t value, BasinsAt& at) const;
    void add_exponent(std::size_t value, BasinsAt& at) const;

    const BasinPlan plan_;
    std::vector<PointSystem> systems_;        ///< for each value
    std::vector<std::vector<State>> starts_;  ///< for each value
    std::vector<std::size_t> labels_;         ///< by line: index of the motion + 1; 0: missing
    std::vector<Found> motions_;              ///< of all values
    std::map<std::pair<std::size_t, std::string>, std::size_t> index_of_;  ///< value and name
    std::vector<Pair> pairs_;
    mutable std::mutex mutex_;
};

}  // namespace vines
