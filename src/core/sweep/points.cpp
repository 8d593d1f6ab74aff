// Independent points of a sweep, computed on all cores, several per core as a vectorised batch; and
// the parallel loop.
#include "core/sweep/point.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "core/motion/batch_run.hpp"
#include "core/sweep/parallel.hpp"

namespace vines {

void parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& task) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failure;
    std::mutex failing;
    const auto work = [&] {
        try {
            for (std::size_t i; (i = next++) < count;) task(i);
        } catch (...) {
            next = count;
            const std::lock_guard lock(failing);
            if (!failure) failure = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    const std::size_t wanted = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
    try {
        for (std::size_t t = 1; t < wanted; ++t) others.emplace_back(work);
        // no more threads available: continue with those already started
    } catch (const std::system_error&) {}
    work();
    for (std::thread& t : others) t.join();
    if (failure) std::rethrow_exception(failure);
}

namespace {

// Memory limits of the points that a thread runs as a batch: total cycles and total section points.
constexpr double most_cycles_together = 1e6;
constexpr std::size_t most_section_points_together = 100'000;

std::size_t most_together(const PointOptions& o) {
    const double by_cycles = most_cycles_together / std::max(1.0, o.cycles);
    const std::size_t by_section =
        o.section == SectionKind::none
            ? max_batch_runs
            : most_section_points_together / std::max<std::size_t>(o.section_points, 1);
    if (!best_batch_search()) return 1;
    const auto most = static_cast<std::size_t>(std::min<double>(by_cycles, max_batch_runs));
    return std::max<std::size_t>(std::min(most, by_section), 1);
}

PointOptions options_of(const PointSystem& system, PointOptions options) {
    options.max_impacts = system.max_impacts;
    options.known = system.known.get();
    return options;
}

/// Counts a completed run; throws Stopped if it was interrupted.
void count(const PointResult& result, RunControl& control) {
    if (result.outcome.reason == End::stopped || control.stop_or_yield()) throw Stopped();
    ++control.runs;
    control.impacts += static_cast<std::size_t>(result.impacts);
}

/// Divides the tasks that a thread takes into batches with the same flow.
class Batches {
public:
    using TakeTask = std::function<std::optional<PointTask>()>;

    explicit Batches(const TakeTask& take) : take_(take) {}

    /// Starts the next batch; false if there is none.
    bool begin() {
        if (!held_) held_ = take_();
        if (held_) flow_ = flow_of(*held_);
        return held_.has_value();
    }
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

/// Source of runs for one vector lane: one point after the other.
class PointSource : public RunSource {
public:
    PointSource(
        Batches& batches, const PointOptions& options, RunControl& control, ComputePermit& permit)
        : batches_(batches),
          options_(options),
          control_(control),
          permit_(permit) {}

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
        count(motions_.back().result, control_);
        if (motions_.size() < task_->starts.size()) return;
        task_->done(std::exchange(motions_, {}));
        task_.reset();
    }

    bool begin_motion() {
        if (!task_) task_ = batches_.next();
        if (!task_) return false;
        permit_.requeue();
        if (control_.stop_or_yield()) throw Stopped();
        run_.emplace(
            task_->system.parameters, task_->starts[motions_.size()].state,
            options_of(task_->system, options_), [this] { return control_.stop_or_yield(); });
        return true;
    }

    Batches& batches_;
    const PointOptions& options_;
    RunControl& control_;
    ComputePermit& permit_;
    std::optional<PointTask> task_;
    std::optional<PointRun> run_;
    std::vector<Motion> motions_;  // of the current task
};

}  // namespace

PointResult run_point(
    const PointSystem& system, const State& start, PointOptions options, RunControl& control) {
    const ComputePermit permit(control);
    if (control.stop_or_yield()) throw Stopped();
    PointResult result = measure(system.parameters, start, options_of(system, options), [&control] {
        return control.stop_or_yield();
    });
    count(result, control);
    return result;
}

void run_points(
    std::size_t count, int threads, const PointOptions& options, RunControl& control,
    const std::function<std::optional<PointTask>(std::size_t)>& task_at) {
    std::atomic<std::size_t> taken = 0;
    const Batches::TakeTask take = [&] {
        std::optional<PointTask> task;
        for (std::size_t i; (i = taken++) < count;) {
            if ((task = task_at(i))) break;
            if (control.stop_or_yield()) throw Stopped();
        }
        return task;
    };
    const std::size_t groups = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
    parallel(groups, threads, [&](std::size_t) {
        // Small enough that every thread gets some.
        const std::size_t lines = std::min(most_together(options), (count + groups - 1) / groups);
        ComputePermit permit(control);
        Batches batches(take);
        while (batches.begin()) {
            std::deque<PointSource> all;
            std::vector<RunSource*> sources;
            for (std::size_t k = 0; k < lines; ++k)
                sources.push_back(&all.emplace_back(batches, options, control, permit));
            simulate_batch(sources);
        }
    });
}

}  // namespace vines
