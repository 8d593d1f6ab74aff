#include "api/impact_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "api/column.hpp"
#include "api/object.hpp"

namespace vines::api {

namespace {

using Scales = ImpactScales;

/// A column's name and packing (numbers, integers or flags), and the number that an impact has in
/// it.
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

const ImpactColumn& column_of(const ListToCome& list) { return impact_columns[list.column]; }

/// The columns made by a function of theirs.
template <class Make>
Json describe(Make make) {
    Json columns = Json::object();
    make_room(columns, std::size(impact_columns));
    for (const ImpactColumn& column : impact_columns)
        append(columns, {{column.name, make(column)}});
    return columns;
}

void find_lists_to_come(const Json& json, std::vector<ListToCome>& lists) {
    if (packing_of(json) == Packed::to_come) lists.push_back(list_to_come(json));
    else if (json.is_structured())
        for (const Json& part : json) find_lists_to_come(part, lists);
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

Json describe_impacts_to_come() {
    return describe([](const ImpactColumn& column) {
        return to_come({static_cast<int>(&column - impact_columns), 1});
    });
}

ImpactLists::ImpactLists(
    const ListedRun& run, const Json& answer, Pace& pace, std::size_t most_bytes)
    : run_(run),
      pace_(pace),
      most_bytes_(most_bytes) {
    find_lists_to_come(answer, to_make_);
    std::size_t all = 0, largest = 0;
    for (const ListToCome& list : to_make_) {
        all += size_of(list);
        largest = std::max(largest, size_of(list));
    }
    bytes_.reserve(std::max(largest, std::min(all, most_bytes_)));
}

std::size_t ImpactLists::size_of(const ListToCome& list) const {
    return static_cast<std::size_t>(run_.listed.count) * entry_size(column_of(list).packing);
}

PackedList ImpactLists::list(const ListToCome&) {
    if (taken_ == made_.size()) make_next();
    const Made& made = made_[taken_++];
    return {column_of(made.list).packing, std::span(bytes_).subspan(made.at, size_of(made.list))};
}

void ImpactLists::make_next() {
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
    const Wanted& w = run_.wanted;
    long k = 0;
    pace_.begin();
    const bool complete = repeat_impacts(
        w.parameters, w.start,
        {.tau_end = w.tau_end,
         .max_impacts = w.max_impacts,
         .stop = [this] { return pace_.stop_or_yield(); }},
        run_.listed, [&](const Impact& impact) {
            for (const Made& to : made_) put(to, k, impact);
            ++k;
        });
    pace_.end();
    if (!complete) throw BrokenOff();
}

void ImpactLists::put(const Made& to, long k, const Impact& impact) {
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
