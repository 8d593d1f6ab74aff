#include "api/sweep.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <span>

namespace vines::api {

namespace {

struct Stopped {};

/// A second start is tried at about so many points of a sweep with a single one.
constexpr std::size_t second_starts = 16;

/// Points that follow each other along the inner axis, and the lines that are wanted of them.
struct Row {
    Place place;
    std::vector<std::size_t> wanted;
    std::vector<SweepPoint> points;
};

class Sweep {
public:
    Sweep(
        const SweepRequest& r, int threads, Pace& pace,
        const std::function<void(std::size_t, const Json&)>& point)
        : r_(r),
          threads_(threads),
          pace_(pace),
          point_(point),
          every_((r.points * (r.reduce ? inner_size() : 1) + second_starts - 1) / second_starts) {}

    void run() {
        if (r_.by_rows()) return run_rows();
        parallel(r_.indices.size(), threads_, [&](std::size_t i) {
            const std::size_t index = r_.indices[i];
            SweepPoint point = begun(place_of(r_, index));
            if (point.system) {
                point.motions.push_back(
                    {"", point.system->start, run_from(*point.system, point.system->start)});
                if (r_.starts.size() == 1 && index % every_ == 0) try_second(point);
            }
            emit(index, describe_point(r_, index, point));
        });
    }

    std::size_t tried = 0, elsewhere = 0;

private:
    std::size_t inner_size() const { return r_.axes[r_.inner()].values.size(); }

    /// The point's system, or why there is none.
    SweepPoint begun(const Place& place) const {
        SweepPoint point;
        try {
            point.system = read_started_system(fields_of(r_, place));
            point.system->system.origin.clear();  // sweep_start() has told it
            point.system->system.notes.clear();
        } catch (const Problem& problem) {
            point.error = problem.what();
        }
        return point;
    }

    PointResult run_from(const StartedSystem& s, const State& start) {
        struct Turn {
            Pace& pace;
            explicit Turn(Pace& p) : pace(p) { pace.begin(); }
            ~Turn() { pace.end(); }
        } const turn(pace_);
        if (pace_.stop_or_yield()) throw Stopped();
        PointOptions options = r_.options;
        options.max_impacts = s.max_impacts;
        PointResult result =
            measure(s.system.parameters, start, options, [this] { return pace_.stop_or_yield(); });
        if (result.outcome.reason == End::stopped || pace_.stop_or_yield()) throw Stopped();
        ++pace_.runs;
        return result;
    }

    /// From the middle, or where that was the start, from the wall.
    void try_second(SweepPoint& point) {
        const auto starts = default_starts(point.system->system.parameters);
        const State& first = point.system->start;
        const bool from_middle =
            first.x == 0 && first.x_dot == 0 && first.y == 0 && first.y_dot == 0;
        const NamedStart& other = starts[from_middle ? 1 : 0];
        point.second = Motion{other.name, other.state, run_from(*point.system, other.state)};
    }

    void run_rows() {
        std::vector<Row> rows = wanted_rows();
        // Rows are kept while they are computed: only so many as keep the threads busy.
        const std::size_t at_once = static_cast<std::size_t>(std::max(threads_, 1));
        for (std::size_t from = 0; from < rows.size(); from += at_once) {
            const std::span<Row> block =
                std::span(rows).subspan(from, std::min(at_once, rows.size() - from));
            run_fresh(block);
            if (r_.options.carry) run_passes(block);
            for (Row& row : block) {
                if (r_.reduce) emit(row.wanted[0], describe_row(r_, row.wanted[0], row.points));
                row = {};
            }
        }
    }

    std::vector<Row> wanted_rows() const {
        std::vector<Row> rows;
        const std::size_t chain = chain_length(r_);
        for (std::size_t i = 0; i < r_.indices.size(); ++i) {
            const std::size_t index = r_.indices[i];
            if (i == 0 || index / chain != r_.indices[i - 1] / chain)
                rows.push_back({place_of(r_, index), {}, {}});
            rows.back().wanted.push_back(index);
        }
        return rows;
    }

    /// The points' systems, and their motions from the starts that do not wait for a neighbour.
    void run_fresh(std::span<Row> rows) {
        const std::size_t n = inner_size();
        for (Row& row : rows) row.points.resize(n);
        parallel(rows.size() * n, threads_, [&](std::size_t task) {
            Row& row = rows[task / n];
            const std::size_t k = task % n;
            Place place = row.place;
            place.at[r_.inner()] = k;
            SweepPoint& point = row.points[k] = begun(place);
            if (!point.system || r_.carry != SweepRequest::Carry::none) return;
            if (!r_.default_set) {
                point.motions.push_back(
                    {"", point.system->start, run_from(*point.system, point.system->start)});
                if (r_.starts.size() == 1 && (row.wanted[0] * n + k) % every_ == 0)
                    try_second(point);
                return;
            }
            for (const NamedStart& start : default_starts(point.system->system.parameters))
                point.motions.push_back(
                    {start.name, start.state, run_from(*point.system, start.state)});
        });
    }

    /// The motions that go on from a neighbour. Up and down are independent of each other, so they
    /// may run at the same time.
    void run_passes(std::span<Row> rows) {
        if (!r_.default_set) {
            parallel(rows.size(), threads_, [&](std::size_t i) { carry_along(rows[i]); });
            return;
        }
        std::vector<std::vector<std::optional<Motion>>> found(2 * rows.size());
        parallel(found.size(), threads_, [&](std::size_t task) {
            found[task] = follow(rows[task / 2].points, task % 2 == 0);
        });
        for (std::size_t i = 0; i < rows.size(); ++i) {
            Row& row = rows[i];
            for (std::size_t k = 0; k < row.points.size(); ++k)
                for (auto& pass : {&found[2 * i], &found[2 * i + 1]})
                    if ((*pass)[k]) row.points[k].motions.push_back(std::move(*(*pass)[k]));
            if (!r_.reduce) emit_points(row);
        }
    }

    struct Carried {
        Parameters parameters;
        State state;
    };

    /// One motion of each point: where its neighbour's has led to. Each line is handed out at once,
    /// up to the last that is wanted.
    void carry_along(Row& row) {
        const std::size_t n = row.points.size();
        std::optional<Carried> before;
        std::size_t left = row.wanted.size();
        for (std::size_t step = 0; step < n && left > 0; ++step) {
            const std::size_t k = r_.carry == SweepRequest::Carry::up ? step : n - 1 - step;
            SweepPoint& point = row.points[k];
            if (point.system) {
                const Parameters& p = point.system->system.parameters;
                point.afresh = step > 0 && !before;
                const State start =
                    before ? carried(before->state, before->parameters, p) : point.system->start;
                point.motions.push_back({"", start, run_from(*point.system, start)});
                const auto& end = point.motions[0].result.at_end;
                before = end ? std::optional(Carried{p, *end}) : std::nullopt;
            }
            if (r_.reduce) continue;
            const std::size_t index = row.wanted[0] / n * n + k;
            if (!std::binary_search(row.wanted.begin(), row.wanted.end(), index)) continue;
            emit(index, describe_point(r_, index, point));
            point = {};
            --left;
        }
    }

    /// From each point's worst motion, the ones found here among them, to the next point.
    std::vector<std::optional<Motion>> follow(const std::vector<SweepPoint>& points, bool up) {
        const std::size_t n = points.size();
        std::vector<std::optional<Motion>> found(n);
        std::optional<Carried> before;
        for (std::size_t step = 0; step < n; ++step) {
            const std::size_t k = up ? step : n - 1 - step;
            if (!points[k].system) continue;
            const Parameters& p = points[k].system->system.parameters;
            if (before) {
                const State start = carried(before->state, before->parameters, p);
                found[k] =
                    Motion{up ? "previous" : "next", start, run_from(*points[k].system, start)};
            }
            const Motion* worst = found[k] && found[k]->result.at_end ? &*found[k] : nullptr;
            for (const Motion& m : points[k].motions)
                if (m.result.at_end && (!worst || m.result.x_max > worst->result.x_max)) worst = &m;
            before = worst ? std::optional(Carried{p, *worst->result.at_end}) : std::nullopt;
        }
        return found;
    }

    void emit_points(const Row& row) {
        for (const std::size_t index : row.wanted)
            emit(index, describe_point(r_, index, row.points[index % row.points.size()]));
    }

    void emit(std::size_t index, const Json& line) {
        const std::lock_guard lock(emitting_);
        if (line.contains("depends_on_start") && !r_.default_set)
            ++tried, elsewhere += line["depends_on_start"] == true;
        point_(index, line);
    }

    const SweepRequest& r_;
    const int threads_;
    Pace& pace_;
    const std::function<void(std::size_t, const Json&)>& point_;
    const std::size_t every_;
    std::mutex emitting_;
};

}  // namespace

std::size_t runs_of(const SweepRequest& r) {
    if (!r.by_rows()) return r.indices.size();
    const std::size_t chain = chain_length(r);
    std::size_t rows = 0;
    for (std::size_t i = 0; i < r.indices.size(); ++i)
        rows += i == 0 || r.indices[i] / chain != r.indices[i - 1] / chain;
    constexpr std::size_t starts_of_default_set = 6;
    return rows * r.axes[r.inner()].values.size() * (r.default_set ? starts_of_default_set : 1);
}

std::string run_sweep(
    const SweepRequest& r, int threads, Pace& pace,
    const std::function<void(std::size_t, const Json&)>& point) {
    Sweep sweep(r, threads, pace, point);
    try {
        sweep.run();
    } catch (const Stopped&) {}
    return start_warning(sweep.elsewhere, sweep.tried);
}

}  // namespace vines::api
