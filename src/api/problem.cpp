#include "api/problem.hpp"

namespace vines::api {

namespace {

// Bytes: several times the longest sentence. Quoted values are shortened separately.
constexpr std::size_t longest_detail = 2000;
// Entries of a range: more than the number of fields or presets.
constexpr std::size_t most_choices = 200;

/// Cuts a text to at most `most` bytes, at a boundary of UTF-8 characters.
std::string cut(std::string_view text, std::size_t most) {
    if (text.size() <= most) return std::string(text);
    std::size_t end = most;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return std::string(text.substr(0, end)) + "...";
}

Json shortened_value(const Json& value) {
    if (value.is_string()) return shortened(value.get_ref<const std::string&>());
    if (!value.is_structured()) return value;
    const std::string text =
        beginning_of(value).dump(-1, ' ', false, Json::error_handler_t::replace);
    return text.size() <= longest_echo ? value : Json(shortened(text));
}

Json shortened_range(const Json& range) {
    if (!range.is_array()) return shortened_value(range);
    Json entries = Json::array();
    for (std::size_t k = 0; k < range.size() && k < most_choices; ++k)
        entries.push_back(shortened_value(range[k]));
    if (range.size() > most_choices) entries.push_back("...");
    return entries;
}

}  // namespace

std::string shortened(std::string_view text) { return cut(text, longest_echo); }

Problem::Problem(int status_, const std::string& detail, std::vector<FieldError> errors_)
    : std::runtime_error(detail),
      status(status_),
      errors(std::move(errors_)) {}

Problem Problem::unavailable(const std::string& lacking, const std::string& detail) {
    Problem problem(503, detail);
    problem.lacking = lacking;
    return problem;
}

std::string Problem::body(const std::string& request_id) const {
    Json document = {
        {"type", "about:blank"},
        {"title", reason_phrase(status)},
        {"status", status},
        {"detail", cut(what(), longest_detail)}};
    if (!request_id.empty()) document["request_id"] = request_id;
    if (!lacking.empty()) document["lacking"] = lacking;
    if (!errors.empty()) {
        Json& list = document["errors"] = Json::array();
        for (const FieldError& e : errors)
            list.push_back(
                {{"pointer", shortened(e.pointer)},
                 {"value", shortened_value(e.value)},
                 {"range", shortened_range(e.range)},
                 {"detail", cut(e.detail, longest_detail)}});
    }
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string_view reason_phrase(int status) {
    switch (status) {
        case 200: return "OK";
        case 304: return "Not Modified";
        case 400: return "Bad Request";
        case 401: return "Unauthorized";
        case 403: return "Forbidden";
        case 404: return "Not Found";
        case 405: return "Method Not Allowed";
        case 406: return "Not Acceptable";
        case 408: return "Request Timeout";
        case 411: return "Length Required";
        case 413: return "Content Too Large";
        case 414: return "URI Too Long";
        case 415: return "Unsupported Media Type";
        case 416: return "Range Not Satisfiable";
        case 417: return "Expectation Failed";
        case 421: return "Misdirected Request";
        case 422: return "Unprocessable Content";
        case 431: return "Request Header Fields Too Large";
        case 499: return "Client Closed Request";
        case 505: return "HTTP Version Not Supported";
        case 503: return "Service Unavailable";
        default: return status >= 500 ? "Internal Server Error" : "Bad Request";
    }
}

void refuse(std::vector<FieldError> errors) {
    const std::string detail =
        errors.size() == 1 ? errors[0].detail
        : errors.size() >= most_errors
            ? "the first " + std::to_string(most_errors) + " errors are listed"
            : std::to_string(errors.size()) + " fields are invalid";
    if (errors.size() > most_errors)
        errors.erase(errors.begin() + static_cast<long>(most_errors), errors.end());
    throw Problem(422, detail, std::move(errors));
}

void refuse(const std::string& pointer, const std::string& detail) {
    refuse({{pointer, nullptr, nullptr, detail}});
}

}  // namespace vines::api
