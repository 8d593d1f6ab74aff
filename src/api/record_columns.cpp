#include "api/record_columns.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>

#include "api/problem.hpp"
#include "api/schema/joined.hpp"

namespace vines::api {

const Quantity time_quantity{
    "time", "time_s", {"time", "t"}, {{"s", 1, {"s", "sec"}}, {"ms", 1e-3, {"ms", "msec"}}}};
const Quantity displacement_quantity{
    "displacement",
    "displacement_m",
    {"displacement", "x"},
    {{"m", 1, {"m"}}, {"mm", 1e-3, {"mm"}}, {"um", 1e-6, {"um"}}}};
const Quantity acceleration_quantity{
    "acceleration",
    "acceleration_m_s2",
    {"acceleration", "a"},
    // m/s^2, the standard gravity.
    {{"m/s2", 1, {"m/s2", "m_s2", "ms-2", "m/s/s"}}, {"g", 9.80665, {"g"}}}};

namespace {

std::string lower(std::string text) {
    std::transform(
        text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

/// As the spellings of units are written.
std::string spelling(std::string text) {
    for (const auto& [written, plain] :
         {std::pair("\u00b5", "u"), std::pair("\u03bc", "u"), std::pair("\u00b2", "2"),
          std::pair("\u207b", "-"), std::pair("\u00b7", "")})
        for (std::size_t at; (at = text.find(written)) != std::string::npos;)
            text.replace(at, std::string(written).size(), plain);
    std::erase_if(text, [](char c) { return c == ' ' || c == '^' || c == '*'; });
    return lower(text);
}

const Unit* known(const Quantity& q, const std::string& text) {
    const std::string written = spelling(text);
    const auto it = std::find_if(q.units.begin(), q.units.end(), [&](const Unit& u) {
        return std::find(u.spellings.begin(), u.spellings.end(), written) != u.spellings.end();
    });
    return it == q.units.end() ? nullptr : &*it;
}

/// What a column's name says after the quantity: in brackets, or behind a blank or underscore.
struct Suffix {
    std::string text;
    bool in_brackets;
};
std::optional<Suffix> suffix_of(const Quantity& q, const std::string& name) {
    const std::size_t open = name.find_first_of("([");
    if (open != std::string::npos) {
        const std::size_t close = name.find_first_of(")]", open);
        return Suffix{
            name.substr(open + 1, close == std::string::npos ? close : close - open - 1), true};
    }
    std::size_t last = std::string::npos;
    for (std::size_t at = name.find_first_of("_ "); at != std::string::npos;
         at = name.find_first_of("_ ", at + 1)) {
        // m_s2 before s2.
        if (known(q, name.substr(at + 1))) return Suffix{name.substr(at + 1), false};
        last = at;
    }
    if (last == std::string::npos) return {};
    const std::string text = name.substr(last + 1);
    const bool number =
        std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
    return number ? std::nullopt : std::optional(Suffix{text, false});
}

/// Units of a laboratory that no quantity here is read in.
bool is_foreign(const std::string& text) {
    static const std::set<std::string> foreign = {
        "nm",  "cm", "dm", "km", "mil", "in", "inch", "ft",    "us",    "ns",
        "min", "h",  "hz", "v",  "mv",  "mg", "gal",  "cm/s2", "mm/s2", "ft/s2",
        "s",   "ms", "m",  "mm", "um",  "g",  "m/s",  "mm/s"};
    return foreign.contains(spelling(text));
}

std::vector<std::string> unit_names(const Quantity& q) {
    std::vector<std::string> names;
    for (const Unit& u : q.units) names.push_back(u.name);
    return names;
}

double unit_factor(const Quantity& q, const Json& fields, const std::string& column) {
    const std::string field = q.name + "_unit";
    const Unit* asked = nullptr;
    if (fields.contains(field))
        asked = &*std::find_if(
            q.units.begin(), q.units.end(),
            [name = fields[field].get<std::string>()](const Unit& u) { return u.name == name; });
    const std::optional<Suffix> suffix = suffix_of(q, column);
    const Unit* said = suffix ? known(q, suffix->text) : nullptr;
    if (suffix && !said) {
        // A column that the request names may be called anything but by another unit.
        if (!suffix->in_brackets && fields.contains(q.name + "_column") &&
            !is_foreign(suffix->text))
            return (asked ? asked : &q.units[0])->factor;
        refuse(
            {{(Json::json_pointer("/record") / column).to_string(), suffix->text, unit_names(q),
              "column " + column + ": the unit \"" + suffix->text + "\" is not known; known are " +
                  joined(unit_names(q)) +
                  (suffix->in_brackets
                       ? ""
                       : ". If it is no unit, name the column in " + q.name + "_column")}});
    }
    if (said && asked && said != asked)
        refuse(
            {{"/" + field, fields[field], Json::array({said->name}),
              field + " is " + asked->name + ", but the column " + column + " says " +
                  said->name}});
    return (said ? said : asked ? asked : &q.units[0])->factor;
}

}  // namespace

RecordColumn find_column(
    const std::vector<CsvColumn>& columns, const Json& fields, const Quantity& q) {
    const auto found = [&](auto fits) {
        const auto it = std::find_if(columns.begin(), columns.end(), [&](const CsvColumn& c) {
            return fits(lower(c.name));
        });
        return it == columns.end() ? RecordColumn{nullptr, 1}
                                   : RecordColumn{&*it, unit_factor(q, fields, it->name)};
    };
    const std::string field = q.name + "_column";
    if (fields.contains(field)) {
        const std::string wanted = fields[field];
        const RecordColumn column =
            found([&](const std::string& name) { return name == lower(wanted); });
        if (column.column) return column;
        std::vector<std::string> names;
        for (const CsvColumn& c : columns) names.push_back(c.name);
        refuse({{"/" + field, wanted, names, "the record has no column of this name"}});
    }
    if (const RecordColumn column =
            found([&](const std::string& name) { return name == q.column; });
        column.column)
        return column;
    for (const std::string& beginning : q.beginnings) {
        const RecordColumn column = found([&](const std::string& name) {
            return name.rfind(beginning, 0) == 0 &&
                   (name == beginning ||
                    std::string("_ ([").find(name[beginning.size()]) != std::string::npos);
        });
        if (column.column) return column;
    }
    return {nullptr, 1};
}

}  // namespace vines::api
