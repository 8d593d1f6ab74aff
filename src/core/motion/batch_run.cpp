// Each slot holds one source and its current run. The loop of simulate_batch() alternates two steps
// until every source is exhausted: replace the runs that are over by the next ones of their
// sources, and advance every run by one free flight (fly_all).
//
// Flights of runs that share the Flow object of the first active run, and with a simple start, are
// searched for their contacts as one batch; the kernel reports a contact, none before the limit, or
// undecided. Undecided and all other flights use the scalar search, run by run. The kernels use the
// operations of the scalar search in the same order, so the results do not depend on the grouping.
#include "core/motion/batch_run.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <deque>
#include <optional>

#include "core/motion/run.hpp"

namespace vines {

std::vector<NamedBatchSearch> batch_searches() {
    std::vector<NamedBatchSearch> searches = {baseline_search()};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) searches.push_back(avx2_search());
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        searches.push_back(avx512_search());
#endif
    return searches;
}

BatchSearch best_batch_search() {
    static const BatchSearch best = [] {
        const auto searches = batch_searches();
        // The baseline batch alone is no faster than the scalar search.
        return searches.size() > 1 ? searches.back().search : nullptr;
    }();
    return best;
}

void append(FlightBatch& flights, const FlightStart& f, double b, double limit) {
    const int i = flights.count++;
    flights.x[i] = f.lo.x;
    flights.x_dot[i] = f.lo.x_dot;
    flights.sin_theta[i] = f.lo.sin_theta;
    flights.cos_theta[i] = f.lo.cos_theta;
    flights.y[i] = f.y;
    flights.y_dot[i] = f.y_dot;
    flights.side[i] = f.side;
    flights.relative_speed[i] = f.relative_speed;
    flights.b[i] = b;
    flights.limit[i] = limit;
}

void search(FlightBatch& flights, BatchSearch kernel) {
    // Unused lanes repeat a valid flight, so that the kernel needs no mask.
    for (int i = flights.count; i < FlightBatch::capacity; ++i) {
        for (auto* column :
             {&flights.x, &flights.x_dot, &flights.sin_theta, &flights.cos_theta, &flights.y,
              &flights.y_dot, &flights.side, &flights.relative_speed, &flights.b, &flights.limit})
            (*column)[i] = (*column)[0];
    }
    kernel(flights);
}

Contact contact_of(const FlightBatch& f, int i) {
    return {
        f.s[i],
        static_cast<int>(f.wall[i]),
        {f.contact_x[i], f.contact_x_dot[i], f.contact_sin[i], f.contact_cos[i]},
        f.contact_speed[i]};
}

Transfer transfer_of(const FlightBatch& f, int i) {
    return {f.a11[i], f.a12[i], f.a21[i], f.a22[i]};
}

namespace {

/// A source of runs and its current run.
class Slot {
public:
    explicit Slot(RunSource& source) : source_(source) { begin({}); }

    bool has_ended() const { return !run_; }
    Run& run() { return *run_; }
    const FlowTables& tables() const { return tables_; }
    /// Replaces finished runs until one is unfinished or the source is exhausted.
    void advance_to_unfinished() {
        while (run_ && run_->is_over()) begin(run_->outcome());
    }

private:
    void begin(const std::optional<Outcome>& last) {
        run_.reset();
        plan_ = source_.next(last);
        if (!plan_) return;
        run_.emplace(plan_->parameters, plan_->start, plan_->limits, plan_->observers);
        tables_ = run_->flow().tables();
    }

    RunSource& source_;
    std::optional<RunPlan> plan_;
    std::optional<Run> run_;
    FlowTables tables_{};
};

/// Advances every run by one flight. Flights with the first run's Flow object and a simple start
/// are searched as one batch; the others are advanced separately, as are all if there is only one
/// slot or no kernel.
void fly_all(std::span<Slot*> slots, BatchSearch kernel) {
    FlightBatch flights;
    std::array<Slot*, FlightBatch::capacity> slot_of;
    const Flow& flow = slots[0]->run().flow();
    for (Slot* slot : slots) {
        Run& run = slot->run();
        const FlightStart flight = run.flight();
        if (slots.size() == 1 || !kernel || &run.flow() != &flow || !has_simple_start(flight)) {
            run.fly();
            continue;
        }
        slot_of[flights.count] = slot;  // append() increments the count
        append(flights, flight, run.b(), run.flight_limit());
        // Transfer matrices are computed for all lanes if one run needs them.
        flights.transfers |= run.is_observed();
    }
    if (flights.count == 0) return;
    flights.tables = &slot_of[0]->tables();
    search(flights, kernel);
    for (int i = 0; i < flights.count; ++i) {
        Run& run = slot_of[i]->run();
        if (flights.result[i] == FlightBatch::undecided) run.fly();
        else if (flights.result[i] == FlightBatch::none) run.fly_to(std::nullopt, nullptr);
        else {
            const Transfer over = transfer_of(flights, i);
            run.fly_to(contact_of(flights, i), flights.transfers ? &over : nullptr);
        }
    }
}

}  // namespace

void simulate_batch(std::span<RunSource* const> sources) {
    simulate_batch(sources, best_batch_search());
}

void simulate_batch(std::span<RunSource* const> sources, BatchSearch kernel) {
    assert(sources.size() <= static_cast<std::size_t>(max_batch_runs));
    std::deque<Slot> slots;
    for (RunSource* source : sources) slots.emplace_back(*source);
    std::vector<Slot*> active;
    for (Slot& slot : slots) active.push_back(&slot);
    const auto prepare_next_round = [&] {
        for (Slot* slot : active) slot->advance_to_unfinished();
        std::erase_if(active, [](const Slot* slot) { return slot->has_ended(); });
        return !active.empty();
    };
    while (prepare_next_round()) fly_all(active, kernel);
}

}  // namespace vines
