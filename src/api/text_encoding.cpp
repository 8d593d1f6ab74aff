#include "api/text_encoding.hpp"

#include <iconv.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <type_traits>

namespace vines::api {

namespace {

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

}  // namespace vines::api
