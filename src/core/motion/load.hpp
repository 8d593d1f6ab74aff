// A load in place of the harmonic forcing, of the base or of the oscillator itself: a record, or a
// formula. Its pieces are polynomials of the time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/motion/elementary.hpp"
#include "core/motion/flow.hpp"

namespace vines {

enum class LoadKind {
    base_acceleration,  ///< values in m (per unit of tau squared); the base starts at rest
    base_displacement,  ///< m
    force               ///< on m1, divided by k1, m
};

/// amplitude sin(Omega tau + phase), m.
struct LoadHarmonic {
    double amplitude, Omega, phase;
};

/// A value and its derivative by tau.
struct LoadNode {
    double value, rate;
};

/// After its end an acceleration or force is zero; a displacement stays.
class Load {
public:
    /// At least two samples at ascending times from 0 on, linear in between.
    Load(LoadKind kind, const std::vector<double>& tau, const std::vector<double>& values);
    /// A sum of harmonics without end: the displacement of the base, m.
    explicit Load(std::vector<LoadHarmonic> harmonics);
    /// amplitude sin(theta): theta(tau) returns the Taylor polynomial of theta about tau; theta' is
    /// monotonic.
    Load(
        LoadKind kind, double amplitude, double duration,
        const std::function<Polynomial(double tau)>& theta);
    /// A force: cubics through nodes at equidistant times from 0 on, at least two.
    Load(double step, const std::vector<LoadNode>& nodes);
    /// The k of the frequencies k 2 pi/duration from Omega_low to Omega_high: the first and the
    /// last; rounding loses none at the ends.
    static std::pair<std::size_t, std::size_t> noise_lines(
        double Omega_low, double Omega_high, double duration);
    /// Normally distributed acceleration of the base with the frequencies of noise_lines(), at
    /// least one. The base begins and ends at rest, at the same place.
    static Load noise(
        double rms, double Omega_low, double Omega_high, double duration, std::uint64_t seed);
    /// Largest product Omega_high duration that noise() accepts.
    static constexpr double most_noise_phase = 2 * std::numbers::pi * 8192;

    /// The number of the interval that begins at or before tau >= 0.
    std::size_t interval_at(double tau) const;
    /// Infinity for the last interval, which follows the load's end.
    double end_of(std::size_t interval) const {
        if (!harmonics_.empty()) return static_cast<double>(interval + 1) * harmonic_step_;
        return interval + 1 < tau_.size() ? tau_[interval + 1] : infinity;
    }
    /// Displacement of the base as a function of the time since `from`; zero for a force.
    Polynomial base(std::size_t interval, double from) const;
    /// base + damping base' (eq. (1), damping = epsilon lambda), or the force.
    Polynomial force(std::size_t interval, double from, double damping) const;

    /// Longest time over which response() to a piece is exact to rounding; damping: of the flow.
    double response_reach(double damping) const;

    bool moves_base() const { return kind_ != LoadKind::force; }
    double length() const { return tau_.empty() ? infinity : tau_.back(); }
    /// True if a run is as long as the load by default: it ends, and is no shock.
    bool sets_length() const { return length() < infinity && length() >= 2 * std::numbers::pi; }
    /// Largest |displacement of the base| at the ends of the pieces up to this time, m.
    double largest_base_displacement(double until) const;
    /// Bound of the error of the displacement of the base, m; zero if it is only rounding.
    double sampling_error() const { return sampling_error_; }

private:
    explicit Load(LoadKind kind) : kind_(kind) {}
    Polynomial piece(std::size_t interval, double from) const;
    void add_piece(double tau, const Polynomial& piece);

    LoadKind kind_;
    std::vector<double> tau_;
    std::size_t width_ = 0;       // number of coefficients of a piece
    std::vector<double> pieces_;  // base or force by the time since the interval's beginning
    std::vector<LoadHarmonic> harmonics_;
    double harmonic_step_ = 0, sampling_error_ = 0;
};

/// A polynomial solution of x'' + damping x' + stiffness x = force: for a cubic force the one
/// without free motion, otherwise a series from rest, for times up to 0.5.
Polynomial response(const Flow& flow, const Polynomial& force);

}  // namespace vines
