#include "core/stability/transfer.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/elementary.hpp"
#include "core/stability/linear.hpp"

namespace vines {

void LegSequence::extend(const Stretch& stretch) {
    const bool sticking = stretch.sticking_side != 0;
    const bool continues = !legs_.empty() && legs_.back().sticking == sticking &&
                           legs_.back().resting == stretch.rests_inside() && legs_.back().slip == 1;
    if (!continues) {
        legs_.push_back(leg_of(stretch));
        return;
    }
    Leg& leg = legs_.back();
    leg = leg_of(
        stretch.flow, stretch.duration + leg.duration * static_cast<double>(leg.parts), sticking,
        stretch.rests_inside());
}

void LegSequence::slip(const Slip& slip) {
    if (legs_.empty())
        legs_.push_back(
            {.oscillator = {}, .duration = 0, .log_det = 0, .parts = 1, .sticking = false});
    legs_.back().slip *= slip.ratio;
}

Moduli eigenvalue_moduli(const Matrix4& m) {
    const Eigen::Vector4cd eigenvalues = eigenvalues_of(m);
    Moduli moduli;
    for (int k = 0; k < 4; ++k) moduli[k] = elementary::modulus(eigenvalues(k));
    std::ranges::sort(moduli, std::greater<>());
    return moduli;
}

namespace {

/// Moduli of J_i, or of T_i = M_i J_i, eq. (30), from the exterior powers.
Moduli moduli_of(const ImpactTransfer& transfer, bool with_impact) {
    PowerProduct product(transfer.epsilon);
    for (const Leg& leg : transfer.legs) product.pass(leg);
    if (with_impact) product.strike(transfer.M);
    Moduli moduli = product.log_moduli();
    for (double& m : moduli) m = elementary::exp(m);
    return moduli;
}

}  // namespace

int ImpactTransfer::rank() const {
    int rank = 4;
    for (const Leg& leg : legs)
        rank = std::min(rank, leg.sticking ? 2 : leg.resting || leg.slip == 0 ? 3 : 4);
    return rank;
}

Moduli ImpactTransfer::J_moduli() const {
    Moduli moduli = {1, 1, 1, 1};
    // Two blocks, eq. (19). The ball's, [1 0; s 1], is a Jordan block, which a solver would split.
    const bool blocks =
        std::ranges::all_of(legs, [](const Leg& leg) { return !leg.sticking && leg.slip == 1; });
    if (blocks) {
        for (const Leg& leg : legs) {
            const auto& [a11, a12, a21, a22] = leg.oscillator;
            const double n = static_cast<double>(leg.parts), half_trace = 0.5 * std::abs(a11 + a22);
            // half_trace^2 minus the determinant, without the ones that cancel in a short flight.
            const double d = 0.25 * (a11 - a22) * (a11 - a22) + a12 * a21;
            const double large =
                d > 0 ? elementary::log(half_trace + std::sqrt(d)) : 0.5 * leg.log_det;
            moduli[2] = elementary::exp(n * large);
            moduli[3] = elementary::exp(n * (leg.log_det - large));
        }
        return moduli;
    }
    return moduli_of(*this, false);
}

Moduli ImpactTransfer::M_moduli() const {
    Moduli moduli = {1, 1, std::abs(M.R), std::abs(M.R_speed)};
    std::ranges::sort(moduli, std::greater<>());
    return moduli;
}

Moduli ImpactTransfer::T_moduli() const { return moduli_of(*this, true); }

void TransferRecord::on_impact(const Impact& impact) {
    if (impact.tau < tau_start_ || impact.tau > tau_end_) return;
    if (begun_) {
        const auto legs = passage_.legs();
        add(
            {impact.tau,
             parameters_.epsilon,
             saltation(parameters_, impact),
             {legs.begin(), legs.end()}});
    }
    begun_ = true;
    passage_.reset();
}

}  // namespace vines
