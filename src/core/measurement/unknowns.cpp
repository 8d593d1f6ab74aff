#include "core/measurement/unknowns.hpp"

#include <algorithm>

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Relative priors of given values: masses and springs are measured more precisely than that,
// dampings hardly.
constexpr double stiffness_prior = 0.02, damping_prior = 0.5, least_damping_prior = 1e-3;
constexpr double frequency_prior = 0.02;
// The displacement's scale is known to a tenth, its delay to a fraction of a cycle.
constexpr double gain_prior = 0.1, delay_prior = 0.1;

}  // namespace

UnknownValues given_unknowns(const Parameters& p) {
    UnknownValues v{};
    v[Unknown::x_gain] = 1;
    v[Unknown::Omega] = p.Omega;
    v[Unknown::stiffness] = 1;
    v[Unknown::damping] = 2 * p.zeta();
    v[Unknown::b] = p.b;
    v[Unknown::R_plus] = p.R_plus;
    v[Unknown::R_minus] = p.R_minus;
    return v;
}

double forcing_of(const Parameters& p) {
    return p.G * p.epsilon * elementary::hypot(1.0, p.lambda * p.epsilon * p.Omega);
}

double G_of(const Parameters& p, double force_sin, double force_cos) {
    return elementary::hypot(force_sin, force_cos) / p.epsilon /
           elementary::hypot(1.0, p.lambda * p.epsilon * p.Omega);
}

UnknownValues priors(const Parameters& p) {
    UnknownValues sigma;
    sigma.fill(infinity);
    sigma[Unknown::x_gain] = gain_prior;
    sigma[Unknown::x_delay] = delay_prior;
    sigma[Unknown::Omega] = frequency_prior * p.Omega;
    sigma[Unknown::stiffness] = stiffness_prior;
    sigma[Unknown::damping] = std::max(damping_prior * 2 * p.zeta(), least_damping_prior);
    return sigma;
}

}  // namespace vines
