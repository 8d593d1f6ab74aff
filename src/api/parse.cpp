// The JSON library's SAX parser reads the text through Characters, which polls for cancellation;
// Builder assembles the value and enforces the limits.
#include "api/parse.hpp"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <iterator>
#include <memory>
#include <unordered_set>

#include "api/problem.hpp"

namespace vines::api {

namespace {

constexpr std::size_t deepest = 16;
// Names in one object; requests have several times fewer.
constexpr std::size_t most_names = 1000;
// Strings in the whole text, and bytes of strings and names; a record holds numbers.
constexpr std::size_t most_texts = 10000, most_text_bytes = 4000000;
// Characters of one number and of one text. The library collects each before it hands it over, in a
// buffer that is doubled and copied.
constexpr std::size_t longest_number = 1000, longest_string = 1000000;
// Bytes of a piece of a packed column. serve() makes malloc map and unmap blocks of this size one
// by one, so that reading the pieces replaces their memory instead of doubling it.
constexpr std::size_t piece = std::size_t{4} << 20;
// Characters between two polls for cancellation: a few hundred microseconds.
constexpr std::size_t characters_between_polls = 8192;

[[noreturn]] void invalid(const std::string& what) {
    throw Problem(400, "the body is not valid JSON: " + what);
}

/// A problem if a text holds too many things; `has`: the subject and the verb.
void limit(
    std::size_t count, std::size_t most, const char* things, int status,
    const char* has = "the JSON text holds") {
    if (count > most) throw Problem(status, fmt::format("{} more than {} {}", has, most, things));
}

/// Input iterator for the library's parser that polls for cancellation and refuses long tokens.
class Characters {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Characters(const char* at, const CancelCheck& cancel) : at_(at), cancel_(&cancel) {}
    reference operator*() const { return *at_; }
    Characters& operator++() {
        measure(*at_++);
        if (++steps_ % characters_between_polls == 0) cancel_->poll();
        return *this;
    }
    bool operator==(const Characters& other) const { return at_ == other.at_; }

private:
    void measure(char c) {
        if (in_text_) {
            if (c == '"' && !escaped_) in_text_ = false, length_ = 0;
            else limit(++length_, longest_string, "bytes", 400, "the JSON text has a string of");
            escaped_ = c == '\\' && !escaped_;
            return;
        }
        const bool is_of_number = (c >= '+' && c <= '9' && c != ',') || c == 'e' || c == 'E';
        length_ = is_of_number ? length_ + 1 : 0;
        in_text_ = c == '"';
        limit(length_, longest_number, "characters", 400, "the JSON text has a number of");
    }

    const char* at_;
    const CancelCheck* cancel_;
    std::size_t steps_ = 0, length_ = 0;  // length of the text or number so far
    bool in_text_ = false, escaped_ = false;
};

/// SAX handler that builds the value. (The library's own handler with a check for repeated names
/// searches an array again for each element, and an object for each name.)
class Builder {
public:
    Builder(const ReadLimits& limits, Columns columns) : limits_(limits), columns_(columns) {}

    bool null() {
        count_value();
        if (in_column()) append(std::numeric_limits<double>::quiet_NaN());
        else place_other(nullptr);
        return true;
    }
    bool boolean(bool value) {
        count_value();
        place_other(value);
        return true;
    }
    bool number_integer(Json::number_integer_t value) { return number(value); }
    bool number_unsigned(Json::number_unsigned_t value) { return number(value); }
    bool number_float(Json::number_float_t value, const std::string&) { return number(value); }
    bool string(std::string& value) {
        limit(++texts_, most_texts, "strings", 400, "the JSON text has");
        count_text(value);
        count_value();
        place_other(std::move(value));
        return true;
    }
    bool binary(Json::binary_t&) { return false; }  // not a type of JSON text
    bool start_object(std::size_t) { return open(Json::object()); }
    bool end_object() { return close(); }
    bool start_array(std::size_t) { return open(Json::array()); }
    bool end_array() { return close(); }

    bool key(std::string& name) {
        std::unordered_set<std::string>& names = open_.back().names;
        limit(names.size() + 1, most_names, "names", 400, "an object of the JSON text has");
        count_text(name);
        if (!names.insert(name).second)
            throw Problem(
                400, "the name \"" + shortened(name) + "\" comes twice in the same JSON object");
        count_part();
        name_ = std::move(name);
        return true;
    }

    template <class Exception>
    bool parse_error(std::size_t, const std::string&, const Exception& e) {
        // The library's text is "[json.exception....] parse error at line 1, column 5: ...". The
        // tag is dropped; the rest is shortened, since it can quote a whole string.
        const std::string what = e.what();
        invalid(shortened(what.substr(what.find("] ") + 2)));
    }

    Json take() { return std::move(whole_); }

private:
    enum class Holder : std::uint8_t { other, measurement, column };
    struct Open {
        Json* value;
        Holder holder;
        std::unordered_set<std::string> names = {};
    };

    bool in_column() const { return !open_.empty() && open_.back().holder == Holder::column; }

    void count_part() {
        limit(++parts_, limits_.most_containers, "arrays, objects and names", 413);
    }
    void count_value() { limit(++numbers_, limits_.most_numbers, "numbers", 413); }
    void count_text(const std::string& text) {
        limit(
            text_bytes_ += text.size(), most_text_bytes, "bytes", 400,
            "the strings and names of the JSON text have");
    }

    template <class Number>
    bool number(Number value) {
        count_value();
        if (in_column()) append(static_cast<double>(value));
        else place_other(value);
        return true;
    }

    /// Appends a number to the column.
    void append(double value) {
        const std::size_t at = packed_.size();
        packed_.resize(at + sizeof value);
        std::memcpy(packed_.data() + at, &value, sizeof value);
        if (packed_.size() == piece) end_piece();
    }
    void end_piece() {
        if (packed_.empty()) return;
        open_.back().value->push_back(
            Json::binary(std::move(packed_), static_cast<std::uint8_t>(Packed::numbers)));
        packed_ = {};
    }

    /// Stores a value that is no number of a column. Beyond the limit none is shown: the reader of
    /// the request refuses other fields, and a measurement after the first errors.
    void place_other(Json value) {
        if (columns_ == Columns::packed && !in_column()) {
            const bool is_measured = open_.size() > 1 && open_[1].holder == Holder::measurement;
            std::size_t& others = is_measured ? measured_others_ : others_;
            if (others > limits_.most_other_values) return;
            ++others;
        }
        place(std::move(value));
    }

    Holder holder_of(const Json& value) const {
        if (columns_ == Columns::as_values) return Holder::other;
        if (open_.size() == 1 && (name_ == "record" || name_ == "impacts"))
            return Holder::measurement;
        const bool is_column = open_.size() == 2 && open_[1].holder == Holder::measurement &&
                               open_[1].value->is_object() && value.is_array();
        return is_column ? Holder::column : Holder::other;
    }

    bool open(Json value) {
        if (open_.size() >= deepest)
            throw Problem(
                400, fmt::format("the JSON text is nested deeper than {} levels", deepest));
        count_part();
        const Holder holder = holder_of(value);
        open_.push_back({&place(std::move(value)), holder});
        if (holder == Holder::column) faults_ = 0;
        return true;
    }

    bool close() {
        if (in_column()) end_piece();
        open_.pop_back();
        return true;
    }

    /// Stores a value and returns its address, which stays valid while the value is open, since its
    /// container does not grow meanwhile.
    Json& place(Json value) {
        if (open_.empty()) return whole_ = std::move(value);
        if (in_column()) {
            // No more errors are reported.
            if (++faults_ > most_errors) {
                append(std::numeric_limits<double>::quiet_NaN());
                return dropped_ = std::move(value);
            }
            end_piece();
        }
        Json& holder = *open_.back().value;
        if (holder.is_array())
            return holder.get_ref<Json::array_t&>().emplace_back(std::move(value));
        // key() has checked that the name is new; no search is needed.
        auto& members = static_cast<Json::object_t::Container&>(holder.get_ref<Json::object_t&>());
        return members.emplace_back(std::move(name_), std::move(value)).second;
    }

    Json whole_, dropped_;
    std::vector<Open> open_;  // objects and arrays, the outermost first
    std::string name_;
    std::vector<std::uint8_t> packed_;  // numbers of the column that no piece holds yet
    const ReadLimits& limits_;
    const Columns columns_;
    std::size_t texts_ = 0, text_bytes_ = 0, numbers_ = 0, parts_ = 0;
    std::size_t others_ = 0, measured_others_ = 0;  // values outside and inside a measurement
    std::size_t faults_ = 0;                        // values of the column that are no numbers
};

/// Appends the text to `text` unless that is null; false if the bytes are invalid in that encoding.
bool convert(std::string_view bytes, const char* encoding, std::string* text) {
    const iconv_t opened = iconv_open("UTF-8", encoding);
    if (opened == reinterpret_cast<iconv_t>(-1)) return false;
    const std::unique_ptr<std::remove_pointer_t<iconv_t>, int (*)(iconv_t)> converter(
        opened, &iconv_close);
    // The longest text: two bytes for one of Latin-1, three for two of UTF-16.
    if (text) text->reserve(2 * bytes.size());
    std::array<char, 4096> piece;
    char* from = const_cast<char*>(bytes.data());  // iconv only reads it
    std::size_t left = bytes.size();
    for (;;) {
        char* to = piece.data();
        std::size_t room = piece.size();
        const bool whole =
            iconv(converter.get(), &from, &left, &to, &room) != static_cast<std::size_t>(-1);
        if (text) text->append(piece.data(), piece.size() - room);
        if (whole) return true;
        if (errno != E2BIG) return false;
    }
}

/// A fast test: most texts are ASCII.
bool is_ascii(std::string_view bytes) {
    return std::ranges::all_of(bytes, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

const char* encoding_of(std::string_view bytes) {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\xff\xfe"sv) || bytes.starts_with("\xfe\xff"sv)) return "UTF-16";
    if (bytes.size() >= 4 && bytes[1] == 0 && bytes[3] == 0) return "UTF-16LE";
    if (bytes.size() >= 4 && bytes[0] == 0 && bytes[2] == 0) return "UTF-16BE";
    return "UTF-8";
}

std::string decoded(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned char byte = 0;
        const char* const digits = text.data() + std::min(i + 1, text.size());
        const char* const end = text.data() + std::min(i + 3, text.size());
        if (text[i] == '%' && end - digits == 2 &&
            std::from_chars(digits, end, byte, 16).ptr == end) {
            out += static_cast<char>(byte);
            i += 2;
        } else {
            out += text[i] == '+' ? ' ' : text[i];
        }
    }
    return out;
}

/// Problem 400 if `whole`, the full name in the query, is repeated.
void add_text(
    Json& object, const std::string& whole, const FieldTable& table, const std::string& name,
    const std::string& text) {
    if (!object.is_object() || object.contains(name))
        throw Problem(400, "the name \"" + whole + "\" comes twice in the query");
    const Field* f = find(table, name);
    object[name] = f ? value_of_text(f->type, text) : Json(text);
}

}  // namespace

Json parse_object(std::string_view text, const ReadLimits& limits, Columns columns) {
    // The library would treat a NUL as the end of the text.
    if (text.find('\0') != std::string_view::npos) invalid("it holds a NUL byte");
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        throw Problem(
            400, "the body is empty; send a JSON object of parameters, {} for the defaults");
    Builder builder(limits, columns);
    const CancelCheck cancel = limits.check();
    const char* const begin = text.data();
    Json::sax_parse(Characters(begin, cancel), Characters(begin + text.size(), cancel), &builder);
    Json object = builder.take();
    if (!object.is_object())
        throw Problem(
            400, "the body must be a JSON object, not " + std::string(object.type_name()));
    return object;
}

std::size_t entries_of(const Json& list) {
    std::size_t all = 0;
    for (const Json& entry : list)
        all +=
            packing_of(entry) == Packed::numbers ? entry.get_binary().size() / sizeof(double) : 1;
    return all;
}

bool is_utf8(std::string_view bytes) { return is_ascii(bytes) || convert(bytes, "UTF-8", nullptr); }

std::string_view as_utf8(std::string_view bytes, std::string& room) {
    const std::string_view encoding = encoding_of(bytes);
    if (encoding == "UTF-8") {
        if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
        if (is_utf8(bytes)) return bytes;
    }
    if (encoding != "UTF-8" && convert(bytes, encoding.data(), &room)) return room;
    room.clear();
    convert(bytes, "ISO-8859-1", &room);
    return room;
}

Query parse_query(std::string_view text) {
    Query pairs;
    while (!text.empty()) {
        const std::string_view part = text.substr(0, text.find('&'));
        text.remove_prefix(std::min(text.size(), part.size() + 1));
        if (part.empty()) continue;
        const std::size_t equals = std::min(part.find('='), part.size());
        pairs.emplace_back(
            decoded(part.substr(0, equals)),
            decoded(part.substr(std::min(equals + 1, part.size()))));
    }
    return pairs;
}

Json from_query(const FieldTable& table, const Query& query) {
    Json object = Json::object();
    for (const auto& [name, text] : query) {
        if (!is_utf8(name) || !is_utf8(text))
            throw Problem(400, "the query is not in UTF-8: " + shortened(name));
        const std::size_t point = name.find('.');
        const std::string outer = name.substr(0, point);
        const Field* f = point == std::string::npos ? nullptr : find(table, outer);
        if (!f || f->fields.empty()) {
            add_text(object, name, table, name, text);
            continue;
        }
        if (!object.contains(outer)) object[outer] = Json::object();
        add_text(object[outer], name, f->fields, name.substr(point + 1), text);
    }
    return object;
}

}  // namespace vines::api
