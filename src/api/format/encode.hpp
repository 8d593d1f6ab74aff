// Encodes an answer as JSON, CSV, CBOR or npz.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>

#include "api/provenance.hpp"

namespace vines::api {

enum class Format { json, csv, cbor, npz };

/// A format's name in requests, and its media type in the headers Accept and Content-Type.
struct FormatName {
    Format format;
    const char* word;
    const char* media_type;
};
inline constexpr std::array<FormatName, 4> format_names = {
    {{Format::json, "json", "application/json"},
     {Format::csv, "csv", "text/csv"},
     {Format::cbor, "cbor", "application/cbor"},
     {Format::npz, "npz", "application/x-npz"}}};
const FormatName& name_of(Format format);

/// Formats of a sweep. Lines of JSON are also sent to clients that accept JSON alone.
inline constexpr std::array<FormatName, 5> sweep_format_names = {
    {{Format::json, "ndjson", "application/x-ndjson"},
     {Format::json, "json", "application/json"},
     format_names[1],
     format_names[2],
     format_names[3]}};

/// The format that the field `format` of a request selects; nullopt if it is missing or unknown.
std::optional<Format> format_in(const Json& fields, std::span<const FormatName> names);

/// Encodes an answer without streamed lists. Its provenance is added, except in CSV. Problem 422
/// where the format cannot hold this answer; Cancelled once gives_up() returns true.
std::string encoded(
    Json answer, Format format, const std::optional<Provenance>& provenance,
    const std::function<bool()>& gives_up = {});

/// Bytes of the numbers in packed lists, which CBOR and npz have at least.
std::size_t packed_bytes(const Json& answer);

/// CBOR with lists of numbers as typed arrays (float64, int32, little-endian) and null in them as
/// NaN. Lists of exponents or matrices are arrays of typed arrays.
std::string cbor_bytes(Json answer, const std::function<bool()>& gives_up = {});

/// A ZIP archive: PATH.npy for each list (float64, int32, bool or text; null is NaN), and
/// answer.json with the rest, without the lists of `only_in_files`.
std::string npz_bytes(
    Json answer, const std::function<bool()>& gives_up = {},
    const Json& only_in_files = Json::object());

/// A value as a cell of CSV: empty for null, words in quotation marks where necessary.
void put_csv_value(const Json& value, std::string& text);

}  // namespace vines::api
