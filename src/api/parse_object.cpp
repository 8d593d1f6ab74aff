#include "api/parse_object.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "api/broken_off.hpp"
#include "api/problem.hpp"

namespace vines::api {

namespace {

constexpr std::size_t deepest = 16;
// Of one object: several times as many as any request has.
constexpr std::size_t most_names = 1000;
// Of all: a record is made of numbers.
constexpr std::size_t most_texts = 10000;
// A longer list is made of pieces of so many values. They are as large as what serve() has mapped
// and unmapped one by one, so that the list is put together in place of them, not beside them.
constexpr std::size_t piece = std::size_t{1} << 18;
// Characters between two looks at whether the text is still wanted: some hundred microseconds.
constexpr std::size_t characters_between_looks = 8192;

[[noreturn]] void invalid(const std::string& what) {
    throw Problem(400, "the body is not valid JSON: " + what);
}

/// The characters of a text, for the library's parser: whatever it is doing, it comes for the next.
class Characters {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Characters(const char* at, const StillWanted& wanted) : at_(at), wanted_(&wanted) {}
    reference operator*() const { return *at_; }
    Characters& operator++() {
        ++at_;
        if (++steps_ % characters_between_looks == 0) wanted_->look();
        return *this;
    }
    bool operator==(const Characters& other) const { return at_ == other.at_; }

private:
    const char* at_;
    const StillWanted* wanted_;
    std::size_t steps_ = 0;
};

/// Takes what the library's parser finds, and puts it together. (Its own way to do so with a check
/// of each name looks through an array again for each element, and through an object for each
/// name.)
class Builder {
public:
    explicit Builder(const Reading& limits) : limits_(limits) {}

    bool null() { return add(nullptr); }
    bool boolean(bool value) { return add(value); }
    bool number_integer(Json::number_integer_t value) { return add(value); }
    bool number_unsigned(Json::number_unsigned_t value) { return add(value); }
    bool number_float(Json::number_float_t value, const std::string&) { return add(value); }
    bool string(std::string& value) {
        if (++texts_ > most_texts)
            throw Problem(400, fmt::format("the JSON text has more than {} texts", most_texts));
        return add(std::move(value));
    }
    bool binary(Json::binary_t&) { return false; }  // of formats other than JSON
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
        // The library's text is "[json.exception....] parse error at line 1, column 5: ..."; its
        // tag is of no use to anyone, and it may hold all of a text.
        const std::string what = e.what();
        invalid(shortened(what.substr(what.find("] ") + 2)));
    }

    Json take() { return std::move(whole_); }

private:
    struct Open {
        Json* value;
        std::unordered_set<std::string> names = {};
        std::vector<Json::array_t> pieces = {};  ///< of an array, those that are full
    };

    void count_part() {
        if (++parts_ > limits_.most_parts)
            throw Problem(
                413, fmt::format(
                         "the JSON text holds more than {} arrays, objects and names",
                         limits_.most_parts));
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

    /// The array of its pieces, each of which goes as its values do.
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

    /// Where it is kept: it stays there as long as it is open, because what holds it does not grow
    /// meanwhile.
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
        // Without a search for the name: it is new.
        auto& members = static_cast<Json::object_t::Container&>(holder.get_ref<Json::object_t&>());
        return members.emplace_back(std::move(name_), std::move(value)).second;
    }

    Json whole_;
    std::vector<Open> open_;  // objects and arrays, the outermost first
    std::string name_;
    const Reading& limits_;
    std::size_t texts_ = 0, numbers_ = 0, parts_ = 0;
};

}  // namespace

Json parse_object(std::string_view text, const Reading& reading) {
    // The library would take it for the end of the text.
    if (text.find('\0') != std::string_view::npos) invalid("it holds a NUL byte");
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        throw Problem(
            400, "the body is empty; send a JSON object of parameters, {} for the defaults");
    Builder builder(reading);
    const StillWanted wanted = reading.wanted();
    const char* const begin = text.data();
    Json::sax_parse(Characters(begin, wanted), Characters(begin + text.size(), wanted), &builder);
    Json object = builder.take();
    if (!object.is_object())
        throw Problem(
            400, "the body must be a JSON object, not " + std::string(object.type_name()));
    return object;
}

}  // namespace vines::api
