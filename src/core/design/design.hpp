// Which absorber to build: the clearance b, the restitution coefficient R and the mass m2 with the
// smallest response over a band of frequencies and a range of amplitudes of the base, for the worst
// of all starts. Under a load or after an impulse the run begins at rest.
//
// The motion depends on the amplitude of the base and on b by their ratio alone, a scale of all
// lengths. One map over (b, f) at the largest amplitude therefore holds the responses at all
// smaller ones, which are those of larger b, scaled.
#pragma once

#include "core/design/tuned_mass_damper.hpp"
#include "core/sweep/parallel.hpp"
#include "core/sweep/point.hpp"

namespace vines {

// Scatter of an absorber and its host (tolerances.cpp).

/// Values with scatter, in the order in which they are set: f0 changes k1, damping_ratio c1.
enum class Toleranced { m1, k1, f0, c1, damping_ratio, m2, b, R, amplitude };

/// The distribution of a value.
struct Tolerance {
    Toleranced what;
    bool is_normal;        ///< otherwise uniform
    bool is_factor;        ///< on the nominal value; otherwise the value itself, in SI
    double first, second;  ///< mean and standard deviation, or both ends
};

/// An absorber and its host. The amplitude is that of the excitation over its nominal value.
struct BuiltAbsorber {
    SiParameters si;  ///< without F and f
    double b, R, amplitude = 1;
};

double value_of(const BuiltAbsorber& absorber, Toleranced what);

/// The values of a sample. A value is drawn again until it is valid: R in [0, 1], others positive;
/// after a thousand draws it becomes the nearest valid one.
BuiltAbsorber drawn(
    const std::vector<Tolerance>& tolerances, const BuiltAbsorber& nominal, std::uint64_t seed,
    std::size_t index);

/// Quantile of values in ascending order, linear between them; infinite if its neighbour is.
double quantile(const std::vector<double>& ascending, double probability);

struct DesignPlan {
    Host host;                   ///< its base amplitude is the largest
    Interval f = {};             ///< band of a harmonic host, Hz
    double amplitude_ratio = 1;  ///< smallest amplitude over the largest
    Interval b;                  ///< m
    std::vector<double> R, m2;
    Objective objective = Objective::x_max;
    bool mean = false;        ///< over band and amplitudes, instead of the largest value
    bool default_set = true;  ///< the worst of several starts, otherwise the default one
    int b_count = 40, f_count = 41;
    double transient_cycles = 100, cycles = 200;
    std::vector<Tolerance> tolerances = {};
    std::vector<std::size_t> samples = {};  ///< indices; none without tolerances
    std::uint64_t seed = 1;
};

/// An absorber and its objective, in SI, for the worst start.
struct DesignPoint {
    double b, R, m2;
    double objective;     ///< infinity if a motion was not measured, for too many impacts
    double f, amplitude;  ///< of the worst case: in Hz, and as a share of the largest
};

/// Largest values at one frequency and the largest amplitude, of the worst start; in SI.
struct DesignResponse {
    double f, worst, best;  ///< Hz; the objective with the worst and the best start
    double without, tuned_mass_damper;
    double impact_speed;  ///< largest of all starts, m/s
    double impulse;       ///< the same, N s
    double impacts_per_second;
};

/// Factors on a value up to which the objective is at most this much worse, as far as tried.
struct DesignMargin {
    Interval five_percent, twenty_percent;
};

/// The best absorber with values drawn from their distributions.
struct ToleranceSample {
    std::size_t index;
    BuiltAbsorber built;
    DesignPoint point;                 ///< worst case
    std::optional<PointResult> worst;  ///< its motion; empty if it was not measured
};

struct Design {
    DesignPoint best;
    PointResult at_worst;  ///< the motion in the worst case, with its regime
    BandMaximum without;
    LinearAbsorber tuned_mass_damper, den_hartog;
    BandMaximum with_tuned_mass_damper, with_den_hartog;
    std::vector<DesignResponse> response;
    DesignMargin b, R, f0, damping;
    Interval works;  ///< amplitudes, over the largest, with at least half of its reduction
    /// The one from which on the manifold permits impacts; empty if it has no fold.
    std::optional<double> activation;
    std::vector<ToleranceSample> samples;  ///< in any order
    bool complete = true;  ///< false if stopped: later members are then empty or NaN
};

/// Receives each absorber that was tried, on the calling thread.
using DesignSink = std::function<void(const DesignPoint&)>;
/// Receives each sample, on any thread, one at a time.
using SampleSink = std::function<void(const ToleranceSample&)>;

/// The objective with a linear absorber, at the frequency f of a harmonic host. For other hosts f
/// has no meaning, and Stopped is thrown once stop() returns true.
using LinearResponse = std::function<double(const LinearAbsorber& absorber, double f)>;
LinearResponse linear_response_of(
    const DesignPlan& plan, Objective objective, const StopRequest& stop);

/// Motions of the first map and of the samples, nearly all of a search.
std::size_t design_runs(const DesignPlan& plan);

/// Searches on `threads` threads. After a stop: the best absorber so far, empty without one.
std::optional<Design> find_design(
    const DesignPlan& plan, int threads, RunControl& control, const DesignSink& sink,
    const SampleSink& sample_sink = {});

}  // namespace vines
