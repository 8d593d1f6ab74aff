// An answer as bytes, in the format that its reader wants.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "api/provenance.hpp"
#include "api/schema/json.hpp"

namespace vines::api {

enum class Format { json, csv, cbor, npz };

/// What a format is called in a request, and in the headers Accept and Content-Type.
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

/// All lists are there. With its provenance, which has a sha256 in JSON alone, but for CSV. Problem
/// 422 where the format cannot hold this answer. gives_up(): asked now and then while it is
/// written; true: BrokenOff.
std::string encoded(
    Json answer, Format format, const std::optional<Provenance>& provenance,
    const std::function<bool()>& gives_up = {});

/// One table: lists of one length in one object, a column each; of four numbers or a matrix
/// several, with the number of each behind its name. Null is an empty cell. Problem 422 where the
/// answer has none, or more than one, which it names.
std::string csv_text(const Json& answer, const std::function<bool()>& gives_up = {});

/// Lists of numbers as typed arrays (float64, int32, little-endian), null in them as NaN; of four
/// numbers or a matrix arrays of such.
std::string cbor_bytes(Json answer, const std::function<bool()>& gives_up = {});

/// A ZIP archive: for each list PATH.npy (float64, int32, bool or text), null in it as NaN, and
/// answer.json with the rest.
std::string npz_bytes(Json answer, const std::function<bool()>& gives_up = {});

}  // namespace vines::api
