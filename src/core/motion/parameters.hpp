// The parameters of the oscillator with a vibro-impact nonlinear energy sink (VI NES), and what
// follows from them.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace vines {

/// Which damping ratio zeta the motion has. The paper uses both: see docs/paper.md.
enum class Damping {
    equation_of_motion,  ///< 2 zeta = epsilon lambda, eqs. (1), (6), (17): what c1 means
    /// zeta = epsilon lambda, eqs. (8)-(11), (19), (20): what the paper's numbers come from
    closed_form
};

/// The same system in SI units: masses in kg, c1 in N s/m, k1 in N/m, F (amplitude of the base) in
/// m, f in Hz. The defaults are the paper's Table 1; its excitation is given in reduced form,
/// G = .02 m and Omega = 1.
struct SiParameters {
    double m1 = 3.807, c1 = 2.53, k1 = 11.68e3, m2 = 0.032;
    double F = 0.02 * m2 / m1, f = f0();

    double omega0() const { return std::sqrt(k1 / m1); }             ///< rad/s
    double f0() const { return omega0() / (2 * std::numbers::pi); }  ///< Hz
    double damping_ratio() const { return c1 / (2 * m1 * omega0()); }
    // The definitions below eq. (1).
    double epsilon() const { return m2 / m1; }
    double lambda() const { return c1 / (m2 * omega0()); }
    double G() const { return F / epsilon(); }
    double Omega() const { return f / f0(); }  ///< exactly 1 for the oscillator's own f
};

/// Dimensionless but where a unit is given; the symbols are the paper's. The defaults are its
/// Table 1 with the b of Fig. 3; epsilon and lambda come from the table's SI values, of which .84 %
/// and 1.43 are rounded.
struct Parameters {
    double epsilon = SiParameters{}.epsilon();  ///< mass ratio m2/m1
    double lambda = SiParameters{}.lambda();    ///< c1/(m2 omega0)
    double G = 0.02;                            ///< base amplitude over epsilon, m
    double Omega = 1.0;                         ///< forcing frequency over omega0
    double R_plus = 0.6;                        ///< restitution coefficient where x - y = +b
    double R_minus = 0.6;                       ///< restitution coefficient where x - y = -b
    double b = 0.022;                           ///< half-width of the cavity, m
    Damping damping = Damping::equation_of_motion;

    double zeta() const;  ///< damping ratio of x'' + 2 zeta x' + x = ...
    double A() const;     ///< forcing amplitude over epsilon, m, eq. (3)
    double phi() const;   ///< forcing phase at tau = 0, eq. (3)
    double cycle() const { return 2 * std::numbers::pi / Omega; }  ///< of the forcing, in tau
    /// Half a cycle of the faster of forcing and oscillator, in tau.
    double faster_half_cycle() const { return std::numbers::pi / (Omega > 1 ? Omega : 1); }
    double restitution(int side) const { return side > 0 ? R_plus : R_minus; }
};

/// The same system in SI, on the scale of an oscillator's mass and stiffness.
SiParameters in_si(const Parameters& parameters, double m1, double k1);

/// State of the flow in the paper's order, eq. (5). Positions in m, velocities in m per unit of
/// tau.
struct State {
    double x_dot = 0, x = 0, y_dot = 0, y = 0;
};

/// The closed range that a parameter must lie in. Exactly one of the two members is set.
struct ParameterRange {
    const char* name;
    double Parameters::* parameter;
    double State::* state;
    double minimum, maximum;
};

/// The ranges of all parameters and of the initial state.
std::span<const ParameterRange> parameter_ranges();

/// One thing that is wrong with an input: the field, its value, the range it must lie in, and a
/// sentence that says so.
struct Fault {
    std::string field;
    double value;
    double minimum, maximum;
    std::string message;
};

/// The state that a run starts from by Table 1: at rest, the free mass at 95 % of b.
State default_state(const Parameters& parameters);

/// Every fault of a system and its initial state (empty: valid). Beyond each number's own range:
/// the damping ratio, and |x - y| <= b at the start.
std::vector<Fault> validate(const Parameters& parameters, const State& start);

/// Whether the equations of motion have a meaning: epsilon, Omega, b > 0, lambda and G >= 0, both R
/// in [0, 1], all of them finite. validate() asks for more, so that a request ends in time.
bool is_physical(const Parameters& parameters);

/// The wall (side = sign(x - y)) that a state touches up to rounding, or 0.
int wall_of(const State& state, double b);

}  // namespace vines
