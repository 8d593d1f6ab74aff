// Largest values of a motion in a window that decide whether an absorber is acceptable: the
// acceleration of the oscillator, its distance from the base, and the impacts' speed.
#pragma once

#include "core/motion/elementary.hpp"
#include "core/motion/simulate.hpp"

namespace vines {

struct Extremes {
    double x = 0;               ///< of |x|, as EnergyBalance::peak, m; with ExtremesWanted::of_x
    double x_acceleration = 0;  ///< of |x''| between impacts, m per unit of tau squared
    double x_max_least = 0;     ///< smallest maximum of |x| in a forcing cycle, m
    double x_relative = 0;      ///< of |x - x_b|, x_b being the displacement of the base, m
    double impact_speed = 0;    ///< of |x' - y'| before an impact, m per unit of tau
    double impulse = 0;         ///< of an impact, per m1: epsilon |jump of y'|, m per unit of tau
    double impact_rate = 0;     ///< impacts per unit of tau
    long impacts = 0, sticks = 0;
};

/// A quantity by which motions are compared.
enum class Objective {
    x_max,               ///< of |x|, m
    x_rms,               ///< of x, m
    x_relative_max,      ///< of the distance from the base, m
    x_acceleration_max,  ///< of |x''|, m/s^2
    impact_speed_max,    ///< of |x' - y'| before an impact, m/s
    impulse_max,         ///< of an impact, N s
    impacts_per_second,
    decay_time  ///< in which the energy of a free decay falls to a tenth, s
};

/// Those of impacts cost almost nothing, that of x little, the others a quarter of the run. All:
/// but for x.
enum class ExtremesWanted { none, of_impacts, of_x, all };

/// Observer of the extremes over a window.
class ExtremesRecord : public Observer {
public:
    ExtremesRecord(
        const Parameters& parameters, const Interval& window,
        ExtremesWanted wanted = ExtremesWanted::all)
        : parameters_(parameters),
          window_(window),
          wanted_(wanted) {}

    void on_stretch(const Stretch&) override;
    void on_impact(const Impact&) override;
    void on_stick(const StickStart& s) override { extremes_.sticks += window_.contains(s.tau); }

    /// The extremes of the part of the window that the run reached.
    Extremes result(const Interval& reached) const {
        Extremes all = extremes_;
        if (reached.length() > 0)
            all.impact_rate = static_cast<double>(all.impacts) / reached.length();
        return all;
    }

private:
    /// x - x_b is `size` times a motion of the flow, its phasor turned by this cosine and sine.
    struct Relative {
        double size, cos, sin;
    };
    Relative relative_to_base(const Flow& flow) const;

    const Parameters parameters_;
    const Interval window_;
    const ExtremesWanted wanted_;
    const double F_ = parameters_.load ? 0 : parameters_.epsilon * parameters_.G,
                 sin_phi_ = elementary::sin(parameters_.phi()),
                 cos_phi_ = elementary::cos(parameters_.phi());
    Extremes extremes_;
};

}  // namespace vines
