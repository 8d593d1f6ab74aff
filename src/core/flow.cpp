#include "core/flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vines {

namespace {

// 40 cells a period (2 pi/h) keep the empty-cell proof of guard.cpp sharp: its margin M2 h^2/8 is .3 % of the amplitude.
constexpr double cells_per_period = 40;

// cos and sin of 0 <= angle <= 2 pi/40: the first term left out is below 1e-18.
struct Turn {
    double cos, sin;
};
Turn small_turn(double a) {
    const double q = a * a;
    return {1 - q / 2 * (1 - q / 12 * (1 - q / 30 * (1 - q / 56 * (1 - q / 90 * (1 - q / 132))))),
            a * (1 - q / 6 * (1 - q / 20 * (1 - q / 42 * (1 - q / 72 * (1 - q / 110)))))};
}

}  // namespace

Oscillation turned(const Oscillation& o, double c, double s) {
    Oscillation t = o;
    t.sin_theta = o.sin_theta * c + o.cos_theta * s;
    t.cos_theta = o.cos_theta * c - o.sin_theta * s;
    const double shrink = 1.5 - 0.5 * (t.sin_theta * t.sin_theta + t.cos_theta * t.cos_theta);  // Newton step to length 1
    t.sin_theta *= shrink;
    t.cos_theta *= shrink;
    return t;
}

Flow::Flow(double stiffness, double damping, double forcing, double Omega)
    : stiffness_(stiffness), damping_(damping), forcing_(forcing), Omega_(Omega),
      h_(2 * std::numbers::pi / cells_per_period / std::max({1.0, Omega, damping})) {
    double factor = 1;  // Omega^n / (n+2)!
    for (int n = 0; n <= degree; ++n) {
        recurrence_[n] = 1.0 / ((n + 1.0) * (n + 2.0));
        factor *= n == 0 ? 0.5 : Omega / (n + 2);
        forcing_term_[n] = forcing * factor;
    }

    // The exponential over one cell by its own series, then its powers, in extended precision: the table is right to
    // the last ulp of double.
    using Real = long double;
    struct Column {
        Real x, v, s, c;
    };
    auto step = [&](const Column& z) {
        Column sum = z, term = z;
        for (int n = 1; n <= 24; ++n) {
            term = {term.v / n,
                    (-(Real)stiffness * term.x - (Real)damping * term.v + (Real)forcing * term.s) / n,
                    (Real)Omega * term.c / n, -(Real)Omega * term.s / n};
            for (auto& t : {&term.x, &term.v, &term.s, &term.c}) *t *= (Real)h_;
            sum = {sum.x + term.x, sum.v + term.v, sum.s + term.s, sum.c + term.c};
        }
        return sum;
    };
    const Column unit[4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    Column over_cell[4], z[4];
    for (int j = 0; j < 4; ++j) over_cell[j] = step(z[j] = unit[j]);
    grid_.reserve(cells + 1);
    for (int k = 0; k <= cells; ++k) {
        grid_.push_back({(double)z[0].x, (double)z[1].x, (double)z[2].x, (double)z[3].x,
                         (double)z[0].v, (double)z[1].v, (double)z[2].v, (double)z[3].v,
                         (double)z[3].c, (double)z[3].s});
        for (Column& c : z) {
            const Column was = c;
            c = {};
            const Real part[4] = {was.x, was.v, was.s, was.c};
            for (int j = 0; j < 4; ++j)
                c = {c.x + over_cell[j].x * part[j], c.v + over_cell[j].v * part[j],
                     c.s + over_cell[j].s * part[j], c.c + over_cell[j].c * part[j]};
        }
    }
}

Flow Flow::free(const Parameters& p) { return Flow(1, 2 * p.zeta(), p.epsilon * p.A(), p.Omega); }

Flow Flow::stuck(const Parameters& p) {
    const double mass = 1 + p.epsilon;
    return Flow(1 / mass, 2 * p.zeta() / mass, p.epsilon * p.A() / mass, p.Omega);
}

Oscillation Flow::at(const Oscillation& o, int k) const {
    const Row& r = grid_[k];
    Oscillation next = turned(o, r.cos, r.sin);
    next.x = x_at(o, k);
    next.x_dot = r.v_x * o.x + r.v_v * o.x_dot + r.v_s * o.sin_theta + r.v_c * o.cos_theta;
    return next;
}

Flow::Series Flow::series(const Oscillation& o) const {
    // (n+1)(n+2) c[n+2] = -stiffness c[n] - damping (n+1) c[n+1] + forcing Omega^n/n! d^n(sin theta)
    const double cycle[4] = {o.sin_theta, o.cos_theta, -o.sin_theta, -o.cos_theta};
    Series c;
    c[0] = o.x;
    c[1] = o.x_dot;
    for (int n = 0; n + 2 <= degree; ++n)
        c[n + 2] = forcing_term_[n] * cycle[n % 4] - recurrence_[n] * (stiffness_ * c[n] + damping_ * (n + 1) * c[n + 1]);
    return c;
}

Oscillation Flow::along(const Series& c, const Oscillation& o, double d) const {
    double x = c[degree], v = 0;
    for (int n = degree - 1; n >= 0; --n) {
        v = v * d + x;
        x = x * d + c[n];
    }
    const Turn t = small_turn(Omega_ * d);
    Oscillation next = turned(o, t.cos, t.sin);
    next.x = x;
    next.x_dot = v;
    return next;
}

Oscillation Flow::after(Oscillation o, double s) const {
    for (; s >= reach(); s -= reach()) o = at(o, cells);
    const int k = static_cast<int>(s / h_);
    o = at(o, k);
    return along(series(o), o, std::max(0.0, s - k * h_));
}

Transfer Flow::transfer(double s) const {
    Transfer j;
    auto then = [&j](const Transfer& t) {
        j = {t.a11 * j.a11 + t.a12 * j.a21, t.a11 * j.a12 + t.a12 * j.a22,
             t.a21 * j.a11 + t.a22 * j.a21, t.a21 * j.a12 + t.a22 * j.a22};
    };
    auto row = [&](int k) { return Transfer{grid_[k].v_v, grid_[k].v_x, grid_[k].x_v, grid_[k].x_x}; };
    for (; s >= reach(); s -= reach()) then(row(cells));
    const int k = static_cast<int>(s / h_);
    const double d = std::max(0.0, s - k * h_);
    then(row(k));

    // Within a cell: x from (x', x) = (1, 0) by the unforced series, and the rest from the equation of motion:
    // x(d) = x0 (u' + damping u) + x'0 u with u that solution.
    double term = 1, before = 0, u = 0, u_dot = 0, power = 1;
    for (int n = 1; n <= degree; ++n) {  // term = coefficient of d^n, before = of d^(n-1)
        u_dot += n * term * power;
        power *= d;
        u += term * power;
        const double next = -(stiffness_ * before + damping_ * n * term) * recurrence_[n - 1];
        before = term;
        term = next;
    }
    then({u_dot, -stiffness_ * u, u, u_dot + damping_ * u});
    return j;
}

Flow::Bounds Flow::bounds(const Oscillation& o) const {
    // d/ds (stiffness x^2 + x'^2)/2 = x' (forcing sin theta - damping x') <= |x'| |forcing|
    const double root = std::sqrt(stiffness_);
    const double speed = std::hypot(root * o.x, o.x_dot) + std::abs(forcing_) * reach();
    const double x = speed / root;
    const double x_ddot = stiffness_ * x + damping_ * speed + std::abs(forcing_);
    return {x, x_ddot, stiffness_ * speed + damping_ * x_ddot + std::abs(forcing_) * Omega_};
}

}  // namespace vines
