// /v1/basins: its request as a sweep over starts, and its result.
#include "api/describe.hpp"
#include "api/properties.hpp"
#include "api/sweep.hpp"
#include "core/motion/impact.hpp"

namespace vines::api {

namespace {

/// Ranges of the starts; a component without one has its value in the base.
StartBox box_of(const Json& box, const State& start) {
    const Eigen::Vector4d at = vector_of(start);
    StartBox ranges;
    constexpr const char* names[] = {"x_dot0", "x0", "y_dot0", "y0"};
    for (int i = 0; i < 4; ++i) ranges[i] = box.value(names[i], Interval{at(i), at(i)});
    return ranges;
}

/// Polls while it finds the starts.
std::shared_ptr<Basins> basins_of(
    const SweepRequest& r, const Json& given, const CancelCheck& cancel) {
    const WithDefaults field{basins_fields(), given};
    BasinPlan plan{
        .count = r.plan.grid.starts,
        .seed = field["seed"],
        .pairs = field["pairs"],
        .values = r.axes.empty() ? std::vector<double>{0} : r.axes[0].values,
        .boxes = {},
        .system_at = [systems = r.systems](double value) { return systems->at_value(value); }};
    for (std::size_t i = 0; i < plan.values.size(); ++i) {
        const auto system = plan.system_at(plan.values[i]);
        std::vector<FieldError> faults;
        if (!system) faults = faults_of_base(fields_of(r, {0, {i}}));
        for (FieldError& e : faults) e.pointer = "/axis", e.value = plan.values[i];
        refuse_any(faults);
        plan.boxes.push_back(box_of(given["box"], system->start));
    }
    auto basins = std::make_shared<Basins>(plan, [&cancel] { cancel.poll(); });
    if (const std::size_t found = basins->fewest_starts(); found < plan.count)
        refuse(
            {{"/box", given["box"], nullptr,
              "the box hardly meets the cavity: |x0 - y0| <= b holds at only " +
                  std::to_string(found) + " starts in it"}});
    return basins;
}

Json describe(const std::optional<Estimate>& estimate) {
    if (!estimate) return nullptr;
    return {{"value", estimate->value}, {"standard_error", finite_or_null(estimate->error)}};
}

// Values of the parameter that is swept: each keeps its system and its motions.
constexpr std::size_t most_values = 1000;

/// Refuses a load, under which no motion lasts, an axis with a range in the box, and too many
/// values.
void check_basins(const SweepRequest& r, const Json& box) {
    if (r.systems->has_load())
        refuse("/base/forcing", "basins need a harmonic forcing: under a load no motion lasts");
    if (r.axes.empty()) return;
    const std::string& parameter = r.axes[0].parameter;
    // The box is in reduced units.
    std::string stated = parameter;
    if (parameter.ends_with("_velocity0")) stated.replace(1, 9, "_dot");
    if (box.contains(stated))
        refuse({{"/axis/parameter", parameter, nullptr, "the box states " + stated + ", too"}});
    const std::size_t values = r.axes[0].values.size();
    if (values > most_values)
        refuse(
            {{"/axis", values, Json::array({1, most_values}),
              "basins have at most " + std::to_string(most_values) + " values on their axis"}});
}

}  // namespace

SweepRequest read_basins_request(
    const Json& given, std::size_t most_points, const CancelCheck& cancel) {
    std::vector<FieldError> errors = check(basins_fields(), given);
    if (!given.contains("box") || given["box"].empty())
        errors.push_back(
            {"/box", nullptr, nullptr,
             "basins need a box: {x0: [from, to], ...} of one to four of x0, x_dot0, y0, y_dot0"});
    refuse_any(errors);
    Json grid = given;
    grid["axes"] = Json::array();
    if (given.contains("axis")) grid["axes"].push_back(given["axis"]);
    const Json count = WithDefaults{basins_fields(), given}["count"];
    try {
        SweepRequest r = read_grid(grid, count.get<std::size_t>(), most_points, cancel);
        check_basins(r, given["box"]);
        r.given.erase("axes");
        r.basins = basins_of(r, given, cancel);
        r.plan.system_at = [basins = r.basins](const Place& place) {
            return basins->system_of(place);
        };
        return r;
    } catch (Problem& problem) {
        for (FieldError& e : problem.errors)
            if (e.pointer.starts_with("/axes/0")) e.pointer.replace(0, 7, "/axis");
        throw;
    }
}

Json describe_basins(const SweepRequest& r) {
    Json attractors = Json::array(), basins = Json::array();
    for (const BasinsAt& at : r.basins->result()) {
        Json place = Json::object();
        if (!r.axes.empty()) place[r.axes[0].parameter] = at.value;
        for (const Basin& basin : at.basins) {
            Json entry = place;
            const auto& orbit = basin.motion.regime.orbit;
            entry.update(describe(properties::basin, basin));
            entry["multipliers"] = orbit ? describe_multipliers(orbit->multipliers) : Json(nullptr);
            attractors.push_back(std::move(entry));
        }
        place.update(describe(properties::basins, at));
        place["entropy"] = describe(at.entropy);
        place["boundary_entropy"] = describe(at.boundary_entropy);
        place["uncertainty_exponent"] = describe(at.uncertainty_exponent);
        place["distances"] = column(at.distances);
        place["uncertain"] = column(at.uncertain);
        basins.push_back(std::move(place));
    }
    return {{"attractors", std::move(attractors)}, {"basins", std::move(basins)}};
}

}  // namespace vines::api
