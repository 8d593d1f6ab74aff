// Parameters of the linear oscillator (LO) with a vibro-impact nonlinear energy sink (VI NES), and
// quantities derived from them. The free mass m2 of the VI NES is called the ball.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace vines {

/// Definition of the damping ratio zeta. The paper uses both: see docs/paper.md.
enum class Damping {
    equation_of_motion,  ///< 2 zeta = epsilon lambda, eqs. (1), (6), (17): c1 as defined
    /// zeta = epsilon lambda, eqs. (8)-(11), (19), (20): the paper's numbers are computed with it
    closed_form
};

/// The same system in SI units: kg, N s/m, N/m, F (base amplitude) in m, f in Hz. The defaults are
/// the paper's Table 1, whose excitation is given as G = .02 m and Omega = 1.
struct SiParameters {
    double m1 = 3.807, c1 = 2.53, k1 = 11.68e3, m2 = 0.032;
    double F = 0.02 * m2 / m1, f = f0();

    double omega0() const { return std::sqrt(k1 / m1); }             ///< rad/s
    double f0() const { return omega0() / (2 * std::numbers::pi); }  ///< Hz
    double damping_ratio() const { return c1 / (2 * m1 * omega0()); }
    // Definitions after eq. (1).
    double epsilon() const { return m2 / m1; }
    double lambda() const { return c1 / (m2 * omega0()); }
    double G() const { return F / epsilon(); }
    double Omega() const { return f / f0(); }  ///< exactly 1 for f = f0()
};

/// R as a function of the speed w = |x' - y'| before the impact: linear between the points.
struct RestitutionTable {
    std::vector<double> speed;  ///< m per unit of tau, ascending, >= 0
    std::vector<double> R;      ///< of equal length, in [0, 1]

    double at(double w) const;
    /// d(R w)/dw: the factor for deviations of x' - y'.
    double derivative(double w) const;
    bool operator==(const RestitutionTable&) const = default;
};

class Load;

/// Dimensionless unless a unit is given; symbols as in the paper. The defaults are Table 1 with the
/// b of Fig. 3; the table rounds epsilon and lambda to .84 % and 1.43.
struct Parameters {
    double epsilon = SiParameters{}.epsilon();  ///< mass ratio m2/m1
    double lambda = SiParameters{}.lambda();    ///< c1/(m2 omega0)
    double G = 0.02;                            ///< base amplitude over epsilon, m
    double Omega = 1.0;                         ///< forcing frequency over omega0
    double R_plus = 0.6;                        ///< restitution coefficient where x - y = +b
    double R_minus = 0.6;                       ///< restitution coefficient where x - y = -b
    double b = 0.022;                           ///< clearance (half-width of the cavity), m
    Damping damping = Damping::equation_of_motion;
    /// Laws that replace R_plus and R_minus, which then are their values at zero speed.
    std::shared_ptr<const RestitutionTable> table_plus, table_minus;
    /// g sin(inclination)/omega0^2, m, of the free ball along +x; x = 0 without ball.
    double gravity = 0;
    /// Deceleration of the sliding ball: mu g cos(inclination)/omega0^2, m.
    double friction = 0;

    /// Replaces the harmonic forcing: G is 0 then.
    std::shared_ptr<const Load> load;

    /// Damping ratio of x'' + 2 zeta x' + x = ...
    double zeta() const {
        return damping == Damping::closed_form ? epsilon * lambda : 0.5 * epsilon * lambda;
    }
    double A() const;    ///< forcing amplitude over epsilon, m, eq. (3)
    double phi() const;  ///< forcing phase at tau = 0, eq. (3)
    double cycle() const { return 2 * std::numbers::pi / Omega; }  ///< forcing period, in tau
    /// Half a cycle of the faster of forcing and oscillator, in tau.
    double faster_half_cycle() const { return std::numbers::pi / (Omega > 1 ? Omega : 1); }
    /// The table of R of a wall; empty if it is constant.
    const auto& table_of(int side) const { return side > 0 ? table_plus : table_minus; }
    /// R of a wall at a speed w = |x' - y'| before the impact.
    double restitution(int side, double w) const {
        const auto& table = table_of(side);
        return table ? table->at(w) : side > 0 ? R_plus : R_minus;
    }
    /// d(R w)/dw.
    double restitution_derivative(int side, double w) const {
        const auto& table = table_of(side);
        return table ? table->derivative(w) : side > 0 ? R_plus : R_minus;
    }
    bool has_constant_R() const { return !table_plus && !table_minus; }
    bool is_forced() const { return G > 0 || load; }
    /// True for the forces of the paper alone: harmonic forcing, and a ball that flies straight.
    bool has_straight_flights() const { return gravity == 0 && friction == 0 && !load; }
    /// True if both walls obey the same law.
    bool has_equal_walls() const;
    /// True if the mirror image of a motion, half a cycle later, is a motion.
    bool is_symmetric() const { return has_equal_walls() && gravity == 0; }
};

/// The same system in SI units, for an oscillator with mass m1 and stiffness k1.
SiParameters in_si(const Parameters& parameters, double m1, double k1);

/// State in the order of eq. (5). Positions in m, velocities in m per unit of tau.
struct State {
    double x_dot = 0, x = 0, y_dot = 0, y = 0;
};

/// Closed range of a parameter or of a component of the initial state (the other pointer is null).
struct ParameterRange {
    const char* name;
    double Parameters::* parameter;
    double State::* state;
    double minimum, maximum;
};

/// The ranges of all parameters and of the initial state.
std::span<const ParameterRange> parameter_ranges();

/// One invalid input: the field, its value, the permitted range, and a sentence for the user.
struct Fault {
    std::string field;
    double value;
    double minimum, maximum;
    std::string message;
};

/// The initial state of Table 1: at rest, the ball at 95 % of b.
inline State default_state(const Parameters& p) { return {0, 0, 0, 0.95 * p.b}; }

/// All faults: ranges, the damping ratio, and |x - y| <= b at the start.
std::vector<Fault> validate(const Parameters& parameters, const State& start);

/// True if the equations of motion are meaningful: epsilon, Omega, b > 0, lambda and G >= 0, both R
/// in [0, 1], all finite. validate() is stricter, so that a request ends in reasonable time.
bool is_physical(const Parameters& parameters);

/// The wall (side = sign(x - y)) in contact with the ball up to rounding, or 0.
int wall_of(const State& state, double b);

}  // namespace vines
