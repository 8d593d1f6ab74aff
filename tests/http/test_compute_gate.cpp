// Who waits for whom at the gate. A thread that would wait for ever makes a test hang, and ctest's
// time limit end it; none rests on how fast the machine is.
#include <doctest/doctest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "http/compute_gate.hpp"
#include "http/turn.hpp"

using namespace vines::http;

namespace {

/// Until it holds: for what another thread is about to do.
template <class Condition>
void wait_until(Condition holds) {
    while (!holds()) std::this_thread::yield();
}

}  // namespace

TEST_CASE("urgent work queues up to its limit and is turned away beyond it") {
    ComputeGate gate({.running = 1, .waiting = 1});
    ComputeGate::Place first = gate.enter();
    REQUIRE(first);
    std::atomic<bool> entered = false;
    std::thread second([&] { entered = gate.enter() != nullptr; });
    wait_until([&] { return gate.wanted(); });
    CHECK(!gate.enter());
    CHECK(!entered);
    first.reset();
    second.join();
    CHECK(entered);
    CHECK(!gate.wanted());
    CHECK(gate.enter());
}

TEST_CASE("nobody may wait where the queue has no room at all") {
    ComputeGate gate({.running = 1, .waiting = 0});
    const ComputeGate::Place place = gate.enter();
    CHECK(place);
    CHECK(!gate.enter());
}

TEST_CASE("patient work that gives its place back gets it again behind the urgent work") {
    ComputeGate gate({.running = 1});
    const std::stop_source stop;
    for (int round = 0; round < 200; ++round) {
        ComputeGate::Place place = gate.enter_patiently(stop.get_token());
        REQUIRE(place);
        std::atomic<bool> served = false;
        std::thread urgent([&] {
            const ComputeGate::Place own = gate.enter();
            served = own != nullptr;
        });
        wait_until([&] { return gate.wanted(); });
        place.reset();
        place = gate.enter_patiently(stop.get_token());
        CHECK(place);
        CHECK(served);
        urgent.join();
    }
}

TEST_CASE("patient work gets its places in the order in which it came") {
    ComputeGate gate({.running = 1});
    const std::stop_source stop;
    for (int round = 0; round < 200; ++round) {
        ComputeGate::Place place = gate.enter_patiently(stop.get_token());
        CHECK(!gate.wanted_patiently());
        std::atomic<bool> served = false;
        std::thread other([&] {
            const ComputeGate::Place own = gate.enter_patiently(stop.get_token());
            served = own != nullptr;
        });
        wait_until([&] { return gate.wanted_patiently(); });
        place.reset();
        place = gate.enter_patiently(stop.get_token());
        CHECK(place);
        CHECK(served);
        other.join();
    }
}

TEST_CASE("patient work that is stopped does not keep those behind it waiting") {
    ComputeGate gate({.running = 1});
    std::stop_source first_stop;
    const std::stop_source stop;
    ComputeGate::Place place = gate.enter_patiently(stop.get_token());
    std::thread first([&] { CHECK(!gate.enter_patiently(first_stop.get_token())); });
    wait_until([&] { return gate.wanted_patiently(); });
    std::thread second([&] { CHECK(gate.enter_patiently(stop.get_token())); });
    first_stop.request_stop();
    first.join();
    place.reset();
    second.join();
}

TEST_CASE(
    "of two places that come free at once patient work gets the one that urgent work leaves") {
    const std::stop_source stop;
    for (int round = 0; round < 1000; ++round) {
        ComputeGate gate({.running = 2});
        ComputeGate::Place first = gate.enter(), second = gate.enter();
        std::atomic<bool> patient_inside = false;
        std::thread patient(
            [&] { patient_inside = gate.enter_patiently(stop.get_token()) != nullptr; });
        std::thread urgent([&] {
            const ComputeGate::Place own = gate.enter();
            wait_until([&] { return patient_inside.load(); });  // with its place kept
        });
        wait_until([&] { return gate.wanted(); });
        first.reset();
        second.reset();
        patient.join();
        urgent.join();
        CHECK(patient_inside);
    }
}

TEST_CASE("a stop ends patient work's wait, before it as well as in it") {
    ComputeGate gate({.running = 1});
    const ComputeGate::Place held = gate.enter();
    for (int round = 0; round < 500; ++round) {  // the stop comes at all moments
        std::stop_source stop;
        std::atomic<bool> waiting = false, entered = true;
        std::thread patient([&] {
            waiting = true;
            entered = gate.enter_patiently(stop.get_token()) != nullptr;
        });
        if (round % 2) wait_until([&] { return waiting.load(); });
        if (round % 4 == 3) std::this_thread::sleep_for(std::chrono::microseconds(round));
        stop.request_stop();
        patient.join();
        CHECK(!entered);
    }
}

TEST_CASE("closing ends all patient waits, lets no sweep in, and urgent work still computes") {
    for (int round = 0; round < 200; ++round) {
        ComputeGate gate({.running = 1, .sweeps = 2});
        const ComputeGate::Room room = gate.enter_sweep();
        CHECK(room);
        ComputeGate::Place held = gate.enter();
        const std::stop_source stop;
        std::atomic<int> waiting = 0, without = 0;
        std::vector<std::thread> patient;
        for (int k = 0; k < 3; ++k)
            patient.emplace_back([&] {
                ++waiting;
                if (!gate.enter_patiently(stop.get_token())) ++without;
            });
        wait_until([&] { return waiting == 3; });
        gate.close_to_sweeps();
        for (std::thread& thread : patient) thread.join();
        CHECK(without == 3);
        CHECK(gate.closed_to_sweeps());
        CHECK(!gate.enter_sweep());
        held.reset();
        CHECK(gate.enter());
    }
}

TEST_CASE("a sweep's room is there again once it was given back") {
    ComputeGate gate({.sweeps = 1});
    ComputeGate::Room room = gate.enter_sweep();
    CHECK(room);
    CHECK(!gate.enter_sweep());
    room.reset();
    CHECK(gate.enter_sweep());
}

TEST_CASE("no wake-up is lost, and no place, where urgent and patient work meet") {
    constexpr int places = 2, rounds = 20000;
    ComputeGate gate({.running = places});
    const std::stop_source stop;
    std::atomic<int> inside = 0, most = 0, patient_done = 0, urgent_done = 0;
    const auto compute = [&] {
        const int now = ++inside;
        for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {}
        --inside;
    };
    std::vector<std::thread> threads;
    for (int k = 0; k < 3; ++k)
        threads.emplace_back([&] {
            for (int round = 0; round < rounds; ++round) {
                ComputeGate::Place place = gate.enter_patiently(stop.get_token());
                if (gate.wanted()) {
                    place.reset();
                    place = gate.enter_patiently(stop.get_token());
                }
                if (!place) continue;
                compute();
                ++patient_done;
            }
        });
    for (int k = 0; k < 3; ++k)
        threads.emplace_back([&] {
            for (int round = 0; round < rounds; ++round)
                if (const ComputeGate::Place place = gate.enter()) {
                    compute();
                    ++urgent_done;
                }
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(patient_done == 3 * rounds);
    CHECK(urgent_done == 3 * rounds);
    CHECK(most <= places);
    CHECK(!gate.wanted());
}

TEST_CASE("urgent work begins without a place where none is free, as much of it as may wait") {
    ComputeGate gate({.running = 1, .waiting = 2});
    const ComputeGate::Begin first = gate.begin(), second = gate.begin(), third = gate.begin();
    CHECK(first.place);
    CHECK(!first.moment);
    CHECK(second.moment);
    CHECK(third.moment);
    CHECK(!second.place);
    const ComputeGate::Begin fourth = gate.begin();
    CHECK(!fourth.place);
    CHECK(!fourth.moment);
    CHECK(!gate.enter());
    CHECK(gate.load().running == 1);
}

TEST_CASE("there are few moments for each place, and one that ended makes room for another") {
    ComputeGate gate({.running = 1, .waiting = 1000});
    const ComputeGate::Place place = gate.enter();
    std::vector<ComputeGate::Begin> begun;
    for (ComputeGate::Begin begin = gate.begin(); begin.moment; begin = gate.begin())
        begun.push_back(std::move(begin));
    CHECK(begun.size() == 4);
    begun.pop_back();
    CHECK(gate.begin().moment);
}

TEST_CASE("work whose moment is over finds room in a queue that is full, behind those in it") {
    ComputeGate gate({.running = 1, .waiting = 2});
    ComputeGate::Place place = gate.enter();
    ComputeGate::Begin begin = gate.begin();
    REQUIRE(begin.moment);
    std::atomic<bool> first_entered = false, second_entered = false;
    std::thread first([&] { first_entered = gate.enter() != nullptr; });
    wait_until([&] { return gate.load().waiting == 1; });
    CHECK(!gate.enter());
    std::thread second([&] {
        const ComputeGate::Place own = gate.enter({}, std::move(begin.moment));
        second_entered = own && first_entered;
    });
    wait_until([&] { return gate.load().waiting == 2; });
    CHECK(!gate.enter());
    place.reset();
    first.join();
    second.join();
    CHECK(second_entered);
    CHECK(gate.begin().place);
}

TEST_CASE("a turn goes on without a place for a moment, then waits for one, or gives up") {
    ComputeGate gate({.running = 1});
    ComputeGate::Place place = gate.enter();
    std::atomic<bool> left = false;
    Turn turn(gate, [&] { return left.load(); }, true);
    REQUIRE(turn);
    CHECK(gate.load().waiting == 0);
    std::atomic<bool> goes_on = false;
    std::thread work([&] {
        while (turn.waited().count() == 0 && turn.goes_on()) {}
        goes_on = turn.goes_on();
    });
    wait_until([&] { return gate.load().waiting == 1; });
    place.reset();
    work.join();
    CHECK(goes_on);
    CHECK(turn.waited().count() > 0);
    CHECK(gate.load().running == 1);

    Turn other(gate, [&] { return left.load(); }, true);
    left = true;
    while (other.goes_on()) {}
    CHECK(!other);
    CHECK(gate.load().waiting == 0);
}

TEST_CASE("a turn that may not begin without a place waits for one") {
    ComputeGate gate({.running = 1, .waiting = 0});
    ComputeGate::Place place = gate.enter();
    CHECK(!Turn(gate, {}, true));
    CHECK(!Turn(gate, {}, false));
    place.reset();
    Turn turn(gate, {}, false);
    CHECK(turn.goes_on());
    CHECK(gate.load().running == 1);
}
