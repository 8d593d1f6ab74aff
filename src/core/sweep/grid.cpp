#include "core/sweep/grid.hpp"

#include <cassert>

namespace vines {

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

}  // namespace vines
