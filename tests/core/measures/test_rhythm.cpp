// Contact statistics of a run (Rhythm): contacts per cycle and synchronised intervals.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "../support.hpp"
#include "core/measures/rhythm.hpp"

using namespace vines;
using namespace vines::test;

namespace {

class ContactCollector : public ContactStream {
public:
    using ContactStream::ContactStream;
    void finish() { flush_contacts(); }
    std::vector<ContactEvent> contacts;

private:
    void on_contact(const ContactEvent& contact) override { contacts.push_back(contact); }
};

/// Random system near Table 1; the family includes chatter, sticking, contacts on one side, and
/// regular alternation.
Parameters random_system_near_table1(std::mt19937_64& engine) {
    Parameters p = table1(uniform(engine, 0.002, 0.035), Damping::closed_form);
    // At small R the ball often meets the same wall twice in a cycle and sticks at the second
    // contact.
    const double most_R = uniform(engine, 0, 1) < 0.5 ? 0.3 : 1;
    p.R_plus = uniform(engine, 0, most_R);
    p.R_minus = uniform(engine, 0, most_R);
    p.Omega = uniform(engine, 0.9, 1.1);
    return p;
}

/// Number of contacts in [from, to), from a list.
long contacts_between(const std::vector<ContactEvent>& contacts, double from, double to) {
    return std::count_if(contacts.begin(), contacts.end(), [&](const ContactEvent& c) {
        return c.tau >= from && c.tau < to;
    });
}

}  // namespace

TEST_CASE("contacts streamed one by one equal those of the list") {
    std::mt19937_64 engine(31);
    int sticks = 0;
    for (int n = 0; n < 100; ++n) {
        const Parameters p = random_system_near_table1(engine);
        ContactRecord list;
        ContactCollector collected(p);
        record(p, default_state(p), 400, 100000, {&list, &collected});
        collected.finish();
        sticks += static_cast<int>(list.sticks.size());
        REQUIRE(collected.contacts.size() == list.contacts.size());
        for (std::size_t k = 0; k < collected.contacts.size(); ++k) {
            CHECK(collected.contacts[k].tau == list.contacts[k].tau);
            CHECK(collected.contacts[k].side == list.contacts[k].side);
        }
    }
    CHECK(sticks > 500);  // the family does include sticking
}

TEST_CASE(
    "moving_z averages contacts over ten cycles; cycles_with is their distribution by cycle") {
    std::mt19937_64 engine(32);
    for (int n = 0; n < 30; ++n) {
        const Parameters p = random_system_near_table1(engine);
        ContactRecord list;
        Rhythm rhythm(p, {0, 300}, everything);
        record(p, default_state(p), 300, 100000, {&list, &rhythm});
        const ContactCounts counts = rhythm.finish({0, 300});
        const auto& contacts = list.contacts;
        REQUIRE(counts.contacts == static_cast<long>(contacts.size()));
        REQUIRE(counts.moving_tau.size() > 1);
        const double cycle = p.cycle();
        double mean = 0, sum = 0;
        for (std::size_t k = 0; k < counts.moving_tau.size(); ++k) {
            const double tau = counts.moving_tau[k];
            CHECK(
                counts.moving_z[k] * 10 ==
                doctest::Approx(contacts_between(contacts, tau - 5 * cycle, tau + 5 * cycle)));
        }
        for (std::size_t k = 0; k < counts.cycles_with.size(); ++k) {
            sum += counts.cycles_with[k];
            mean += static_cast<double>(k) * counts.cycles_with[k];
        }
        CHECK(sum == doctest::Approx(1));
        const double from = counts.moving_tau.front() - 5 * cycle,
                     to = counts.moving_tau.back() + 5 * cycle;
        CHECK(
            mean * std::round((to - from) / cycle) ==
            doctest::Approx(contacts_between(contacts, from, to)));
    }
}

TEST_CASE("bounded lists hold every n-th moving_z and the last synchronised intervals") {
    const Parameters p = table1(0.022, Damping::closed_form);
    const std::size_t most = 7;
    Rhythm all(p, {0, 2000}, everything), thinned(p, {0, 2000}, most), none(p, {0, 2000}, 0);
    record(p, default_state(p), 2000, 1000000, {&all, &thinned, &none});
    const ContactCounts whole = all.finish({0, 2000}), few = thinned.finish({0, 2000}),
                        without = none.finish({0, 2000});
    // With this stride the list has at most `most` entries.
    const std::size_t every = whole.moving_z.size() / most + 1;
    REQUIRE(few.moving_z.size() == (whole.moving_z.size() + every - 1) / every);
    for (std::size_t k = 0; k < few.moving_z.size(); ++k) {
        CHECK(few.moving_tau[k] == whole.moving_tau[k * every]);
        CHECK(few.moving_z[k] == whole.moving_z[k * every]);
    }
    CHECK(few.cycles_with == whole.cycles_with);
    CHECK(without.cycles_with.empty());
    const auto &stretches = whole.stretches, &last = few.stretches;
    REQUIRE(stretches.size() > most);
    REQUIRE(last.size() == most);
    CHECK(last.back().tau_end == stretches.back().tau_end);
    CHECK(last.front().tau_start == stretches[stretches.size() - most].tau_start);
    CHECK(without.stretches.empty());
    for (const ContactCounts* counts : {&few, &without}) {
        CHECK(counts->contacts == whole.contacts);
        CHECK(counts->z_overall == whole.z_overall);
        CHECK(counts->longest_synchronised == whole.longest_synchronised);
        CHECK(counts->synchronised == whole.synchronised);
        CHECK(counts->stretch_count == whole.stretch_count);
    }
}

TEST_CASE(
    "positions are returned in order, rounded down to 1/parts of a cycle, also after pauses") {
    CyclePositions positions;
    const std::vector<double> cycles = {0, 0, 0.25, 0.5, 1.49, 1.5, 5.125, 1000, 2e6};
    for (const double at : cycles) positions.add(at);
    std::vector<double> back;
    positions.each([&](std::int64_t at) { back.push_back(static_cast<double>(at)); });
    REQUIRE(back.size() == cycles.size());
    for (std::size_t k = 0; k < cycles.size(); ++k)
        CHECK(back[k] == std::floor(cycles[k] * CyclePositions::parts));
}
