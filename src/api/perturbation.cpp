// The field `perturbation` of a request, and its part of the answer.
#include <algorithm>

#include "api/answer_json.hpp"
#include "api/columns.hpp"
#include "api/describe.hpp"

namespace vines::api {

namespace {

/// A component of the perturbation and the start field that it is added to.
struct Component {
    const char *name, *of_start;
    double State::* value;
};
constexpr Component perturbed_components[] = {
    {"x", "x0", &State::x},
    {"x_dot", "x_dot0", &State::x_dot},
    {"y", "y0", &State::y},
    {"y_dot", "y_dot0", &State::y_dot},
};

const std::string at_perturbation = "/perturbation/";

/// Maps an invalid field of the perturbed start to the field of the perturbation. |x - y| <= b is
/// reported for y, or for x if only that is given; a random perturbation is reported by its size.
FieldError error_of(
    const Fault& fault, const Json& given, const Parameters& p, const State& start,
    const State& perturbed) {
    const std::string detail = "the perturbed start is invalid: " + fault.message;
    if (given.contains("size")) return {at_perturbation + "size", given["size"], nullptr, detail};
    const bool by_x = fault.field == "y0" && !given.contains("y");
    const Component& c = *std::find_if(
        std::begin(perturbed_components), std::end(perturbed_components), [&](const Component& of) {
            return by_x ? of.value == &State::x : of.of_start == fault.field;
        });
    const double from = start.*c.value, low = by_x ? perturbed.y - p.b : fault.minimum,
                 high = by_x ? perturbed.y + p.b : fault.maximum;
    return {
        at_perturbation + c.name, given.value(c.name, 0.0), Json::array({low - from, high - from}),
        detail};
}

}  // namespace

std::optional<State> read_perturbation(
    const MergedFields& l, const Parameters& p, const State& start,
    std::vector<FieldError>& errors) {
    if (!l.has("perturbation")) return std::nullopt;
    const Json& given = l.fields["perturbation"];
    const auto own = present(given, {"x", "x_dot", "y", "y_dot"}),
               random = present(given, {"seed", "size"});
    if (!own.empty() && !random.empty()) {
        for (const auto& some : {own, random})
            for (const std::string& name : some)
                errors.push_back(
                    {at_perturbation + name, given[name], nullptr,
                     "a perturbation is either x, x_dot, y, y_dot or seed and size"});
        return std::nullopt;
    }
    if (!random.empty() && !given.contains("size")) {
        errors.push_back(
            {at_perturbation + "size", nullptr, nullptr,
             "size, the length of the perturbation, is missing"});
        return std::nullopt;
    }
    State difference;
    for (const Component& c : perturbed_components) difference.*c.value = given.value(c.name, 0.0);
    if (!random.empty()) {
        const double seed = given.value(
            "seed", find(find(l.table, "perturbation")->fields, "seed")->fallback.get<double>());
        difference =
            random_difference(static_cast<std::uint64_t>(seed), given["size"].get<double>());
    }
    const State perturbed = displaced(start, difference);
    if (length_of(difference_of(perturbed, start)) == 0)
        errors.push_back(
            {"/perturbation", given, nullptr,
             "the perturbed start equals the start: the perturbation must not be zero, nor below "
             "the rounding of the start"});
    for (const Fault& fault : validate(p, perturbed))
        errors.push_back(error_of(fault, given, p, start, perturbed));
    return difference;
}

Json describe_perturbation(Perturbation&& p) {
    const std::optional<LinearStretch>& linear = p.linear;
    Json start = Json::object();
    for (const Component& c : perturbed_components) start[c.name] = p.start.*c.value;
    Json j = describe(perturbation_columns, p);
    j.update(
        {{"start", std::move(start)},
         {"impacts", describe(touch_columns, p.impacts)},
         {quantity.distance.name, column(p.distance)},
         {"predicted",
          {{"lambda1", linear ? finite_or_null(linear->lambda1) : Json(nullptr)},
           {quantity.distance.name, column(p.tangent)}}},
         {"slope",
          {{"lambda1", linear ? finite_or_null(linear->slope) : Json(nullptr)},
           {quantity.tau_start.name, linear ? Json(linear->tau.from) : Json(nullptr)},
           {quantity.tau_end.name, linear ? Json(linear->tau.to) : Json(nullptr)}}},
         {quantity.parted.name, or_null(p.parted)}});
    return j;
}

}  // namespace vines::api
