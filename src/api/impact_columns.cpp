#include "api/impact_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "api/answer_json.hpp"

namespace vines::api {

namespace {

using Scales = ImpactScales;

/// A column's name, its packing (numbers, integers or flags), and its value for an impact.
struct ImpactColumn {
    const char* name;
    Packed packing;
    double (*of)(const Impact&, const Scales&);
};

constexpr ImpactColumn impact_columns[] = {
    {"tau", Packed::numbers, [](const Impact& i, const Scales&) { return i.tau; }},
    {"side", Packed::integers,
     [](const Impact& i, const Scales&) { return static_cast<double>(i.side); }},
    {"phase", Packed::numbers, [](const Impact& i, const Scales&) { return i.phase(); }},
    {"x", Packed::numbers, [](const Impact& i, const Scales&) { return i.x; }},
    {"x_dot_before", Packed::numbers,
     [](const Impact& i, const Scales&) { return i.x_dot_before; }},
    {"x_dot_after", Packed::numbers, [](const Impact& i, const Scales&) { return i.x_dot_after; }},
    {"y_dot_before", Packed::numbers,
     [](const Impact& i, const Scales&) { return i.y_dot_before; }},
    {"y_dot_after", Packed::numbers, [](const Impact& i, const Scales&) { return i.y_dot_after; }},
    {"x_ddot_before", Packed::numbers,
     [](const Impact& i, const Scales&) { return i.x_ddot_before; }},
    {"relative_speed", Packed::numbers,
     [](const Impact& i, const Scales&) { return std::abs(i.relative_speed_before); }},
    {"impulse", Packed::numbers,
     [](const Impact& i, const Scales& s) { return i.impulse(s.epsilon); }},
    {"relative_speed_ratio", Packed::numbers,
     [](const Impact& i, const Scales& s) {
         return std::abs(i.relative_speed_before) / s.typical_speed;
     }},
    {"grazing", Packed::flags, [](const Impact& i, const Scales&) { return i.grazing ? 1. : 0.; }},
};

const ImpactColumn& column_of(const StreamedList& list) { return impact_columns[list.column]; }

/// Columns made by make(column).
template <class Make>
Json describe(Make make) {
    Json columns = Json::object();
    make_room(columns, std::size(impact_columns));
    for (const ImpactColumn& column : impact_columns)
        append(columns, {{column.name, make(column)}});
    return columns;
}

void find_streamed_lists(const Json& json, std::vector<StreamedList>& lists) {
    if (packing_of(json) == Packed::streamed) lists.push_back(streamed_list(json));
    else if (json.is_structured())
        for (const Json& part : json) find_streamed_lists(part, lists);
}

template <class Entry>
void put_entry(std::uint8_t* list, long k, Entry entry) {
    std::memcpy(list + static_cast<std::size_t>(k) * sizeof entry, &entry, sizeof entry);
}

}  // namespace

Json describe_impacts(const std::vector<Impact>& impacts, const ImpactScales& scales) {
    return describe([&](const ImpactColumn& c) {
        switch (c.packing) {
            case Packed::integers:
                return column(
                    impacts, [&](const Impact& i) { return static_cast<int>(c.of(i, scales)); });
            case Packed::flags:
                return column(impacts, [&](const Impact& i) { return c.of(i, scales) != 0; });
            default: return column(impacts, [&](const Impact& i) { return c.of(i, scales); });
        }
    });
}

Json describe_streamed_impacts() {
    return describe([](const ImpactColumn& column) {
        return streamed({static_cast<int>(&column - impact_columns), 1});
    });
}

StreamedImpacts::StreamedImpacts(
    const ListedRun& run, const Json& answer, RunControl& control, std::size_t most_bytes)
    : run_(run),
      control_(control),
      most_bytes_(most_bytes) {
    find_streamed_lists(answer, to_make_);
    std::size_t all = 0, largest = 0;
    for (const StreamedList& list : to_make_) {
        all += size_of(list);
        largest = std::max(largest, size_of(list));
    }
    bytes_.reserve(std::max(largest, std::min(all, most_bytes_)));
}

std::size_t StreamedImpacts::size_of(const StreamedList& list) const {
    return static_cast<std::size_t>(run_.listed.count) * entry_size(column_of(list).packing);
}

PackedList StreamedImpacts::list(const StreamedList&) {
    if (taken_ == made_.size()) make_next();
    const Made& made = made_[taken_++];
    return {column_of(made.list).packing, std::span(bytes_).subspan(made.at, size_of(made.list))};
}

void StreamedImpacts::make_next() {
    made_.clear();
    taken_ = 0;
    std::size_t end = 0;
    for (; next_ < to_make_.size(); ++next_) {
        const std::size_t size = size_of(to_make_[next_]);
        if (end > 0 && end + size > most_bytes_) break;
        made_.push_back({to_make_[next_], end});
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
            for (const Made& to : made_) put(to, k, impact);
            ++k;
        });
    control_.end();
    if (!complete) throw Cancelled();
}

void StreamedImpacts::put(const Made& to, long k, const Impact& impact) {
    const ImpactColumn& column = column_of(to.list);
    const double number = column.of(impact, run_.scales);
    std::uint8_t* const list = bytes_.data() + to.at;
    switch (column.packing) {
        case Packed::integers: return put_entry(list, k, static_cast<int>(number));
        case Packed::flags: return put_entry(list, k, number != 0);
        default: return put_entry(list, k, number * to.list.factor);
    }
}

}  // namespace vines::api
