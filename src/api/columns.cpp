#include "api/columns.hpp"

#include "api/describe.hpp"

namespace vines::api {

namespace {

/// Upper bound of a value as JSON text with a comma, in bytes.
double type_bytes(ValueType type) {
    // The longest double in its shortest form: "-2.2250738585072014e-308,".
    constexpr double of_number = 25, brackets = 2;
    switch (type) {
        case ValueType::wall: return 3;
        case ValueType::whole: return 8;  // up to 2000000
        case ValueType::flag: return 6;
        case ValueType::word:
        case ValueType::component: return 0;  // in no list whose length is chosen
        case ValueType::moduli:
        case ValueType::exponents: return 4 * of_number + brackets;
        case ValueType::matrix: return 16 * of_number + 5 * brackets;
        default: return of_number;
    }
}

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

double value_bytes(const Quantity& q, bool si) {
    return type_bytes(q.type) + (si && q.si_name ? type_bytes(ValueType::number) : 0);
}

MatrixByRows by_rows(const Matrix4& m) {
    MatrixByRows rows;
    for (int i = 0; i < 4; ++i) rows[i] = {m(i, 0), m(i, 1), m(i, 2), m(i, 3)};
    return rows;
}

std::string status_word(const IdentifiedImpact& i) {
    if (i.is_left_out()) return text_of(i.fault);
    if (i.is_hidden) return "hidden";
    return std::isnan(i.R) ? "R is not known" : "ok";
}

Packed ImpactColumn::packing() const {
    return quantity.type == ValueType::wall   ? Packed::integers
           : quantity.type == ValueType::flag ? Packed::flags
                                              : Packed::numbers;
}

void ImpactColumn::put(
    std::uint8_t* list, std::size_t k, const Impact& impact, const ImpactScales& scales,
    double factor) const {
    const double number = value(impact, scales);
    const auto set = [&](auto entry) {
        std::memcpy(list + k * sizeof entry, &entry, sizeof entry);
    };
    switch (packing()) {
        case Packed::integers: return set(static_cast<int>(number));
        case Packed::flags: return set(number != 0);
        default: return set(number * factor);
    }
}

Json describe_impacts(const std::vector<Impact>& impacts, const ImpactScales& scales) {
    Json columns = Json::object();
    make_room(columns, std::size(impact_columns));
    for (const ImpactColumn& c : impact_columns) {
        std::vector<std::uint8_t> list(impacts.size() * entry_size(c.packing()));
        for (std::size_t k = 0; k < impacts.size(); ++k) c.put(list.data(), k, impacts[k], scales);
        append(
            columns, {{c.quantity.name,
                       Json::binary(std::move(list), static_cast<std::uint8_t>(c.packing()))}});
    }
    return columns;
}

}  // namespace vines::api
