// Transfer matrices of deviations: J over flights (19), projections over sticking phases, M at
// impacts (27), T = M J (30).
#pragma once

#include <span>
#include <vector>

#include "core/motion/record.hpp"
#include "core/stability/exterior.hpp"

namespace vines {

/// The legs since the last reset, collected by stretch; consecutive free flights form one leg.
class LegSequence {
public:
    void extend(const Stretch& stretch);
    void slip(const Slip& slip);  ///< at the end of the last leg
    void reset() { legs_.clear(); }
    std::span<const Leg> legs() const { return legs_; }

private:
    std::vector<Leg> legs_;
};

Moduli eigenvalue_moduli(const Matrix4& m);

/// The three matrices of one impact: J from the previous impact, its own M, and T = M J.
struct ImpactTransfer {
    double tau;
    double epsilon;
    Saltation M;
    std::vector<Leg> legs;  ///< from the previous impact

    Matrix4 J() const { return transfer_of(legs, epsilon); }
    int rank() const;  ///< of J: 4, 3 after a rest inside the cavity, 2 after sticking
    Matrix4 T() const { return M.times(J()); }
    Moduli J_moduli() const;
    /// Exactly 1, 1, R, R (section 4): M is triangular for the centre of mass and x - y.
    Moduli M_moduli() const;
    /// From the exterior powers: accurate for any damping and any entries of M.
    Moduli T_moduli() const;
};

/// The matrices of the impacts in [tau_start, tau_end], from the second one on; keeps the last
/// `most` and up to half as many more.
class TransferRecord : public Observer, public LastOf<ImpactTransfer> {
public:
    TransferRecord(
        const Parameters& parameters, double tau_start, double tau_end,
        std::size_t most = everything)
        : LastOf(most),
          parameters_(parameters),
          tau_start_(tau_start),
          tau_end_(tau_end) {}
    void on_stretch(const Stretch& stretch) override { passage_.extend(stretch); }
    void on_slip(const Slip& slip) override { passage_.slip(slip); }
    void on_impact(const Impact& impact) override;

private:
    const Parameters parameters_;
    const double tau_start_, tau_end_;
    LegSequence passage_;
    bool begun_ = false;
};

}  // namespace vines
