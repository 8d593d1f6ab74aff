// Deviations, and the areas and volumes that two and three of them span, as they pass flights,
// stuck phases and impacts (exterior powers of the transfer matrices).
//
// A flight under strong damping shrinks the deviations of the oscillator by more than double
// precision holds beside those of the free mass, and near grazing the entries of M grow without
// bound. Computed from the deviations, an area or a volume would then be the difference of large
// numbers. Carried as such it needs none: every formula below adds products of what a flight or an
// impact is made of, and the determinant of a flight is known, e^(-2 zeta s).
#pragma once

#include <array>

#include "core/motion/simulate.hpp"

namespace vines {

/// What is carried in one go shrinks no deviation by more than e to the minus this: the product of
/// two neighbouring lengths then keeps 14 digits.
inline constexpr double most_contraction = 4;

/// A free flight, or a stuck phase (both masses as one), in equal parts of which none shrinks by
/// more than most_contraction.
struct Leg {
    Transfer oscillator;  ///< of one part: J's block of (x', x), eq. (19)
    double duration;      ///< of one part
    double log_det;       ///< of `oscillator`
    long parts;
    bool stuck;
};
Leg leg_of(const Flow& flow, double duration, bool stuck);
Leg leg_of(const Stretch& stretch);

/// Carries deviations over one part: J of eq. (19), or of a stuck leg the
/// projection onto the centre of mass and its motion; epsilon: mass ratio.
void carry(Frame& deviations, const Leg& leg, double epsilon);
void carry(Eigen::Vector4d& deviation, const Leg& leg, double epsilon);
/// J of all parts.
Matrix4 transfer_of(const Leg& leg, double epsilon);

/// The area of two deviations: its components 01, 02, 03, 12, 13, 23 in the order (x', x, y', y).
using Area = Eigen::Matrix<double, 6, 1>;
/// The volume of three deviations, by its normal n: with a fourth deviation v it spans n.v.
struct Volume {
    Eigen::Vector4d normal;
};

Area carried(const Area& area, const Leg& leg, double epsilon);  ///< over one part
/// Over one part; zero after a stick.
Volume carried(const Volume& volume, const Leg& leg);
Area carried(const Area& area, const Saltation& M);
Volume carried(const Volume& volume, const Saltation& M);

/// What the first deviation, the first two and three of them span: a length, an area and a volume;
/// and the determinant of the flights, that of an impact being R^2. Carried from (x', x, y', y) =
/// the unit vectors they are the products of the diagonal of R in a QR factorisation of all
/// matrices passed: nothing needs to be made orthogonal.
struct Flag {
    Eigen::Vector4d deviation = Eigen::Vector4d::Unit(0);
    Area area = Area::Unit(0);
    Volume volume{Eigen::Vector4d::Unit(3)};
    double determinant = 1;

    void pass(const Leg& leg, double epsilon);  ///< one part of it
    void strike(const Saltation& M);
    std::array<double, 3> squares() const;  ///< of length, area and volume
    /// Sines of the angles by which the deviation leaves the plane of the area, and that the space
    /// of the volume: how far rounding has carried the parts apart. NaN of what is zero.
    std::array<double, 2> gaps() const;
};

/// Moduli of four eigenvalues, or their logarithms; descending.
using Moduli = std::array<double, 4>;

/// A product of transfer matrices by its exterior powers, scaled as it grows, so that the moduli of
/// all four eigenvalues are found however far they are apart: the largest eigenvalue of the k-th
/// power is the product of the k largest ones.
class PowerProduct {
public:
    explicit PowerProduct(double epsilon) : epsilon_(epsilon) {}

    void pass(const Leg& leg);
    void strike(const Saltation& M);

    /// 4; 2 once a stick has left only deviations of the centre of mass; 3 after an impact with
    /// R = 0.
    int rank() const { return rank_; }
    /// ln|eigenvalues|, descending; -infinity beyond the rank, NaN where they were not found.
    Moduli log_moduli() const;

private:
    template <int n>
    struct Scaled {
        Eigen::Matrix<double, n, n> matrix = Eigen::Matrix<double, n, n>::Identity();
        double log_scale = 0;

        void rescale();
        double log_radius() const;
    };

    const double epsilon_;
    Scaled<4> first_, third_;
    Scaled<6> second_;
    double log_det_ = 0;
    int rank_ = 4;
};

}  // namespace vines
