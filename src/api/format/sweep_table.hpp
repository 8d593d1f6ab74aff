// The points of a sweep as one table in CSV, CBOR or npz: a row for each point, in the order of the
// index. The columns depend only on the request: they follow from sample_lines(), and so from the
// tables in properties.hpp. Sections and lists of starts are left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>

#include "api/format/encode.hpp"
#include "api/sweep.hpp"

namespace vines::api {

/// The format that the field `format` of a sweep's request selects; Format::json for lines. nullopt
/// if it is missing or unknown, which read_sweep_request() refuses.
std::optional<Format> sweep_format(const Json& fields);

class SweepTable {
public:
    /// Offsets in a ZIP archive have 32 bits.
    static constexpr std::size_t most_of_npz = std::numeric_limits<std::uint32_t>::max();

    /// A format other than Format::json. The request must outlive the object. Problem 413 if CBOR
    /// or npz would have more than `most_bytes`.
    SweepTable(const SweepRequest& request, Format format, std::size_t most_bytes = most_of_npz);

    /// The bytes before the first point.
    std::string begin() const;
    /// Adds a point's line and returns the bytes that follow from it: in CSV the rows that are next
    /// in the order of the index.
    std::string add(std::size_t index, const std::string& line);
    /// The last bytes, after all points; `warning`: about the whole sweep, or empty.
    std::string end(const std::string& warning);

    /// Size of the answer, about; in CSV what is in memory at once. Until it is sent, the memory is
    /// twice as large.
    std::size_t bytes() const;

private:
    enum class Kind { number, flag, word };
    struct Column {
        std::string name;
        Kind kind = Kind::number;
        std::vector<double> numbers = {};     ///< flags are 1 and 0; NaN where there is none
        std::vector<std::string> words = {};  ///< empty where there is none
    };
    using Cells = std::vector<Json>;  ///< null where there is none

    void add_columns(const Json& sample);
    Cells cells_of(std::size_t index, const std::string& line) const;
    std::string add_row(std::size_t index, const Cells& cells);
    void keep(std::size_t row, const Cells& cells);

    const SweepRequest& request_;
    const Format format_;
    std::vector<Column> columns_;
    std::map<std::string, std::size_t> column_of_;
    std::map<std::size_t, std::string> waiting_;  ///< rows of CSV after a missing one, by index
    std::size_t written_ = 0;                     ///< rows of CSV
};

}  // namespace vines::api
