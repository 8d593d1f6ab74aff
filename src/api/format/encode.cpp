#include "api/format/encode.hpp"

#include <utility>

#include "api/json_text.hpp"

namespace vines::api {

const FormatName& name_of(Format format) {
    return format_names[static_cast<std::size_t>(format)];  // they stand in this order
}

std::string encoded(Json answer, Format format) {
    switch (format) {
        case Format::json: return json_text(std::move(answer)) + "\n";
        case Format::csv: return csv_text(answer);
        case Format::cbor: return cbor_bytes(std::move(answer));
        case Format::npz: return npz_bytes(std::move(answer));
    }
    return {};
}

}  // namespace vines::api
