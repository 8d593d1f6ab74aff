// JSON and CBOR; CSV and npz are in lists.cpp. CBOR (RFC 8949) has lists of numbers as typed arrays
// (RFC 8746): the JSON library writes a binary value's subtype as its tag.
#include "api/format/encode.hpp"

#include <bit>
#include <utility>

#include "api/cancellation.hpp"

namespace vines::api {

const FormatName& name_of(Format format) {
    return format_names[static_cast<std::size_t>(format)];  // in the order of the enum
}

std::optional<Format> format_in(const Json& fields, std::span<const FormatName> names) {
    const auto given = fields.find("format");
    for (const FormatName& name : names)
        if (given != fields.end() && *given == name.word) return name.format;
    return std::nullopt;
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

/// The entries of a list as to_cbor() writes them as documented: four doubles as a typed array.
template <class Entry>
Json cbor_of(const Entry& entry) {
    return entry;
}
Json cbor_of(const Quadruple& doubles) {
    Json typed_array = column(doubles);
    nan_for_null(typed_array.get_binary());
    return typed_array;
}
Json cbor_of(const MatrixByRows& rows) {
    Json array = Json::array();
    for (const Quadruple& row : rows) array.push_back(cbor_of(row));
    return array;
}

/// Turns packed lists into values that to_cbor() writes as documented.
void prepare(Json& value, const CancelCheck& cancel) {
    if (value.is_structured()) {
        for (Json& part : value) prepare(part, cancel);
        return;
    }
    if (!value.is_binary()) return;
    cancel.poll();
    const PackedList list = list_in_memory(value);
    if (list.packing == Packed::numbers) return nan_for_null(value.get_binary());
    if (list.packing == Packed::integers) return;
    Json array = Json::array();
    array.get_ref<Json::array_t&>().reserve(list.bytes.size() / entry_size(list.packing));
    for_each_entry(list, [&array](const auto& entry) { array.push_back(cbor_of(entry)); });
    value = std::move(array);
}

}  // namespace

void nan_for_null(std::span<std::uint8_t> doubles) {
    change_numbers(doubles, [](double number) {
        return std::isfinite(number) ? number : std::numeric_limits<double>::quiet_NaN();
    });
}

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
