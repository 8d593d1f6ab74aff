#include <doctest/doctest.h>

#include "core/motion/last_used.hpp"

using namespace vines;

TEST_CASE("a table is made once while it is remembered, and the oldest of four is forgotten") {
    LastUsed<int, int> last_used;
    int made = 0;
    const auto get = [&](int key) {
        return last_used.get(key, [&] {
            ++made;
            return 10 * key;
        });
    };
    const auto first = get(1);
    CHECK(*first == 10);
    CHECK(get(1) == first);
    for (const int key : {2, 3, 4}) get(key);
    CHECK(get(1) == first);
    CHECK(made == 4);
    get(5);
    CHECK(get(4) == get(4));
    CHECK(made == 5);
    // It outlives being forgotten, but is made again.
    CHECK(*first == 10);
    CHECK(get(1) != first);
    CHECK(made == 6);
}
