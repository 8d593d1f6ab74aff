// Fuzz target: a simulation, from the request to the text of its answer.
#include "api/simulate.hpp"

#include "api/json_text.hpp"
#include "api/parse.hpp"
#include "fuzz.hpp"

using namespace vines;

namespace {

// A few tenths of a second under the sanitizers.
constexpr long max_simulate_calls = 300;
constexpr std::size_t max_bytes = 100000;

}  // namespace

void fuzz::simulate(std::string_view text) {
    fuzz::or_problem([text] {
        fuzz::CallLimit call_limit(max_simulate_calls);
        const auto is_over = [&] { return call_limit.is_over(); };
        const api::Json answer = api::simulate_in_parts(
                                     api::read_simulate_request(api::parse_object(text)),
                                     {.requested = is_over, .analysis_late = is_over}, max_bytes)
                                     .json;
        fuzz::require(api::Json::accept(api::json_text(answer)), "an answer is JSON");
    });
}
