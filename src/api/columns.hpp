// The lists of an answer: the columns of each, as quantities and their values for a source.
#pragma once

#include <concepts>
#include <functional>
#include <string>

#include "api/answer_json.hpp"
#include "api/quantity.hpp"
#include "api/schema/enum_names.hpp"
#include "core/analysis/analysis.hpp"
#include "core/measurement/measurement.hpp"

namespace vines::api {

/// A key of an object: `value` returns its value, or its list, for a source.
template <class Source>
struct Property {
    Quantity quantity;
    Json (*value)(const Source& source);
};

/// An object with these properties, all null if the source is null.
template <class Source, std::size_t count>
Json describe(const Property<Source> (&properties)[count], const Source* source) {
    Json object = Json::object();
    make_room(object, count);
    for (const Property<Source>& p : properties)
        append(object, {{p.quantity.name, source ? p.value(*source) : Json(nullptr)}});
    return object;
}
template <class Source, std::size_t count>
Json describe(const Property<Source> (&properties)[count], const Source& source) {
    return describe(properties, &source);
}
/// Null if there is no source.
template <class Source, std::size_t count>
Json describe(const Property<Source> (&properties)[count], const std::optional<Source>& source) {
    return source ? describe(properties, *source) : Json(nullptr);
}

/// Upper bound of a value as JSON text with a comma, in bytes; `si`: and of its SI counterpart.
double value_bytes(const Quantity& quantity, bool si);
double row_bytes(const auto& columns, bool si) {
    double bytes = 0;
    for (const auto& column : columns) bytes += value_bytes(column.quantity, si);
    return bytes;
}

MatrixByRows by_rows(const Matrix4& m);
/// ok, R is not known, hidden, or the reason why the exponents exclude the impact.
std::string status_word(const IdentifiedImpact& impact);

inline Json json_of(double value) { return finite_or_null(value); }
inline Json json_of(std::integral auto value) { return value; }
inline Json json_of(const Exponents& values) { return column(values); }
inline Json json_of(RegimeType type) { return name_of(type); }
inline Json json_of(Verdict verdict) { return enum_json(verdict); }
inline Json json_of(Damping damping) { return enum_json(damping); }
inline Json json_of(Json value) { return value; }
template <class Entry>
Json json_of(const std::vector<Entry>& list) {
    return column(list);
}
template <class Value>
Json json_of(const std::optional<Value>& value) {
    return value ? json_of(*value) : Json(nullptr);
}

/// The value at the end of a path of members; its last one can be a function. JSON null if an
/// optional value on the path is missing; of a list, the column of the values of its entries.
template <auto first, auto... rest>
decltype(auto) value_at(const auto& source) {
    if constexpr (requires { source.has_value(); })
        return source ? json_of(value_at<first, rest...>(*source)) : Json(nullptr);
    else if constexpr (requires { source.capacity(); })
        return column(source, [](const auto& entry) { return value_at<first, rest...>(entry); });
    else if constexpr (sizeof...(rest) > 0) return value_at<rest...>(std::invoke(first, source));
    else return std::invoke(first, source);
}
template <auto... path>
inline constexpr auto at =
    [](const auto& source) -> Json { return json_of(value_at<path...>(source)); };

template <std::size_t k>
inline constexpr auto entry = [](const Exponents& values) { return values[k]; };

inline constexpr const char* since_start = "exponent from the window's start to tau";

// Parts of a simulation. x and y in m, derivatives with respect to tau.

inline constexpr Property<Series> series_columns[] = {
    {quantity.tau.with("equal steps, then the end of the run"), at<&Series::tau>},
    {quantity.x, at<&Series::x>},
    {quantity.x_dot, at<&Series::x_dot>},
    {quantity.y, at<&Series::y>},
    {quantity.y_dot, at<&Series::y_dot>},
    {quantity.x_ddot, at<&Series::x_ddot>},
};

/// Where a load moves the base.
inline constexpr Property<Series> relative_columns[] = {
    {quantity.x_relative, at<&Series::x_relative>},
};

inline constexpr Property<std::vector<StickingPhase>> sticking_columns[] = {
    {quantity.side.with("side of the wall"), at<&StickingPhase::start, &StickStart::side>},
    {quantity.tau_start.with("start: the end of the chatter"),
     at<&StickingPhase::start, &StickStart::tau>},
    {quantity.tau_end.with("release, or the end of the run"), at<&StickingPhase::tau_end>},
    {{"impacts",
      "impacts of the chatter, all on this side; it is followed until the remainder would last "
      "less than 1e-9 in tau, with friction 1e-6",
      ValueType::whole},
     at<&StickingPhase::start, &StickStart::impacts>},
};

inline constexpr Property<std::vector<ContactEvent>> touch_columns[] = {
    {quantity.tau, at<&ContactEvent::tau>},
    {quantity.side, at<&ContactEvent::side>},
};

/// Moduli of the eigenvalues of J, M, T at each impact.
inline constexpr Property<TransferModuli> moduli_columns[] = {
    {quantity.tau, at<&TransferModuli::tau>},
    {{"J", "transfer matrix of the flight before the impact: four moduli, descending",
      ValueType::moduli},
     at<&TransferModuli::J>},
    {{"M", "transfer matrix of the impact", ValueType::moduli}, at<&TransferModuli::M>},
    {{"T", "T = M J; null if rounding leaves no accurate digit, at the end of a chatter",
      ValueType::exponents},
     at<&TransferModuli::T>},
    {{"M_condition", "condition number of M in the Frobenius norm; null if R = 0",
      ValueType::number_or_null},
     at<&TransferModuli::M_condition>},
};

inline constexpr Property<TransferMatrices> matrix_columns[] = {
    {quantity.tau, at<&TransferMatrices::tau>},
    {{"order", "order of rows and columns: x_dot, x, y_dot, y", ValueType::component},
     [](const TransferMatrices&) { return Json{"x_dot", "x", "y_dot", "y"}; }},
    {{"J", "transfer matrix of the flight before the impact, by rows", ValueType::matrix},
     at<&TransferMatrices::J, by_rows>},
    {{"M", "transfer matrix of the impact, by rows", ValueType::matrix},
     at<&TransferMatrices::M, by_rows>},
    {{"T", "T = M J, by rows", ValueType::matrix}, at<&TransferMatrices::T, by_rows>},
};

inline constexpr Property<std::vector<SectionPoint>> impact_section_columns[] = {
    {quantity.tau.with("time of each impact in the window"),
     at<&SectionPoint::impact, &Impact::tau>},
    {quantity.side, at<&SectionPoint::impact, &Impact::side>},
    {quantity.phase, at<&SectionPoint::impact, &Impact::phase>},
    {quantity.x, at<&SectionPoint::impact, &Impact::x>},
    {quantity.x_dot_after, at<&SectionPoint::impact, &Impact::x_dot_after>},
    {quantity.y_dot_after, at<&SectionPoint::impact, &Impact::y_dot_after>},
    {quantity.time_difference, at<&SectionPoint::since>},
};

inline constexpr Property<std::vector<State>> state_columns[] = {
    {quantity.x, at<&State::x>},
    {quantity.x_dot, at<&State::x_dot>},
    {quantity.y, at<&State::y>},
    {quantity.y_dot, at<&State::y_dot>},
};

inline constexpr Property<std::vector<ManifoldPoint>> branch_columns[] = {
    {quantity.C.with("amplitudes of the oscillator, m"), at<&ManifoldPoint::C>},
    {quantity.V.with("speeds of the ball, m per unit of tau"), at<&ManifoldPoint::V>},
};

inline constexpr Property<ExponentHistory> history_columns[] = {
    {quantity.tau.with("every impact, or every second, fourth, ..."), at<&ExponentHistory::tau>},
    {{"lambda1", since_start, ValueType::number_or_null}, at<&ExponentHistory::lambda, entry<0>>},
    {{"lambda2", since_start, ValueType::number_or_null}, at<&ExponentHistory::lambda, entry<1>>},
    {{"lambda3", since_start, ValueType::number_or_null}, at<&ExponentHistory::lambda, entry<2>>},
    {{"lambda4", since_start, ValueType::number_or_null}, at<&ExponentHistory::lambda, entry<3>>},
};

inline constexpr Property<Regime> moving_z_columns[] = {
    {quantity.tau.with("middle of ten cycles"), at<&Regime::moving_tau>},
    {{"z", "contacts per cycle in these ten"}, at<&Regime::moving_z>},
};

inline constexpr Property<std::vector<SynchronyStretch>> stretch_columns[] = {
    {quantity.tau_start.with("start of each stretch"), at<&SynchronyStretch::tau_start>},
    {quantity.tau_end.with("end of each stretch"), at<&SynchronyStretch::tau_end>},
    {{"synchronised", "true for a synchronised stretch", ValueType::flag},
     at<&SynchronyStretch::synchronised>},
    {{"contacts", "number of contacts in the stretch", ValueType::whole},
     at<&SynchronyStretch::contacts>},
};

inline constexpr Property<Perturbation> perturbation_columns[] = {
    {quantity.tau.with("times of the series, up to the end of the shorter run"),
     at<&Perturbation::series, &Series::tau>},
    {quantity.x.with("displacement of the oscillator in the second run, m"),
     at<&Perturbation::series, &Series::x>},
    {quantity.x_dot.with("velocity of the oscillator in the second run"),
     at<&Perturbation::series, &Series::x_dot>},
    {quantity.y.with("displacement of the ball in the second run, m"),
     at<&Perturbation::series, &Series::y>},
    {quantity.y_dot.with("velocity of the ball in the second run"),
     at<&Perturbation::series, &Series::y_dot>},
};

// Parts of an identification.

/// Time and wall of an impact, which the direct estimate shares with the fit; the other columns.
inline constexpr Property<std::vector<IdentifiedImpact>> identified_wall_columns[] = {
    {quantity.tau, at<&IdentifiedImpact::tau>},
    {quantity.side.with("wall"), at<&IdentifiedImpact::side>},
    {quantity.tau_error.with("standard error of the time; null in a list or if hidden"),
     at<&IdentifiedImpact::tau_error>},
};

inline constexpr Property<std::vector<IdentifiedImpact>> identified_columns[] = {
    {quantity.x.with("displacement, m").or_null(), at<&IdentifiedImpact::x>},
    {quantity.x_dot_before.with("estimated velocity of the oscillator").or_null(),
     at<&IdentifiedImpact::x_dot_before>},
    {quantity.x_dot_after.with("estimated velocity of the oscillator").or_null(),
     at<&IdentifiedImpact::x_dot_after>},
    {quantity.x_ddot_before.with("estimated acceleration of the oscillator").or_null(),
     at<&IdentifiedImpact::x_ddot_before>},
    {quantity.y_dot_before.with("velocity of the ball, from its flights, eq. (43)").or_null(),
     at<&IdentifiedImpact::y_dot_before>},
    {quantity.y_dot_after.with("velocity of the ball, from its flights, eq. (43)").or_null(),
     at<&IdentifiedImpact::y_dot_after>},
    {{"R", "restitution coefficient, eq. (4); null for the first and the last impact",
      ValueType::number_or_null},
     at<&IdentifiedImpact::R>},
    {{"momentum_error", "error of x' + epsilon y', over the median jump of x'",
      ValueType::number_or_null},
     at<&IdentifiedImpact::momentum_error>},
    {{"status",
      "ok, R is not known, hidden, or the reason why the exponents exclude the impact: R outside "
      "[0, 1], momentum not kept, picked twice, ...",
      ValueType::word},
     at<status_word>},
};

/// The fitted motion at chosen times, without these.
inline constexpr Property<std::vector<OscillatorMotion>> fitted_motion_columns[] = {
    {quantity.x, at<&OscillatorMotion::x>},
    {quantity.x_dot, at<&OscillatorMotion::x_dot>},
    {quantity.x_ddot.with("acceleration of the oscillator, without the pulses of impacts"),
     at<&OscillatorMotion::x_ddot>},
};

/// Impacts of a run of the identified system.
inline constexpr Property<std::vector<Impact>> forward_impact_columns[] = {
    {quantity.tau, at<&Impact::tau>},
    {quantity.side.with("wall"), at<&Impact::side>},
    {quantity.x.with("displacement, m"), at<&Impact::x>},
    {quantity.x_dot_after, at<&Impact::x_dot_after>},
};

/// The columns of `impacts` in a request to /v1/identify.
struct ImpactList {
    Quantity tau = quantity.tau.with("dimensionless time tau = omega0 t; or use time_s");
    Quantity x = quantity.x;
    Quantity side = quantity.side.with("1 or -1; default: from the jump of x'");
    Quantity phase = quantity.phase.with("phase of the forcing; default: fitted to the impacts");
    Quantity x_dot_before = quantity.x_dot_before;
    Quantity x_dot_after = quantity.x_dot_after;
    Quantity y_dot_before =
        quantity.y_dot_before
            .with("velocity of the ball; default: from its positions at successive impacts")
            .or_null();
    Quantity y_dot_after =
        quantity.y_dot_after
            .with("velocity of the ball; default: from its positions at successive impacts")
            .or_null();
    Quantity x_ddot_before = quantity.x_ddot_before.with(
        "acceleration of the oscillator before the impact, if phase is unknown");
};
inline constexpr ImpactList impact_list;

/// Scales of impulses and speeds of impacts.
struct ImpactScales {
    double epsilon;
    double typical_speed;  ///< see Analysis, m per unit of tau
};

/// A column of listed impacts and its value for one impact; flags are 0 or 1.
struct ImpactColumn {
    Quantity quantity;
    double (*value)(const Impact& impact, const ImpactScales& scales);

    Packed packing() const;
    /// Sets entry k of the packed list to the value for the impact; a number times `factor`.
    void put(
        std::uint8_t* list, std::size_t k, const Impact& impact, const ImpactScales& scales,
        double factor = 1) const;
};
template <auto member>
inline constexpr auto of_impact = [](const Impact& impact, const ImpactScales&) {
    return static_cast<double>(std::invoke(member, impact));
};

inline constexpr ImpactColumn impact_columns[] = {
    {quantity.tau, of_impact<&Impact::tau>},
    {quantity.side, of_impact<&Impact::side>},
    {quantity.phase, of_impact<&Impact::phase>},
    {quantity.x, of_impact<&Impact::x>},
    {quantity.x_dot_before, of_impact<&Impact::x_dot_before>},
    {quantity.x_dot_after, of_impact<&Impact::x_dot_after>},
    {quantity.y_dot_before, of_impact<&Impact::y_dot_before>},
    {quantity.y_dot_after, of_impact<&Impact::y_dot_after>},
    {quantity.x_ddot_before, of_impact<&Impact::x_ddot_before>},
    {quantity.relative_speed,
     [](const Impact& i, const ImpactScales&) { return std::abs(i.relative_speed_before); }},
    {quantity.impulse, [](const Impact& i, const ImpactScales& s) { return i.impulse(s.epsilon); }},
    {{"relative_speed_ratio", "relative_speed over its median; 0 for a grazing contact",
      ValueType::number_or_null},
     [](const Impact& i, const ImpactScales& s) {
         return std::abs(i.relative_speed_before) / s.typical_speed;
     }},
    {{"grazing", "true for a nearly tangent impact", ValueType::flag}, of_impact<&Impact::grazing>},
};

Json describe_impacts(const std::vector<Impact>& impacts, const ImpactScales& scales);

}  // namespace vines::api
