#include "core/motion/together.hpp"

#include <doctest/doctest.h>

#include <deque>

#include "../support.hpp"
#include "core/motion/in_lanes.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// All that a run tells, to the last bit.
struct Told : Observer {
    void on_stretch(const Stretch& s) override {
        add(
            {s.tau, s.duration, s.start.x, s.start.x_dot, s.start.sin_theta, s.start.cos_theta, s.y,
             s.y_dot, 1.0 * s.stuck_side});
        const Transfer t = s.transfer ? *s.transfer : s.flow.transfer(s.duration);
        add({t.a11, t.a12, t.a21, t.a22});
    }
    void on_impact(const Impact& i) override {
        add(
            {i.tau, 1.0 * i.side, i.x, i.x_dot_before, i.y_dot_before, i.relative_speed_before,
             i.sin_theta, i.cos_theta});
    }
    void on_touch(double tau, int side) override { add({tau, 1.0 * side}); }
    void on_stick(const StickStart& s) override { add({s.tau, 1.0 * s.side, 1.0 * s.impacts}); }
    void on_release(double tau) override { add({tau}); }
    void add(std::initializer_list<double> numbers) {
        all.insert(all.end(), numbers.begin(), numbers.end());
    }

    std::vector<double> all;
};

struct Followed {
    std::vector<double> told;
    Outcome outcome;
};

bool same(const Followed& a, const Followed& b) {
    const State &s = a.outcome.state, &t = b.outcome.state;
    return a.told == b.told && a.outcome.reason == b.outcome.reason &&
           a.outcome.tau == b.outcome.tau && a.outcome.impacts == b.outcome.impacts && s.x == t.x &&
           s.x_dot == t.x_dot && s.y == t.y && s.y_dot == t.y_dot;
}

const Limits limits{.tau_end = 120, .max_impacts = 500};

std::vector<Followed> alone(const std::vector<System>& systems) {
    std::vector<Followed> all;
    for (const System& system : systems) {
        Told told;
        Observer* const observers[] = {&told};
        const Outcome outcome = simulate(system.parameters, system.start, limits, observers);
        all.push_back({std::move(told.all), outcome});
    }
    return all;
}

/// Each line follows every so manieth system.
class Every : public RunLine {
public:
    Every(
        const std::vector<System>& systems, std::size_t first, std::size_t step,
        std::vector<Followed>& found)
        : systems_(systems),
          step_(step),
          next_(first),
          found_(found) {}
    std::optional<RunPlan> next(const std::optional<Outcome>& last) override {
        if (last) found_[next_ - step_] = {std::move(told_.all), *last};
        told_ = {};
        if (next_ >= systems_.size()) return std::nullopt;
        const System& system = systems_[next_];
        next_ += step_;
        return RunPlan{system.parameters, system.start, limits, {&told_}};
    }

private:
    const std::vector<System>& systems_;
    const std::size_t step_;
    std::size_t next_;
    std::vector<Followed>& found_;
    Told told_;
};

std::vector<Followed> together(
    const std::vector<System>& systems, std::size_t lines, FlightSearch search) {
    std::vector<Followed> found(systems.size());
    std::deque<Every> all;
    std::vector<RunLine*> pointers;
    for (std::size_t k = 0; k < lines; ++k)
        pointers.push_back(&all.emplace_back(systems, k, lines, found));
    simulate_together(pointers, search);
    return found;
}

std::vector<System> sweep_of_b() {
    std::vector<System> systems;
    for (double b = 0.001; b < 0.05; b += 0.001) {
        const Parameters p = table1(b, Damping::closed_form);
        systems.push_back({p, default_state(p)});
    }
    return systems;
}

/// Of each random flow so many systems, that fly together.
std::vector<System> random_systems() {
    std::mt19937_64 engine(11);
    std::vector<System> systems;
    for (int i = 0; i < 60; ++i) {
        System system = random_system(engine);
        for (double share = 1; share > 0.2; share *= 0.8) {
            systems.push_back(system);
            systems.back().parameters.b *= share;
            systems.back().start.y = systems.back().start.x - systems.back().parameters.b * share;
        }
    }
    return systems;
}

}  // namespace

TEST_CASE("a run is the same to the last bit alone and beside others, by every instruction set") {
    for (const auto& systems : {sweep_of_b(), random_systems()}) {
        const std::vector<Followed> expected = alone(systems);
        for (const NamedSearch& by : flight_searches())
            for (const std::size_t lines : {8u, 3u, 1u}) {
                INFO(by.name, ", lines: ", lines);
                const std::vector<Followed> found = together(systems, lines, by.search);
                std::size_t equal = 0;
                for (std::size_t i = 0; i < found.size(); ++i) equal += same(found[i], expected[i]);
                CHECK(equal == systems.size());
            }
    }
}
