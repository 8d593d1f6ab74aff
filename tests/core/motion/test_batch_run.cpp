#include "core/motion/batch_run.hpp"

#include <doctest/doctest.h>

#include <deque>

#include "../support.hpp"
#include "core/motion/batch_run.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// All events of a run, to the last bit.
struct EventLog : Observer {
    void on_stretch(const Stretch& s) override {
        add(
            {s.tau, s.duration, s.start.x, s.start.x_dot, s.start.sin_theta, s.start.cos_theta, s.y,
             s.y_dot, 1.0 * s.sticking_side});
        const Transfer t = s.transfer ? *s.transfer : s.flow.transfer(s.duration);
        add({t.a11, t.a12, t.a21, t.a22});
    }
    void on_impact(const Impact& i) override {
        add(
            {i.tau, 1.0 * i.side, i.x, i.x_dot_before, i.y_dot_before, i.relative_speed_before,
             i.sin_theta, i.cos_theta});
    }
    void on_grazing_contact(double tau, int side) override { add({tau, 1.0 * side}); }
    void on_stick(const StickStart& s) override { add({s.tau, 1.0 * s.side, 1.0 * s.impacts}); }
    void on_release(double tau) override { add({tau}); }
    void add(std::initializer_list<double> numbers) {
        all.insert(all.end(), numbers.begin(), numbers.end());
    }

    std::vector<double> all;
};

struct LoggedRun {
    std::vector<double> log;
    Outcome outcome;
};

bool same(const LoggedRun& a, const LoggedRun& b) {
    const State &s = a.outcome.state, &t = b.outcome.state;
    return a.log == b.log && a.outcome.reason == b.outcome.reason &&
           a.outcome.tau == b.outcome.tau && a.outcome.impacts == b.outcome.impacts && s.x == t.x &&
           s.x_dot == t.x_dot && s.y == t.y && s.y_dot == t.y_dot;
}

const Limits limits{.tau_end = 120, .max_impacts = 500};

std::vector<LoggedRun> alone(const std::vector<System>& systems) {
    std::vector<LoggedRun> all;
    for (const System& system : systems) {
        EventLog log;
        Observer* const observers[] = {&log};
        const Outcome outcome = simulate(system.parameters, system.start, limits, observers);
        all.push_back({std::move(log.all), outcome});
    }
    return all;
}

/// Source of every step-th system.
class SystemSource : public RunSource {
public:
    SystemSource(
        const std::vector<System>& systems, std::size_t first, std::size_t step,
        std::vector<LoggedRun>& found)
        : systems_(systems),
          step_(step),
          next_(first),
          found_(found) {}
    std::optional<RunPlan> next(const std::optional<Outcome>& last) override {
        if (last) found_[next_ - step_] = {std::move(log_.all), *last};
        log_ = {};
        if (next_ >= systems_.size()) return std::nullopt;
        const System& system = systems_[next_];
        next_ += step_;
        return RunPlan{system.parameters, system.start, limits, {&log_}};
    }

private:
    const std::vector<System>& systems_;
    const std::size_t step_;
    std::size_t next_;
    std::vector<LoggedRun>& found_;
    EventLog log_;
};

std::vector<LoggedRun> in_batch(
    const std::vector<System>& systems, std::size_t sources, BatchSearch search) {
    std::vector<LoggedRun> found(systems.size());
    std::deque<SystemSource> all;
    std::vector<RunSource*> pointers;
    for (std::size_t k = 0; k < sources; ++k)
        pointers.push_back(&all.emplace_back(systems, k, sources, found));
    simulate_batch(pointers, search);
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

/// Several systems for each random flow, so that they form batches.
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

TEST_CASE("a run has the same bits alone and in a batch, with every instruction set") {
    for (const auto& systems : {sweep_of_b(), random_systems()}) {
        const std::vector<LoggedRun> expected = alone(systems);
        for (const NamedBatchSearch& search : batch_searches())
            for (const std::size_t sources : {8u, 3u, 1u}) {
                INFO(search.name, ", sources: ", sources);
                const std::vector<LoggedRun> found = in_batch(systems, sources, search.search);
                std::size_t equal = 0;
                for (std::size_t i = 0; i < found.size(); ++i) equal += same(found[i], expected[i]);
                CHECK(equal == systems.size());
            }
    }
}
