#include "core/sweep/grid.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace vines {

namespace {

/// The coarsest grid has so many places on an axis, or up to twice as many: enough to see what a
/// picture is of.
constexpr std::size_t coarsest = 8;

std::size_t level_on_axis(std::size_t at, std::size_t steps) {
    const auto levels =
        static_cast<std::size_t>(std::bit_width(std::max(steps / coarsest, 1UL)) - 1);
    const auto halvings = static_cast<std::size_t>(std::countr_zero(at));
    return levels - std::min(levels, halvings);
}

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
    bool starts_counted = false;
    for (std::size_t a = 0; a < steps.size(); ++a) {
        if (a == reduced) continue;
        place.at[a] = take(steps[a]);
        if (!starts_counted) place.start = take(starts);
        starts_counted = true;
    }
    if (!starts_counted) place.start = take(starts);
    return place;
}

std::size_t Grid::level(const Place& place) const {
    std::size_t finest = 0;
    for (std::size_t a = 0; a < steps.size(); ++a)
        finest = std::max(finest, level_on_axis(place.at[a], steps[a]));
    return finest;
}

}  // namespace vines
