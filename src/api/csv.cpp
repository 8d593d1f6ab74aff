#include "api/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vines::api {

namespace {

std::string_view trimmed(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || c == '\r' || c == '"' || c == '\t'; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return text;
}

std::vector<std::string_view> cells(std::string_view line, char separator) {
    std::vector<std::string_view> list;
    for (std::size_t from = 0;;) {
        const std::size_t at = std::min(line.find(separator, from), line.size());
        list.push_back(trimmed(line.substr(from, at - from)));
        if (at == line.size()) return list;
        from = at + 1;
    }
}

[[noreturn]] void fault(
    std::size_t line, const std::string& column, std::string_view value, const std::string& what) {
    const std::string shown(value.substr(0, 40)),
        where = "line " + std::to_string(line) + (column.empty() ? "" : ", column " + column);
    throw Problem(
        422, where + ": " + what,
        {{"/record/" +
              (column.empty() ? std::to_string(line) : column + "/" + std::to_string(line)),
          shown, nullptr, where + ": " + what}});
}

double number_in(
    std::string_view text, char separator, std::size_t line, const std::string& column) {
    std::string copy;
    if (separator != ',' && text.find(',') != std::string_view::npos) {
        copy = text;
        std::replace(copy.begin(), copy.end(), ',', '.');
        text = copy;
    }
    if (text.empty()) fault(line, column, text, "there is no number");
    if (text.front() == '+') text.remove_prefix(1);
    double value;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
        std::string what = "\"";  // not operator+: g++ 12 warns of it at -O3, without a reason
        what.append(text.substr(0, 40)).append("\" is no number");
        fault(line, column, text, what);
    }
    if (!std::isfinite(value)) fault(line, column, text, "the number is not finite");
    return value;
}

}  // namespace

std::vector<CsvColumn> parse_csv(std::string_view text) {
    if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);  // a byte order mark
    std::vector<CsvColumn> columns;
    char separator = ',';
    std::size_t number_of_line = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number_of_line;
        if (trimmed(line).empty() || line.front() == '#') continue;
        if (columns.empty()) {
            separator = line.find(';') != std::string_view::npos    ? ';'
                        : line.find('\t') != std::string_view::npos ? '\t'
                                                                    : ',';
            for (std::string_view name : cells(line, separator))
                columns.push_back({std::string(name), {}});
            double value;
            const std::string& first = columns[0].name;
            if (std::from_chars(first.data(), first.data() + first.size(), value).ec == std::errc())
                fault(
                    number_of_line, "", first,
                    "the first line must name the columns, for example "
                    "time_s,displacement_m,acceleration_m_s2");
            continue;
        }
        const auto parts = cells(line, separator);
        if (parts.size() != columns.size())
            fault(
                number_of_line, "", line,
                "has " + std::to_string(parts.size()) + " columns, the header has " +
                    std::to_string(columns.size()));
        for (std::size_t k = 0; k < parts.size(); ++k)
            columns[k].values.push_back(
                number_in(parts[k], separator, number_of_line, columns[k].name));
    }
    if (columns.empty())
        throw Problem(422, "the record is empty: it needs a header and lines of numbers");
    return columns;
}

}  // namespace vines::api
