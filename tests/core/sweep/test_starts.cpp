#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "../support.hpp"
#include "core/sweep/starts.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("a carried state keeps the mass at its place in the cavity") {
    const Parameters wide = table1(0.02, Damping::closed_form),
                     narrow = table1(0.01, Damping::closed_form);
    const State s = carried({0.1, 0.005, 0.2, -0.009}, wide, narrow);
    CHECK(s.x == 0.005);
    CHECK(s.y == doctest::Approx(0.005 - 0.007));
    CHECK(std::abs(s.x - s.y) <= narrow.b);
}

TEST_CASE("the default starts are valid, and untouched is one where the free motion fits in b") {
    for (const double b : {0.005, 0.5}) {
        const Parameters p = table1(b, Damping::closed_form);
        const auto starts = default_starts(p);
        bool untouched = false;
        for (const NamedStart& s : starts) {
            CAPTURE(s.name);
            CHECK(validate(p, s.state).empty());
            untouched = untouched || std::string(s.name) == "untouched";
        }
        CHECK(untouched == (b > 0.1));
        CHECK(starts.size() + 2 <= most_starts);
    }
}
