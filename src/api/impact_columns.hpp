// The columns of a list of impacts: made of impacts that are kept, or of a run that is made once
// more while they are written.
#pragma once

#include <cstdint>
#include <vector>

#include "api/broken_off.hpp"
#include "api/json_text.hpp"
#include "core/analysis/analysis.hpp"
#include "core/sweep/sweep.hpp"

namespace vines::api {

/// What impulses and speeds of impacts are told by.
struct ImpactScales {
    double epsilon;
    double typical_speed;  ///< of Analysis, m per unit of tau
};

/// Columns, one entry for each impact.
Json describe_impacts(const std::vector<Impact>& impacts, const ImpactScales& scales);

/// The same columns, to come: ImpactLists makes them.
Json describe_impacts_to_come();

/// A run, and which of its impacts are listed.
struct ListedRun {
    Wanted wanted;
    ImpactRange listed;
    ImpactScales scales;
};

/// Makes the columns to come of an answer, in the order in which they stand there: as many at a
/// time as fit into `most_bytes`, or one, by making the run once more.
class ImpactLists : public ListSource {
public:
    /// A run begins and ends with that of `pace`, which may stop it: BrokenOff.
    ImpactLists(const ListedRun& run, const Json& answer, Pace& pace, std::size_t most_bytes);

    PackedList list(const ListToCome&) override;

private:
    /// A list, and where it begins among the bytes.
    struct Made {
        ListToCome list;
        std::size_t at;
    };
    std::size_t size_of(const ListToCome& list) const;
    void make_next();
    void put(const Made& to, long k, const Impact& impact);

    const ListedRun run_;
    Pace& pace_;
    const std::size_t most_bytes_;
    std::vector<ListToCome> to_make_;  // in their order
    std::size_t next_ = 0;             // of those that are not made
    std::vector<Made> made_;
    std::size_t taken_ = 0;  // of those that are made
    std::vector<std::uint8_t> bytes_;
};

}  // namespace vines::api
