// CSV: the one table of an answer.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "api/broken_off.hpp"
#include "api/format/encode.hpp"
#include "api/format/list.hpp"
#include "api/number_text.hpp"
#include "api/problem.hpp"
#include "api/schema/joined.hpp"

namespace vines::api {

namespace {

struct ToldColumn {
    std::string name;
    List list;
};

/// An object of lists of one length.
struct ToldTable {
    std::string path;
    std::vector<ToldColumn> columns;
};

/// The object itself, where it is one, and those in it.
void add_tables(const Json& object, const std::string& path, std::vector<ToldTable>& tables) {
    ToldTable table{.path = path, .columns = {}};
    bool is_table = !path.empty() && !object.empty();
    for (const auto& [name, value] : object.items()) {
        if (value.is_object()) add_tables(value, path.empty() ? name : path + "." + name, tables);
        std::optional<List> list = List::of(value);
        is_table = is_table && list &&
                   (table.columns.empty() || list->size() == table.columns[0].list.size());
        if (is_table) table.columns.push_back({name, std::move(*list)});
    }
    if (is_table) tables.push_back(std::move(table));
}

/// Problem 422 unless there is one.
ToldTable only_table(const Json& answer) {
    std::vector<ToldTable> tables;
    add_tables(answer, "", tables);
    if (tables.size() == 1) return std::move(tables[0]);
    std::vector<std::string> paths;
    for (const ToldTable& t : tables) paths.push_back(t.path);
    const std::string which =
        tables.empty() ? "none" : fmt::format("{}: {}", tables.size(), joined(paths));
    refuse(
        {{"/fields", nullptr, Json(paths),
          "CSV is one table, lists of one length, which fields names, as in fields=impacts or "
          "fields=matrices.tau,matrices.T; this answer has " +
              which}});
}

/// lambda1 ... lambda4 of four numbers, J11 ... J44 of a matrix.
void put_csv_names(const ToldColumn& column, std::string& text) {
    const std::size_t width = column.list.width();
    for (std::size_t k = 0; k < width; ++k) {
        if (k > 0) text += ',';
        text += column.name;
        if (width == 4) text += std::to_string(k + 1);
        if (width == 16) text += std::to_string(10 * (k / 4 + 1) + k % 4 + 1);
    }
}

void put_csv_number(double number, std::string& text) {
    std::array<char, room_for_number> digits;
    if (std::isfinite(number)) text.append(digits.data(), write_number(digits.data(), number));
}

/// RFC 4180, 2.5 to 2.7.
void put_csv_word(const std::string& word, std::string& text) {
    if (word.find_first_of(",\"\r\n") == std::string::npos) {
        text += word;
        return;
    }
    text += '"';
    for (const char c : word) text.append(c == '"' ? 2 : 1, c);
    text += '"';
}

void put_csv_entry(const List& list, std::size_t row, std::string& text) {
    if (list.packing() == Packed::no) return put_csv_word(list.words()[row], text);
    const std::uint8_t* const entry = list.bytes().data() + row * entry_size(list.packing());
    if (list.packing() == Packed::flags) {
        text += *entry ? "true" : "false";
    } else if (list.packing() == Packed::integers) {
        int number = 0;
        std::memcpy(&number, entry, sizeof number);
        text += std::to_string(number);
    } else {
        for (std::size_t k = 0; k < list.width(); ++k) {
            double number = 0;
            std::memcpy(&number, entry + k * sizeof number, sizeof number);
            if (k > 0) text += ',';
            put_csv_number(number, text);
        }
    }
}

}  // namespace

std::string csv_text(const Json& answer, const std::function<bool()>& gives_up) {
    const ToldTable table = only_table(answer);
    std::string text;
    for (const ToldColumn& column : table.columns) {
        if (!text.empty()) text += ',';
        put_csv_names(column, text);
    }
    text += '\n';
    StillWanted wanted(gives_up);
    for (std::size_t row = 0; row < table.columns[0].list.size(); ++row) {
        wanted.step();
        const std::size_t begins = text.size();
        for (const ToldColumn& column : table.columns) {
            if (&column != table.columns.data()) text += ',';
            put_csv_entry(column.list, row, text);
        }
        if (text.size() == begins) text += "\"\"";  // readers leave an empty line out
        text += '\n';
    }
    return text;
}

}  // namespace vines::api
