#include "api/format/encode.hpp"

#include <utility>

namespace vines::api {

const FormatName& name_of(Format format) {
    return format_names[static_cast<std::size_t>(format)];  // they stand in this order
}

std::string encoded(Json answer, Format format, const std::optional<Provenance>& provenance) {
    if (format == Format::json) return sealed_text(std::move(answer), provenance);
    if (format == Format::csv) return csv_text(answer);
    if (provenance) answer["provenance"] = describe(*provenance, nullptr);
    return format == Format::cbor ? cbor_bytes(std::move(answer)) : npz_bytes(std::move(answer));
}

}  // namespace vines::api
