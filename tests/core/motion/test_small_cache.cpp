#include <doctest/doctest.h>

#include "core/motion/flow.hpp"

using namespace vines;

TEST_CASE("a table is computed once while it is cached, and the oldest of four is evicted") {
    SmallCache<int, int> cache;
    int made = 0;
    const auto get = [&](int key) {
        return cache.get(key, [&] {
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
    // An evicted table stays alive for its owner, but is computed again.
    CHECK(*first == 10);
    CHECK(get(1) != first);
    CHECK(made == 6);
}
