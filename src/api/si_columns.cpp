#include "api/si_columns.hpp"

#include <string>
#include <utility>
#include <vector>

#include "api/answer_json.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

// t = tau/omega0.
constexpr SiCounterpart of_any_part[] = {
    {"tau", "time_s", -1},
    {"tau_start", "time_start_s", -1},
    {"tau_end", "time_end_s", -1},
    {"tau_half", "time_half_s", -1},
    {"tau_tenth", "time_tenth_s", -1},
    {"time_difference", "time_difference_s", -1},
    {"window", "window_s", -1},
    {"asked", "asked_s", -1},
    {"parted", "parted_s", -1},
    {"x_dot", "x_velocity", 1},
    {"y_dot", "y_velocity", 1},
    {"x_ddot", "x_acceleration", 2},
    {"x_dot_before", "x_velocity_before", 1},
    {"x_dot_after", "x_velocity_after", 1},
    {"y_dot_before", "y_velocity_before", 1},
    {"y_dot_after", "y_velocity_after", 1},
    {"x_ddot_before", "x_acceleration_before", 2},
    {"relative_speed", "impact_speed", 1},
    {"impulse", "impulse_N_s", 1, true},
    {"V", "V_velocity", 1},
};
constexpr SiCounterpart of_energy[] = {
    {"input", "input_J", 2, true},       {"damper", "damper_J", 2, true},
    {"impacts", "impacts_J", 2, true},   {"stored", "stored_J", 2, true},
    {"residual", "residual_J", 2, true}, {"at_start", "at_start_J", 2, true},
    {"at_end", "at_end_J", 2, true},
};

Json scaled(const Json& value, double factor) {
    if (value.is_number()) return value.get<double>() * factor;
    if (value.is_null()) return nullptr;  // a number that does not exist
    if (packing_of(value) == Packed::streamed) {
        StreamedList list = streamed_list(value);
        list.factor *= factor;
        return streamed(list);
    }
    Json list = value;
    if (value.is_binary())
        change_numbers(list.get_binary(), [factor](double number) { return number * factor; });
    else
        for (Json& v : list) v = scaled(v, factor);
    return list;
}

void add(Json& object, std::span<const SiCounterpart> table, const SiParameters& si) {
    make_room(object, object.size());
    for (const SiCounterpart& t : table)
        if (object.contains(t.name) && !object[t.name].is_string())
            object[t.si_name] = scaled(
                object[t.name], elementary::pow(si.omega0(), t.power) * (t.per_m1 ? si.m1 : 1));
}

}  // namespace

std::span<const SiCounterpart> si_counterparts() { return of_any_part; }
std::span<const SiCounterpart> energy_counterparts() { return of_energy; }

void add_si(Json& part, const SiParameters& si) {
    if (!part.is_object()) {
        if (part.is_array() && !part.empty() && part[0].is_object())
            for (Json& entry : part) add_si(entry, si);
        return;
    }
    add(part, of_any_part, si);
    for (auto& [name, value] : part.items()) add_si(value, si);
}

void add_joules(Json& energy, const SiParameters& si) { add(energy, of_energy, si); }

}  // namespace vines::api
