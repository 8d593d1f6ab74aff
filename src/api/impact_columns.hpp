// Columns of listed impacts.
//
// An answer can list more impacts than are kept in memory. Its JSON then holds placeholders, and
// StreamedImpacts repeats the run, which yields the same bits, for a few columns at a time while
// the text is sent.
#pragma once

#include <cstdint>
#include <vector>

#include "api/cancellation.hpp"
#include "api/json_text.hpp"
#include "core/analysis/analysis.hpp"
#include "core/sweep/sweep.hpp"

namespace vines::api {

/// Scales of impulses and speeds of impacts.
struct ImpactScales {
    double epsilon;
    double typical_speed;  ///< see Analysis, m per unit of tau
};

/// Columns with one entry per impact.
Json describe_impacts(const std::vector<Impact>& impacts, const ImpactScales& scales);

/// The same columns as placeholders, which StreamedImpacts generates.
Json describe_streamed_impacts();

/// A run and the range of its listed impacts.
struct ListedRun {
    AnalysisRequest wanted;
    ImpactRange listed;
    ImpactScales scales;
};

/// Generates the placeholder columns of an answer in their order. Each repetition of the run fills
/// as many columns as fit into `most_bytes`, at least one.
class StreamedImpacts : public ListSource {
public:
    /// Each run calls control.begin() and control.end(). Throws Cancelled if `control` stops a run.
    StreamedImpacts(
        const ListedRun& run, const Json& answer, RunControl& control, std::size_t most_bytes);

    PackedList list(const StreamedList&) override;

private:
    /// A generated list and its offset in bytes_.
    struct Made {
        StreamedList list;
        std::size_t at;
    };
    std::size_t size_of(const StreamedList& list) const;
    void make_next();
    void put(const Made& to, long k, const Impact& impact);

    const ListedRun run_;
    RunControl& control_;
    const std::size_t most_bytes_;
    std::vector<StreamedList> to_make_;  // in order
    std::size_t next_ = 0;               // index of the next list to generate
    std::vector<Made> made_;
    std::size_t taken_ = 0;  // count of made_ lists already returned
    std::vector<std::uint8_t> bytes_;
};

}  // namespace vines::api
