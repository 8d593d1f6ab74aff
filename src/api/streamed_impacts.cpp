// Impact lists that are generated while an answer is sent.
//
// An answer can list more impacts than are kept in memory. Its part `impacts` then holds a
// placeholder for each column. While the answer is written, the run is repeated, which yields the
// same bits, for a few columns at a time.
#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "api/cancellation.hpp"
#include "api/simulate.hpp"

namespace vines::api {

namespace {

/// A placeholder: a column of impact_columns, and the factor of its numbers. It lies in a binary
/// value whose subtype is no packing of a list in memory.
struct Placeholder {
    std::size_t column;
    double factor;

    static constexpr std::uint8_t subtype = 255;

    Json json() const {
        std::vector<std::uint8_t> bytes(sizeof *this);
        std::memcpy(bytes.data(), this, sizeof *this);
        return Json::binary(std::move(bytes), subtype);
    }
    static bool is(const Json& value) {
        return value.is_binary() && value.get_binary().subtype() == subtype;
    }
    static Placeholder of(const Json& value) {
        Placeholder placeholder;
        std::memcpy(&placeholder, value.get_binary().data(), sizeof placeholder);
        return placeholder;
    }
    const ImpactColumn& source() const { return impact_columns[column]; }
};

void find_placeholders(const Json& json, std::vector<Placeholder>& found) {
    if (Placeholder::is(json)) found.push_back(Placeholder::of(json));
    else if (json.is_structured())
        for (const Json& part : json) find_placeholders(part, found);
}

template <class Entry>
void put_entry(std::uint8_t* list, long k, Entry entry) {
    std::memcpy(list + static_cast<std::size_t>(k) * sizeof entry, &entry, sizeof entry);
}

class Generator {
public:
    Generator(const ListedRun& run, const Json& answer, RunControl& control, std::size_t most_bytes)
        : run_(run),
          control_(control),
          most_bytes_(most_bytes) {
        find_placeholders(answer, lists_);
        std::size_t all = 0, largest = 0;
        for (const Placeholder& list : lists_) {
            all += size_of(list);
            largest = std::max(largest, size_of(list));
        }
        bytes_.reserve(std::max(largest, std::min(all, most_bytes_)));
    }

    PackedList next() {
        if (taken_ == filled_.size()) fill();
        const Filled& list = filled_[taken_++];
        return {
            list.placeholder.source().packing(),
            std::span(bytes_).subspan(list.at, size_of(list.placeholder))};
    }

private:
    /// A generated list and its offset in bytes_.
    struct Filled {
        Placeholder placeholder;
        std::size_t at;
    };

    std::size_t size_of(const Placeholder& list) const {
        return static_cast<std::size_t>(run_.listed.count) * entry_size(list.source().packing());
    }

    void fill() {
        filled_.clear();
        taken_ = 0;
        std::size_t end = 0;
        for (; next_ < lists_.size(); ++next_) {
            const std::size_t size = size_of(lists_[next_]);
            if (end > 0 && end + size > most_bytes_) break;
            filled_.push_back({lists_[next_], end});
            end += size;
        }
        bytes_.resize(end);
        const AnalysisRequest& w = run_.wanted;
        long k = 0;
        control_.begin();
        const bool complete = repeat_impacts(
            w.parameters, w.start,
            {.tau_end = w.tau_end,
             .max_impacts = w.max_impacts,
             .stop = [this] { return control_.stop_or_yield(); }},
            run_.listed, [&](const Impact& impact) {
                for (const Filled& list : filled_) put(list, k, impact);
                ++k;
            });
        control_.end();
        if (!complete) throw Cancelled();
    }

    void put(const Filled& to, long k, const Impact& impact) {
        const ImpactColumn& column = to.placeholder.source();
        const double value = column.value(impact, run_.scales);
        std::uint8_t* const list = bytes_.data() + to.at;
        switch (column.packing()) {
            case Packed::integers: return put_entry(list, k, static_cast<int>(value));
            case Packed::flags: return put_entry(list, k, value != 0);
            default: return put_entry(list, k, value * to.placeholder.factor);
        }
    }

    const ListedRun run_;
    RunControl& control_;
    const std::size_t most_bytes_;
    std::vector<Placeholder> lists_;  // in the order of the answer
    std::size_t next_ = 0;            // index of the next list to generate
    std::vector<Filled> filled_;
    std::size_t taken_ = 0;  // count of filled_ lists already returned
    std::vector<std::uint8_t> bytes_;
};

}  // namespace

Json streamed_impacts(const std::optional<SiParameters>& si) {
    Json columns = Json::object();
    for (std::size_t k = 0; k < std::size(impact_columns); ++k)
        columns[impact_columns[k].quantity.name] = Placeholder{k, 1}.json();
    for (std::size_t k = 0; si && k < std::size(impact_columns); ++k)
        if (const Quantity& q = impact_columns[k].quantity; q.si_name)
            columns[q.si_name] = Placeholder{k, si_factor(q, *si)}.json();
    return columns;
}

JsonText::ListOf list_generator(
    const ListedRun& run, const Json& answer, RunControl& control, std::size_t most_bytes) {
    const auto generator = std::make_shared<Generator>(run, answer, control, most_bytes);
    return [generator](const Json& value) {
        return Placeholder::is(value) ? generator->next() : list_in_memory(value);
    };
}

}  // namespace vines::api
