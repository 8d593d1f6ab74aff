// Fuzz target: JSON from a client. parse_object() agrees with the JSON library on accepted texts,
// and each request is read or refused.
#include "api/identify.hpp"
#include "api/parse.hpp"
#include "api/simulate.hpp"
#include "fuzz.hpp"

using namespace vines;

void fuzz::json(std::string_view text) {
    fuzz::or_problem([text] {
        const api::Json object = api::parse_object(text);
        fuzz::require(api::Json::parse(text) == object, "the JSON library gives the same value");
        fuzz::or_problem([&] { api::read_simulate_request(object); });
        fuzz::or_problem([&] { api::read_manifold_request(object); });
        fuzz::or_problem([&] { api::read_identify_request(object); });
    });
}
