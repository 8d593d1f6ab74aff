// Transfer matrices of deviations: J over flights (19), projections over sticking phases, M at
// impacts (27), T = M J (30); and their exterior powers, which transport the areas and volumes
// spanned by two and three deviations.
//
// Under strong damping a flight shrinks deviations of the oscillator below double precision
// relative to those of the ball, and near grazing the entries of M grow without bound: an area or
// volume computed from deviations would be a difference of large numbers. The formulas below only
// add products of the factors of a flight or an impact.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/motion/record.hpp"

namespace vines {

/// Largest contraction exponent of one part of a leg: products of two lengths keep 14 digits.
inline constexpr double most_contraction = 4;

/// A free flight, or a phase with both masses as one, divided into equal parts that contract by at
/// most e^-most_contraction each.
struct Leg {
    Transfer oscillator;  ///< per part: block (x', x) of J, eq. (19)
    double duration;      ///< per part
    double log_det;       ///< ln det of `oscillator`
    long parts;
    bool sticking;
    /// Friction holds the ball inside the cavity: deviations of x - y stay.
    bool resting = false;
    /// The slip that ends it: factor for deviations of x' - y'.
    double slip = 1;
};
Leg leg_of(const Flow& flow, double duration, bool sticking, bool resting = false);
Leg leg_of(const Stretch& stretch);

/// Transports deviations over one part: J of eq. (19), or for a sticking leg the projection onto
/// the centre of mass followed by its motion. epsilon: mass ratio.
template <class Deviations>  // Frame or Eigen::Vector4d
void carry(Deviations& deviations, const Leg& leg, double epsilon);
/// J over all parts.
Matrix4 transfer_of(const Leg& leg, double epsilon);
/// The same over legs that follow each other.
Matrix4 transfer_of(std::span<const Leg> legs, double epsilon);

/// The slip that ends a leg, as a saltation matrix.
Saltation slip_of(const Leg& leg, double epsilon);

/// Area spanned by two deviations: components 01, 02, 03, 12, 13, 23 in the order (x', x, y', y).
using Area = Eigen::Matrix<double, 6, 1>;
/// Volume spanned by three deviations, as its normal n: with a fourth deviation v it spans n.v.
using Volume = Eigen::Vector4d;

Area carried(const Area& area, const Leg& leg, double epsilon);  ///< over one part
/// Over one part; zero after sticking, of rank 3 after a rest.
Volume carried(const Volume& volume, const Leg& leg, double epsilon);
Area carried(const Area& area, const Saltation& M);
Volume carried(const Volume& volume, const Saltation& M);

/// A flag (nested subspaces): the length, area and volume spanned by the first one, two and three
/// deviations, and the determinant of the flights; that of an impact is R^2. Started from the unit
/// vectors of (x', x, y', y), the sizes are the products of the diagonal of R in a QR factorisation
/// of all matrices passed; no orthogonalisation is needed.
struct Flag {
    Eigen::Vector4d deviation = Eigen::Vector4d::Unit(0);
    Area area = Area::Unit(0);
    Volume volume = Volume::Unit(3);
    double determinant = 1;

    void pass(const Leg& leg, double epsilon);  ///< over one part
    void strike(const Saltation& M);
    std::array<double, 3> squares() const;  ///< squares of length, area and volume
    /// Sines of the angles between the deviation, the plane of the area and the space of the
    /// volume: how far rounding has separated them. NaN for a zero size.
    std::array<double, 2> separations() const;
};

/// Moduli of four eigenvalues, or their logarithms; descending.
using Moduli = std::array<double, 4>;

/// A product of transfer matrices as exterior powers, rescaled as they grow: the largest eigenvalue
/// of the k-th power is the product of the k largest ones, at any ratio between these.
class PowerProduct {
public:
    explicit PowerProduct(double epsilon) : epsilon_(epsilon) {}

    void pass(const Leg& leg);
    void strike(const Saltation& M);

    /// 4; 3 after an impact with R = 0 or a rest inside the cavity; 2 after sticking.
    int rank() const { return rank_; }
    /// ln|eigenvalues|, descending; -infinity beyond the rank, NaN if not found.
    Moduli log_moduli() const;

private:
    template <int n>
    struct Scaled {
        Eigen::Matrix<double, n, n> matrix = Eigen::Matrix<double, n, n>::Identity();
        double log_scale = 0;

        void rescale();
        double log_radius() const;
    };
    /// Transports areas and volumes by carried(..., by...).
    template <class... By>
    void transport(const By&... by);

    const double epsilon_;
    Scaled<4> first_, third_;
    Scaled<6> second_;
    double log_det_ = 0;
    int rank_ = 4;
};

/// The three matrices of one impact: J from the previous impact, its own M, and T = M J.
struct ImpactTransfer {
    double tau;
    double epsilon;
    Saltation M;
    std::vector<Leg> legs;  ///< from the previous impact

    Matrix4 J() const { return transfer_of(legs, epsilon); }
    Matrix4 T() const { return M.times(J()); }
    Moduli J_moduli() const;
    /// Exactly 1, 1, R, R (section 4): M is triangular for the centre of mass and x - y.
    Moduli M_moduli() const;
    /// From the exterior powers: accurate for any damping and any entries of M.
    Moduli T_moduli() const { return moduli(true); }

private:
    Moduli moduli(bool with_impact) const;
};

/// Passes on the impacts in a window, from the second one on, each with its M and the legs since
/// the previous one; consecutive free flights form one leg.
class TransferObserver : public Observer {
public:
    TransferObserver(const Parameters& parameters, const Interval& window)
        : parameters_(parameters),
          window_(window) {}

    void on_stretch(const Stretch& stretch) override;
    void on_slip(const Slip& slip) override;
    void on_impact(const Impact& impact) override;

    const Interval& window() const { return window_; }

protected:
    virtual void on_first_impact(const Impact&) {}
    virtual void on_transfer(
        const Impact& impact, const Saltation& M, std::span<const Leg> legs) = 0;
    double epsilon() const { return parameters_.epsilon; }

private:
    const Parameters parameters_;
    const Interval window_;
    std::vector<Leg> legs_;
    bool begun_ = false;
};

/// The matrices of these impacts; keeps the last `most` and up to half as many more.
class TransferRecord : public TransferObserver, public LastOf<ImpactTransfer> {
public:
    TransferRecord(
        const Parameters& parameters, const Interval& window, std::size_t most = everything)
        : TransferObserver(parameters, window),
          LastOf(most) {}

private:
    void on_transfer(const Impact& impact, const Saltation& M, std::span<const Leg> legs) override {
        add({impact.tau, epsilon(), M, {legs.begin(), legs.end()}});
    }
};

}  // namespace vines
