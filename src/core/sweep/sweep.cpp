// Independent points are computed coarse to fine, on all cores. Points that depend on a neighbour
// are computed in rows, as many rows at a time as there are threads: first all motions whose starts
// need no neighbour; then, with the default set of starts, a pass up and a pass down each row,
// which continue from each point's worst motion, or, with `carry`, one pass in its direction.
#include "core/sweep/sweep.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

namespace vines {

namespace {

/// A second start is tried at about this many points of a sweep with a single start.
constexpr std::size_t second_starts = 16;

/// Positions per axis of the coarsest grid, or up to twice as many: enough to recognise a picture.
constexpr std::size_t coarsest = 8;

std::size_t level_on_axis(std::size_t at, std::size_t steps) {
    const auto levels =
        static_cast<std::size_t>(std::bit_width(std::max(steps / coarsest, 1UL)) - 1);
    const auto halvings = static_cast<std::size_t>(std::countr_zero(at));
    return levels - std::min(levels, halvings);
}

/// Points along the inner axis, and the requested lines among them.
struct Row {
    Place place;
    std::vector<std::size_t> wanted;
    std::vector<SweepPoint> points;
};

struct Sweep {
    const SweepPlan& plan;
    const int threads;
    RunControl& control;
    SweepSink& sink;
    std::atomic<std::size_t> tried = 0, elsewhere = 0;

    void run() {
        if (plan.by_rows()) return run_rows();
        const std::vector<std::size_t> lines = plan.in_order ? plan.lines : coarse_to_fine();
        parallel(lines.size(), threads, &control, [&](std::size_t i) { run_single(lines[i]); });
    }

    /// Requested lines, ordered so that the whole picture appears early. Points with the same flow
    /// share its tables: if each step of the first axis has another flow, lines run along the other
    /// axes.
    std::vector<std::size_t> coarse_to_fine() const {
        const bool across = first_axis_changes_flow();
        std::vector<std::array<std::size_t, 3>> keys;
        keys.reserve(plan.lines.size());
        for (const std::size_t line : plan.lines) {
            const Place place = plan.grid.place_of(line);
            keys.push_back({plan.grid.level(place), across ? place.at[0] : 0, line});
        }
        std::ranges::sort(keys);
        std::vector<std::size_t> lines;
        lines.reserve(keys.size());
        for (const auto& key : keys) lines.push_back(key[2]);
        return lines;
    }

    bool first_axis_changes_flow() const {
        if (plan.grid.steps.empty() || plan.grid.steps[0] < 2) return false;
        Place place = plan.grid.place_of(0);
        const auto one = plan.system_at(place);
        place.at[0] = 1;
        const auto next = plan.system_at(place);
        return one && next &&
               Flow::free_coefficients(one->parameters) !=
                   Flow::free_coefficients(next->parameters);
    }

    void run_single(std::size_t line) {
        SweepPoint point{plan.system_at(plan.grid.place_of(line))};
        if (point.system) run_own_starts(point, line);
        hand_out(line, point);
        if (!point.system) poll(control);
    }

    /// Runs the point's own start and, at regular intervals, a second one: the middle, or the wall.
    void run_own_starts(SweepPoint& point, std::size_t number) const {
        const auto& [p, first, max_impacts, known, units] = *point.system;
        point.motions.push_back(run_from(*point.system, "", first));
        if (p.load || !plan.tries_second_start(number)) return;
        const bool from_middle =
            first.x == 0 && first.x_dot == 0 && first.y == 0 && first.y_dot == 0;
        const NamedStart second = default_starts(p)[from_middle ? 1 : 0];
        point.second = run_from(*point.system, second.name, second.state);
    }

    Motion run_from(const PointSystem& system, const char* name, const State& start) const {
        return {name, start, run_point(system, start, plan.options, control)};
    }

    void run_rows() {
        std::vector<Row> rows = wanted_rows();
        // Rows stay in memory while they are computed: only enough to keep the threads busy.
        const std::size_t at_once = static_cast<std::size_t>(std::max(threads, 1));
        for (std::size_t from = 0; from < rows.size(); from += at_once) {
            const std::span<Row> block =
                std::span(rows).subspan(from, std::min(at_once, rows.size() - from));
            run_fresh(block);
            if (plan.default_set) follow_neighbours(block);
            else if (plan.carry != Carry::none)
                parallel(
                    block.size(), threads, &control, [&](std::size_t i) { carry_along(block[i]); });
            for (Row& row : block) {
                if (plan.grid.reduced) hand_out(row);
                row = {};
            }
        }
    }

    std::vector<Row> wanted_rows() const {
        std::vector<Row> rows;
        const std::size_t chain = plan.chain();
        for (std::size_t i = 0; i < plan.lines.size(); ++i) {
            const std::size_t line = plan.lines[i];
            if (i == 0 || line / chain != plan.lines[i - 1] / chain) {
                rows.push_back({plan.grid.place_of(line), {}, {}});
                rows.back().place.at[plan.grid.inner()] = 0;
            }
            rows.back().wanted.push_back(line);
        }
        if (plan.in_order) return rows;
        std::ranges::stable_sort(rows, [this](const Row& one, const Row& other) {
            return plan.grid.level(one.place) < plan.grid.level(other.place);
        });
        return rows;
    }

    /// Sets up the points' systems and runs the starts that do not depend on a neighbour.
    void run_fresh(std::span<Row> rows) {
        const std::size_t n = plan.grid.row();
        for (Row& row : rows) row.points.resize(n);
        parallel(rows.size() * n, threads, &control, [&](std::size_t task) {
            Row& row = rows[task / n];
            const std::size_t k = task % n;
            Place place = row.place;
            place.at[plan.grid.inner()] = k;
            SweepPoint& point = row.points[k] = {plan.system_at(place)};
            if (!point.system || plan.carry != Carry::none) return poll(control);
            if (plan.default_set)
                for (const auto& [name, start] : default_starts(point.system->parameters))
                    point.motions.push_back(run_from(*point.system, name, start));
            else run_own_starts(point, row.wanted[0] * n + k);
        });
    }

    /// Passes up and down are independent of each other and run at the same time.
    void follow_neighbours(std::span<Row> rows) {
        std::vector<std::vector<std::optional<Motion>>> found(2 * rows.size());
        parallel(found.size(), threads, &control, [&](std::size_t task) {
            found[task] = follow(rows[task / 2].points, task % 2 == 0);
        });
        for (std::size_t i = 0; i < rows.size(); ++i) {
            Row& row = rows[i];
            for (std::size_t k = 0; k < row.points.size(); ++k)
                for (auto* pass : {&found[2 * i], &found[2 * i + 1]})
                    if ((*pass)[k]) row.points[k].motions.push_back(std::move(*(*pass)[k]));
            if (plan.grid.reduced) continue;
            for (const std::size_t line : row.wanted)
                hand_out(line, row.points[line % row.points.size()]);
        }
    }

    /// The last state of a point.
    struct Carried {
        Parameters parameters;
        double omega0;
        State state;

        State to(const PointSystem& next) const {
            return carried(state, parameters, next.parameters, next.units.omega0 / omega0);
        }
    };

    /// One motion per point, continued from its neighbour's last state. Each line is handed out at
    /// once, up to the last requested one.
    void carry_along(Row& row) {
        const std::size_t n = row.points.size();
        std::optional<Carried> before;
        std::size_t left = row.wanted.size();
        for (std::size_t step = 0; step < n && left > 0; ++step) {
            const std::size_t k = plan.carry == Carry::up ? step : n - 1 - step;
            SweepPoint& point = row.points[k];
            if (point.system) {
                const PointSystem& s = *point.system;
                point.afresh = step > 0 && !before;
                point.motions.push_back(run_from(s, "", before ? before->to(s) : s.start));
                const auto& end = point.motions[0].result.at_end;
                before =
                    end ? std::optional(Carried{s.parameters, s.units.omega0, *end}) : std::nullopt;
            }
            if (plan.grid.reduced) continue;
            const std::size_t line = row.wanted[0] / n * n + k;
            if (!std::ranges::binary_search(row.wanted, line)) continue;
            hand_out(line, point);
            point = {};
            --left;
        }
    }

    /// Continues from each point's worst motion, including those found here, to the next point.
    std::vector<std::optional<Motion>> follow(const std::vector<SweepPoint>& points, bool up) {
        const std::size_t n = points.size();
        std::vector<std::optional<Motion>> found(n);
        std::optional<Carried> before;
        for (std::size_t step = 0; step < n; ++step) {
            const std::size_t k = up ? step : n - 1 - step;
            if (!points[k].system) continue;
            const PointSystem& s = *points[k].system;
            if (before) found[k] = run_from(s, up ? "previous" : "next", before->to(s));
            const Motion* worst = found[k] && found[k]->result.at_end ? &*found[k] : nullptr;
            for (const Motion& m : points[k].motions)
                if (m.result.at_end && (!worst || m.result.objective > worst->result.objective))
                    worst = &m;
            before =
                worst ? std::optional(Carried{s.parameters, s.units.omega0, *worst->result.at_end})
                      : std::nullopt;
        }
        return found;
    }

    void hand_out(std::size_t line, const SweepPoint& point) {
        if (point.system && !plan.default_set) count(depends_on_start(point, false));
        sink.point(line, point);
    }

    void hand_out(const Row& row) {
        const RowSummary summary = summary_of(row.points, plan.largest, plan.default_set);
        if (!plan.default_set) count(summary.depends_on_start);
        sink.row(row.wanted[0], summary);
    }

    void count(std::optional<bool> depends) {
        tried += depends.has_value();
        elsewhere += depends == true;
    }
};

}  // namespace

std::size_t Grid::points() const {
    std::size_t product = starts;
    for (const std::size_t n : steps) product *= n;
    return product;
}

Place Grid::place_of(std::size_t line) const {
    assert(line < lines());
    Place place{0, std::vector<std::size_t>(steps.size(), 0)};
    auto take = [&line](std::size_t n) {
        const std::size_t at = line % n;
        line /= n;
        return at;
    };
    const std::size_t first = reduced == 0 ? 1 : 0;
    if (first < steps.size()) place.at[first] = take(steps[first]);
    place.start = take(starts);
    for (std::size_t a = first + 1; a < steps.size(); ++a)
        if (a != reduced) place.at[a] = take(steps[a]);
    return place;
}

std::size_t Grid::level(const Place& place) const {
    std::size_t finest = 0;
    for (std::size_t a = 0; a < steps.size(); ++a)
        finest = std::max(finest, level_on_axis(place.at[a], steps[a]));
    return finest;
}

std::size_t SweepPlan::runs() const {
    if (!by_rows()) return lines.size();
    const std::size_t of_chain = chain();
    std::size_t rows = 0;
    for (std::size_t i = 0; i < lines.size(); ++i)
        rows += i == 0 || lines[i] / of_chain != lines[i - 1] / of_chain;
    return rows * grid.row() * runs_per_point();
}

bool SweepPlan::tries_second_start(std::size_t point) const {
    const std::size_t every = (grid.points() + second_starts - 1) / second_starts;
    return !default_set && carry == Carry::none && grid.starts == 1 && point % every == 0;
}

std::vector<double> spaced(double from, double to, std::size_t count, bool geometric) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        const double share =
            count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
        values.push_back(
            geometric ? from * elementary::pow(to / from, share) : from + share * (to - from));
    }
    if (count > 1) values.back() = to;
    return values;
}

StartTrial run_sweep(const SweepPlan& plan, int threads, RunControl& control, SweepSink& sink) {
    Sweep sweep{plan, threads, control, sink};
    try {
        sweep.run();
    } catch (const Stopped&) {}
    return {sweep.tried, sweep.elsewhere};
}

}  // namespace vines
