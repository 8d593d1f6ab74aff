#include "core/motion/together.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <deque>
#include <optional>

#include "core/motion/in_lanes.hpp"
#include "core/motion/run.hpp"

namespace vines {

namespace {

/// A line and its run at hand.
class Lane {
public:
    explicit Lane(RunLine& line) : line_(line) { begin({}); }

    bool has_ended() const { return !run_; }
    Run& run() { return *run_; }
    const FlowTables& tables() const { return tables_; }
    /// Goes to the first run that is not over.
    void settle() {
        while (run_ && run_->is_over()) begin(run_->outcome());
    }

private:
    void begin(const std::optional<Outcome>& last) {
        run_.reset();
        plan_ = line_.next(last);
        if (!plan_) return;
        run_.emplace(plan_->parameters, plan_->start, plan_->limits, plan_->observers);
        tables_ = run_->flow().tables();
    }

    RunLine& line_;
    std::optional<RunPlan> plan_;
    std::optional<Run> run_;
    FlowTables tables_{};
};

/// A flight of every run: those of the first one's flow together, the others alone.
void fly(std::span<Lane*> lanes, FlightSearch by) {
    FlightLanes flights;
    std::array<Lane*, FlightLanes::lanes> in_lane;
    const Flow& flow = lanes[0]->run().flow();
    for (Lane* lane : lanes) {
        Run& run = lane->run();
        const FlightStart flight = run.flight();
        if (lanes.size() == 1 || !by || &run.flow() != &flow || !is_plain(flight)) {
            run.fly();
            continue;
        }
        in_lane[flights.count] = lane;
        put(flights, flight, run.b(), run.flight_limit());
        flights.transfers |= run.is_observed();
    }
    if (flights.count == 0) return;
    flights.tables = &in_lane[0]->tables();
    search(flights, by);
    for (int i = 0; i < flights.count; ++i) {
        Run& run = in_lane[i]->run();
        if (flights.found[i] == FlightLanes::open) run.fly();
        else if (flights.found[i] == FlightLanes::none) run.fly_to(std::nullopt, nullptr);
        else {
            const Transfer over = transfer_of(flights, i);
            run.fly_to(contact_of(flights, i), flights.transfers ? &over : nullptr);
        }
    }
}

}  // namespace

void simulate_together(std::span<RunLine* const> lines) { simulate_together(lines, best_search()); }

void simulate_together(std::span<RunLine* const> lines, FlightSearch search) {
    assert(lines.size() <= static_cast<std::size_t>(most_lines));
    std::deque<Lane> lanes;
    for (RunLine* line : lines) lanes.emplace_back(*line);
    std::vector<Lane*> going;
    for (Lane& lane : lanes) going.push_back(&lane);
    const auto settled = [&] {
        for (Lane* lane : going) lane->settle();
        std::erase_if(going, [](const Lane* lane) { return lane->has_ended(); });
        return !going.empty();
    };
    while (settled()) fly(going, search);
}

}  // namespace vines
