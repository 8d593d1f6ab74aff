#include "core/continuation/return_map.hpp"

#include <cmath>

#include "core/measures/energy.hpp"
#include "core/motion/record.hpp"

namespace vines {

namespace {

// Two halves of an orbit can be those of its parent if the state returns to within this, in units
// of the length.
constexpr double similar_return = 0.3;

/// The events of a period.
class Events : public ContactRecord {
public:
    void on_slip(const Slip&) override { ++slips; }

    /// Their sequence; that of the first half if `like` is mirrored.
    ImpactSequence sequence(const ImpactSequence& like) const {
        const std::size_t parts = like.mirrored ? 2 : 1;
        ImpactSequence found{{}, like.mirrored, like.half_cycles};
        for (std::size_t k = 0; k < contacts.size() / parts; ++k)
            found.sides.push_back(contacts[k].side);
        found.sticks = static_cast<long>(sticks.size() / parts);
        found.slips = slips / static_cast<long>(parts);
        return found;
    }

private:
    long slips = 0;
};

}  // namespace

std::optional<OrbitValues> ReturnEquations::evaluated(
    const Unknowns& z, const Parameters& p, Eigen::MatrixXd* jacobian) const {
    const State start = state(z);
    if (!(std::abs(start.x - start.y) < p.b)) return std::nullopt;
    Monodromy monodromy(p);
    const auto end = follow(
        p, start, section_ * p.cycle(), 0.5 * sequence().half_cycles * p.cycle(), {}, {&monodromy});
    if (!end) return std::nullopt;
    const double sign = sequence().sign();
    OrbitValues out{sign / length() * vector_of(*end) - z.head<4>(), {}, sign * monodromy.matrix};
    if (jacobian) jacobian->leftCols<4>() = out.transfer - Frame::Identity();
    return out;
}

OrbitCheck ReturnEquations::check(const Unknowns& z, const std::vector<double>&) const {
    const Parameters p = *system(z);
    const State start = state(z);
    const double tau = section_ * p.cycle(), period = sequence().cycles() * p.cycle();
    Events events;
    Energy energy(p, {tau, tau + period});
    follow(p, start, tau, period, {}, {&events, &energy});
    const ImpactSequence found = events.sequence(sequence());
    OrbitCheck check;
    using Kind = SequenceFault::Kind;
    if (found.sticks != sequence().sticks || found.slips != sequence().slips)
        check.fault = SequenceFault{Kind::stick};
    else if (found.size() != sequence().size())
        check.fault =
            SequenceFault{found.size() > sequence().size() ? Kind::contact : Kind::missing};
    const EnergyBalance balance = energy.balance({tau, tau + period});
    check.measures = {
        follow(p, start, tau, p.cycle() - tau, {}).value_or(start), balance.peak, balance.rms,
        balance.share_impacts};
    return check;
}

std::shared_ptr<const OrbitEquations> ReturnEquations::doubled() const {
    return std::make_shared<ReturnEquations>(sequence().doubled(), family(), length(), section_);
}

std::optional<OrbitGuess> ReturnEquations::half(const Unknowns& z) const {
    const ImpactSequence& all = sequence();
    const auto p = system(z);
    if (all.mirrored || all.half_cycles % 2 != 0 || !p) return std::nullopt;
    ImpactSequence one{
        {}, all.half_cycles % 4 != 0, all.half_cycles / 2, all.sticks / 2, all.slips / 2};
    if (one.mirrored && !p->is_symmetric()) return std::nullopt;
    one.sides.assign(all.sides.begin(), all.sides.begin() + static_cast<long>(all.size() / 2));
    auto equations = std::make_shared<ReturnEquations>(one, family(), length(), section_);
    const auto at = equations->values(z);
    if (!at || !(at->residual.cwiseAbs().maxCoeff() < similar_return)) return std::nullopt;
    return OrbitGuess{std::move(equations), z};
}

std::shared_ptr<const OrbitEquations> ReturnEquations::over(const ParameterFamily& family) const {
    return std::make_shared<ReturnEquations>(sequence(), family, length(), section_);
}

std::optional<OrbitGuess> return_of(
    const Parameters& p, const TimedState& at, const ImpactSequence& like,
    const ParameterFamily& family, double length, const Eigen::VectorXd& parameters) {
    const auto whole = follow(p, at.state, at.tau, p.cycle() - at.tau, {});
    if (!whole) return std::nullopt;
    const double tau = time_far_from_events(p, *whole, {});
    const auto state = follow(p, *whole, 0, tau, {});
    Events events;
    if (!state || !follow(p, *state, tau, like.cycles() * p.cycle(), {}, {&events}))
        return std::nullopt;
    Unknowns z(4 + parameters.size());
    z << vector_of(*state) / length, parameters;
    return OrbitGuess{
        std::make_shared<ReturnEquations>(events.sequence(like), family, length, tau / p.cycle()),
        z};
}

}  // namespace vines
