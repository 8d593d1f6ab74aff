#include "api/format/encode.hpp"

#include <utility>

#include "api/cancellation.hpp"

namespace vines::api {

const FormatName& name_of(Format format) {
    return format_names[static_cast<std::size_t>(format)];  // in the order of the enum
}

namespace {

// Approximate size of a provenance without the request, in bytes.
constexpr std::size_t room_for_provenance = 1024;

std::string sealed_text(
    Json answer, const std::optional<Provenance>& provenance,
    const std::function<bool()>& gives_up) {
    std::string text;
    text.reserve(room_for_lists(answer) + room_for_provenance);
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
    if (format == Format::json) return sealed_text(std::move(answer), provenance, gives_up);
    if (format == Format::csv) return csv_text(answer, gives_up);
    if (provenance) answer["provenance"] = describe(*provenance, nullptr);
    return (format == Format::cbor ? cbor_bytes : npz_bytes)(std::move(answer), gives_up);
}

}  // namespace vines::api
