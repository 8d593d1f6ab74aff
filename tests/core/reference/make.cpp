// Makes the files beside it: make_reference closed_b0.008 [TAU_END] writes one to standard output;
// scripts/references makes them all.
//
// A second method, which shares no code with the program under test: the closed form (8)-(11) in
// 250 digits. Chaos magnifies their rounding by e^(lambda1 tau), at most 10^123 here. No contact
// can be missed: the march to the next one takes only steps within which there is none (safe_step).
//
// Numbers in brackets are equations of the paper, see docs/physics.md. Omega = 1.
//
// A file holds, in this order:
//     one line an impact: tau side x x'- y'- x'+ y'+
//     # stick: both masses move as one from ... to ..., where they have x and v
//     window: from the first impact to the last event; n impacts, the first one included
//     qr: the four exponents of the product of T (30) over the window, by its QR factorisation
//     sumrule: their sum; and what damping and impacts say it is
//     eig: the exponents by the product's eigenvalues (33)
// A stick's projection, which would leave two exponents of minus infinity, is left out of the
// product and of the sum rule; its duration is not.
#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdio>
#include <ios>
#include <optional>
#include <string>
#include <vector>

namespace {

namespace mp = boost::multiprecision;
using Real = mp::number<mp::cpp_bin_float<250>, mp::et_off>;

/// A step in tau that ends a march: some digits above the rounding at tau = 1709.
const Real smallest_step("1e-240");
/// A chatter is followed to the first impact of a relative speed below this; what is left of it
/// moves none of the 25 digits of a stick.
const Real stick_speed("1e-35");
/// Impacts of a relative speed below this are followed and counted but not printed.
const Real printed_speed("1e-9");

/// Table 1: m1 = 3.807 kg, m2 = 0.032 kg, c1 = 2.53 N s/m, k1 = 11.68 kN/m, G = .02 m, R = .6.
struct System {
    Real b, zeta;
    Real epsilon = Real("0.032") / Real("3.807");
    Real epsilon_lambda = Real("2.53") / sqrt(Real("11680") * Real("3.807"));
    Real R = Real("0.6");
    // (3): epsilon A and phi
    Real forcing = epsilon * Real("0.02") * sqrt(1 + epsilon_lambda * epsilon_lambda);
    Real phi = atan(epsilon_lambda);
};

/// `law` is closed (zeta = epsilon lambda) or eom (2 zeta = epsilon lambda).
System table1(const std::string& law, const std::string& b) {
    System s;
    s.b = Real(b);
    s.zeta = law == "closed" ? s.epsilon_lambda : s.epsilon_lambda / 2;
    return s;
}

/// x and its derivatives.
struct Position {
    Real x, x_dot, x_ddot, x_dddot;
};

/// The solution of mass x'' + 2 zeta x' + x = forcing sin(tau + phi) from (tau, x, x') on,
/// (8)-(11). The mass is 1 in free flight, 1 + epsilon while both masses move as one.
class Motion {
public:
    Motion(const System& s, const Real& mass, const Real& tau, const Real& x, const Real& x_dot)
        : start_(tau),
          phi_(s.phi),
          k_(1 / mass),
          alpha_(s.zeta / mass),
          w_(sqrt(k_ - alpha_ * alpha_)) {
        const Real f = s.forcing / mass, detuning = k_ - 1;
        const Real D = detuning * detuning + 4 * alpha_ * alpha_;
        X_ = f * detuning / D;
        Y_ = -2 * alpha_ * f / D;
        const Real sine = sin(tau + phi_), cosine = cos(tau + phi_);
        q_ = x - X_ * sine - Y_ * cosine;
        r_ = (x_dot - X_ * cosine + Y_ * sine + alpha_ * q_) / w_;
    }

    Position at(const Real& tau) const {
        const Real s = tau - start_, decay = exp(-alpha_ * s), C = cos(w_ * s), S = sin(w_ * s);
        const Real free = decay * (q_ * C + r_ * S);
        const Real free_dot = decay * ((w_ * r_ - alpha_ * q_) * C - (w_ * q_ + alpha_ * r_) * S);
        const Real free_ddot = -k_ * free - 2 * alpha_ * free_dot;
        const Real sine = sin(tau + phi_), cosine = cos(tau + phi_);
        const Real forced = X_ * sine + Y_ * cosine, forced_dot = X_ * cosine - Y_ * sine;
        return {
            free + forced, free_dot + forced_dot, free_ddot - forced,
            -k_ * free_dot - 2 * alpha_ * free_ddot - forced_dot};
    }

    /// Upper bound of |x''| from the start on: the unforced part of x is the real part of
    /// (q - i r) e^((i w - alpha) s), and |i w - alpha|^2 = k.
    Real bound2() const { return k_ * sqrt(q_ * q_ + r_ * r_) + sqrt(X_ * X_ + Y_ * Y_); }
    /// The same of |x''''|.
    Real bound4() const { return k_ * k_ * sqrt(q_ * q_ + r_ * r_) + sqrt(X_ * X_ + Y_ * Y_); }

private:
    Real start_, phi_, k_, alpha_, w_, X_, Y_, q_, r_;
};

/// For how long a function cannot come down to zero that has this value and slope now, and a second
/// derivative of modulus `bound` at most: until value + slope d - bound d^2/2 = 0. Step by step
/// that leads to the function's next zero, from before it and at last as fast as Newton's method.
Real safe_step(const Real& value, const Real& slope, const Real& bound) {
    const Real root = sqrt(slope * slope + 2 * bound * value);
    return slope < 0 ? 2 * value / (root - slope) : (slope + root) / bound;
}

/// The state just after an event; on a wall side = sign(x - y), at the start 0.
struct State {
    Real tau, x, x_dot, y, y_dot;
    int side = 0;
};

struct Impact {
    State before, after;
    Real x_ddot;
};

struct Stick {
    State start, release;
};

/// The next contact of a free flight, before `end`; there is known to be none before `from`.
std::optional<State> next_contact(
    const System& s, const State& start, const Motion& motion, const Real& from, const Real& end) {
    const Real bound = motion.bound2();
    for (Real tau = from; tau <= end;) {
        const Position at = motion.at(tau);
        const Real y = start.y + start.y_dot * (tau - start.tau);
        Real step = end;
        for (const int side : {1, -1}) {
            const Real gap = s.b - side * (at.x - y), slope = -side * (at.x_dot - start.y_dot);
            const Real safe = safe_step(gap, slope, bound);
            if (slope < 0 && safe < smallest_step)  // not the wall just left, which recedes
                return State{tau, at.x, at.x_dot, at.x - side * s.b, start.y_dot, side};
            step = std::min(step, safe);
        }
        tau += step;
    }
    return {};
}

/// Momentum is kept, the relative velocity reversed and shrunk (4).
State strike(const System& s, const State& before) {
    const Real change = (1 + s.R) * (before.x_dot - before.y_dot) / (1 + s.epsilon);
    State after = before;
    after.x_dot -= s.epsilon * change;
    after.y_dot += change;
    return after;
}

/// Both masses move as one until the wall stops pressing, side x'' = 0.
State release(const System& s, const State& start) {
    const Motion motion(s, 1 + s.epsilon, start.tau, start.x, start.x_dot);
    const Real bound = motion.bound4();
    for (Real tau = start.tau;;) {
        const Position at = motion.at(tau);
        const Real step = safe_step(start.side * at.x_ddot, start.side * at.x_dddot, bound);
        if (step < smallest_step)
            return {tau, at.x, at.x_dot, at.x - start.side * s.b, at.x_dot, start.side};
        tau += step;
    }
}

using Matrix = std::vector<std::vector<Real>>;

Matrix operator*(const Matrix& a, const Matrix& b) {
    const std::size_t n = a.size();
    Matrix c(n, std::vector<Real>(n, 0));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            for (std::size_t k = 0; k < n; ++k) c[i][j] += a[i][k] * b[k][j];
    return c;
}

/// J (19) over a flight of duration s; deviations are (x', x, y', y), (5).
Matrix flight(const System& system, const Real& s) {
    const Real& zeta = system.zeta;
    const Real w = sqrt(1 - zeta * zeta), decay = exp(-zeta * s);
    const Real C = decay * cos(w * s), S = decay * sin(w * s) / w;
    return {{C - zeta * S, -S, 0, 0}, {S, C + zeta * S, 0, 0}, {0, 0, 1, 0}, {0, 0, s, 1}};
}

/// M = S + (f+ - S f-) g^T/(g^T f-) (27) with the flow f = (x'', x', 0, y') and g = (0, 1, 0, -1).
Matrix saltation(const System& s, const Impact& i) {
    const Real e = s.epsilon, total = 1 + e;
    const Matrix S = {
        {(1 - e * s.R) / total, 0, e * (1 + s.R) / total, 0},
        {0, 1, 0, 0},
        {(1 + s.R) / total, 0, (e - s.R) / total, 0},
        {0, 0, 0, 1}};  // (25)
    const Real x_ddot_after =
        i.x_ddot - 2 * s.zeta * (i.after.x_dot - i.before.x_dot);  // x and the forcing stay
    const std::array<Real, 4> before = {i.x_ddot, i.before.x_dot, 0, i.before.y_dot};
    const std::array<Real, 4> after = {x_ddot_after, i.after.x_dot, 0, i.after.y_dot};
    Matrix M = S;
    for (int row = 0; row < 4; ++row) {
        Real r = after[row];
        for (int k = 0; k < 4; ++k) r -= S[row][k] * before[k];
        r /= i.before.x_dot - i.before.y_dot;
        M[row][1] += r;
        M[row][3] -= r;
    }
    return M;
}

/// The minor of the rows and columns whose bits are set, expanded along the first row.
Real minor_of(const Matrix& m, unsigned rows, unsigned columns) {
    if (rows == 0) return 1;
    Real sum = 0;
    int sign = 1;
    for (unsigned left = columns; left != 0; left &= left - 1, sign = -sign) {
        const int j = std::countr_zero(left);
        sum += sign * m[std::countr_zero(rows)][j] *
               minor_of(m, rows & (rows - 1), columns & ~(1U << j));
    }
    return sum;
}

/// The k-th compound of a 4x4 matrix: its minors of k rows. A product's compound is the product of
/// the compounds, so the small exponents are not lost below the large ones.
Matrix compound(const Matrix& m, int k) {
    std::vector<unsigned> choices;  // the first is the first k
    for (unsigned bits = 0; bits < 16; ++bits)
        if (std::popcount(bits) == k) choices.push_back(bits);
    Matrix c;
    for (const unsigned rows : choices) {
        c.emplace_back();
        for (const unsigned columns : choices) c.back().push_back(minor_of(m, rows, columns));
    }
    return c;
}

/// ln of the volume that the first k unit vectors span after a product: of the first column of its
/// k-th compound. It is the product of the first k lengths of the product's QR factorisation.
Real log_volume(const Matrix& c) {
    Real square = 0;
    for (const auto& row : c) square += row[0] * row[0];
    return log(square) / 2;
}

/// ln of the largest modulus of the eigenvalues, ln||c^n||/n with n = 2^60: of the k-th compound of
/// a product it is the product of its k largest moduli.
Real log_radius(const Matrix& compound) {
    Matrix c = compound;
    Real sum = 0, share = 1;
    for (int squarings = 0; squarings < 60; ++squarings, share /= 2) {
        Real size = 0;
        for (const auto& row : c)
            for (const Real& entry : row) size = std::max(size, Real(abs(entry)));
        for (auto& row : c)
            for (Real& entry : row) entry /= size;
        sum += share * log(size);
        c = c * c;
    }
    return sum;
}

std::string text(const Real& v, int digits) { return v.str(digits, std::ios_base::fmtflags(0)); }

/// The exponents of a product of transfer matrices, through its four compounds.
class Exponents {
public:
    void multiply(const Matrix& T) {
        for (int k = 0; k < 4; ++k)
            product_[k] =
                product_[k].empty() ? compound(T, k + 1) : compound(T, k + 1) * product_[k];
    }
    Real log_determinant() const { return log_volume(product_[3]); }
    void print(const char* name, Real (*log_growth)(const Matrix&), const Real& duration) const {
        std::printf("%s", name);
        Real before = 0;
        for (const Matrix& c : product_) {
            const Real growth = log_growth(c);
            std::printf(" %s", text((growth - before) / duration, 15).c_str());
            before = growth;
        }
        std::printf("\n");
    }

private:
    std::array<Matrix, 4> product_;
};

void print(const Impact& i) {
    std::printf("%.17g %d", static_cast<double>(i.before.tau), i.before.side);
    for (const Real& v : {i.before.x, i.before.x_dot, i.before.y_dot, i.after.x_dot, i.after.y_dot})
        std::printf(" %.17g", static_cast<double>(v));
    std::printf("\n");
}

void print(const Stick& stick) {
    std::printf(
        "# stick side %d from %s to %s x %s v %s\n", stick.start.side,
        text(stick.start.tau, 25).c_str(), text(stick.release.tau, 25).c_str(),
        text(stick.release.x, 25).c_str(), text(stick.release.x_dot, 25).c_str());
}

/// Follows the motion from rest with y(0) = .95 b, and prints.
void run(const System& s, const Real& end) {
    State state{0, 0, 0, Real("0.95") * s.b, 0};
    Exponents exponents;
    Real first = 0, stuck = 0, from = 0;
    int impacts = 0;
    for (;;) {
        const Motion motion(s, 1, state.tau, state.x, state.x_dot);
        const std::optional<State> contact = next_contact(s, state, motion, from, end);
        if (!contact) break;
        const Impact impact{*contact, strike(s, *contact), motion.at(contact->tau).x_ddot};
        if (impacts++ == 0) first = contact->tau;
        else exponents.multiply(saltation(s, impact) * flight(s, contact->tau - state.tau));
        const Real speed = abs(contact->x_dot - contact->y_dot);
        if (speed > printed_speed) print(impact);
        state = impact.after;
        from = state.tau;
        if (speed > stick_speed) continue;

        const Stick stick{state, release(s, state)};
        print(stick);
        state = stick.release;
        stuck += state.tau - stick.start.tau;
        // The wall recedes while side x'' is negative: it falls from zero, and cannot be back there
        // before this moment. The other wall is far out of reach.
        const Motion freed(s, 1, state.tau, state.x, state.x_dot);
        from = state.tau + 2 * abs(freed.at(state.tau).x_dddot) / freed.bound4();
    }
    if (impacts < 2) return;
    const Real duration = state.tau - first;
    std::printf(
        "window %s %s n %d\n", text(first, 15).c_str(), text(state.tau, 15).c_str(), impacts);
    exponents.print("qr", log_volume, duration);
    const Real rule = -2 * s.zeta * (duration - stuck) + 2 * (impacts - 1) * log(s.R);
    std::printf(
        "sumrule %s %s\n", text(exponents.log_determinant() / duration, 15).c_str(),
        text(rule / duration, 15).c_str());
    exponents.print("eig", log_radius, duration);
}

}  // namespace

int main(int argc, char** argv) {
    const std::string name = argc > 1 ? argv[1] : "";
    const std::size_t split = name.find("_b");
    const std::string law = name.substr(0, split);
    if (split == std::string::npos || (law != "closed" && law != "eom") || argc > 3) {
        std::fprintf(stderr, "usage: make_reference closed_bMETRES|eom_bMETRES [TAU_END]\n");
        return 2;
    }
    const std::string b = name.substr(split + 2);
    std::printf(
        "# b=%s damping=%s; from rest with y(0) = .95 b, Table 1; impacts: tau side x x'- y'- x'+ "
        "y'+; 250-digit arithmetic, 17 digits kept\n",
        b.c_str(), law == "closed" ? "closed_form" : "equation_of_motion");
    run(table1(law, b), Real(argc > 2 ? argv[2] : "1709"));
}
