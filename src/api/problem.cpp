#include "api/problem.hpp"

#include <fmt/format.h>

#include <set>

namespace vines::api {

namespace {

constexpr int deepest = 16;
// Of one object: several times as many as any request has. Each name is compared with all before
// it.
constexpr std::size_t most_names = 1000;

constexpr std::size_t longest_echo = 200;

std::string shortened(const std::string& text) {
    return text.size() <= longest_echo ? text : text.substr(0, longest_echo) + "...";
}

Json shortened(const Json& value) {
    if (value.is_string()) return shortened(value.get<std::string>());
    if (!value.is_structured()) return value;
    const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    return text.size() <= longest_echo ? value : Json(shortened(text));
}

std::string quoted(const std::string& name) { return "\"" + name + "\""; }

}  // namespace

Problem::Problem(int status_, const std::string& detail, std::vector<FieldError> errors_)
    : std::runtime_error(detail),
      status(status_),
      errors(std::move(errors_)) {}

std::string Problem::body() const {
    Json document = {
        {"type", "about:blank"},
        {"title", reason_phrase(status)},
        {"status", status},
        {"detail", what()}};
    if (!errors.empty()) {
        Json& list = document["errors"] = Json::array();
        for (const FieldError& e : errors)
            list.push_back(
                {{"pointer", shortened(e.pointer)},
                 {"value", shortened(e.value)},
                 {"range", e.range},
                 {"detail", e.detail}});
    }
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string_view reason_phrase(int status) {
    switch (status) {
        case 400: return "Bad Request";
        case 404: return "Not Found";
        case 405: return "Method Not Allowed";
        case 411: return "Length Required";
        case 413: return "Content Too Large";
        case 414: return "URI Too Long";
        case 415: return "Unsupported Media Type";
        case 416: return "Range Not Satisfiable";
        case 422: return "Unprocessable Content";
        case 431: return "Request Header Fields Too Large";
        case 503: return "Service Unavailable";
        default: return status >= 500 ? "Internal Server Error" : "Bad Request";
    }
}

Json parse_object(std::string_view text) {
    std::vector<std::set<std::string>> names(1);  // of the open objects and arrays, outermost first
    auto check = [&names](int depth, Json::parse_event_t event, Json& value) {
        using Event = Json::parse_event_t;
        if (event == Event::object_start || event == Event::array_start) {
            if (depth >= deepest)
                throw Problem(
                    400,
                    "the JSON text is nested deeper than " + std::to_string(deepest) + " levels");
            names.emplace_back();
        } else if (event == Event::object_end || event == Event::array_end) {
            names.pop_back();
        } else if (event == Event::key && names.back().size() >= most_names) {
            throw Problem(
                400, fmt::format("an object of the JSON text has more than {} names", most_names));
        } else if (event == Event::key && !names.back().insert(value.get<std::string>()).second) {
            throw Problem(
                400, "the name " + quoted(value.get<std::string>()) +
                         " comes twice in the same JSON object");
        }
        return true;
    };
    // The library would take it for the end of the text.
    if (text.find('\0') != std::string_view::npos)
        throw Problem(400, "the body is not valid JSON: it holds a NUL byte");
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        throw Problem(
            400, "the body is empty; send a JSON object of parameters, {} for the defaults");
    try {
        Json object = Json::parse(text, check);
        if (!object.is_object())
            throw Problem(
                400, "the body must be a JSON object, not " + std::string(object.type_name()));
        return object;
    } catch (const Json::parse_error& e) {
        // The library's text is "[json.exception....] parse error at line 1, column 5: ..."; its
        // tag is of no use to anyone.
        const std::string what = e.what();
        throw Problem(400, "the body is not valid JSON: " + what.substr(what.find("] ") + 2));
    } catch (const Json::out_of_range& e) {  // a number beyond the range of double
        const std::string what = e.what();
        throw Problem(400, "the body is not valid JSON: " + what.substr(what.find("] ") + 2));
    }
}

void add_errors(
    const std::string& where, std::vector<FieldError> nested, std::vector<FieldError>& all) {
    for (FieldError& e : nested) {
        e.pointer = where + e.pointer;
        all.push_back(std::move(e));
    }
}

void refuse(std::vector<FieldError> errors) {
    const std::string detail =
        errors.size() == 1 ? errors[0].detail
        : errors.size() >= most_errors
            ? "the first " + std::to_string(errors.size()) + " faults are listed"
            : std::to_string(errors.size()) + " fields are at fault";
    throw Problem(422, detail, std::move(errors));
}

}  // namespace vines::api
