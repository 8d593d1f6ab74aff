// Encoding of an answer as JSON, CSV, CBOR or npz. All but CSV end with a provenance. CSV and npz
// have files of their own. CBOR (RFC 8949) has lists of numbers as typed arrays (RFC 8746): the
// JSON library writes a binary value's subtype as its tag.
#include "api/format/encode.hpp"

#include <bit>
#include <utility>

#include "api/cancellation.hpp"
#include "api/format/answer_list.hpp"

namespace vines::api {

const FormatName& name_of(Format format) {
    return format_names[static_cast<std::size_t>(format)];  // in the order of the enum
}

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

static_assert(
    std::endian::native == std::endian::little);  // required by the tags in answer_json.hpp

/// The entries of a list without typed array, each made by entry(bytes).
template <class Entry>
Json array_of(std::span<const std::uint8_t> bytes, std::size_t size, Entry entry) {
    Json array = Json::array();
    array.get_ref<Json::array_t&>().reserve(bytes.size() / size);
    for (std::size_t at = 0; at < bytes.size(); at += size)
        array.push_back(entry(bytes.subspan(at, size)));
    return array;
}

Json typed_array(std::span<const std::uint8_t> doubles) {
    std::vector<std::uint8_t> bytes(doubles.begin(), doubles.end());
    nan_for_null(bytes);
    return Json::binary(std::move(bytes), static_cast<std::uint8_t>(Packed::numbers));
}

Json rows_of(std::span<const std::uint8_t> doubles) {
    return array_of(doubles, sizeof(Quadruple), typed_array);
}

/// Turns packed lists into values that to_cbor() writes as documented.
void prepare(Json& value, const CancelCheck& cancel) {
    if (value.is_structured()) {
        for (Json& part : value) prepare(part, cancel);
        return;
    }
    if (!value.is_binary()) return;
    cancel.poll();
    auto& list = value.get_binary();
    switch (packing_of(value)) {
        case Packed::numbers: return nan_for_null(list);
        case Packed::quadruples: value = rows_of(list); return;
        case Packed::matrices: value = array_of(list, sizeof(MatrixByRows), rows_of); return;
        case Packed::flags:
            value = array_of(list, sizeof(bool), [](auto flag) { return Json(flag[0] != 0); });
            return;
        default: return;
    }
}

}  // namespace

std::string cbor_bytes(Json answer, const std::function<bool()>& gives_up) {
    const CancelCheck cancel(gives_up);
    prepare(answer, cancel);
    std::string bytes;
    Json::to_cbor(answer, bytes);
    cancel.poll();
    return bytes;
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
