// A recorded load in place of the harmonic forcing: of the base, or of the oscillator itself.
#pragma once

#include <cstddef>
#include <vector>

#include "core/motion/elementary.hpp"
#include "core/motion/flow.hpp"

namespace vines {

enum class LoadKind {
    base_acceleration,  ///< values in m (per unit of tau squared); the base starts at rest
    base_displacement,  ///< m
    force               ///< on m1, divided by k1, m
};

/// Samples at ascending times from 0 on, linear in between. After the last one the acceleration or
/// force is zero; a displacement stays. The motion of the base is a cubic in each interval.
class Load {
public:
    /// `tau`: times of the samples; `values`: one for each time. At least two samples.
    Load(LoadKind kind, const std::vector<double>& tau, const std::vector<double>& values);

    /// The number of the interval that begins at or before tau >= 0.
    std::size_t interval_at(double tau) const;
    /// Infinity for the last interval, which follows the record.
    double end_of(std::size_t interval) const {
        return interval + 1 < tau_.size() ? tau_[interval + 1] : infinity;
    }
    /// Displacement of the base as a function of the time since `from`; zero for a force.
    Cubic base(std::size_t interval, double from) const;
    /// Right-hand side of x'' + 2 zeta x' + x: base + damping base' (eq. (1), damping = epsilon
    /// lambda), or the force.
    Cubic force(std::size_t interval, double from, double damping) const;

    bool moves_base() const { return kind_ != LoadKind::force; }
    std::size_t samples() const { return tau_.size(); }
    double length() const { return tau_.back(); }
    double largest_base_displacement() const { return largest_; }  ///< at the samples, m

private:
    const LoadKind kind_;
    std::vector<double> tau_;
    std::vector<Cubic> pieces_;  // base or force by the time since the interval's beginning
    double largest_ = 0;
};

/// The particular solution p of x'' + damping x' + stiffness x = force that is a polynomial.
Cubic particular_solution(const Flow& flow, const Cubic& force);

}  // namespace vines
