// Energy balance (forcing, damper, impacts, stored energy) and amplitudes of the linear oscillator.
// Energies are divided by m1 omega0^2, in m^2: E = x'^2/2 + x^2/2 + epsilon (y'^2/2 - gravity y).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/measures/quadrature.hpp"
#include "core/motion/elementary.hpp"
#include "core/motion/simulate.hpp"
#include "core/stability/mean_error.hpp"

namespace vines {

/// Energy balance of a window and amplitudes of x in it. Energies divided by m1 omega0^2, in m^2.
struct EnergyBalance {
    Interval window;  ///< the part that the run reached
    double input;     ///< integral of epsilon A sin(theta) x' dtau, or of the load times x'
    double damper;    ///< integral of 2 zeta x'^2 dtau
    /// Sum of epsilon (1 - R^2) v^2/(2 (1 + epsilon)), v = x' - y' before the impact.
    double impacts;
    double friction;  ///< epsilon friction times the path along which the ball slides
    double stored;    ///< at the end minus at the start
    double residual;  ///< error of the balance: zero up to rounding
    double at_start, at_end;
    /// Fraction of the dissipation that is due to impacts; empty without dissipation.
    std::optional<double> share_impacts;
    double rms, peak;  ///< of x, of |x|, m; relative to the base if a load moves it
    /// Standard errors (mean_error.hpp); NaN for windows of fewer than 32 cycles.
    double rms_error, share_impacts_error;
    double difference_of_halves;  ///< of the mean of x^2 (mean_error.hpp)
};

/// Smallest of the maxima of |x| in each forcing cycle of a window, x relative to the base if a
/// load moves it. A cycle needs no search once a value of |x| in it, usually at an event, exceeds
/// the smallest maximum so far.
class CyclePeaks : public Observer {
public:
    CyclePeaks(const Interval& window, double cycle) : window_(window), cycle_(cycle) {}

    void on_stretch(const Stretch&) override;
    double least() const { return least_; }  ///< m; infinity without a whole cycle

private:
    double end() const { return window_.from + (whole_ + 1) * cycle_; }  ///< of the current cycle

    const Interval window_;
    const double cycle_;
    double whole_ = 0, peak_ = 0, least_ = infinity;  // whole_: number of complete cycles
};

/// Observer of the energy balance and the amplitude of x over a window.
class Energy : public Observer {
public:
    Energy(const Parameters& parameters, const Interval& window)
        : parameters_(parameters),
          window_(window) {}

    void on_stretch(const Stretch&) override;
    void on_impact(const Impact&) override;

    double duration() const { return duration_; }
    /// `reached`: the part of the window that the run reached.
    EnergyBalance balance(const Interval& reached) const;

private:
    const Parameters parameters_;
    const Interval window_;
    /// Free or sticking motion with its integration rules.
    struct Law {
        std::shared_ptr<const Flow> flow;
        std::shared_ptr<const Quadrature> quadrature = Quadrature::shared(*flow);
        /// Used instead of the quadrature once the window is longer than settled(): cheaper.
        std::optional<Antiderivative> antiderivative = Antiderivative::of(*flow);
    };
    const Law free_{Flow::shared_free(parameters_)};
    std::optional<Law> sticking_;  // set at the first sticking phase
    /// Integrals so far, without the antiderivative at the end of the last stretch.
    Integrals sum_ = Integrals::Zero();
    struct Last {
        Oscillation begin;
        double duration, y_dot;
        bool is_stuck, in_closed_form;
    };
    Last last_{};
    double duration_ = 0, peak_ = 0, impacts_ = 0, friction_ = 0, work_ = 0, start_ = 0;
    State end_{};  // unless flights are straight
    /// Integrals and dissipation from the window's start to the end of each step.
    struct Sums {
        double x_squared, x_dot_squared, impacts, friction;
    };
    const WindowSteps steps_{window_, parameters_.cycle()};
    std::vector<Sums> at_steps_;
    double next_step_ = steps_.end_of(0);  ///< its end, in tau

    void add_curved(const Stretch& stretch, double from, double to);
    Oscillation end() const { return last_law().flow->after(last_.begin, last_.duration); }
    Integrals integrals() const {
        if (!last_.in_closed_form) return sum_;
        return sum_ + last_law().antiderivative->at(end());
    }
    const Law& last_law() const { return last_.is_stuck ? *sticking_ : free_; }
    void add_steps(const Law& law, const Oscillation& begin, double tau, double duration);
};

/// Empty unless the denominator is positive.
std::optional<double> ratio(double numerator, double denominator);

/// Energy E of a state, m^2.
double energy_of(const Parameters& parameters, const State& state);

/// Amplitudes of the linear oscillator without absorber, with the same forcing and start.
struct Unattached {
    double rms, peak;  ///< of x over a window, m; NaN if stopped
    /// epsilon A/sqrt((1 - Omega^2)^2 + 4 zeta^2 Omega^2), steady, m; empty at undamped resonance.
    std::optional<double> amplitude;
};
Unattached unattached(
    const Parameters& parameters, const State& start, const Interval& window,
    const StopRequest& stop = {});
/// Unattached::amplitude for these parameters.
std::optional<double> free_amplitude(const Parameters& parameters);
/// Steady motion without absorber at tau = 0: x and x', y = y' = 0; empty at undamped resonance.
std::optional<State> free_steady_state(const Parameters& parameters);

/// First times at which a free decay has a half and a tenth of its initial energy, above that of
/// the ball at rest where gravity presses it.
struct DecayTimes {
    std::optional<double> half, tenth;
};

/// Observer of these times.
class Decay : public Observer {
public:
    Decay(const Parameters& parameters, double tau_start)
        : parameters_(parameters),
          tau_start_(tau_start) {}
    void on_stretch(const Stretch&) override;

    DecayTimes times;

private:
    const Parameters parameters_;
    const double tau_start_;
    std::optional<double> at_start_;  // energies above that at rest
};

/// The same times for the linear oscillator without absorber; empty if it is undamped or at rest.
DecayTimes unattached_decay(const Parameters& parameters, const State& start, double tau_start);

}  // namespace vines
