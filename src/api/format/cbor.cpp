// CBOR (RFC 8949), lists of numbers as typed arrays (RFC 8746).
#include <bit>

#include "api/format/encode.hpp"
#include "api/format/list.hpp"

namespace vines::api {

namespace {

static_assert(std::endian::native == std::endian::little);  // as the tags say

// RFC 8746, 2.1.
constexpr std::uint8_t float64_tag = 86, int32_tag = 78;

Json typed_doubles(std::span<const std::uint8_t> bytes) {
    return Json::binary(with_nan(bytes), float64_tag);
}

/// An array of typed ones: so many bytes each.
Json typed_rows(std::span<const std::uint8_t> bytes, std::size_t row) {
    Json rows = Json::array();
    for (std::size_t at = 0; at < bytes.size(); at += row)
        rows.push_back(typed_doubles(bytes.subspan(at, row)));
    return rows;
}

Json typed(const List& list) {
    const std::span<const std::uint8_t> bytes = list.bytes();
    switch (list.packing()) {
        case Packed::numbers: return typed_doubles(bytes);
        case Packed::quadruples: return typed_rows(bytes, sizeof(Quadruple));
        case Packed::matrices: {
            Json matrices = Json::array();
            for (std::size_t at = 0; at < bytes.size(); at += sizeof(MatrixByRows))
                matrices.push_back(
                    typed_rows(bytes.subspan(at, sizeof(MatrixByRows)), sizeof(Quadruple)));
            return matrices;
        }
        case Packed::integers:
            return Json::binary(std::vector<std::uint8_t>(bytes.begin(), bytes.end()), int32_tag);
        default: {
            Json flags = Json::array();
            for (const std::uint8_t flag : bytes) flags.push_back(flag != 0);
            return flags;
        }
    }
}

void make_typed(Json& value) {
    if (value.is_object())
        for (auto& part : value) make_typed(part);
    else if (value.is_binary()) value = typed(*List::of(value));
    else if (value.is_array() && !value.empty() && value[0].is_object())
        for (Json& part : value) make_typed(part);
}

}  // namespace

std::string cbor_bytes(Json answer) {
    make_typed(answer);
    std::string bytes;
    Json::to_cbor(answer, bytes);
    return bytes;
}

}  // namespace vines::api
