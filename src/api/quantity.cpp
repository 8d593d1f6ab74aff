#include "api/quantity.hpp"

#include <utility>

#include "api/answer_json.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

Json scaled(const Json& value, double factor) {
    if (value.is_number()) return value.get<double>() * factor;
    if (value.is_null()) return nullptr;  // a number that does not exist
    Json list = value;
    if (value.is_binary())
        change_numbers(list.get_binary(), [factor](double number) { return number * factor; });
    else
        for (Json& v : list) v = scaled(v, factor);
    return list;
}

template <class Table>
void add(Json& object, const Table& table, const SiParameters& si) {
    make_room(object, object.size());
    for (const Quantity& q : table)
        if (q.si_name && object.contains(q.name) && !object[q.name].is_string() &&
            !object.contains(q.si_name))
            object[q.si_name] = scaled(object[q.name], si_factor(q, si));
}

}  // namespace

double si_factor(const Quantity& q, const SiParameters& si) {
    return elementary::pow(si.omega0(), q.power) * (q.per_m1 ? si.m1 : 1);
}

void add_si(Json& part, const SiParameters& si) {
    if (!part.is_object()) {
        if (part.is_array() && !part.empty() && part[0].is_object())
            for (Json& entry : part) add_si(entry, si);
        return;
    }
    static const auto table = members_of(quantity);
    add(part, table, si);
    for (auto& [name, value] : part.items()) add_si(value, si);
}

void add_joules(Json& energy, const SiParameters& si) { add(energy, members_of(energies), si); }

}  // namespace vines::api
