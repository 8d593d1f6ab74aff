#include "api/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "api/broken_off.hpp"
#include "api/text_encoding.hpp"
#include "api/units.hpp"

namespace vines::api {

namespace {

constexpr std::string_view blanks = " \t";
constexpr char by_blanks = ' ';
// A line with more cells is no line of a record.
constexpr std::size_t most_cells = 1000;

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

struct Line {
    std::size_t number = 0;  ///< from 1 on
    std::string_view text;
};

class Lines {
public:
    explicit Lines(std::string_view text) : rest_(text) {}

    std::optional<Line> next() {
        if (rest_.empty()) return std::nullopt;
        const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
        const Line line{++number_, rest_.substr(0, end)};
        const bool two = rest_.substr(end, 2) == "\r\n";
        rest_.remove_prefix(std::min(end + (two ? 2 : 1), rest_.size()));
        return line;
    }

private:
    std::string_view rest_;
    std::size_t number_ = 0;
};

/// Empty where the line is none.
std::string_view comment_of(std::string_view line) {
    line = trimmed(line);
    for (const std::string_view sign : {"#", "%", "//"})
        if (line.starts_with(sign)) return line.substr(sign.size());
    return {};
}

bool is_comment(std::string_view line) {
    line = trimmed(line);
    return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

struct Cell {
    std::string_view text;
    bool is_quoted = false;
};

/// The cells of a line into a list, without empty ones behind the last.
void split(std::string_view line, char separator, std::vector<Cell>& cells) {
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
    split(line, separator, cells);
    return cells;
}

/// None where the cell is no number.
std::optional<double> number_of(const Cell& cell, char separator) {
    std::string_view text = cell.text;
    std::string copy;
    if ((separator != ',' || cell.is_quoted) && text.find(',') != text.npos) {
        copy = text;
        std::replace(copy.begin(), copy.end(), ',', '.');
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

double number_in(const Cell& cell, char separator, std::size_t line, const std::string& column) {
    if (cell.text.empty()) fault(line, column, cell.text, "there is no number");
    const std::optional<double> value = number_of(cell, separator);
    if (!value) {
        std::string what = "\"";  // not operator+: g++ 12 warns of it at -O3, without a reason
        what.append(cell.text.substr(0, 40)).append("\" is no number");
        fault(line, column, cell.text, what);
    }
    if (!std::isfinite(*value)) fault(line, column, cell.text, "the number is not finite");
    return *value;
}

[[noreturn]] void fault_of_length(const Line& line, std::size_t cells, std::size_t columns) {
    fault(
        line.number, "", line.text,
        "has " + std::to_string(cells) + " columns, the header has " + std::to_string(columns));
}

bool has_number(const std::vector<Cell>& cells, char separator) {
    return std::any_of(cells.begin(), cells.end(), [separator](const Cell& c) {
        return number_of(c, separator).has_value();
    });
}

/// Told by its first character, and by whether anything separates: most lines that are none of
/// numbers need not be split.
bool may_be_numbers(std::string_view line, std::optional<char> said) {
    line = trimmed(line);
    constexpr std::string_view of_a_first_cell = "0123456789+-.,\"iInN";  // inf and nan, too
    return !line.empty() && of_a_first_cell.find(line[0]) != line.npos &&
           (said || line.find_first_of(";\t, ") != line.npos);
}

/// That by which the line is numbers, two or more.
std::optional<char> separator_of_numbers(std::string_view line, std::optional<char> said) {
    if (!may_be_numbers(line, said)) return std::nullopt;
    std::vector<Cell> cells;
    std::string separators = said ? std::string(1, *said) : ";\t,";
    if (!said) separators += by_blanks;
    for (const char separator : separators) {
        split(line, separator, cells);
        const auto is_number = [separator](const Cell& c) {
            return number_of(c, separator).has_value();
        };
        if (cells.size() > 1 && std::all_of(cells.begin(), cells.end(), is_number))
            return separator;
    }
    return std::nullopt;
}

/// What stands above the numbers.
class Heading {
public:
    /// A line that is no line of numbers.
    void take(const Line& line) {
        if (is_comment(line.text)) comment_ = {line.number, comment_of(line.text)};
        else before_ = std::exchange(last_, line);
        something_ = true;
    }
    bool has_something() const { return something_; }

    /// Named columns without values, for `count` cells; `first` is the first line of numbers.
    std::vector<CsvColumn> columns(const Line& first, std::size_t count, char separator) const {
        const std::vector<Cell> last = cells_of(last_.text, separator),
                                before = cells_of(before_.text, separator),
                                comment = cells_of(comment_.text, separator);
        const auto fits = [&](const std::vector<Cell>& cells) {
            return cells.size() == count && !has_number(cells, separator);
        };
        const auto are_units = [count](const std::vector<Cell>& cells) {
            return !cells.empty() && cells.size() <= count &&
                   std::all_of(
                       cells.begin(), cells.end(), [](const Cell& c) { return is_unit(c.text); });
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
            // Not the names, but the first line of the numbers, and at fault.
            const auto columns = named(before, {});
            for (std::size_t k = 0; k < count; ++k)
                number_in(last[k], separator, last_.number, columns[k].name);
        }
        if (!last.empty() && !has_number(last, separator))
            fault_of_length(first, count, last.size());
        fault(
            first.number, "", first.text,
            "a line above the numbers must name the columns, for example "
            "time_s,displacement_m,acceleration_m_s2");
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

    Line last_, before_, comment_;
    bool something_ = false;
};

/// Which decimal signs a record has: with both, one of them may group thousands.
class DecimalSigns {
public:
    void see(std::string_view number, std::size_t line, const std::string& column) {
        const std::size_t at = number.find_first_of(".,");
        if (at == number.npos) return;
        (number[at] == ',' ? comma_ : point_) = true;
        if (comma_ && point_)
            fault(line, column, number, "the record has decimal points and decimal commas");
    }

private:
    bool comma_ = false, point_ = false;
};

/// What a line like "sep=;" says, which spreadsheets write and read.
std::optional<char> said_separator(std::string_view line) {
    line = trimmed(line);
    if (line.size() != 5 || !(line.starts_with("sep=") || line.starts_with("SEP=")))
        return std::nullopt;
    return line[4];
}

}  // namespace

Csv parse_csv(std::string_view bytes, const Reading& reading) {
    StillWanted wanted = reading.wanted();
    std::size_t numbers = 0;
    std::string room;
    Lines lines(as_utf8(bytes, room));
    Csv csv;
    Heading heading;
    std::optional<char> said, separator;
    std::vector<Cell> cells;
    DecimalSigns signs;
    while (const auto line = lines.next()) {
        wanted.step();
        if (trimmed(line->text).empty()) continue;
        if (csv.columns.empty()) {
            if (!said && (said = said_separator(line->text))) continue;
            if (!is_comment(line->text)) separator = separator_of_numbers(line->text, said);
            if (!separator) {
                heading.take(*line);
                continue;
            }
            csv.columns =
                heading.columns(*line, cells_of(line->text, *separator).size(), *separator);
        } else if (is_comment(line->text)) {
            continue;
        }
        split(line->text, *separator, cells);
        if (cells.empty()) continue;
        if (cells.size() != csv.columns.size()) {
            // Empty cells are dropped at the end alone: what is missing there is named.
            if (cells.size() + 1 == csv.columns.size() && line->text.back() == *separator)
                cells.push_back({});
            else fault_of_length(*line, cells.size(), csv.columns.size());
        }
        if ((numbers += cells.size()) > reading.most_numbers)
            throw Problem(
                413, "the record has more than " + std::to_string(reading.most_numbers) +
                         " numbers: fewer samples, or fewer columns, tell as much");
        for (std::size_t k = 0; k < cells.size(); ++k) {
            wanted.step();
            csv.columns[k].values.push_back(
                number_in(cells[k], *separator, line->number, csv.columns[k].name));
            signs.see(cells[k].text, line->number, csv.columns[k].name);
        }
        csv.lines.push_back(static_cast<std::uint32_t>(line->number));
    }
    if (csv.columns.empty())
        throw Problem(
            422, heading.has_something()
                     ? "the record has no line of two or more numbers, separated by semicolons, "
                       "tabs, commas or blanks"
                     : "the record is empty: it needs a header and lines of numbers");
    return csv;
}

}  // namespace vines::api
