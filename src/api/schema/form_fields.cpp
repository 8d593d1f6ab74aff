// The table of how an answer is told.
#include "api/schema/tables.hpp"

namespace vines::api {

const FieldTable& form_fields() {
    static const FieldTable table = {
        {.name = "format",
         .type = FieldType::choice,
         .group = "answer",
         .description =
             "of the answer: json; csv: its one table; cbor: with typed arrays (RFC 8746); "
             "npz: arrays for numpy.load",
         .fallback_note = "what the header Accept asks for, else json",
         .choices = {"json", "csv", "cbor", "npz"}},
        {.name = "fields",
         .type = FieldType::choices,
         .group = "answer",
         .description =
             "what is kept of the answer: names and paths with points, as in "
             "impacts.tau; version, status, warnings and provenance always are. What is not kept "
             "is not computed, unless include says so",
         .fallback_note = "everything"}};
    return table;
}

}  // namespace vines::api
