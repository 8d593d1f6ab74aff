#include "systems.hpp"

#include <cmath>
#include <cstdio>

#include "../core/support.hpp"

namespace vines::hunt {

namespace {

double log_uniform(std::mt19937_64& engine, double from, double to) {
    return std::exp(uniform(engine, std::log(from), std::log(to)));
}

bool chance(std::mt19937_64& engine, double share) { return uniform(engine, 0, 1) < share; }

void set_zeta(Parameters& p, double zeta) {
    p.lambda = (p.damping == Damping::closed_form ? 1 : 2) * zeta / p.epsilon;
}

/// Amplitude of the oscillator without the absorber.
double unattached_amplitude(const Parameters& p) {
    return p.epsilon * p.A() / std::hypot(1 - p.Omega * p.Omega, 2 * p.zeta() * p.Omega);
}

/// A state in the range of the motion, with the ball inside its cavity.
State random_start(std::mt19937_64& engine, const Parameters& p, double amplitude) {
    State s;
    s.x = amplitude * uniform(engine, -1, 1);
    s.x_dot = amplitude * p.Omega * uniform(engine, -1, 1);
    s.y = s.x + p.b * uniform(engine, -0.999, 0.999);
    s.y_dot = amplitude * p.Omega * uniform(engine, -1, 1) * log_uniform(engine, 0.5, 10);
    return s;
}

System with_random_start(std::mt19937_64& engine, const Parameters& p) {
    return {p, random_start(engine, p, unattached_amplitude(p))};
}

Damping random_damping(std::mt19937_64& engine) {
    return chance(engine, 0.5) ? Damping::closed_form : Damping::equation_of_motion;
}

System wide(std::mt19937_64& engine) {
    Parameters p;
    p.epsilon = log_uniform(engine, 1e-3, 5);
    p.damping = random_damping(engine);
    p.Omega = uniform(engine, 0.4, 2.3);
    set_zeta(p, log_uniform(engine, 1e-4, 0.5));
    p.G = log_uniform(engine, 1e-4, 100);
    p.R_plus = uniform(engine, 0.05, 0.95);
    p.R_minus = chance(engine, 0.7) ? p.R_plus : uniform(engine, 0.05, 0.95);
    p.b = unattached_amplitude(p) * log_uniform(engine, 0.02, 2);
    return with_random_start(engine, p);
}

System table(std::mt19937_64& engine) {
    Parameters p;
    p.damping = random_damping(engine);
    p.R_plus = p.R_minus = chance(engine, 0.5) ? 0.6 : uniform(engine, 0.3, 0.9);
    // Symmetry breaking, torus and fold of the motion with two impacts per cycle, closed-form
    // damping.
    const double special[] = {0.007046736303, 0.0162860264, 0.017274732497};
    p.b = chance(engine, 0.2) ? special[engine() % 3] * uniform(engine, 0.99, 1.01)
                              : log_uniform(engine, 0.003, 0.04);
    return chance(engine, 0.5) ? System{p, default_state(p)} : with_random_start(engine, p);
}

System band(std::mt19937_64& engine) {
    Parameters p;
    p.damping = Damping::closed_form;
    p.R_plus = p.R_minus = chance(engine, 0.3) ? 0.5 : uniform(engine, 0.47, 0.53);
    p.b = 0.0046 * uniform(engine, 0.96, 1.04);
    return {p, default_state(p)};
}

System contracting(std::mt19937_64& engine) {
    Parameters p;
    p.epsilon = log_uniform(engine, 0.02, 1);
    p.lambda = log_uniform(engine, 0.1, 3);
    p.damping = random_damping(engine);
    p.Omega = uniform(engine, 0.4, 1.3);
    p.R_plus = uniform(engine, 0.05, 0.3);
    p.R_minus = chance(engine, 0.7) ? p.R_plus : uniform(engine, 0.05, 0.3);
    p.b = unattached_amplitude(p) * log_uniform(engine, 0.03, 1.5);
    return chance(engine, 0.5) ? System{p, default_state(p)} : with_random_start(engine, p);
}

System neutral(std::mt19937_64& engine) {
    System system = wide(engine);
    Parameters& p = system.parameters;
    switch (engine() % 4) {
        case 0: p.R_plus = p.R_minus = 1; break;
        case 1: p.R_plus = 1; break;
        case 2: p.lambda = 0; break;
        case 3:  // without impacts
            p.b = unattached_amplitude(p) * uniform(engine, 1.5, 5);
            system.start = {0, 0, 0, 0};
            break;
    }
    return system;
}

System torus(std::mt19937_64& engine) {
    Parameters p;
    p.damping = Damping::equation_of_motion;
    if (chance(engine, 0.4)) {
        p.b = uniform(engine, 0.0197, 0.0203);
        return {p, default_state(p)};
    }
    p.epsilon = log_uniform(engine, 0.07, 0.14);
    p.lambda = log_uniform(engine, 0.2, 2);
    p.Omega = uniform(engine, 2.8, 3.4);
    p.R_plus = p.R_minus = uniform(engine, 0.5, 0.9);
    p.b = unattached_amplitude(p) * log_uniform(engine, 0.2, 5);
    return with_random_start(engine, p);
}

}  // namespace

std::mt19937_64 engine_of(std::uint64_t seed, int number) {
    std::seed_seq all{
        static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
        static_cast<std::uint32_t>(number)};
    return std::mt19937_64(all);
}

const char* name_of(Kind kind) {
    constexpr const char* names[] = {"wide", "table", "band", "contracting", "neutral", "torus"};
    return names[static_cast<int>(kind)];
}

Kind random_kind(std::mt19937_64& engine) {
    const double u = uniform(engine, 0, 1);
    return u < 0.4    ? Kind::wide
           : u < 0.58 ? Kind::table
           : u < 0.66 ? Kind::band
           : u < 0.8  ? Kind::contracting
           : u < 0.86 ? Kind::neutral
                      : Kind::torus;
}

namespace {

System any_system(Kind kind, std::mt19937_64& engine) {
    switch (kind) {
        case Kind::wide: return wide(engine);
        case Kind::table: return table(engine);
        case Kind::band: return band(engine);
        case Kind::contracting: return contracting(engine);
        case Kind::neutral: return neutral(engine);
        case Kind::torus: return torus(engine);
    }
    return {};
}

}  // namespace

System random_system(Kind kind, std::mt19937_64& engine) {
    for (;;) {
        const System system = any_system(kind, engine);
        if (validate(system.parameters, system.start).empty()) return system;
    }
}

System strongly_damped(std::mt19937_64& engine) {
    Parameters p;
    p.epsilon = log_uniform(engine, 1e-3, 3);
    p.damping = random_damping(engine);
    set_zeta(p, chance(engine, 0.05) ? 1 : log_uniform(engine, 0.5, 9.999));
    p.Omega = log_uniform(engine, 0.2, 3);
    p.G = log_uniform(engine, 1e-3, 10);
    // Small R leads to sticking; R = 0 loses a direction at every impact.
    p.R_plus = chance(engine, 0.15)  ? 0
               : chance(engine, 0.3) ? uniform(engine, 0.05, 0.3)
                                     : uniform(engine, 0.3, 1);
    p.R_minus = chance(engine, 0.6) ? p.R_plus : uniform(engine, 0.05, 1);
    p.b = unattached_amplitude(p) * log_uniform(engine, 0.1, 1);
    System system = with_random_start(engine, p);
    if (p.R_plus == 0) system.start.y_dot *= 10;  // fast enough to leave the wall sometimes
    return system;
}

std::string request(const System& system, const std::string& more) {
    const auto& [p, s] = system;
    char text[700];
    std::snprintf(
        text, sizeof text,
        "{\"epsilon\":%.17g,\"lambda\":%.17g,\"damping\":\"%s\",\"G\":%.17g,\"Omega\":%.17g,\"R_"
        "plus\":%."
        "17g,\"R_minus\":%.17g,\"b\":%.17g,"
        "\"x0\":%.17g,\"x_dot0\":%.17g,\"y0\":%.17g,\"y_dot0\":%.17g",
        p.epsilon, p.lambda,
        p.damping == Damping::closed_form ? "closed_form" : "equation_of_motion", p.G, p.Omega,
        p.R_plus, p.R_minus, p.b, s.x, s.x_dot, s.y, s.y_dot);
    return text + ("," + more) + "}";
}

}  // namespace vines::hunt
