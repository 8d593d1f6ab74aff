// The points of a sweep as one table in CSV, CBOR or npz: a row for each point, in the order of the
// index. The columns follow from sample_lines(). Sections and lists of starts are left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>

#include "api/format/encode.hpp"
#include "api/sweep.hpp"

namespace vines::api {

/// Texts of a sweep's lines, brought into the order of their index.
class LinesInOrder {
public:
    /// `indices`: those of all lines, ascending. They must outlive the object.
    explicit LinesInOrder(const std::vector<std::size_t>& indices) : indices_(indices) {}

    /// Takes the text of a line. Returns the texts that are next in order.
    std::string add(std::size_t index, std::string text);
    /// Returns the other texts, despite missing ones between them.
    std::string rest() const;

private:
    const std::vector<std::size_t>& indices_;
    std::map<std::size_t, std::string> waiting_;  ///< after a missing one, by index
    std::size_t returned_ = 0;
};

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

    void add_columns(const Json& sample);
    /// With the first point: a service reserves their memory before it computes.
    void make_rows();

    const SweepRequest& request_;
    const Format format_;
    std::vector<Column> columns_;
    std::map<std::string, std::size_t> column_of_;
    LinesInOrder rows_;  ///< of CSV
    bool has_rows_ = false;
};

/// A sweep as a stream: its lines, or its points as a table.
class SweepStream : public LineStream {
public:
    /// Format::json: lines. Problem 413 as SweepTable.
    SweepStream(
        SweepRequest request, Format format, std::size_t most_bytes = SweepTable::most_of_npz);

    std::string begin() const override;
    bool compute(int threads, RunControl& control, const Take& take) override;
    std::string progress(
        std::size_t done, const RunControl& control, double seconds) const override;
    std::string end() override;
    const char* remedy() const override;

    /// True if it is a table.
    bool is_table() const { return table_.has_value(); }
    /// Contacts or states that a point lists at most.
    std::size_t listed() const;
    std::size_t bytes(int threads) const override;

private:
    std::size_t bytes_of_point() const;
    int used_of(int threads) const;

    SweepRequest request_;
    std::optional<SweepTable> table_;
    std::size_t lines_ = 0;  ///< computed
    std::string warning_;    ///< about all points
};

}  // namespace vines::api
