#include "core/sweep/points.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <utility>

#include "core/motion/in_lanes.hpp"
#include "core/motion/together.hpp"
#include "core/sweep/parallel.hpp"

namespace vines {

namespace {

// A thread's points hold no more together than one of so many cycles, or points of a section.
constexpr double most_cycles_together = 1e6;
constexpr std::size_t most_section_points_together = 100'000;

/// How many points a thread runs side by side.
std::size_t most_together(const PointOptions& o) {
    const double by_cycles = most_cycles_together / std::max(1.0, o.cycles);
    const std::size_t by_section =
        o.section == SectionKind::none
            ? most_lines
            : most_section_points_together / std::max<std::size_t>(o.section_points, 1);
    if (!best_search()) return 1;
    const auto most = static_cast<std::size_t>(std::min<double>(by_cycles, most_lines));
    return std::max<std::size_t>(std::min(most, by_section), 1);
}

PointOptions options_of(const PointSystem& system, PointOptions options) {
    options.max_impacts = system.max_impacts;
    return options;
}

/// A run has ended, and its result is worth something.
void count(const PointResult& result, Pace& pace) {
    if (result.outcome.reason == End::stopped || pace.stop_or_yield()) throw Stopped();
    ++pace.runs;
    pace.impacts += static_cast<std::size_t>(result.impacts);
}

/// The tasks that a thread takes, in batches of one flow.
class Batches {
public:
    using TakeTask = std::function<std::optional<PointTask>()>;

    explicit Batches(const TakeTask& take) : take_(take) {}

    /// Whether there is another one.
    bool begin() {
        if (!held_) held_ = take_();
        if (held_) flow_ = flow_of(*held_);
        return held_.has_value();
    }
    /// The next task of the one that has begun.
    std::optional<PointTask> next() {
        if (!held_) held_ = take_();
        if (!held_ || flow_of(*held_) != flow_) return std::nullopt;
        return std::exchange(held_, std::nullopt);
    }

private:
    static Flow::Coefficients flow_of(const PointTask& task) {
        return Flow::free_coefficients(task.system.parameters);
    }

    const TakeTask& take_;
    Flow::Coefficients flow_{};
    std::optional<PointTask> held_;
};

/// One point after the other, in a lane.
class PointLine : public RunLine {
public:
    PointLine(Batches& batches, const PointOptions& options, Pace& pace, Turn& turn)
        : batches_(batches),
          options_(options),
          pace_(pace),
          turn_(turn) {}

    std::optional<RunPlan> next(const std::optional<Outcome>& last) override {
        std::optional<RunPlan> plan;
        if (run_) plan = run_->next(last);
        while (!plan) {
            if (run_) end_motion();
            if (!begin_motion()) return std::nullopt;
            plan = run_->next(std::nullopt);
        }
        return plan;
    }

private:
    void end_motion() {
        const NamedStart& start = task_->starts[motions_.size()];
        motions_.push_back({start.name, start.state, run_->take()});
        run_.reset();
        count(motions_.back().result, pace_);
        if (motions_.size() < task_->starts.size()) return;
        task_->done(std::exchange(motions_, {}));
        task_.reset();
    }

    bool begin_motion() {
        if (!task_) task_ = batches_.next();
        if (!task_) return false;
        turn_.again();
        if (pace_.stop_or_yield()) throw Stopped();
        run_.emplace(
            task_->system.parameters, task_->starts[motions_.size()].state,
            options_of(task_->system, options_), [this] { return pace_.stop_or_yield(); });
        return true;
    }

    Batches& batches_;
    const PointOptions& options_;
    Pace& pace_;
    Turn& turn_;
    std::optional<PointTask> task_;
    std::optional<PointRun> run_;
    std::vector<Motion> motions_;  // of the task at hand
};

}  // namespace

PointResult run_point(
    const PointSystem& system, const State& start, PointOptions options, Pace& pace) {
    const Turn turn(pace);
    if (pace.stop_or_yield()) throw Stopped();
    PointResult result = measure(system.parameters, start, options_of(system, options), [&pace] {
        return pace.stop_or_yield();
    });
    count(result, pace);
    return result;
}

void run_points(
    std::size_t count, int threads, const PointOptions& options, Pace& pace,
    const std::function<std::optional<PointTask>(std::size_t)>& task_at) {
    std::atomic<std::size_t> taken = 0;
    const Batches::TakeTask take = [&] {
        std::optional<PointTask> task;
        for (std::size_t i; (i = taken++) < count;) {
            if ((task = task_at(i))) break;
            if (pace.stop_or_yield()) throw Stopped();
        }
        return task;
    };
    const std::size_t groups = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
    parallel(groups, threads, [&](std::size_t) {
        // So many that every thread has some.
        const std::size_t lines = std::min(most_together(options), (count + groups - 1) / groups);
        Turn turn(pace);
        Batches batches(take);
        while (batches.begin()) {
            std::deque<PointLine> all;
            std::vector<RunLine*> going;
            for (std::size_t k = 0; k < lines; ++k)
                going.push_back(&all.emplace_back(batches, options, pace, turn));
            simulate_together(going);
        }
    });
}

}  // namespace vines
