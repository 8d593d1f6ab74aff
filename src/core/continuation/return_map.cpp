// Periodic orbits as fixed points of the return map: the state at a phase of the forcing within a
// flight returns after the period. The motion is simulated, so that the ball may chatter, stick to
// a wall or slide with friction, whatever the order of these events; the derivative is the product
// of the transfer matrices (stability/orbit.hpp). Deviations grow along an unstable orbit, so that
// these equations are less accurate there than those of its impacts by the largest multiplier.
#include <cmath>

#include "core/continuation/orbit_equations.hpp"
#include "core/measures/energy.hpp"
#include "core/motion/record.hpp"

namespace vines {

namespace {

// A return after half the period to within this, in units of the length, can be the parent's.
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

/// Unknowns: (x', x, y', y)/length and the parameters. Residuals: the return of the state.
class ReturnEquations : public OrbitEquations {
public:
    /// section: the phase of the state, as a fraction of a forcing cycle after tau = 0.
    ReturnEquations(
        ImpactSequence sequence, const ParameterFamily& family, double length, double section)
        : OrbitEquations(std::move(sequence), family, length),
          section_(section) {}

    Eigen::Index equations() const override { return 4; }

    /// A fault is the first difference in number: of sticking phases and slips, then of impacts.
    OrbitCheck check(const Unknowns& z, const std::vector<double>&) const override {
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

    std::shared_ptr<const OrbitEquations> doubled() const override {
        return std::make_shared<ReturnEquations>(
            sequence().doubled(), family(), length(), section_);
    }
    Eigen::VectorXd twice(const Eigen::VectorXd& z) const override { return z; }

    std::optional<OrbitGuess> half(const Unknowns& z) const override {
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

    std::shared_ptr<const OrbitEquations> over(const ParameterFamily& family) const override {
        return std::make_shared<ReturnEquations>(sequence(), family, length(), section_);
    }
    std::optional<OrbitGuess> changed(const Unknowns&, const SequenceFault&) const override {
        return std::nullopt;
    }

protected:
    std::optional<OrbitValues> evaluated(
        const Unknowns& z, const Parameters& p, Eigen::MatrixXd* jacobian) const override {
        const State start = state(z);
        if (!(std::abs(start.x - start.y) < p.b)) return std::nullopt;
        Monodromy monodromy(p);
        const double duration = 0.5 * sequence().half_cycles * p.cycle();
        const auto end = follow(p, start, section_ * p.cycle(), duration, {}, {&monodromy});
        if (!end) return std::nullopt;
        const double sign = sequence().sign();
        OrbitValues out{
            sign / length() * vector_of(*end) - z.head<4>(), {}, sign * monodromy.matrix};
        if (jacobian) jacobian->leftCols<4>() = out.transfer - Frame::Identity();
        return out;
    }

private:
    State state(const Unknowns& z) const { return state_of(length() * z.head<4>()); }

    const double section_;
};

}  // namespace

std::optional<OrbitGuess> return_of(
    const Parameters& p, double tau, const State& state, const ImpactSequence& like,
    const ParameterFamily& family, double length, const Eigen::VectorXd& parameters) {
    const auto whole = follow(p, state, tau, p.cycle() - tau, {});
    if (!whole) return std::nullopt;
    const double far = time_far_from_events(p, *whole, {});
    const auto start = follow(p, *whole, 0, far, {});
    Events events;
    if (!start || !follow(p, *start, far, like.cycles() * p.cycle(), {}, {&events}))
        return std::nullopt;
    Unknowns z(4 + parameters.size());
    z << vector_of(*start) / length, parameters;
    return OrbitGuess{
        std::make_shared<ReturnEquations>(events.sequence(like), family, length, far / p.cycle()),
        z};
}

}  // namespace vines
