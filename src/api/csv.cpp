// Lines are read one by one. Those above the data go to Heading, which keeps the last comment and
// the last two other lines: they give names and units once the count of cells is known. Every data
// line must have that count of cells.
#include "api/csv.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <ctime>
#include <set>

#include "api/parse.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

constexpr std::string_view blanks = " \t";
constexpr char by_blanks = ' ';
// Longest line in cells.
constexpr std::size_t most_cells = 1000;

struct CsvLine {
    std::size_t number = 0;  ///< from 1
    std::string_view text;
};

/// Takes the first line, without its end, off a text.
std::string_view take_line(std::string_view& text) {
    const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
    const bool two = text.substr(line.size(), 2) == "\r\n";
    text.remove_prefix(std::min(line.size() + (two ? 2 : 1), text.size()));
    return line;
}

/// The text of a comment; nullopt for any other line.
std::optional<std::string_view> comment_of(std::string_view line) {
    line = trimmed(line);
    for (const std::string_view sign : {"#", "%", "//"})
        if (line.starts_with(sign)) return line.substr(sign.size());
    return std::nullopt;
}

struct Cell {
    std::string_view text;
    bool is_quoted = false;
};

/// Splits a line into cells, without trailing empty ones.
void split_cells(std::string_view line, char separator, std::vector<Cell>& cells) {
    cells.clear();
    const bool blank = separator == by_blanks;
    const auto end_of = [&](std::size_t from) {
        return std::min(
            blank ? line.find_first_of(blanks, from) : line.find(separator, from), line.size());
    };
    for (std::size_t from = 0; from <= line.size();) {
        while (from < line.size() && blanks.find(line[from]) != blanks.npos &&
               line[from] != separator)
            ++from;
        if (blank) from = std::min(line.find_first_not_of(blanks, from), line.size());
        const std::size_t quote =
            from < line.size() && line[from] == '"' ? line.find('"', from + 1) : line.npos;
        const bool is_quoted = quote != line.npos;
        const std::size_t end = end_of(is_quoted ? quote : from);
        const bool is_whole = is_quoted && trimmed(line.substr(quote + 1, end - quote - 1)).empty();
        const std::string_view text =
            is_whole ? line.substr(from + 1, quote - from - 1) : line.substr(from, end - from);
        cells.push_back({trimmed(text), is_whole});
        if (cells.size() > most_cells) return;
        from = end + 1;
    }
    while (!cells.empty() && cells.back().text.empty()) cells.pop_back();
}

std::vector<Cell> cells_of(std::string_view line, char separator) {
    std::vector<Cell> cells;
    split_cells(line, separator, cells);
    return cells;
}

/// Seconds of a time stamp hh:mm:ss, with a fraction or none, after a date yyyy-mm-dd (ISO 8601) or
/// none; nullopt for other text.
std::optional<double> seconds_of_stamp(std::string text) {
    std::tm time{};
    time.tm_year = 120, time.tm_mday = 1, time.tm_hour = -1;  // stays with too many digits
    const bool is_dated =
        text.size() > 10 && text[4] == '-' && (text[10] == ' ' || text[10] == 'T');
    if (is_dated) text[10] = 'T';
    if (text.ends_with('Z')) text.pop_back();
    const char* const end = text.data() + text.size();
    const char* rest = is_dated ? ::strptime(text.c_str(), "%Y-%m-%dT", &time) : text.c_str();
    if (!rest || !std::isdigit(static_cast<unsigned char>(*rest))) return std::nullopt;
    rest = std::from_chars(rest, end, time.tm_hour).ptr;  // 24 and more in elapsed time
    rest = ::strptime(rest, ":%M:%S", &time);
    double fraction = 0;
    if (!rest || time.tm_hour < 0) return std::nullopt;
    if (rest != end) {
        const auto [read, error] = std::from_chars(rest, end, fraction);
        if (*rest != '.' || error != std::errc() || read != end) return std::nullopt;
    }
    constexpr std::time_t origin = 1577836800;  // 2020: leaves more digits to the fraction
    return fraction + static_cast<double>(::timegm(&time) - origin);
}

/// nullopt if the cell is neither a number nor a time stamp.
std::optional<double> number_of(const Cell& cell, char separator) {
    std::string_view text = cell.text;
    std::string copy;
    if ((separator != ',' || cell.is_quoted) && text.find(',') != text.npos) {
        copy = text;
        std::replace(copy.begin(), copy.end(), ',', '.');
        text = copy;
    }
    if (text.find(':') != text.npos) return seconds_of_stamp(std::string(text));
    // Fortran's exponent
    if (const std::size_t at = text.find_first_of("dD"); at != text.npos && at > 0) {
        copy = text;
        copy[at] = 'e';
        text = copy;
    }
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double value;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

[[noreturn]] void fault(
    std::size_t line, const std::string& column, std::string_view value, const std::string& what) {
    const std::string shown(value.substr(0, 40)),
        name = shortened(column),
        where = "line " + std::to_string(line) + (name.empty() ? "" : ", column " + name);
    throw Problem(
        422, where + ": " + what,
        {{"/record/" + (name.empty() ? std::to_string(line) : name + "/" + std::to_string(line)),
          shown, nullptr, where + ": " + what}});
}

/// NaN for an empty cell.
double number_in(const Cell& cell, char separator, std::size_t line, const std::string& column) {
    if (cell.text.empty()) return nan;
    const std::optional<double> value = number_of(cell, separator);
    if (!value) {
        std::string what = "\"";  // not operator+: g++ 12 warns of it at -O3, without a reason
        what.append(cell.text.substr(0, 40)).append("\" is not a number");
        fault(line, column, cell.text, what);
    }
    if (!std::isfinite(*value)) fault(line, column, cell.text, "the number is not finite");
    return *value;
}

[[noreturn]] void fault_of_length(const CsvLine& line, std::size_t cells, std::size_t columns) {
    fault(
        line.number, "", line.text,
        "has " + std::to_string(cells) + " columns, the header has " + std::to_string(columns));
}

auto is_number_by(char separator) {
    return [separator](const Cell& c) { return number_of(c, separator).has_value(); };
}

bool has_number(const std::vector<Cell>& cells, char separator) {
    return std::ranges::any_of(cells, is_number_by(separator));
}

/// The separator that splits the line into two or more numbers.
std::optional<char> separator_of_numbers(std::string_view line, std::optional<char> declared) {
    std::string separators = declared ? std::string(1, *declared) : ";\t,";
    if (!declared) separators += by_blanks;
    for (const char separator : separators) {
        const std::vector<Cell> cells = cells_of(line, separator);
        if (cells.size() > 1 && std::ranges::all_of(cells, is_number_by(separator)))
            return separator;
    }
    return std::nullopt;
}

/// The lines above the data: names, units, comments.
class Heading {
public:
    /// Takes a line that is not data.
    void take(const CsvLine& line) {
        if (const auto comment = comment_of(line.text)) comment_ = {line.number, *comment};
        else before_ = std::exchange(last_, line);
    }
    /// Reports that there are no data.
    [[noreturn]] void refuse_empty() const {
        throw Problem(
            422, last_.number > 0 || comment_.number > 0
                     ? "the record has no line of two or more numbers, separated by semicolons, "
                       "tabs, commas or blanks"
                     : "the record is empty: it needs a header and lines of numbers");
    }

    /// Named empty columns for `count` cells; `first` is the first data line.
    std::vector<CsvColumn> columns(const CsvLine& first, std::size_t count, char separator) const {
        const std::vector<Cell> last = cells_of(last_.text, separator),
                                before = cells_of(before_.text, separator),
                                comment = cells_of(comment_.text, separator);
        const auto fits = [&](const std::vector<Cell>& cells) {
            return cells.size() == count && !has_number(cells, separator);
        };
        const auto are_units = [count](const std::vector<Cell>& cells) {
            return !cells.empty() && cells.size() <= count &&
                   std::ranges::all_of(cells, is_unit, &Cell::text);
        };
        if (fits(before) && are_units(last)) return named(before, last);
        if (fits(comment) && !are_units(comment) && are_units(last)) return named(comment, last);
        if (fits(last))
            return named(
                last, are_units(before)    ? before
                      : are_units(comment) ? comment
                                           : std::vector<Cell>());
        if (fits(comment)) return named(comment, {});
        if (last.size() == count && fits(before)) {
            // The last line is the first data line, with an invalid cell.
            const auto columns = named(before, {});
            for (std::size_t k = 0; k < count; ++k)
                number_in(last[k], separator, last_.number, columns[k].name);
        }
        if (!last.empty() && !has_number(last, separator))
            fault_of_length(first, count, last.size());
        std::vector<CsvColumn> numbered;
        for (std::size_t k = 1; k <= count; ++k) numbered.push_back({std::to_string(k), {}, {}});
        return numbered;
    }

private:
    static std::vector<CsvColumn> named(
        const std::vector<Cell>& names, const std::vector<Cell>& units) {
        std::vector<CsvColumn> columns;
        for (std::size_t k = 0; k < names.size(); ++k)
            columns.push_back(
                {std::string(names[k].text),
                 k < units.size() ? std::string(units[k].text) : std::string(),
                 {}});
        return columns;
    }

    CsvLine last_, before_, comment_;
};

/// The separator of a line "sep=;", which spreadsheets write and read.
std::optional<char> declared_separator(std::string_view line) {
    line = trimmed(line);
    if (line.size() != 5 || !(line.starts_with("sep=") || line.starts_with("SEP=")))
        return std::nullopt;
    return line[4];
}

bool is_text(const std::vector<Cell>& cells, char separator) {
    return !cells[0].text.empty() && std::isalpha(static_cast<unsigned char>(cells[0].text[0])) &&
           !has_number(cells, separator);
}

/// Restores dropped empty cells at the end, so that a missing last value is reported as such;
/// refuses any other wrong number of cells.
void complete_cells(
    std::vector<Cell>& cells, const CsvLine& line, std::size_t columns, char separator) {
    if (cells.size() < columns && line.text.back() == separator) cells.resize(columns);
    else if (cells.size() != columns) fault_of_length(line, cells.size(), columns);
}

}  // namespace

Csv parse_csv(std::string_view bytes, const ReadLimits& limits) {
    CancelCheck cancel = limits.check();
    std::size_t numbers = 0;
    std::string room;
    std::string_view rest = as_utf8(bytes, room);
    Csv csv;
    Heading heading;
    std::optional<char> declared, separator;
    std::vector<Cell> cells;
    bool has_points = false, has_commas = false;  // as decimal signs
    std::optional<CsvLine> footer;
    for (CsvLine line; !rest.empty();) {
        line = {line.number + 1, take_line(rest)};
        cancel.step();
        if (trimmed(line.text).empty()) continue;
        if (csv.columns.empty()) {
            if (!declared && (declared = declared_separator(line.text))) continue;
            if (!comment_of(line.text)) separator = separator_of_numbers(line.text, declared);
            if (!separator) {
                heading.take(line);
                continue;
            }
            csv.columns = heading.columns(line, cells_of(line.text, *separator).size(), *separator);
            const std::size_t rows = rest.size() / (line.text.size() + 1) + 2;
            for (CsvColumn& column : csv.columns) column.values.reserve(rows);
            csv.lines.reserve(rows);  // columns of a large record are not copied as they grow
        } else if (comment_of(line.text)) {
            continue;
        }
        split_cells(line.text, *separator, cells);
        if (cells.empty()) continue;
        if (is_text(cells, *separator)) {
            if (!footer) footer = line;
            continue;
        }
        if (footer) fault(footer->number, "", footer->text, "is text, but lines of numbers follow");
        complete_cells(cells, line, csv.columns.size(), *separator);
        if ((numbers += cells.size()) > limits.most_numbers)
            throw Problem(
                413, "the record has more than " + std::to_string(limits.most_numbers) +
                         " numbers; send fewer samples or columns");
        for (std::size_t k = 0; k < cells.size(); ++k) {
            cancel.step();
            const std::string_view text = cells[k].text;
            CsvColumn& column = csv.columns[k];
            column.values.push_back(number_in(cells[k], *separator, line.number, column.name));
            if (const std::size_t sign = text.find_first_of(".,"); sign != text.npos)
                (text[sign] == ',' ? has_commas : has_points) = true;
            // One of them could group thousands.
            if (has_points && has_commas)
                fault(
                    line.number, column.name, text,
                    "the record has decimal points and decimal commas");
        }
        csv.lines.push_back(static_cast<std::uint32_t>(line.number));
    }
    if (csv.columns.empty()) heading.refuse_empty();
    return csv;
}

void refuse_unnamed(const Csv& csv) {
    fault(
        csv.lines[0], "", csv.columns[0].name,
        "a line above the numbers must name the columns, for example "
        "time_s,displacement_m,acceleration_m_s2, or the request gives their positions: "
        "time_column = 1, displacement_column = 2");
}

void refuse_missing_numbers(const CsvColumn& column, const std::vector<std::uint32_t>& lines) {
    for (std::size_t k = 0; k < lines.size(); ++k)
        if (std::isnan(column.values[k])) fault(lines[k], column.name, "", "a number is missing");
}

std::string unit_spelling(std::string_view text) {
    if (text.size() > longest_unit) return "?";
    std::string spelling(text);
    for (const auto& [written, plain] :
         {std::pair("\u00b5", "u"), std::pair("\u03bc", "u"), std::pair("\u00b2", "2"),
          std::pair("\u207b", "-"), std::pair("\u00b7", "")})
        for (std::size_t at; (at = spelling.find(written)) != std::string::npos;)
            spelling.replace(at, std::string_view(written).size(), plain);
    std::erase_if(spelling, [](char c) {
        return std::string_view(" ^*()[]").find(c) != std::string_view::npos;
    });
    for (char& c : spelling) c = lower_case(c);
    return spelling;
}

bool is_foreign_unit(std::string_view text) {
    static const std::set<std::string, std::less<>> foreign = {
        "nm",    "cm",  "dm", "km", "mil", "in", "inch", "ft",  "us",
        "ns",    "min", "h",  "hz", "v",   "mv", "mg",   "gal", "cm/s2",
        "ft/s2", "s",   "ms", "m",  "mm",  "um", "g",    "m/s", "mm/s"};
    return foreign.contains(unit_spelling(text));
}

bool is_unit(std::string_view text) {
    static const std::set<std::string, std::less<>> others = {
        "",      "-",       "1",     "sec",   "msec",  "m/s2",   "m_s2", "ms-2",
        "m/s/s", "n",       "mm/s2", "mm_s2", "mms-2", "mm/s/s", "a",    "deg",
        "degc",  "\u00b0c", "k",     "pa",    "bar",   "%",      "rad",  "kn"};
    return is_foreign_unit(text) || others.contains(unit_spelling(text));
}

}  // namespace vines::api
