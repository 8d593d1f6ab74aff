#include "api/openapi/examples.hpp"

#include <string_view>

namespace vines::api::document {

namespace {

struct Example {
    std::string_view of, json;
};

constexpr Example requests[] = {
    {"simulate_by_query", R"({"preset": "fig11", "include": ["regime", "energy"]})"},
    {"manifold_by_query", R"({"preset": "fig11", "points": 5})"},
    {"simulate", R"({
        "figure": {
            "summary": "energies of the paper's Fig. 11",
            "value": {"preset": "fig11", "include": ["energy"]}},
        "machine": {
            "summary": "a platform of 12 kg with an absorber of 1 % of its mass, in SI",
            "value": {"m1": 12, "f0": 14, "damping_ratio": 0.006, "mass_ratio": 0.01, "F": 0.0004,
                "f": 14, "R": 0.4, "b": 0.03, "include": ["impacts", "exponents", "regime"]}},
        "perturbed": {
            "summary": "beside a run that starts a little off",
            "value": {"b": 0.022, "tau_end": 400, "perturbation": {"size": 1e-8}}}})"},
    {"manifold", R"({
        "default": {"summary": "of Table 1", "value": {"points": 3}}})"},
    {"sweep", R"({
        "half-widths": {
            "summary": "four half-widths of the cavity",
            "value": {"base": {"damping": "closed_form"}, "cycles": 500,
                "axes": [{"parameter": "b", "from": 0.006, "to": 0.015, "count": 4}]}},
        "worst motion": {
            "summary": "the largest motion between 13 and 15 Hz, whatever the start",
            "value": {"base": {"m1": 12, "f0": 14, "damping_ratio": 0.006, "mass_ratio": 0.01,
                "F": 0.0004, "R": 0.4, "b": 0.03}, "starts": "default set",
                "reduce": "max over f", "cycles": 200,
                "axes": [{"parameter": "f", "from": 13, "to": 15, "count": 9}]}}})"},
};

constexpr Example answers[] = {
    {"Status", R"({"status": "ok"})"},
};

template <std::size_t n>
Json example_of(const Example (&table)[n], std::string_view of) {
    for (const Example& example : table)
        if (example.of == of) return Json::parse(example.json);
    return nullptr;
}

}  // namespace

Json request_example(const char* operation) { return example_of(requests, operation); }

Json answer_example(const char* schema) { return example_of(answers, schema); }

}  // namespace vines::api::document
