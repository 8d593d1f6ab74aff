#include "core/motion/together.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <deque>
#include <optional>

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

void put(FlightLanes& flights, int lane, const FlowTables& tables, const Run& run) {
    const FlightStart f = run.flight();
    flights.tables[lane] = &tables;
    flights.x[lane] = f.lo.x;
    flights.x_dot[lane] = f.lo.x_dot;
    flights.sin_theta[lane] = f.lo.sin_theta;
    flights.cos_theta[lane] = f.lo.cos_theta;
    flights.y[lane] = f.y;
    flights.y_dot[lane] = f.y_dot;
    flights.side[lane] = f.side;
    flights.relative_speed[lane] = f.relative_speed;
    flights.b[lane] = run.b();
    flights.limit[lane] = run.flight_limit();
}

Contact contact_of(const FlightLanes& f, int lane) {
    return {
        f.s[lane],
        static_cast<int>(f.wall[lane]),
        {f.contact_x[lane], f.contact_x_dot[lane], f.contact_sin[lane], f.contact_cos[lane]},
        f.contact_speed[lane]};
}

/// A vector's lanes are all in use: what is left over flies as the first one does.
void fill(FlightLanes& flights) {
    for (int lane = flights.count; lane < FlightLanes::lanes; ++lane) {
        flights.tables[lane] = flights.tables[0];
        for (auto* column :
             {&flights.x, &flights.x_dot, &flights.sin_theta, &flights.cos_theta, &flights.y,
              &flights.y_dot, &flights.side, &flights.relative_speed, &flights.b, &flights.limit})
            (*column)[lane] = (*column)[0];
    }
}

/// A flight of every run.
void fly(std::span<Lane*> lanes, FlightSearch search) {
    FlightLanes flights;
    std::array<Lane*, FlightLanes::lanes> in_lane;
    for (Lane* lane : lanes) {
        if (!search || !is_plain(lane->run().flight())) {
            lane->run().fly();
            continue;
        }
        put(flights, flights.count, lane->tables(), lane->run());
        in_lane[flights.count++] = lane;
    }
    if (flights.count == 0) return;
    fill(flights);
    search(flights);
    for (int i = 0; i < flights.count; ++i) {
        Run& run = in_lane[i]->run();
        if (flights.found[i] == FlightLanes::open) run.fly();
        else if (flights.found[i] == FlightLanes::none) run.fly_to(std::nullopt);
        else run.fly_to(contact_of(flights, i));
    }
}

/// The widest, but none where that is two lanes wide: a flight alone is as fast.
FlightSearch best_search() {
    static const FlightSearch search = [] {
        const auto searches = flight_searches();
        return searches.size() > 1 ? searches.back().search : nullptr;
    }();
    return search;
}

}  // namespace

std::vector<NamedSearch> flight_searches() {
    std::vector<NamedSearch> searches = {baseline_search()};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) searches.push_back(avx2_search());
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        searches.push_back(avx512_search());
#endif
    return searches;
}

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
