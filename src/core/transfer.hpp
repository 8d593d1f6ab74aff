// Transfer matrices of the deviations: J over flights (19), projections over stuck phases, M at impacts (27), T = M J (30).
#pragma once

#include <vector>

#include "core/record.hpp"

namespace vines {

/// J of eq. (19) as a 4x4 matrix.
Matrix4 free_transfer(const Transfer& transfer, double duration);
/// The projection onto the centre of mass, and its motion while both masses stick together.
Matrix4 stuck_transfer(const Transfer& transfer, double epsilon);

/// The transfer matrix since some moment, extended stretch by stretch. Its rank is 4, or 2 once a stick has left only the
/// deviations of the centre of mass.
class Passage {
public:
    void extend(const Stretch& stretch, double epsilon);
    void strike(const Saltation& M);
    void reset() { *this = {}; }

    const Matrix4& matrix() const { return matrix_; }
    int rank() const { return rank_; }

private:
    Matrix4 matrix_ = Matrix4::Identity();
    bool empty_ = true;
    int rank_ = 4;
};

/// Moduli of four eigenvalues, descending, dimensionless.
using Moduli = std::array<double, 4>;
Moduli eigenvalue_moduli(const Matrix4& m);

/// The three matrices of one impact: J from the impact before it, its own M, and T = M J.
struct ImpactTransfer {
    double tau;
    double R;
    Matrix4 J;
    Saltation M;
    int rank;  ///< of J

    Matrix4 T() const { return M.times(J); }
    Moduli J_moduli() const;
    /// Exactly 1, 1, R, R (section 4): in the coordinates of the centre of mass and of x - y, M is triangular.
    Moduli M_moduli() const { return {1, 1, R, R}; }
    /// From the compound matrices, so that all four are right however large the entries of M are near grazing.
    Moduli T_moduli() const;
};

/// The matrices of the impacts in [tau_start, tau_end], from the second one on; up to half more than the last `most` of them.
class TransferRecord : public Observer {
public:
    TransferRecord(const Parameters& parameters, double tau_start, double tau_end, std::size_t most = everything)
        : parameters_(parameters), tau_start_(tau_start), tau_end_(tau_end), most_(most) {}
    void on_stretch(const Stretch& stretch) override { passage_.extend(stretch, parameters_.epsilon); }
    void on_impact(const Impact& impact) override;

    std::vector<ImpactTransfer> transfers;
    long seen = 0;  ///< all of them, kept or not

private:
    const Parameters parameters_;
    const double tau_start_, tau_end_;
    const std::size_t most_;
    Passage passage_;
    bool begun_ = false;
};

}  // namespace vines
