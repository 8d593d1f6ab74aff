// The forcing as a channel of the record shows it, the motion of the base or a force: its dominant
// sine, and the load, in which modulation and sweeps of a shaker and its harmonics appear. With
// sigma = tau - tau_m, tau_m the middle of the record, the force on the right of eq. (2) is
//
//     f(tau) = Re sum_k C_k(tau) exp(i k Omega sigma),   k = 1 to 5.
//
// C_k is a constant or a cubic spline, a least-squares fit to the channel; to the acceleration of a
// base with the derivatives of spline and phasor, so that nothing is integrated. A slow spline
// takes offset and drift of the sensor. Bayes' information criterion decides which harmonics exist.
//
// The fit (unknowns.hpp) determines amplitude and phase of the fundamental from the motion; the
// channel gives the rest in relation to the fundamental, so that its gain and sign do not matter.
// A delay of the channel turns harmonic k by k times the phase of the fundamental.
#pragma once

#include <complex>
#include <memory>
#include <optional>
#include <vector>

#include "core/measurement/progress.hpp"
#include "core/measurement/unknowns.hpp"
#include "core/motion/load.hpp"

namespace vines {

/// The dominant harmonic of a channel, offset + sin sin(omega t) + cos cos(omega t).
struct Harmonic {
    double omega;  ///< per unit of time
    double sin, cos;
};

/// Fits one harmonic. The frequency comes from the mean crossings first, then from the phase drift
/// between shorter pieces. Empty if the harmonic explains less than three quarters of the signal,
/// or with fewer than five cycles.
std::optional<Harmonic> harmonic_of(
    const std::vector<double>& time, const std::vector<double>& values, const Look& look = [] {});

/// A channel of the forcing, with its samples in tau. `damping`: 2 zeta, for a base.
struct ForcingChannel {
    LoadKind kind;
    std::vector<double> tau, values;  ///< in m, accelerations per unit of tau squared; ascending
    double begin, end;                ///< of the record, tau
    double damping;
};

/// A constant, or a cubic spline with equidistant knots.
struct Envelope {
    std::vector<std::complex<double>> coefficients;  ///< of B-splines; a single one: a constant

    bool varies() const { return coefficients.size() > 1; }
    /// Value at u in [0, 1]: the time since the beginning of the record divided by its length.
    std::complex<double> at(double u) const;
};

class MeasuredLoad {
public:
    /// The load; null if the channel shows nothing but a sine and noise. `sine`: the channel's
    /// dominant harmonic, by tau.
    static std::shared_ptr<const MeasuredLoad> of(
        const ForcingChannel& channel, const Harmonic& sine, const Look& look = [] {});

    double Omega;                      ///< of the fundamental
    std::complex<double> fundamental;  ///< mean of C_1: mean modulus and phase, m

    /// The force beyond its fundamental, for the fundamental exp(i Omega sigma): the motion has
    /// the forcing Re (f_c - i f_s) (exp(i Omega sigma) + excess). `values`: Omega, f_s and f_c.
    std::complex<double> excess(double sigma, const UnknownValues& values) const;
    /// Standard error of each coefficient of a harmonic due to the channel's noise, relative to the
    /// fundamental; 0 if the load does not contain the harmonic, or its fundamental is constant.
    double error_of(std::size_t harmonic) const;
    double length() const { return length_; }

private:
    MeasuredLoad() = default;

    double length_ = 0, noise_ = 0;
    LoadKind kind_ = LoadKind::base_acceleration;
    std::vector<Envelope> harmonics_;  ///< C_k divided by the fundamental, from k = 1 on
};

/// Responses of the oscillator to a load's excess, from rest before the record: a table, between
/// whose entries the motion is interpolated to about 1e-6.
class LoadResponse {
public:
    /// The excess at steps of half a cell.
    struct Excess {
        Excess(const MeasuredLoad& load, const UnknownValues& values);
        double begin, step;  ///< sigma; step of a cell
        std::vector<std::complex<double>> at;
    };
    /// The response of x'' + damping x' + stiffness x = by_force times the excess.
    LoadResponse(const Excess& excess, double stiffness, double damping, double by_force);

    /// The responses to f_s = 1 and to f_c = 1.
    struct Motion {
        OscillatorMotion by_sin, by_cos;
    };
    Motion at(double sigma) const;

private:
    /// The real part is the response to f_c = 1, the imaginary part that to f_s = 1.
    struct Node {
        std::complex<double> x, x_dot, x_ddot;
    };
    double begin_, step_;
    std::vector<Node> nodes_;
};

}  // namespace vines
