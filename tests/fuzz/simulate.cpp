// A request for a simulation to the text of its answer.
#include "api/simulate.hpp"

#include "api/json_text.hpp"
#include "api/parse_object.hpp"
#include "fuzz.hpp"

using namespace vines;

namespace {

// Some tenths of a second under the sanitizers.
constexpr long looks = 300;
constexpr std::size_t most_bytes = 100000;

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    fuzz::or_problem([text] {
        fuzz::Patience patience(looks);
        const auto is_over = [&] { return patience.is_over(); };
        const api::Json answer = api::simulate_answer(
            api::read_simulate_request(api::parse_object(text)),
            {.asked = is_over, .analysis_late = is_over}, most_bytes);
        fuzz::require(api::Json::accept(api::json_text(answer)), "an answer is JSON");
    });
    return 0;
}
