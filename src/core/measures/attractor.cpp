#include "core/measures/attractor.hpp"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <set>

namespace vines {

namespace {

// Width of a cell in units of b, also for velocities: far above the errors of orbits. States closer
// to a border than this part of a cell can be on either side.
constexpr double cell_width = 0x1p-20, near_border = 0x1p-7;
// Newton's method from the middle of a cell moves less than this, in units of the motion.
constexpr double reach_from_cell = 0.1;

/// x', x, y', y in units of the cells.
using StateCell = std::array<std::int64_t, 4>;

/// The cells in which a state lies, but for rounding errors.
std::set<StateCell> cells_of(const Parameters& p, const State& s) {
    const Eigen::Vector4d v = vector_of(s) / (p.b * cell_width);
    std::set<StateCell> cells = {{}};
    for (int i = 0; i < 4; ++i) {
        const double low = std::floor(v(i)), part = v(i) - low;
        const bool doubtful = std::abs(part - 0.5) < near_border;
        std::set<StateCell> next;
        for (StateCell cell : cells) {
            cell[i] = static_cast<std::int64_t>(low) + (part >= 0.5);
            next.insert(cell);
            if (doubtful) cell[i] += part >= 0.5 ? -1 : 1, next.insert(cell);
        }
        cells = std::move(next);
    }
    return cells;
}

/// The cell to which Newton's method leads from the middle of another one.
std::optional<StateCell> next_cell(
    const Parameters& p, const StateCell& cell, int cycles, const StopRequest& stop) {
    Eigen::Vector4d v;
    for (int i = 0; i < 4; ++i) v(i) = static_cast<double>(cell[i]) * p.b * cell_width;
    State middle = state_of(v);
    // The middle of a cell can lie across the wall.
    middle.y = std::clamp(middle.y, middle.x - p.b, middle.x + p.b);
    const auto orbit =
        find_orbit(p, middle, cycles, scale_of(p, {&middle, 1}), reach_from_cell, stop);
    if (!orbit) return std::nullopt;
    const Eigen::Vector4d there =
        vector_of(whole_cycle_states(p, *orbit).back()) / (p.b * cell_width);
    StateCell next;
    for (int i = 0; i < 4; ++i) next[i] = std::llround(there(i));
    return next;
}

StateCell canonical_cell(const Parameters& p, const State& s, int cycles, const StopRequest& stop) {
    std::set<StateCell> cells = cells_of(p, s);
    for (std::size_t before = 0; cells.size() > 1 && cells.size() != before;) {
        std::set<StateCell> next;
        for (const StateCell& cell : cells)
            if (const auto to = next_cell(p, cell, cycles, stop)) next.insert(*to);
        if (next.empty()) break;
        before = cells.size();
        cells = std::move(next);
    }
    return *cells.begin();
}

/// FNV-1a over the bytes of a number.
void digest(std::uint64_t& hash, std::int64_t value) {
    for (int byte = 0; byte < 8; ++byte)
        hash = (hash ^ (static_cast<std::uint64_t>(value) >> 8 * byte & 0xff)) * 0x100000001b3;
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

std::string orbit_name(const Parameters& p, const PeriodicOrbit& orbit, const StopRequest& stop) {
    if (orbit.contacts == 0) return "untouched";
    // Their set does not depend on the start; positions are continuous even at an impact.
    std::set<std::array<std::int64_t, 2>> positions;
    for (const State& s : whole_cycle_states(p, orbit)) {
        const StateCell cell = canonical_cell(p, s, orbit.cycles, stop);
        positions.insert({cell[1], cell[3]});
    }
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const auto& [x, y] : positions) digest(hash, x), digest(hash, y);
    return formatted("p%d-%08" PRIx32, orbit.cycles, static_cast<std::uint32_t>(hash ^ hash >> 32));
}

}  // namespace

AttractorName name_of(const Parameters& p, const PeriodicOrbit& orbit, const StopRequest& stop) {
    AttractorName name{orbit_name(p, orbit, stop)};
    if (!p.is_symmetric()) return name;
    const auto half = follow(p, orbit.state, orbit.tau, 0.5 * p.cycle(), stop);
    if (!half) return name;
    PeriodicOrbit twin = orbit;
    twin.state = state_of(-vector_of(*half));
    name.mirror = orbit_name(p, twin, stop);
    return name;
}

AttractorName name_of(
    const Parameters& p, const Regime& r, Verdict verdict, double x_rms, const StopRequest& stop) {
    if (r.orbit) return name_of(p, *r.orbit, stop);
    if (r.forced && r.untouched && r.untouched->for_ever) return {"untouched", "untouched"};
    if (r.quasi_periodic)
        return {"quasi_periodic" + formatted("-%.3f", r.quasi_periodic->rotation_number)};
    if (verdict == Verdict::chaotic)
        return {"chaotic" + formatted("-z%.1f", r.z) + formatted("-x%.1f", x_rms / p.b)};
    return {};
}

}  // namespace vines
