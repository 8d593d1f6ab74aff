// Finds the column of a record that holds a channel, and its unit.
#include <algorithm>
#include <cctype>

#include "api/identify_parts.hpp"

namespace vines::api {

namespace {

/// Ignores case and does not copy: a name can be as long as a record.
bool is_same_name(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, {}, lower_case, lower_case);
}

/// True for this name, and for names that continue it after a separator.
bool begins_with(std::string_view name, std::string_view beginning) {
    return is_same_name(name.substr(0, beginning.size()), beginning) &&
           (name.size() == beginning.size() ||
            std::string_view("_ ([").find(name[beginning.size()]) != std::string_view::npos);
}

const Unit* known(const Channel& q, std::string_view text) {
    const std::string written = unit_spelling(text);
    for (const Unit& unit : q.units)
        if (std::ranges::count(unit.spellings, written) > 0) return &unit;
    return nullptr;
}

/// The unit part of a column's name: in brackets, or after a blank or underscore.
struct Suffix {
    std::string text;
    bool in_brackets;
};
std::optional<Suffix> suffix_of(const Channel& q, const std::string& name) {
    const std::size_t open = name.find_first_of("([");
    if (open != std::string::npos) {
        const std::size_t close = name.find_first_of(")]", open);
        return Suffix{
            name.substr(open + 1, close == std::string::npos ? close : close - open - 1), true};
    }
    // The name is a unit.
    if (known(q, name)) return Suffix{name, false};
    std::size_t last = name.find_last_of("_ ");
    // No unit is longer.
    const std::size_t from = name.size() > longest_unit ? name.size() - longest_unit - 1 : 0;
    for (std::size_t at = name.find_first_of("_ ", from); at != std::string::npos;
         at = name.find_first_of("_ ", at + 1)) {
        // The longest suffix first: m_s2 before s2.
        if (known(q, std::string_view(name).substr(at + 1)))
            return Suffix{name.substr(at + 1), false};
    }
    if (last == std::string::npos) return {};
    const std::string text = name.substr(last + 1);
    const bool number = std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c); });
    return number ? std::nullopt : std::optional(Suffix{text, false});
}

std::string pointer_to(const CsvColumn& column) {
    return (Json::json_pointer("/record") / shortened(column.name)).to_string();
}

/// `remark` follows the list of known units.
[[noreturn]] void refuse_unit(
    const Channel& q, const CsvColumn& column, const std::string& unit, const std::string& remark) {
    const std::string shown = shortened(unit);
    const std::vector<std::string> units = texts_of(q.units, &Unit::name);
    refuse(
        {{pointer_to(column), shown, units,
          "column " + shortened(column.name) + ": the unit \"" + shown +
              "\" is unknown; known units: " + joined(units) + remark}});
}

/// The unit in the column's name; null if none.
const Unit* unit_of_name(const Channel& q, const CsvColumn& column, bool named_by_request) {
    const std::optional<Suffix> suffix = suffix_of(q, column.name);
    if (!suffix) return nullptr;
    if (const Unit* named = known(q, suffix->text)) return named;
    // A column named by the request can have any suffix except another unit.
    if (!suffix->in_brackets && named_by_request && !is_foreign_unit(suffix->text)) return nullptr;
    refuse_unit(
        q, column, suffix->text,
        suffix->in_brackets ? ""
                            : ". If it is not a unit, name the column in " + q.name + "_column");
}

double unit_factor(const Channel& q, const Json& fields, const CsvColumn& column) {
    const std::string field = q.name + "_unit";
    const Unit* requested = nullptr;
    if (fields.contains(field))
        requested = &*std::ranges::find(q.units, fields[field].get<std::string>(), &Unit::name);
    const Unit* named = unit_of_name(q, column, fields.contains(q.name + "_column"));
    const Unit* const in_row = known(q, column.unit);
    if (!in_row && !unit_spelling(column.unit).empty()) refuse_unit(q, column, column.unit, "");
    if (named && in_row && named != in_row)
        refuse(
            {{pointer_to(column), shortened(column.unit), Json::array({named->name}),
              "column " + shortened(column.name) + " has the unit " + named->name +
                  ", but the row of units has " + in_row->name}});
    if (!named) named = in_row;
    if (named && requested && named != requested)
        refuse(
            {{"/" + field, fields[field], Json::array({named->name}),
              field + " is " + requested->name + ", but column " + shortened(column.name) +
                  " has the unit " + named->name}});
    return (named ? named : requested ? requested : &q.units[0])->factor;
}

}  // namespace

std::vector<std::string> names_of(const std::vector<CsvColumn>& columns) {
    return texts_of(columns, [](const CsvColumn& c) { return shortened(c.name); });
}

RecordColumn find_column(
    const std::vector<CsvColumn>& columns, const Json& fields, const Channel& q) {
    const auto found = [&](auto fits) {
        const auto it = std::ranges::find_if(columns, fits, &CsvColumn::name);
        return it == columns.end() ? RecordColumn{nullptr, 1}
                                   : RecordColumn{&*it, unit_factor(q, fields, *it)};
    };
    const std::string field = q.name + "_column";
    if (fields.contains(field)) {
        const std::string wanted = fields[field];
        RecordColumn column =
            found([&](std::string_view name) { return is_same_name(name, wanted); });
        // The name without its unit.
        if (!column.column)
            column = found([&](std::string_view name) {
                const auto suffix = suffix_of(q, std::string(name));
                return suffix && known(q, suffix->text) && begins_with(name, wanted);
            });
        if (column.column) return column;
        refuse({{"/" + field, wanted, names_of(columns), "the record has no column of this name"}});
    }
    if (const RecordColumn column =
            found([&](std::string_view name) { return is_same_name(name, q.column); });
        column.column)
        return column;
    for (const std::string& beginning : q.beginnings) {
        const auto fits = [&](std::string_view name) { return begins_with(name, beginning); };
        Json candidates = Json::array();
        for (const CsvColumn& c : columns)
            if (fits(c.name)) candidates.push_back(shortened(c.name));
        if (candidates.size() > 1)
            refuse(
                {{"/" + field, nullptr, candidates,
                  "several columns can be the " + q.quantity + ": choose one by " + field}});
        if (const RecordColumn column = found(fits); column.column) return column;
    }
    return {nullptr, 1};
}

}  // namespace vines::api
