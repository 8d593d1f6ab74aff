// The JSON library's SAX parser reads the text through Characters, which polls for cancellation;
// Builder assembles the value and enforces the limits.
#include "api/parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "api/cancellation.hpp"
#include "api/problem.hpp"
#include "api/schema/field.hpp"
#include "api/text_encoding.hpp"

namespace vines::api {

namespace {

constexpr std::size_t deepest = 16;
// Names in one object; requests have several times fewer.
constexpr std::size_t most_names = 1000;
// Strings in the whole text; a record holds numbers.
constexpr std::size_t most_texts = 10000;
// Characters of one number and of one text. The library collects each before it hands it over, in a
// buffer that is doubled and copied.
constexpr std::size_t longest_number = 1000, longest_string = 1000000;
// Longer lists are built in pieces of this size. serve() makes malloc map and unmap blocks of this
// size one by one, so that joining the pieces replaces their memory instead of doubling it.
constexpr std::size_t piece = std::size_t{1} << 18;
// Characters between two polls for cancellation: a few hundred microseconds.
constexpr std::size_t characters_between_polls = 8192;

[[noreturn]] void invalid(const std::string& what) {
    throw Problem(400, "the body is not valid JSON: " + what);
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
        limit(*at_++);
        if (++steps_ % characters_between_polls == 0) cancel_->poll();
        return *this;
    }
    bool operator==(const Characters& other) const { return at_ == other.at_; }

private:
    void limit(char c) {
        if (in_text_) {
            if (++length_ > longest_string)
                throw Problem(
                    400, fmt::format(
                             "the JSON text has a string of more than {} bytes", longest_string));
            if (c == '"' && !escaped_) in_text_ = false, length_ = 0;
            escaped_ = c == '\\' && !escaped_;
            return;
        }
        const bool is_of_number = (c >= '+' && c <= '9' && c != ',') || c == 'e' || c == 'E';
        length_ = is_of_number ? length_ + 1 : 0;
        in_text_ = c == '"';
        if (length_ > longest_number)
            throw Problem(
                400, fmt::format(
                         "the JSON text has a number of more than {} characters", longest_number));
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
    explicit Builder(const ReadLimits& limits) : limits_(limits) {}

    bool null() { return add(nullptr); }
    bool boolean(bool value) { return add(value); }
    bool number_integer(Json::number_integer_t value) { return add(value); }
    bool number_unsigned(Json::number_unsigned_t value) { return add(value); }
    bool number_float(Json::number_float_t value, const std::string&) { return add(value); }
    bool string(std::string& value) {
        if (++texts_ > most_texts)
            throw Problem(400, fmt::format("the JSON text has more than {} strings", most_texts));
        return add(std::move(value));
    }
    bool binary(Json::binary_t&) { return false; }  // not a type of JSON text
    bool start_object(std::size_t) { return open(Json::object()); }
    bool end_object() { return close(); }
    bool start_array(std::size_t) { return open(Json::array()); }
    bool end_array() { return close(); }

    bool key(std::string& name) {
        std::unordered_set<std::string>& names = open_.back().names;
        if (names.size() >= most_names)
            throw Problem(
                400, fmt::format("an object of the JSON text has more than {} names", most_names));
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
    struct Open {
        Json* value;
        std::unordered_set<std::string> names = {};
        std::vector<Json::array_t> pieces = {};  ///< full pieces of an array
    };

    void count_part() {
        if (++parts_ > limits_.most_containers)
            throw Problem(
                413, fmt::format(
                         "the JSON text holds more than {} arrays, objects and names",
                         limits_.most_containers));
    }

    bool add(Json value) {
        if (++numbers_ > limits_.most_numbers)
            throw Problem(
                413, fmt::format("the JSON text holds more than {} numbers", limits_.most_numbers));
        place(std::move(value));
        return true;
    }

    bool open(Json value) {
        if (open_.size() >= deepest)
            throw Problem(
                400, fmt::format("the JSON text is nested deeper than {} levels", deepest));
        count_part();
        open_.push_back({&place(std::move(value))});
        return true;
    }

    bool close() {
        if (!open_.back().pieces.empty()) join(open_.back());
        open_.pop_back();
        return true;
    }

    /// Joins the pieces of an array, freeing each after its values are moved.
    static void join(Open& open) {
        auto& rest = open.value->get_ref<Json::array_t&>();
        open.pieces.push_back(std::move(rest));
        Json::array_t whole;
        whole.reserve((open.pieces.size() - 1) * piece + open.pieces.back().size());
        for (Json::array_t& values : open.pieces) {
            std::move(values.begin(), values.end(), std::back_inserter(whole));
            Json::array_t().swap(values);
        }
        rest = std::move(whole);
    }

    /// Stores a value and returns its address, which stays valid while the value is open, since its
    /// container does not grow meanwhile.
    Json& place(Json value) {
        if (open_.empty()) return whole_ = std::move(value);
        Json& holder = *open_.back().value;
        if (holder.is_array()) {
            auto& values = holder.get_ref<Json::array_t&>();
            if (values.size() == piece) {
                open_.back().pieces.push_back(std::move(values));
                values = {};
                values.reserve(piece);
            }
            return values.emplace_back(std::move(value));
        }
        // key() has checked that the name is new; no search is needed.
        auto& members = static_cast<Json::object_t::Container&>(holder.get_ref<Json::object_t&>());
        return members.emplace_back(std::move(name_), std::move(value)).second;
    }

    Json whole_;
    std::vector<Open> open_;  // objects and arrays, the outermost first
    std::string name_;
    const ReadLimits& limits_;
    std::size_t texts_ = 0, numbers_ = 0, parts_ = 0;
};

}  // namespace

Json parse_object(std::string_view text, const ReadLimits& limits) {
    // The library would treat a NUL as the end of the text.
    if (text.find('\0') != std::string_view::npos) invalid("it holds a NUL byte");
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        throw Problem(
            400, "the body is empty; send a JSON object of parameters, {} for the defaults");
    Builder builder(limits);
    const CancelCheck cancel = limits.check();
    const char* const begin = text.data();
    Json::sax_parse(Characters(begin, cancel), Characters(begin + text.size(), cancel), &builder);
    Json object = builder.take();
    if (!object.is_object())
        throw Problem(
            400, "the body must be a JSON object, not " + std::string(object.type_name()));
    return object;
}

namespace {

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

}  // namespace

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

namespace {

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
