// Slow invariant manifold: two symmetric impacts per forcing cycle in the limit epsilon -> 0 (see
// docs/physics.md). With the ball's speed V, W = V/Omega and k = (1 - R)/(1 + R),
//
//     C^2 = (pi W/2 - b)^2 + k^2 W^2.
//
// Linearised, half a cycle followed by the reflection (x, y) -> (-x, -y) has determinant R^2 and
// trace 2 R + (1 + R)^2 (pi b/(2 W) - pi^2/4). An eigenvalue is 1 at the fold and -1, where the
// impacts lose their symmetry, at W = (pi/2) b/(pi^2/4 - 1), for every R. The manifold is stable
// between the two.
//
// It exists as long as the flight meets no wall before its end. With t = Omega tau since the impact
// and q = pi/2 - b/W, the ball stays off the wall that it has left while q (1 - cos t) < t - k sin
// t, and then also off the other one. The limit q = min of (t - k sin t)/(1 - cos t) over 0 < t <
// pi has its minimum where tan(t/2) = (1 + R) t/2, which has one root. Up to R = .0867 this second
// contact comes before the loss of symmetry.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/motion/record.hpp"

namespace vines {

/// Amplitude C of the oscillator in m, speed V of the ball in m per unit of tau.
struct ManifoldPoint {
    double C, V;
};

/// C on the manifold for a speed V >= 0 of the ball.
double manifold_C(double R, double Omega, double b, double V);
/// Smallest C, b k/sqrt(pi^2/4 + k^2): below this amplitude the absorber cannot be activated.
ManifoldPoint manifold_fold(double R, double Omega, double b);
/// The point at which the symmetric impacts become unstable to asymmetric ones.
ManifoldPoint manifold_symmetry_breaking(double R, double Omega, double b);
/// Beyond it the ball meets a wall twice before it reaches the other.
ManifoldPoint manifold_second_contact(double R, double Omega, double b);
/// The b whose fold lies at amplitude C, m; 0 for R = 1, where every fold is at C = 0.
double manifold_b(double R, double C);

/// The manifold as a curve, and its limits.
struct Manifold {
    double R, Omega, b;
    ManifoldPoint fold;
    std::optional<ManifoldPoint> symmetry_breaking;  ///< empty if the second contact comes first
    ManifoldPoint second_contact;
    std::vector<ManifoldPoint> stable, unstable, asymmetric;
    /// Steady amplitude of the oscillator without absorber, and the b whose fold lies there.
    std::optional<double> free_amplitude, b_at_free_amplitude;
};
/// Manifold of a system with R_plus = R_minus, with `points` points on each existing branch, up to
/// V_max (0: twice the speed of the symmetry breaking) or to the end of the motion's existence.
Manifold manifold_of(const Parameters& parameters, double V_max, std::size_t points);

/// Observer of a run's counterparts of (C, V): largest |x| and mean |y'| in each half cycle of the
/// forcing. Keeps the last `most` of them, and up to half as many more.
class HalfCycles : public Observer {
public:
    HalfCycles(const Parameters& p, const Interval& window, std::size_t most = everything)
        : half_cycle_(std::numbers::pi / p.Omega),
          window_(window),
          most_(most) {}
    void on_stretch(const Stretch&) override;

    std::vector<double> tau;  ///< end of the half cycle
    std::vector<ManifoldPoint> points;

private:
    void pass(const Stretch& stretch, double from, double to);
    const double half_cycle_;
    const Interval window_;
    const std::size_t most_;
    // The current half cycle ends at next_ half_cycle_.
    long next_ = static_cast<long>(std::ceil(window_.from / half_cycle_)) + 1;
    double peak_ = 0, path_ = 0, begun_ = (next_ - 1) * half_cycle_;
};

}  // namespace vines
