// CSV: the table of an answer.
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <utility>

#include "api/cancellation.hpp"
#include "api/format/answer_list.hpp"
#include "api/format/encode.hpp"
#include "api/problem.hpp"
#include "api/schema/field.hpp"

namespace vines::api {

namespace {

struct TableColumn {
    std::string name;
    AnswerList list;
};

/// An object of lists of one length.
struct Table {
    std::string path;
    std::vector<TableColumn> columns;
};

/// Adds the object, if it is a table, and the tables in it.
void add_tables(const Json& object, const std::string& path, std::vector<Table>& tables) {
    Table table{.path = path, .columns = {}};
    bool is_table = !path.empty() && !object.empty();
    for (const auto& [name, value] : object.items()) {
        if (value.is_object()) add_tables(value, path.empty() ? name : path + "." + name, tables);
        std::optional<AnswerList> list = AnswerList::of(value);
        is_table = is_table && list &&
                   (table.columns.empty() || list->size() == table.columns[0].list.size());
        if (is_table) table.columns.push_back({name, std::move(*list)});
    }
    if (is_table) tables.push_back(std::move(table));
}

/// The table of an answer. Problem 422 unless it has exactly one.
Table only_table(const Json& answer) {
    std::vector<Table> tables;
    add_tables(answer, "", tables);
    if (tables.size() == 1) return std::move(tables[0]);
    std::vector<std::string> paths;
    for (const Table& t : tables) paths.push_back(t.path);
    const std::string which =
        tables.empty() ? "none" : fmt::format("{}: {}", tables.size(), joined(paths));
    refuse(
        {{"/fields", nullptr, Json(paths),
          "CSV is one table, lists of equal length, selected by fields, for example fields=impacts "
          "or fields=matrices.tau,matrices.T; this answer has " +
              which}});
}

/// lambda1 ... lambda4 of four numbers, J11 ... J44 of a matrix.
void put_csv_names(const TableColumn& column, std::string& text) {
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

void put_csv_entry(const AnswerList& list, std::size_t row, std::string& text) {
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
    const Table table = only_table(answer);
    std::string text;
    for (const TableColumn& column : table.columns) {
        if (!text.empty()) text += ',';
        put_csv_names(column, text);
    }
    text += '\n';
    CancelCheck cancel(gives_up);
    for (std::size_t row = 0; row < table.columns[0].list.size(); ++row) {
        cancel.step();
        const std::size_t begins = text.size();
        for (const TableColumn& column : table.columns) {
            if (&column != table.columns.data()) text += ',';
            put_csv_entry(column.list, row, text);
        }
        if (text.size() == begins) text += "\"\"";  // CSV readers skip an empty line
        text += '\n';
    }
    return text;
}

void put_csv_value(const Json& value, std::string& text) {
    if (value.is_string()) put_csv_word(value.get_ref<const std::string&>(), text);
    else if (value.is_number_float()) put_csv_number(value.get<double>(), text);
    else if (!value.is_null()) text += value.dump();
}

}  // namespace vines::api
