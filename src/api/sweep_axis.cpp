#include "api/sweep_request.hpp"

#include <algorithm>

#include "api/schema/check.hpp"
#include "api/schema/tables.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

bool is_parameter(const std::string& name) {
    const Field* field = find(sweep_base_fields(), name);
    return field && field->type == FieldType::number;
}

std::vector<std::string> parameter_names() {
    std::vector<std::string> names;
    for (const Field& f : sweep_base_fields())
        if (f.type == FieldType::number) names.push_back(f.name);
    return names;
}

/// `count` values from `from` to `to`; both ends are exact.
std::vector<double> spaced(double from, double to, std::size_t count, bool logarithmic) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        const double share =
            count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
        values.push_back(
            logarithmic ? from * elementary::pow(to / from, share) : from + share * (to - from));
    }
    if (count > 1) values.back() = to;
    return values;
}

void check_values(const Json& j, std::size_t most, std::vector<FieldError>& errors) {
    for (const char* name : {"from", "to", "count", "scale"})
        if (j.contains(name))
            errors.push_back(
                {std::string("/") + name, j[name], nullptr,
                 "values and from, to, count, scale exclude each other"});
    const Json& values = j["values"];
    if (!values.is_array()) return;
    if (values.empty())
        errors.push_back({"/values", values, nullptr, "values must hold at least one number"});
    if (values.size() > most)
        errors.push_back(
            {"/values", values.size(), Json::array({1, most}),
             "values can hold at most " + std::to_string(most) + " numbers"});
}

std::vector<FieldError> faults_of(const Json& j, std::size_t most) {
    std::vector<FieldError> errors = check(axis_fields(), j);
    if (!j.contains("parameter"))
        errors.push_back({"/parameter", nullptr, parameter_names(), "an axis needs its parameter"});
    else if (j["parameter"].is_string() && !is_parameter(j["parameter"]))
        errors.push_back(
            {"/parameter", j["parameter"], parameter_names(),
             "there is no parameter of this name to sweep"});
    if (j.contains("values")) {
        check_values(j, most, errors);
    } else {
        for (const char* name : {"from", "to", "count"})
            if (!j.contains(name))
                errors.push_back(
                    {std::string("/") + name, nullptr, nullptr,
                     "an axis needs from, to and count, or values"});
    }
    if (!errors.empty() || j.value("scale", "linear") != "log") return errors;
    for (const char* name : {"from", "to"})
        if (!(j[name].get<double>() > 0)) {
            errors.push_back(
                {std::string("/") + name, j[name], nullptr,
                 "a logarithmic axis runs between positive numbers"});
            break;
        }
    return errors;
}

}  // namespace

Axis read_axis(
    const Json& j, const std::string& where, std::size_t most, std::vector<FieldError>& errors) {
    if (!j.is_object()) {
        errors.push_back(
            {where, j, nullptr,
             "an axis is {parameter, from, to, count, scale} or {parameter, values}"});
        return {};
    }
    std::vector<FieldError> faults = faults_of(j, most);
    if (!faults.empty()) {
        add_errors(where, std::move(faults), errors);
        return {};
    }
    Axis axis{
        j["parameter"], j.contains("values")
                            ? j["values"].get<std::vector<double>>()
                            : spaced(
                                  j["from"].get<double>(), j["to"].get<double>(),
                                  static_cast<std::size_t>(j["count"].get<double>()),
                                  j.value("scale", "linear") == "log")};
    const auto [least, largest] = std::ranges::minmax(axis.values);
    for (const double value : {least, largest})
        for (FieldError& e : check(sweep_base_fields(), {{axis.parameter, value}})) {
            e.pointer = where;
            errors.push_back(std::move(e));
        }
    return axis;
}

}  // namespace vines::api
