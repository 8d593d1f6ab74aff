#include "core/motion/simulate.hpp"

#include "core/motion/run.hpp"

namespace vines {

State Stretch::at(double s) const {
    const Oscillation o = flow.after(start, s);
    if (stuck_side != 0) return {o.x_dot, o.x, o.x_dot, o.x + (y - start.x)};
    return {o.x_dot, o.x, y_dot, y + y_dot * s};
}

Outcome simulate(
    const Parameters& parameters, const State& start, const Limits& limits,
    std::span<Observer* const> observers) {
    return Run(parameters, start, limits, observers).to_its_end();
}

Outcome simulate(const RunPlan& plan) {
    return simulate(plan.parameters, plan.start, plan.limits, plan.observers);
}

}  // namespace vines
