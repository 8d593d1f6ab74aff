#include "http/encoding.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace vines::http {

std::string gzip(const std::string& text) {
    z_stream stream{};
    constexpr int window = 15, with_gzip_header = 16, memory = 8;  // zlib's own, but for the header
    if (deflateInit2(
            &stream, 1, Z_DEFLATED, window + with_gzip_header, memory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("zlib: deflateInit2");
    std::string out;
    // The whole may be 4 GiB and more, of which zlib cannot count.
    std::vector<char> piece(1 << 20);
    int result = Z_OK;
    for (std::size_t at = 0; result == Z_OK; at += piece.size()) {
        const std::size_t size = std::min(piece.size(), text.size() - at);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data() + at));
        stream.avail_in = static_cast<uInt>(size);
        const int flush = at + size == text.size() ? Z_FINISH : Z_NO_FLUSH;
        do {
            stream.next_out = reinterpret_cast<Bytef*>(piece.data());
            stream.avail_out = static_cast<uInt>(piece.size());
            result = deflate(&stream, flush);
            if (result == Z_BUF_ERROR) result = Z_OK;  // nothing was left to do
            out.append(piece.data(), piece.size() - stream.avail_out);
        } while (result == Z_OK && stream.avail_out == 0);
    }
    deflateEnd(&stream);
    if (result != Z_STREAM_END) throw std::runtime_error("zlib: deflate");
    return out;
}

bool accepts_gzip(const std::string& accept_encoding) {
    const std::size_t at = accept_encoding.find("gzip");
    return at != std::string::npos && accept_encoding.compare(at + 4, 4, ";q=0") != 0;
}

std::string entity_tag(const std::string& body) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (unsigned char c : body) hash = (hash ^ c) * 0x100000001b3;
    return fmt::format("W/\"{:016x}\"", hash);
}

}  // namespace vines::http
