#include <doctest/doctest.h>

#include <set>
#include <vector>

#include "core/sweep/sweep.hpp"

using namespace vines;

TEST_CASE("lines count along the first axis fastest, then the starts, then the other axes") {
    const Grid grid{.steps = {3, 2, 2}, .starts = 2};
    CHECK(grid.points() == 24);
    CHECK(grid.lines() == 24);
    CHECK(grid.row() == 3);
    std::size_t line = 0;
    for (std::size_t third = 0; third < 2; ++third)
        for (std::size_t second = 0; second < 2; ++second)
            for (std::size_t start = 0; start < 2; ++start)
                for (std::size_t first = 0; first < 3; ++first) {
                    const Place place = grid.place_of(line++);
                    CHECK(place.start == start);
                    CHECK(place.at == std::vector<std::size_t>{first, second, third});
                }
}

TEST_CASE("the points of a reduced axis share one line, with index 0") {
    for (const std::size_t reduced : {0u, 1u, 2u}) {
        CAPTURE(reduced);
        const Grid grid{.steps = {3, 2, 4}, .starts = 2, .reduced = reduced};
        CHECK(grid.points() == 48);
        CHECK(grid.row() == grid.steps[reduced]);
        CHECK(grid.lines() == 48 / grid.steps[reduced]);
        std::set<std::vector<std::size_t>> places;
        for (std::size_t line = 0; line < grid.lines(); ++line) {
            Place place = grid.place_of(line);
            CHECK(place.at[reduced] == 0);
            place.at.push_back(place.start);
            places.insert(place.at);
        }
        CHECK(places.size() == grid.lines());
    }
}

TEST_CASE("if the first axis is reduced the second one counts fastest") {
    const Grid grid{.steps = {3, 4}, .starts = 2, .reduced = 0};
    CHECK(grid.place_of(3).at[1] == 3);
    CHECK(grid.place_of(3).start == 0);
    CHECK(grid.place_of(4).at[1] == 0);
    CHECK(grid.place_of(4).start == 1);
}

TEST_CASE("if the only axis is reduced each start has a line") {
    const Grid grid{.steps = {5}, .starts = 3, .reduced = 0};
    CHECK(grid.lines() == 3);
    for (std::size_t line = 0; line < 3; ++line) CHECK(grid.place_of(line).start == line);
}

TEST_CASE(
    "each level of a grid halves the steps of the one before, starting from 8 to 16 per axis") {
    const Grid grid{.steps = {65, 20}};
    std::vector<std::size_t> seen(4, 0);
    for (std::size_t line = 0; line < grid.lines(); ++line) {
        const Place place = grid.place_of(line);
        const std::size_t level = grid.level(place);
        REQUIRE(level < seen.size());
        ++seen[level];
        const std::size_t first = 8 >> level, second = 2 >> std::min<std::size_t>(level, 1);
        CHECK(place.at[0] % first == 0);
        CHECK(place.at[1] % second == 0);
    }
    CHECK(seen[0] == 9 * 10);
    CHECK(seen[0] + seen[1] == 17 * 20);
    CHECK(seen[0] + seen[1] + seen[2] == 33 * 20);
}
