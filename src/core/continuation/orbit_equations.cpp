#include "core/continuation/orbit_equations.hpp"

#include "core/continuation/periodic_impacts.hpp"

namespace vines {

namespace {

// Step of the central differences, in units of the parameter: truncation and rounding are 1e-11.
// That of a return is shorter where deviations grow, as next to an event without speed.
constexpr double parameter_step = 1e-5;
// Distance of values at which a family is compared with a symmetric one, in units of the parameter.
constexpr double near_value = 1e-3;

/// True if `holds` for the systems of the family at these values and next to them.
bool all_near(
    const ParameterFamily& family, const std::vector<double>& values,
    const std::function<bool(const Parameters&)>& holds) {
    for (std::size_t i = 0; i < values.size(); ++i)
        for (const double side : {0.0, 1.0, -1.0}) {
            std::vector<double> beside = values;
            beside[i] += side * near_value * family.unit(i);
            const auto p = family.system_at(beside);
            if (p && !holds(*p)) return false;
        }
    return true;
}

bool slides_freely(const Parameters& p) { return p.friction == 0; }

/// The equations of an orbit by the times of its impacts.
std::optional<OrbitGuess> by_impacts(
    const Parameters& p, const PeriodicOrbit& orbit, bool mirrored, double length,
    const ParameterFamily& family, const Eigen::VectorXd& values) {
    ImpactRecord record;
    follow(p, orbit.state, orbit.tau, 2 * orbit.cycles * p.cycle(), {}, {&record});
    std::vector<Impact> impacts = record.entries;
    const auto all = static_cast<std::size_t>(orbit.impacts);
    if (impacts.size() <= all) return std::nullopt;
    ImpactSequence sequence{.sides = {}, .mirrored = mirrored && all % 2 == 0};
    sequence.half_cycles = (sequence.mirrored ? 1 : 2) * orbit.cycles;
    const std::size_t n = sequence.mirrored ? all / 2 : all;
    Unknowns z(static_cast<Eigen::Index>(n) + 4 + values.size());
    z.head<4>() << impacts[0].phase(), impacts[0].x / length, impacts[0].x_dot_after / length,
        impacts[0].relative_speed_after / length;
    for (std::size_t k = 0; k < n; ++k) {
        sequence.sides.push_back(impacts[k].side);
        z(static_cast<Eigen::Index>(4 + k)) = impacts[k + 1].tau - impacts[k].tau;
    }
    z.tail(values.size()) = values;
    return OrbitGuess{std::make_shared<ImpactEquations>(sequence, family, length), z};
}

}  // namespace

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
    const double step =
        at->approach.empty() ? parameter_step / std::max(1.0, at->transfer.norm()) : parameter_step;
    for (Eigen::Index c = equations(); c < unknowns(); ++c) {
        // One-sided at the end of a parameter's range.
        Unknowns beside = z;
        Eigen::VectorXd difference = Eigen::VectorXd::Zero(equations());
        double width = 0;
        for (const double side : {1.0, -1.0}) {
            beside(c) = z(c) + side * step;
            const auto other = values(beside);
            difference += side * (other ? other->residual : at->residual);
            if (other) width += step;
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

std::optional<OrbitGuess> orbit_start(
    const Parameters& p, const PeriodicOrbit& orbit, double length, const ParameterFamily& family,
    const std::vector<double>& values) {
    if (orbit.impacts == 0) return std::nullopt;
    Eigen::VectorXd scaled(std::ssize(values));
    for (std::size_t i = 0; i < values.size(); ++i)
        scaled(static_cast<Eigen::Index>(i)) = values[i] / family.unit(i);
    const bool mirrored = orbit.symmetric && all_near(family, values, [](const Parameters& q) {
                              return q.is_symmetric();
                          });
    if (orbit.sticks == 0 && all_near(family, values, slides_freely))
        return by_impacts(p, orbit, mirrored, length, family, scaled);
    return return_of(
        p, orbit.tau, orbit.state, {{}, mirrored, (mirrored ? 1 : 2) * orbit.cycles}, family,
        length, scaled);
}

std::optional<OrbitGuess> impacts_of(const OrbitGuess& guess) {
    const OrbitEquations& by_return = *guess.equations;
    const ImpactSequence& sequence = by_return.sequence();
    const Parameters p = *by_return.system(guess.z);
    if (sequence.sticks > 0 ||
        !all_near(by_return.family(), by_return.parameters(guess.z), slides_freely))
        return std::nullopt;
    PeriodicOrbit orbit{};
    orbit.cycles = sequence.cycles();
    orbit.state = by_return.check(guess.z, {}).measures.at_whole_cycle;
    orbit.impacts = sequence.impacts();
    return by_impacts(
        p, orbit, sequence.mirrored, by_return.length(), by_return.family(),
        guess.z.tail(std::ssize(by_return.family().ranges)));
}

}  // namespace vines
