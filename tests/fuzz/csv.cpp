// Fuzz target: a CSV record. The first line is the query sent with it.
#include "api/csv.hpp"

#include <cmath>

#include "api/identify.hpp"
#include "api/parse.hpp"
#include "api/schema/tables.hpp"
#include "fuzz.hpp"

using namespace vines;

namespace {

void check(const api::Csv& csv) {
    fuzz::require(csv.columns.size() >= 2, "a record has at least two columns");
    for (const api::CsvColumn& c : csv.columns) {
        fuzz::require(c.values.size() == csv.lines.size(), "each row has a number in each column");
        for (const double v : c.values)
            fuzz::require(!std::isinf(v), "numbers are finite, or NaN for an empty cell");
    }
    for (std::size_t k = 1; k < csv.lines.size(); ++k)
        fuzz::require(csv.lines[k] > csv.lines[k - 1], "line numbers increase");
}

}  // namespace

void fuzz::csv(std::string_view text) {
    const std::string_view query = fuzz::take_part(text, '\n');
    fuzz::or_problem([text] { check(api::parse_csv(text)); });
    fuzz::or_problem([&] {
        const api::Json fields = api::from_query(api::identify_fields(), api::parse_query(query));
        api::read_identify_request(fields, text);
    });
}
