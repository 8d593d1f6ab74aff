// The objects of an answer: the keys of each that hold a plain value, as quantities and their
// values for a source. Lists are in columns.hpp.
#pragma once

#include "api/columns.hpp"
#include "core/motion/elementary.hpp"
#include "core/sweep/basins.hpp"
#include "core/sweep/recommend.hpp"

namespace vines::api {

/// The status of each exponent.
inline Json statuses_of(const Exponents& values) {
    return column(values, [](double v) { return enum_json(status_of(v)); });
}

namespace properties {

using enum ValueType;

// Parameters.

inline constexpr Property<Parameters> reduced[] = {
    {{"epsilon", "mass ratio m2/m1"}, at<&Parameters::epsilon>},
    {{"lambda", "damping c1/(m2 omega0)"}, at<&Parameters::lambda>},
    {{"G", "amplitude of the base over epsilon, m"}, at<&Parameters::G>},
    {{"Omega", "forcing frequency over omega0"}, at<&Parameters::Omega>},
    {{"R_plus", "restitution coefficient of the wall at x - y = b"}, at<&Parameters::R_plus>},
    {{"R_minus", "restitution coefficient of the wall at x - y = -b"}, at<&Parameters::R_minus>},
    {{"b", "clearance: half-width of the cavity, m"}, at<&Parameters::b>},
    {{"gravity", "acceleration of the free ball along +x over omega0^2, m"},
     at<&Parameters::gravity>},
    {{"friction", "deceleration of the sliding ball over omega0^2, m"}, at<&Parameters::friction>},
    {{"damping", "whether zeta is epsilon lambda/2 or epsilon lambda", damping},
     at<&Parameters::damping>},
};

inline constexpr Property<SiParameters> si[] = {
    {{"m1", "mass of the linear oscillator, kg"}, at<&SiParameters::m1>},
    {{"c1", "damping of the oscillator, N s/m"}, at<&SiParameters::c1>},
    {{"k1", "stiffness of the oscillator, N/m"}, at<&SiParameters::k1>},
    {{"m2", "mass of the ball, kg"}, at<&SiParameters::m2>},
    {{"F", "amplitude of the base, m"}, at<&SiParameters::F>},
    {{"f", "forcing frequency, Hz"}, at<&SiParameters::f>},
};

inline constexpr Property<Parameters> derived[] = {
    {{"zeta", "damping ratio of the motion"}, at<&Parameters::zeta>},
    {{"omega_d", "sqrt(1 - zeta^2); null if zeta >= 1", number_or_null},
     [](const Parameters& p) {
         return p.zeta() < 1 ? Json(std::sqrt(1 - p.zeta() * p.zeta())) : Json(nullptr);
     }},
    {{"A", "amplitude of the forcing over epsilon, m"}, at<&Parameters::A>},
    {{"phi", "phase of the forcing at tau = 0, rad"}, at<&Parameters::phi>},
    {{"cycle", "length of a forcing cycle"}, at<&Parameters::cycle>},
};

inline constexpr Property<SiParameters> derived_si[] = {
    {{"omega0", "natural frequency in rad/s, for a system in SI"}, at<&SiParameters::omega0>},
    {{"f0", "natural frequency in Hz, for a system in SI"}, at<&SiParameters::f0>},
    {{"damping_ratio", "c1/(2 m1 omega0), for a system in SI; does not depend on `damping`"},
     at<&SiParameters::damping_ratio>},
    {{"mass_ratio", "m2/m1, for a system in SI"}, at<&SiParameters::epsilon>},
    {{"cycle_s", "cycle in s, for a system in SI"},
     [](const SiParameters& si) { return Json(1 / si.f); }},
};

/// The host of a design.
inline constexpr Property<SiParameters> host[] = {
    {{"m1", "mass, kg"}, at<&SiParameters::m1>},
    {{"c1", "damping, N s/m"}, at<&SiParameters::c1>},
    {{"k1", "stiffness, N/m"}, at<&SiParameters::k1>},
    {{"f0", "frequency, Hz"}, at<&SiParameters::f0>},
    {{"damping_ratio", "damping ratio"}, at<&SiParameters::damping_ratio>},
};

// Energy.

inline constexpr Property<EnergyBalance> balance[] = {
    {{"window", "interval of the balance", interval}, at<&EnergyBalance::window>},
    {energies.input, at<&EnergyBalance::input>},
    {energies.damper, at<&EnergyBalance::damper>},
    {energies.impacts, at<&EnergyBalance::impacts>},
    {energies.friction, at<&EnergyBalance::friction>},
    {energies.stored, at<&EnergyBalance::stored>},
    {energies.residual, at<&EnergyBalance::residual>},
    {{"share_impacts", "fraction of the dissipated energy; null if none is dissipated",
      number_or_null},
     at<&EnergyBalance::share_impacts>},
    {energies.at_start, at<&EnergyBalance::at_start>},
    {energies.at_end, at<&EnergyBalance::at_end>},
    {{"share_impacts_standard_error", "as rms_standard_error, for share_impacts", number_or_null},
     at<&EnergyBalance::share_impacts_error>},
    {{"rms", "rms of x, m, relative to the base if a load moves it"}, at<&EnergyBalance::rms>},
    {{"rms_standard_error",
      "standard error of rms as an estimate for an infinite run, m, with four degrees of freedom: "
      "95 % intervals are 2.776 errors on both sides; null for windows of fewer than 32 cycles",
      number_or_null},
     at<&EnergyBalance::rms_error>},
    {{"peak",
      "maximum of |x| in the window, m, relative to the base if a load moves it; that of an "
      "irregular motion grows with the window"},
     at<&EnergyBalance::peak>},
};

inline constexpr Property<Unattached> unattached[] = {
    {{"rms", "rms of x, m; null under a load if the time limit ended it", number_or_null},
     at<&Unattached::rms>},
    {{"peak", "maximum of |x| in the window, m; null like rms", number_or_null},
     at<&Unattached::peak>},
    {{"amplitude", "steady amplitude, m; null at undamped resonance, under a load", number_or_null},
     at<&Unattached::amplitude>},
};

inline constexpr Property<EnergyResult> energy_ratio[] = {
    {{"peak_least", "smallest maximum of |x| in a forcing cycle, m; peak is the largest",
      number_or_null},
     at<&EnergyResult::peak_least>},
    {{"rms_ratio", "rms with over rms without the absorber", number_or_null},
     at<&EnergyResult::rms_ratio>},
    {{"peak_ratio", "peak with over peak without the absorber", number_or_null},
     at<&EnergyResult::peak_ratio>},
};

inline constexpr Property<DecayTimes> decay[] = {
    {quantity.tau_half, at<&DecayTimes::half>},
    {quantity.tau_tenth, at<&DecayTimes::tenth>},
};

// Manifold.

inline constexpr Property<ManifoldPoint> manifold_point[] = {
    {quantity.C, at<&ManifoldPoint::C>},
    {quantity.V, at<&ManifoldPoint::V>},
};

inline constexpr Property<Recommendation> recommendation[] = {
    {{"b", "clearance, m"}, at<&Recommendation::b>},
    {{"fold_share", "amplitude at the fold over free_amplitude"}, at<&Recommendation::fold_share>},
    {{"x_rms_ratio", "rms of x over that without the absorber, for the worst start"},
     at<&Recommendation::x_rms_ratio>},
    {{"x_max", "maximum of |x| over the measured cycles, m, for the worst start"},
     at<&Recommendation::x_max>},
    {{"regime", "regime, for the worst start", regime}, at<&Recommendation::regime>},
    {{"start", "the worst start of the default set", word}, at<&Recommendation::start>},
    {{"tolerance_ratio",
      "largest rms of x with F up to 20 % higher or 17 % lower and f up to 1 % off, over the "
      "largest without the absorber there"},
     at<&Recommendation::tolerance_ratio>},
    {{"margin_F",
      "factors on F (or G) between which at least half of the reduction, 1 - x_rms_ratio, remains, "
      "as far as tried",
      interval},
     at<&Recommendation::margin_F>},
    {{"margin_f",
      "factors on f (or Omega) between which half of the reduction remains, as far as tried",
      interval},
     at<&Recommendation::margin_f>},
};

// Regime.

inline constexpr Property<PeriodicOrbit> orbit[] = {
    {{"period_cycles",
      "period in forcing cycles; null if not periodic, as are all keys up to capture", whole},
     at<&PeriodicOrbit::cycles>},
    {{"impacts_per_period", "contacts per period", whole}, at<&PeriodicOrbit::contacts>},
    {{"chatter_impacts_per_period", "impacts of chatter in addition to the contacts", whole},
     [](const PeriodicOrbit& o) { return Json(o.impacts - o.contacts); }},
    {{"sticks_per_period", "sticking phases per period", whole}, at<&PeriodicOrbit::sticks>},
    {{"symmetric", "true if a shift by half a period gives the mirror image", flag},
     at<&PeriodicOrbit::symmetric>},
    {{"stable", "true if all multipliers lie inside the unit circle", flag},
     at<&PeriodicOrbit::stable>},
    {{"closure", "relative distance between a state of the orbit and its return"},
     at<&PeriodicOrbit::closure>},
};

inline constexpr Property<QuasiPeriodic> quasi_periodic[] = {
    {{"rotation_number", "turns on the closed curve per forcing cycle, 0 to 0.5, or to 0.5/curves"},
     at<&QuasiPeriodic::rotation_number>},
    {{"standard_error", "bound of its error, from the rotation numbers of both halves"},
     at<&QuasiPeriodic::error>},
    {{"curves", "closed curves of the stroboscopic section, which the motion visits in turn",
      whole},
     at<&QuasiPeriodic::curves>},
    {{"points", "examined points of one curve", whole}, at<&QuasiPeriodic::points>},
    {{"largest_gap", "largest gap between the phases of neighbours on the curve, in turns"},
     at<&QuasiPeriodic::largest_gap>},
    {{"length_ratio",
      "length of the curve through all points over that through every fourth point: about 1 for a "
      "curve, 4 for a set with a thickness"},
     at<&QuasiPeriodic::length_ratio>},
    {{"curvature_ratio", "the same of the median curvature: about 1 for a smooth curve, else 16"},
     at<&QuasiPeriodic::curvature_ratio>},
};

inline constexpr Property<PeriodicOrbit> orbit_state[] = {
    {quantity.tau.with("a time on the orbit, during a flight"), at<&PeriodicOrbit::tau>},
    {{"x_dot", "velocity of the oscillator at that time"},
     at<&PeriodicOrbit::state, &State::x_dot>},
    {{"x", "displacement of the oscillator at that time, m"}, at<&PeriodicOrbit::state, &State::x>},
    {{"y_dot", "velocity of the ball at that time"}, at<&PeriodicOrbit::state, &State::y_dot>},
    {{"y", "displacement of the ball at that time, m"}, at<&PeriodicOrbit::state, &State::y>},
};

inline constexpr Property<Regime> rhythm[] = {
    {{"z", "contacts per cycle: of the orbit if periodic, else from the first contact to the last"},
     at<&Regime::z>},
    {{"z_overall", "contacts per cycle from the first contact to the last, periodic or not"},
     at<&Regime::z_overall>},
    {{"z_standard_error",
      "standard error of z_overall as an estimate for an infinite run; null for windows of fewer "
      "than 32 cycles",
      number_or_null},
     at<&Regime::z_error>},
    {{"contacts", "contacts in the window; a chatter that ends in a sticking phase counts as one",
      whole},
     at<&Regime::contacts>},
    {{"periodic", "true if a stable orbit attracts the motion", flag},
     [](const Regime& r) { return Json(r.orbit.has_value()); }},
};

inline constexpr Property<Regime> synchrony[] = {
    {{"share", "fraction of the contacts that lie in synchronised stretches"},
     at<&Regime::synchronised>},
    {{"longest_half_cycles", "length of the longest such stretch", whole},
     at<&Regime::longest_synchronised>},
};

// Parts of an identification.

inline constexpr Property<Restitution> restitution[] = {
    {{"R", "fitted; for a list of impacts, their median", number_or_null}, at<&Restitution::R>},
    {{"standard_error", "standard error of R", number_or_null}, at<&Restitution::error>},
    {{"impacts", "number of impacts", whole}, at<&Restitution::impacts>},
};

inline constexpr Property<Identification> fitted_b[] = {
    {{"b", "clearance, m; null if momentum conservation determines none", number_or_null},
     at<&Identification::b_fitted>},
    {{"standard_error", "m; null if the fit does not include the ball", number_or_null},
     at<&Identification::b_error>},
};

inline constexpr Property<MeasuredSlope> slope[] = {
    {{"lambda1",
      "long-term slope of lambda1(tau) tau, without the first tenth of the impacts and corrected "
      "for the phase of the modulation at both ends",
      number_or_null},
     at<&MeasuredSlope::value>},
    {{"low", "lower end of its 90 % interval", number_or_null}, at<&MeasuredSlope::low>},
    {{"high", "upper end of its 90 % interval", number_or_null}, at<&MeasuredSlope::high>},
};

// Exponents.

inline constexpr Property<Exponents> final_exponents[] = {
    {{"final", "four exponents at the end of the window, descending, per unit of tau", exponents},
     [](const Exponents& values) { return json_of(values); }},
    {{"status",
      "for each exponent: ok, minus_infinity (the rank is reduced: a sticking phase, R = 0, for "
      "raw_product also rounding), not_converged",
      statuses},
     statuses_of},
};

inline constexpr Property<TransferProduct> window[] = {
    {{"window", "from the first impact at or after tau_s to the last at or before tau_e, or null",
      interval_or_null},
     [](const TransferProduct& p) {
         return p.impacts() > 0 ? Json{p.start_tau(), p.end_tau()} : Json(nullptr);
     }},
    {{"impacts", "number of impacts in the window", whole}, at<&TransferProduct::impacts>},
    {{"sum_rule_residual",
      "error of qr in the sum rule of the exponents (after a sticking phase or R = 0 only of its "
      "angles), or the bound of its rounding errors if that exceeds 1e-6",
      number_or_null},
     at<&TransferProduct::sum_rule_residual>},
};

// Points of a sweep.

inline constexpr Quantity attractor_quantity{
    "attractor",
    "name of the motion, equal wherever a run settles on it: see attractors.md; not_decided if it "
    "has not settled",
    word};
inline constexpr Quantity mirror_quantity{
    "mirror",
    "name of the orbit's mirror image, equal to attractor if the orbit is symmetric or untouched; "
    "null without an orbit or without a mirror image",
    word_or_null};

inline constexpr Property<PointResult> point[] = {
    {{"lambda", "four exponents by qr", exponents}, at<&PointResult::lambda>},
    {{"status", "status of each exponent", statuses},
     [](const PointResult& p) { return statuses_of(p.lambda); }},
    {{"standard_error",
      "standard error of each exponent, with seven degrees of freedom: 95 % intervals are 2.365 "
      "errors on both sides; 2.776 for the other standard errors, which have four",
      exponents},
     at<&PointResult::standard_error>},
    {{"verdict",
      "regular if a periodic orbit captures the motion, otherwise the verdict on the measured "
      "cycles: chaos found there can be a transient; null without forcing, or if the ball meets no "
      "wall in the end",
      verdict},
     at<&PointResult::verdict>},
    {{"z", "contacts per cycle"}, at<&PointResult::regime, &Regime::z>},
    {{"z_standard_error", "standard error of z; null if periodic", number_or_null},
     [](const PointResult& p) { return json_of(p.regime.orbit ? nan : p.regime.z_error); }},
    {{"regime", "I to VI, or none", regime}, at<&PointResult::regime, &Regime::type>},
    {{"periodic", "true if a stable orbit attracts the motion", flag},
     [](const PointResult& p) { return Json(p.regime.orbit.has_value()); }},
    {{"period_cycles", "period in forcing cycles", whole},
     at<&PointResult::regime, &Regime::orbit, &PeriodicOrbit::cycles>},
    {{"impacts_per_period", "contacts per period", whole},
     at<&PointResult::regime, &Regime::orbit, &PeriodicOrbit::contacts>},
    {{"symmetric", "true if a shift by half a period gives the mirror image", flag},
     at<&PointResult::regime, &Regime::orbit, &PeriodicOrbit::symmetric>},
    {{"capture_cycle",
      "measured cycle in which the orbit captured the motion, later than the last one if "
      "settle_cycles was needed; if it is late, lambda is a mean over a transient; null if not "
      "periodic or not yet captured"},
     at<&PointResult::capture_cycle>},
    {{"lambda1_before", "lambda1 up to the capture; null if not periodic", number_or_null},
     at<&PointResult::lambda1_before>},
    {{"lambda1_after", "lambda1 of the orbit, from its multipliers", number_or_null},
     at<&PointResult::lambda1_after>},
    {attractor_quantity, at<&PointResult::name, &AttractorName::motion>},
    {mirror_quantity, at<&PointResult::name, &AttractorName::mirror>},
    {{"multiplier", "largest modulus of the Floquet multipliers"},
     at<&PointResult::regime, &Regime::orbit,
        [](const PeriodicOrbit& o) { return elementary::modulus(o.multipliers[0]); }>},
    {{"synchronised", "fraction of the contacts that lie in synchronised stretches"},
     at<&PointResult::regime, &Regime::synchronised>},
    {{"x_max",
      "maximum of |x| over the measured cycles, m, relative to the base if a load moves it; that "
      "of an irregular motion grows with their number"},
     at<&PointResult::x_max>},
    {{"x_rms", "rms of x, m, relative to the base if a load moves it"}, at<&PointResult::x_rms>},
    {{"x_rms_standard_error",
      "standard error of x_rms, m; as those of z and share_impacts null for fewer than 32 cycles",
      number_or_null},
     at<&PointResult::x_rms_error>},
    {{"x_rms_ratio", "x_rms over that without the absorber: steady, or else from the same start"},
     at<&PointResult::x_rms_ratio>},
    {{"x_free", "steady amplitude without the absorber, m"}, at<&PointResult::x_free>},
    {{"share_impacts", "fraction of the energy that impacts dissipate"},
     at<&PointResult::share_impacts>},
    {{"share_impacts_standard_error", "standard error of share_impacts", number_or_null},
     at<&PointResult::share_impacts_error>},
    {{"impacts", "number of impacts", whole}, at<&PointResult::extremes, &Extremes::impacts>},
    {{"sticks", "number of sticking phases", whole}, at<&PointResult::extremes, &Extremes::sticks>},
    {{"stationary",
      "false if lambda1 or x_rms differs between the halves of the measured cycles by more than "
      "chance permits, or if nothing dissipates (zeta = 0, R = 1): then the standard errors do not "
      "cover",
      flag},
     at<&PointResult::stationary>},
    {{"chaotic_cycles",
      "measured cycles of shown chaos: up to its capture, or as long as the motion was followed; "
      "null without shown chaos",
      number_or_null},
     at<&PointResult::chaotic_cycles>},
};

/// If requested.
inline constexpr Property<Extremes> peaks[] = {
    {{"x_max_least", "smallest maximum of |x| in a forcing cycle, m; x_max is the largest",
      number_or_null},
     at<&Extremes::x_max_least>},
    {quantity.x_ddot_max, at<&Extremes::x_acceleration>},
    {{"x_relative_max", "largest distance of the oscillator from the base, m"},
     at<&Extremes::x_relative>},
};

inline constexpr Property<Extremes> impact_extremes[] = {
    {quantity.relative_speed_max, at<&Extremes::impact_speed>},
    {quantity.impulse_per_m1_max, at<&Extremes::impulse>},
    {quantity.impact_rate, at<&Extremes::impact_rate>},
};

/// Quantities that distinguish the motions of a point.
inline constexpr Property<PointResult> motion[] = {
    {{"x_max", "maximum of |x| over the measured cycles, m"}, at<&PointResult::x_max>},
    {{"x_rms", "rms of x, m"}, at<&PointResult::x_rms>},
    {{"regime", "as for a point", regime}, at<&PointResult::regime, &Regime::type>},
    {{"verdict", "as for a point", verdict}, at<&PointResult::verdict>},
    {{"z", "as for a point"}, at<&PointResult::regime, &Regime::z>},
    {{"lambda1", "largest exponent by qr", number_or_null},
     [](const PointResult& p) { return json_of(p.lambda[0]); }},
};

/// Quantities of the motion at the peak of a row.
inline constexpr Property<PointResult> peak[] = {
    {{"regime", "regime at x_peak", regime}, at<&PointResult::regime, &Regime::type>},
    {{"verdict", "verdict at x_peak", verdict}, at<&PointResult::verdict>},
    {{"z", "contacts per cycle at x_peak"}, at<&PointResult::regime, &Regime::z>},
    {{"x_rms", "rms of x at x_peak, m"}, at<&PointResult::x_rms>},
};

inline constexpr Property<PointResult> motion_name[] = {
    {attractor_quantity, at<&PointResult::name, &AttractorName::motion>},
    {mirror_quantity, at<&PointResult::name, &AttractorName::mirror>},
};

/// The starts that lead to a motion.
inline constexpr Property<Basin> basin[] = {
    {{"branch",
      "number of the branch of orbits, the same at neighbouring values; null without an orbit",
      whole},
     at<&Basin::branch>},
    {attractor_quantity, at<&Basin::motion, &PointResult::name, &AttractorName::motion>},
    {mirror_quantity, at<&Basin::motion, &PointResult::name, &AttractorName::mirror>},
    {{"regime", "I to VI, or none", regime},
     at<&Basin::motion, &PointResult::regime, &Regime::type>},
    {{"period_cycles", "period in forcing cycles; null without an orbit", whole},
     at<&Basin::motion, &PointResult::regime, &Regime::orbit, &PeriodicOrbit::cycles>},
    {{"z", "contacts per cycle"}, at<&Basin::motion, &PointResult::regime, &Regime::z>},
    {{"x_max", "maximum of |x| over the measured cycles, m"},
     at<&Basin::motion, &PointResult::x_max>},
    {{"starts", "number of starts that lead to it", whole}, at<&Basin::starts>},
    {{"fraction", "fraction of all starts"}, at<&Basin::fraction>},
    {{"interval", "95 % interval of the fraction, from the number of starts", interval},
     at<&Basin::interval>},
};

/// All starts at a value of the axis.
inline constexpr Property<BasinsAt> basins[] = {
    {{"starts", "number of starts", whole}, at<&BasinsAt::starts>},
    {{"not_decided", "number of those whose motion has not settled", whole},
     at<&BasinsAt::not_decided>},
    {{"cells", "cells of the box with at least ten starts", whole}, at<&BasinsAt::cells>},
};

inline constexpr Property<Lifetime> lifetime[] = {
    {{"mean", "cycles of chaos per capture; null without a capture", number_or_null},
     at<&Lifetime::mean>},
    {{"low", "lower end of its 95 % interval; null without chaos", number_or_null},
     at<&Lifetime::low>},
    {{"high", "upper end of its 95 % interval", number_or_null}, at<&Lifetime::high>},
    {{"captured", "captured motions", whole}, at<&Lifetime::captured>},
    {{"runs", "motions with shown chaos", whole}, at<&Lifetime::runs>},
};

/// A difference of two initial states.
inline constexpr Property<State> difference[] = {
    {quantity.x, at<&State::x>},
    {quantity.x_dot.with("velocity of the oscillator, m per unit of tau"), at<&State::x_dot>},
    {quantity.y, at<&State::y>},
    {quantity.y_dot.with("velocity of the ball, m per unit of tau"), at<&State::y_dot>},
};

/// The initial state, as fields of /v1/simulate that reproduce the motion.
inline constexpr Property<State> start[] = {
    {{"x0", "displacement of the oscillator, m"}, at<&State::x>},
    {{"x_dot0", "velocity of the oscillator, m per unit of tau"}, at<&State::x_dot>},
    {{"y0", "displacement of the ball, m"}, at<&State::y>},
    {{"y_dot0", "velocity of the ball, m per unit of tau"}, at<&State::y_dot>},
};

}  // namespace properties

}  // namespace vines::api
