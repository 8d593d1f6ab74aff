#include "http/worker_pool.hpp"

#include <doctest/doctest.h>
#include <atomic>
#include <latch>

using vines::http::WorkerPool;

TEST_CASE("a full queue refuses the last job of the client with the most, whose share is in work") {
    enum Job { quick, blocked };
    std::latch end(1);
    std::atomic<int> done = 0, begun = 0;
    WorkerPool<Job> pool(4, [&](Job job) {
        ++begun;
        if (job == blocked) end.wait();
        ++done;
    });
    const auto fill = [&pool] {
        while (!pool.add("greedy", blocked)) {}
    };
    fill();
    for (int i = 1; i <= 20; ++i) {
        CHECK(pool.add("modest", quick).value_or(blocked) == blocked);
        while (done < i) std::this_thread::yield();
    }
    // Its share of the threads is in work too, and it has had more turns.
    pool.add("modest", blocked);
    while (begun < 23) std::this_thread::yield();
    fill();
    const std::optional<Job> refused = pool.add("modest", quick);
    REQUIRE(refused);
    CHECK(*refused == blocked);
    end.count_down();
}

TEST_CASE("others need the threads of a client that has more of them") {
    std::latch end(1);
    std::atomic<int> begun = 0;
    WorkerPool<int> pool(4, [&](int) {
        ++begun;
        end.wait();
    });
    auto add = [&, count = 0](const std::string& client) mutable {
        CHECK(!pool.add(client, 0));
        ++count;
        while (begun < std::min(count, 4)) std::this_thread::yield();
    };
    for (const char* client : {"greedy", "greedy", "second", "third"}) add(client);
    CHECK(!pool.others_need("greedy", false));
    add("second");
    CHECK(!pool.others_need("greedy", false));
    add("new");
    CHECK(pool.others_need("greedy", false));
    CHECK(!pool.others_need("third", false));
    CHECK(pool.others_need("third", true));
    CHECK(!pool.others_need("new", true));
    end.count_down();
}
