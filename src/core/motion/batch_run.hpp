// A batch of runs on one thread, whose contacts are searched at once with vector instructions.
//
// Each run equals the same run alone, bit for bit (flight_batch.hpp). Flights that do not suit the
// vectorised search (chatter, sticking, an undecided cell) are advanced separately, and when a run
// ends, the next one of its source replaces it. The batch shares the tables of one flow; runs with
// a flow other than the first one's are also advanced separately.
#pragma once

#include <vector>

#include "core/motion/contact_search.hpp"
#include "core/motion/flight_batch.hpp"
#include "core/motion/simulate.hpp"

namespace vines {

/// A source of runs that follow each other.
class RunSource {
public:
    virtual ~RunSource() = default;
    /// The next run, or nullopt at the end. `last`: outcome of the previous run, nullopt at first.
    /// An exception ends the whole batch.
    virtual std::optional<RunPlan> next(const std::optional<Outcome>& last) = 0;
};

/// Largest number of sources in a batch.
inline constexpr int max_batch_runs = FlightBatch::capacity;
/// Carries out all runs of at most max_batch_runs sources, with best_batch_search().
void simulate_batch(std::span<RunSource* const> sources);
/// The same with a given search; null: fast_contact() for each flight.
void simulate_batch(std::span<RunSource* const> sources, BatchSearch search);

/// The searches that this processor supports, the widest last; all give the same results.
std::vector<NamedBatchSearch> batch_searches();
/// The widest search, or null where it is no faster than fast_contact() per flight.
BatchSearch best_batch_search();

/// Appends a flight and increments the count. The flight must satisfy has_simple_start(); b and
/// limit as in fast_contact().
void append(FlightBatch& flights, const FlightStart& start, double b, double limit);
/// Searches all flights of the batch. Unused elements repeat the first flight.
void search(FlightBatch& flights, BatchSearch kernel);
/// Contact and transfer matrix of a flight whose contact was found.
Contact contact_of(const FlightBatch& flights, int i);
Transfer transfer_of(const FlightBatch& flights, int i);

}  // namespace vines
