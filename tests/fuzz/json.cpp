// JSON of strangers: parse_object() agrees with the library's own parser on what it takes, and each
// request is read or refused.
#include "api/identify_request.hpp"
#include "api/parse_object.hpp"
#include "fuzz.hpp"

using namespace vines;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    fuzz::or_problem([text] {
        const api::Json object = api::parse_object(text);
        fuzz::require(api::Json::parse(text) == object, "the library reads the same");
        fuzz::or_problem([&] { api::read_simulate_request(object); });
        fuzz::or_problem([&] { api::read_manifold_request(object); });
        fuzz::or_problem([&] { api::read_identify_request(object); });
    });
    return 0;
}
