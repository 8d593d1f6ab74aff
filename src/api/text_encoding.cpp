#include "api/text_encoding.hpp"

#include <iconv.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <optional>
#include <type_traits>

namespace vines::api {

namespace {

/// nullopt if the bytes are invalid in that encoding.
std::optional<std::string> converted(std::string_view bytes, const char* encoding) {
    const iconv_t opened = iconv_open("UTF-8", encoding);
    if (opened == reinterpret_cast<iconv_t>(-1)) return std::nullopt;
    const std::unique_ptr<std::remove_pointer_t<iconv_t>, int (*)(iconv_t)> converter(
        opened, &iconv_close);
    std::string text;
    std::array<char, 4096> piece;
    char* from = const_cast<char*>(bytes.data());  // iconv only reads it
    std::size_t left = bytes.size();
    for (;;) {
        char* to = piece.data();
        std::size_t room = piece.size();
        const bool whole =
            iconv(converter.get(), &from, &left, &to, &room) != static_cast<std::size_t>(-1);
        text.append(piece.data(), piece.size() - room);
        if (whole) return text;
        if (errno != E2BIG) return std::nullopt;
    }
}

/// A fast test: most texts are ASCII.
bool is_ascii(std::string_view bytes) {
    return std::all_of(
        bytes.begin(), bytes.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

const char* encoding_of(std::string_view bytes) {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\xff\xfe"sv) || bytes.starts_with("\xfe\xff"sv)) return "UTF-16";
    if (bytes.size() >= 4 && bytes[1] == 0 && bytes[3] == 0) return "UTF-16LE";
    if (bytes.size() >= 4 && bytes[0] == 0 && bytes[2] == 0) return "UTF-16BE";
    return "UTF-8";
}

}  // namespace

bool is_utf8(std::string_view bytes) {
    return is_ascii(bytes) || converted(bytes, "UTF-8").has_value();
}

std::string_view as_utf8(std::string_view bytes, std::string& room) {
    const std::string_view encoding = encoding_of(bytes);
    if (encoding == "UTF-8") {
        if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
        if (is_utf8(bytes)) return bytes;
    }
    auto text = converted(bytes, encoding.data());
    room = text ? std::move(*text) : converted(bytes, "ISO-8859-1").value_or(std::string());
    return room;
}

}  // namespace vines::api
