// Encoding of an answer as JSON, CSV, CBOR or npz. All but CSV end with a provenance.
#include "api/format/encode.hpp"

#include <utility>

#include "api/cancellation.hpp"

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

}  // namespace

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
