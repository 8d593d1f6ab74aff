// Impact lists that are generated while an answer is sent.
//
// An answer can list more impacts than are kept in memory. Its part `impacts` then holds a
// placeholder for each column. While the answer is written, the run is repeated, which yields the
// same bits, for a few columns at a time.
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

/// Generates the lists of the placeholders in the order of the answer.
class Generator {
public:
    Generator(const ListedRun& run, const Json& answer, RunControl& control, std::size_t most_bytes)
        : run_(run),
          control_(control),
          most_bytes_(most_bytes) {
        find_placeholders(answer, lists_);
        // Allocated once: the allocator would keep the memory of smaller vectors.
        std::size_t all = 0, largest = 0;
        for (const Placeholder& list : lists_) {
            all += size_of(list);
            largest = std::max(largest, size_of(list));
        }
        bytes_.reserve(std::max(largest, std::min(all, most_bytes_)));
    }

    PackedList next() {
        if (next_ == end_) fill();
        const Placeholder& list = lists_[next_++];
        const std::size_t size = size_of(list);
        return {
            list.source().packing(),
            std::span(bytes_).subspan(std::exchange(at_, at_ + size), size)};
    }

private:
    std::size_t size_of(const Placeholder& list) const {
        return static_cast<std::size_t>(run_.listed.count) * entry_size(list.source().packing());
    }

    /// Generates the next lists, as many as fit into most_bytes_, by one run.
    void fill() {
        std::size_t bytes = 0;
        for (; end_ < lists_.size(); ++end_) {
            const std::size_t size = size_of(lists_[end_]);
            if (bytes > 0 && bytes + size > most_bytes_) break;
            bytes += size;
        }
        bytes_.resize(bytes);
        at_ = 0;
        const AnalysisRequest& w = run_.wanted;
        std::size_t k = 0;
        control_.begin();
        const bool complete = repeat_impacts(
            w.parameters, w.start,
            {.tau_end = w.tau_end,
             .max_impacts = w.max_impacts,
             .stop = [this] { return control_.stop_or_yield(); }},
            run_.listed, [&](const Impact& impact) {
                std::uint8_t* list = bytes_.data();
                for (std::size_t l = next_; l < end_; ++l) {
                    lists_[l].source().put(list, k, impact, run_.scales, lists_[l].factor);
                    list += size_of(lists_[l]);
                }
                ++k;
            });
        control_.end();
        if (!complete) throw Cancelled();
    }

    const ListedRun run_;
    RunControl& control_;
    const std::size_t most_bytes_;
    std::vector<Placeholder> lists_;
    std::size_t next_ = 0, end_ = 0;  // lists_ from next_ to end_ are in bytes_, from at_ on
    std::size_t at_ = 0;
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
