// Fuzz target: URL queries of the requests that accept one.
#include "api/identify.hpp"
#include "api/parse.hpp"
#include "api/schema/tables.hpp"
#include "api/simulate.hpp"
#include "fuzz.hpp"

using namespace vines;

namespace {

/// The shortest valid record.
std::string record() {
    std::string csv = "time_s,displacement_m\n";
    for (int k = 0; k < 100; ++k) csv += std::to_string(k) + "e-3," + std::to_string(k % 7) + "\n";
    return csv;
}

}  // namespace

void fuzz::query(std::string_view text) {
    static const std::string csv = record();
    const api::Query query = api::parse_query(text);
    fuzz::or_problem(
        [&] { api::read_simulate_request(api::from_query(api::simulate_fields(), query)); });
    fuzz::or_problem(
        [&] { api::read_manifold_request(api::from_query(api::manifold_fields(), query)); });
    fuzz::or_problem(
        [&] { api::read_identify_request(api::from_query(api::identify_fields(), query), csv); });
}
