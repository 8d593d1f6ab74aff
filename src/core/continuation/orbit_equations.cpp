#include "core/continuation/orbit_equations.hpp"

namespace vines {

namespace {

// Step of the central differences, in units of the parameter: errors of 1e-11 each from truncation
// and rounding.
constexpr double parameter_step = 1e-5;

}  // namespace

ImpactSequence ImpactSequence::rotated() const {
    ImpactSequence next = *this;
    for (std::size_t k = 0; k < size(); ++k) next.sides[k] = side_after(k);
    return next;
}

ImpactSequence ImpactSequence::doubled() const {
    ImpactSequence twice{sides, false, 2 * half_cycles, 2 * sticks, 2 * slips};
    for (const int side : sides) twice.sides.push_back(mirrored ? -side : side);
    return twice;
}

OrbitEquations::OrbitEquations(
    ImpactSequence sequence, const ParameterFamily& family, double length)
    : sequence_(std::move(sequence)),
      family_(family),
      length_(length) {}

std::vector<double> OrbitEquations::parameters(const Unknowns& z) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < family_.ranges.size(); ++i)
        values.push_back(z(equations() + static_cast<Eigen::Index>(i)) * family_.unit(i));
    return values;
}

std::optional<Parameters> OrbitEquations::system(const Unknowns& z) const {
    return family_.system_at(parameters(z));
}

std::optional<OrbitValues> OrbitEquations::values(
    const Unknowns& z, Eigen::MatrixXd* jacobian) const {
    const auto p = system(z);
    if (!p) return std::nullopt;
    if (jacobian) jacobian->setZero(equations(), unknowns());
    auto at = evaluated(z, *p, jacobian);
    if (!at || !jacobian) return at;
    for (Eigen::Index c = equations(); c < unknowns(); ++c) {
        // One-sided at the end of a parameter's range.
        Unknowns beside = z;
        Eigen::VectorXd difference = Eigen::VectorXd::Zero(equations());
        double width = 0;
        for (const double side : {1.0, -1.0}) {
            beside(c) = z(c) + side * parameter_step;
            const auto other = values(beside);
            difference += side * (other ? other->residual : at->residual);
            if (other) width += parameter_step;
        }
        if (width == 0) return std::nullopt;
        jacobian->col(c) = difference / width;
    }
    return at;
}

std::optional<OrbitGuess> OrbitEquations::by_return(
    const Unknowns& z, const std::vector<double>& approach) const {
    return return_of(
        *system(z), 0, check(z, approach).measures.at_whole_cycle, sequence(), family(), length(),
        z.tail(std::ssize(family().ranges)));
}

}  // namespace vines
