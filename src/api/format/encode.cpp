// Encodes an answer as JSON, CSV (its only table), CBOR or npz. CBOR (RFC 8949) has lists of
// numbers as typed arrays (RFC 8746): the JSON library writes a binary value's subtype as its tag.
// npz, for numpy.load, has a .npy file for each list of the answer, and answer.json with the rest.
#include "api/format/encode.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "api/cancellation.hpp"
#include "api/problem.hpp"

namespace vines::api {

namespace {

// Approximate size of a provenance without the request, in bytes.
constexpr std::size_t provenance_bytes = 1024;

std::string json_with_provenance(
    Json answer, const std::optional<Provenance>& provenance,
    const std::function<bool()>& gives_up) {
    std::string text;
    text.reserve(room_for_lists(answer) + provenance_bytes);
    const CancelCheck cancel(gives_up);
    write_sealed(answer, provenance, [&](std::string_view piece) {
        cancel.poll();
        text += piece;
    });
    return text;
}

// --- Lists ---

/// Replaces infinities, which stand for null here, by NaN, which readers expect.
void nan_for_null(std::span<std::uint8_t> doubles) {
    change_numbers(doubles, [](double number) {
        return std::isfinite(number) ? number : std::numeric_limits<double>::quiet_NaN();
    });
}

/// A list of numbers, flags or words. Refers to the JSON value, which must outlive it.
struct AnswerList {
    /// The entries as they lie in memory; NaN and infinities stand for null. Packed::no: words.
    PackedList packed{Packed::no, {}};
    Json own = {};                ///< packed copy of an array of numbers or flags
    const Json* words = nullptr;  ///< an array of strings and nulls

    std::size_t size() const {
        return words ? words->size() : packed.bytes.size() / entry_size(packed.packing);
    }
    /// Numbers in each entry: 1, 4 or 16.
    std::size_t width() const {
        return packed.packing == Packed::quadruples ? 4
               : packed.packing == Packed::matrices ? 16
                                                    : 1;
    }
    /// Empty for null.
    std::string_view word(std::size_t k) const {
        const auto* const word = (*words)[k].get_ptr<const std::string*>();
        return word ? std::string_view(*word) : "";
    }
};

/// The list of a packed value or of an array of numbers, flags or strings, nulls among them.
std::optional<AnswerList> list_of(const Json& value) {
    AnswerList list;
    const auto all_are = [&value](auto... is) {
        return std::ranges::all_of(
            value, [=](const Json& entry) { return ((entry.*is)() || ...); });
    };
    if (value.is_binary()) {
        list.packed = list_in_memory(value);
        return list;
    }
    if (!value.is_array()) return std::nullopt;
    if (all_are(&Json::is_number, &Json::is_null)) {
        list.own = column(value, [](const Json& entry) {
            return entry.is_null() ? std::numeric_limits<double>::quiet_NaN() : entry.get<double>();
        });
    } else if (all_are(&Json::is_boolean)) {
        list.own = column(value, [](const Json& entry) { return entry.get<bool>(); });
    } else if (all_are(&Json::is_string, &Json::is_null)) {
        list.words = &value;
        return list;
    } else {
        return std::nullopt;
    }
    list.packed = list_in_memory(list.own);
    return list;
}

// --- CSV ---

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
        std::optional<AnswerList> list = list_of(value);
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
    const std::vector<std::string> paths = texts_of(tables, &Table::path);
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

void put_csv(bool flag, std::string& text) { text += flag ? "true" : "false"; }
void put_csv(int number, std::string& text) { text += std::to_string(number); }
void put_csv(double number, std::string& text) {
    std::array<char, room_for_number> digits;
    if (std::isfinite(number)) text.append(digits.data(), write_number(digits.data(), number));
}
template <class Entry>
void put_csv(const std::array<Entry, 4>& entries, std::string& text) {
    for (const Entry& entry : entries) {
        if (&entry != entries.data()) text += ',';
        put_csv(entry, text);
    }
}
/// RFC 4180, 2.5 to 2.7.
void put_csv(std::string_view word, std::string& text) {
    if (word.find_first_of(",\"\r\n") == std::string_view::npos) {
        text += word;
        return;
    }
    text += '"';
    for (const char c : word) text.append(c == '"' ? 2 : 1, c);
    text += '"';
}

void put_csv_entry(const AnswerList& list, std::size_t row, std::string& text) {
    if (list.words) return put_csv(list.word(row), text);
    const std::size_t size = entry_size(list.packed.packing);
    const PackedList one{list.packed.packing, list.packed.bytes.subspan(row * size, size)};
    for_each_entry(one, [&text](const auto& entry) { put_csv(entry, text); });
}

/// The only table of an answer. A list of exponents has four columns, a list of matrices sixteen;
/// their numbers follow the name. Null is an empty cell.
std::string csv_text(const Json& answer, const std::function<bool()>& gives_up) {
    const Table table = only_table(answer);
    std::string text;
    text.reserve(room_for_lists(answer));
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

// --- CBOR ---

static_assert(
    std::endian::native == std::endian::little);  // required by the tags in answer_json.hpp

/// An entry of a list in its documented CBOR form: four doubles are a typed array.
template <class Entry>
Json cbor_of(const Entry& entry) {
    return entry;
}
Json cbor_of(const Quadruple& doubles) {
    Json typed_array = column(doubles);
    nan_for_null(typed_array.get_binary());
    return typed_array;
}
Json cbor_of(const MatrixByRows& rows) {
    return column(rows, [](const Quadruple& row) { return cbor_of(row); });
}

/// Turns packed lists into values that to_cbor() writes as documented.
void prepare(Json& value, const CancelCheck& cancel) {
    if (value.is_structured()) {
        for (Json& part : value) prepare(part, cancel);
        return;
    }
    if (!value.is_binary()) return;
    cancel.poll();
    const PackedList list = list_in_memory(value);
    if (list.packing == Packed::numbers) return nan_for_null(value.get_binary());
    if (list.packing == Packed::integers) return;
    Json array = Json::array();
    array.get_ref<Json::array_t&>().reserve(list.bytes.size() / entry_size(list.packing));
    for_each_entry(list, [&array](const auto& entry) { array.push_back(cbor_of(entry)); });
    value = std::move(array);
}

// --- npz ---

void put_little(std::string& to, std::uint64_t number, int bytes) {
    for (int k = 0; k < bytes; ++k) to += static_cast<char>(number >> (8 * k) & 0xff);
}

/// A ZIP archive of uncompressed files (PKWARE APPNOTE, 4.3).
class Archive {
public:
    /// bytes: an estimate of the files' size.
    explicit Archive(std::size_t bytes) { files_.reserve(bytes); }

    /// A file of these parts.
    void add(const std::string& name, std::initializer_list<std::string_view> parts) {
        uLong crc = 0;
        std::size_t size = 0;
        for (const std::string_view part : parts) {
            const auto* const data = reinterpret_cast<const Bytef*>(part.data());
            if (data)
                crc = ::crc32(crc, data, static_cast<uInt>(part.size()));  // null would reset it
            size += part.size();
        }
        std::string common;
        put_little(common, 20, 2);          // version needed to extract
        put_little(common, 0x0800, 2);      // names in UTF-8
        put_little(common, 0, 2);           // stored
        put_little(common, 0x00210000, 4);  // 1980-01-01: the same answer has the same bytes
        put_little(common, crc, 4);
        put_little(common, size, 4);
        put_little(common, size, 4);
        put_little(common, name.size(), 2);
        put_little(common, 0, 2);  // no extra field
        directory_ += "PK\x01\x02";
        put_little(directory_, 20, 2);
        directory_ += common;
        directory_.append(10, '\0');  // no comment, first disk, attributes
        put_little(directory_, files_.size(), 4);
        directory_ += name;
        files_ += "PK\x03\x04" + common + name;
        for (const std::string_view part : parts) files_ += part;
        ++number_;
    }
    std::string end() {
        std::string tail = "PK\x05\x06";
        put_little(tail, 0, 4);
        put_little(tail, number_, 2);
        put_little(tail, number_, 2);
        put_little(tail, directory_.size(), 4);
        put_little(tail, files_.size(), 4);
        put_little(tail, 0, 2);
        files_ += directory_ + tail;
        return std::move(files_);
    }

private:
    std::string files_, directory_;
    std::size_t number_ = 0;
};

/// Header of the NPY format, version 1.0, padded to a multiple of 64 bytes.
std::string npy_header(const std::string& type, const AnswerList& list) {
    const char* const entry = list.width() == 1 ? "" : list.width() == 4 ? " 4" : " 4, 4";
    std::string header = fmt::format(
        "{{'descr': '{}', 'fortran_order': False, 'shape': ({},{}), }}", type, list.size(), entry);
    constexpr std::size_t before = 10, step = 64;
    header.resize((before + header.size() + step) / step * step - before - 1, ' ');
    std::string file = "\x93NUMPY";
    put_little(file, 1, 2);
    put_little(file, header.size() + 1, 2);
    return file + header + '\n';
}

/// Strings in UCS-4. All strings of lists are ASCII.
void add_words(Archive& archive, const std::string& name, const AnswerList& list) {
    std::size_t longest = 1;
    for (std::size_t n = 0; n < list.size(); ++n) longest = std::max(longest, list.word(n).size());
    std::string data;
    for (std::size_t n = 0; n < list.size(); ++n) {
        std::string word(list.word(n));
        word.resize(longest);
        for (const char c : word) put_little(data, static_cast<unsigned char>(c), 4);
    }
    archive.add(name, {npy_header(fmt::format("<U{}", longest), list), data});
}

void add_list(Archive& archive, const std::string& name, const AnswerList& list) {
    if (list.words) return add_words(archive, name, list);
    const Packed packing = list.packed.packing;
    std::vector<std::uint8_t> bytes(list.packed.bytes.begin(), list.packed.bytes.end());
    if (packing != Packed::flags && packing != Packed::integers) nan_for_null(bytes);
    const char* const type = packing == Packed::flags      ? "|b1"
                             : packing == Packed::integers ? "<i4"
                                                           : "<f8";
    const auto* const data = reinterpret_cast<const char*>(bytes.data());
    archive.add(name, {npy_header(type, list), {data, bytes.size()}});
}

/// Calls visit(path, list) for each list but those of objects; a path joins names with points.
template <class Visit>
void visit_lists(const Json& answer, const Visit& visit, const std::string& path = "") {
    if (answer.is_object()) {
        for (const auto& [name, part] : answer.items())
            visit_lists(part, visit, path.empty() ? name : path + "." + name);
    } else if (const std::optional<AnswerList> list = list_of(answer)) {
        visit(path, *list);
    }
}

/// Removes the packed lists, which have their own files; lists of words stay in both.
void take_out_lists(Json& object) {
    std::vector<std::string> lists;
    for (auto& [name, value] : object.items()) {
        if (value.is_object()) take_out_lists(value);
        else if (value.is_binary()) lists.push_back(name);
    }
    for (const std::string& name : lists) object.erase(name);
}

// Usual size of what an answer has beside its lists, in bytes.
constexpr std::size_t room_for_rest = 16 << 10;

}  // namespace

const FormatName& name_of(Format format) {
    return format_names[static_cast<std::size_t>(format)];  // in the order of the enum
}

std::optional<Format> format_in(const Json& fields, std::span<const FormatName> names) {
    const auto given = fields.find("format");
    for (const FormatName& name : names)
        if (given != fields.end() && *given == name.word) return name.format;
    return std::nullopt;
}

void put_csv_value(const Json& value, std::string& text) {
    if (value.is_string()) put_csv(value.get_ref<const std::string&>(), text);
    else if (value.is_number_float()) put_csv(value.get<double>(), text);
    else if (!value.is_null()) text += value.dump();
}

std::string npz_bytes(
    Json answer, const std::function<bool()>& gives_up, const Json& only_in_files) {
    const CancelCheck cancel(gives_up);
    Archive archive(packed_bytes(answer) + packed_bytes(only_in_files) + room_for_rest);
    const auto add = [&](const std::string& path, const AnswerList& list) {
        cancel.poll();
        // Lists of the answer itself, as warnings, are in answer.json alone.
        if (path.find('.') != std::string::npos) add_list(archive, path + ".npy", list);
    };
    visit_lists(answer, add);
    visit_lists(only_in_files, add);
    take_out_lists(answer);
    archive.add("answer.json", {json_text(std::move(answer)), "\n"});
    return archive.end();
}

std::string cbor_bytes(Json answer, const std::function<bool()>& gives_up) {
    const CancelCheck cancel(gives_up);
    prepare(answer, cancel);
    std::string bytes;
    Json::to_cbor(answer, bytes);
    cancel.poll();
    return bytes;
}

std::size_t packed_bytes(const Json& answer) {
    if (answer.is_binary()) return answer.get_binary().size();
    std::size_t sum = 0;
    if (answer.is_structured())
        for (const Json& part : answer) sum += packed_bytes(part);
    return sum;
}

std::string encoded(
    Json answer, Format format, const std::optional<Provenance>& provenance,
    const std::function<bool()>& gives_up) {
    if (format == Format::json)
        return json_with_provenance(std::move(answer), provenance, gives_up);
    if (format == Format::csv) return csv_text(answer, gives_up);
    if (provenance) answer["provenance"] = describe(*provenance, content_sha256(answer));
    if (format == Format::cbor) return cbor_bytes(std::move(answer), gives_up);
    return npz_bytes(std::move(answer), gives_up);
}

}  // namespace vines::api
