#include "api/columns.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "api/warning_text.hpp"

namespace vines::api {

namespace {

/// The column `member` of each entry of a list.
template <auto member>
constexpr auto each = [](const auto& entries) {
    return column(entries, [](const auto& entry) { return std::invoke(member, entry); });
};

/// The list `member` of a result.
template <auto member>
constexpr auto list = [](const auto& result) { return column(result.*member); };

MatrixByRows by_rows(const Matrix4& m) {
    MatrixByRows rows;
    for (int i = 0; i < 4; ++i) rows[i] = {m(i, 0), m(i, 1), m(i, 2), m(i, 3)};
    return rows;
}

template <auto member>
constexpr auto matrices = [](const TransferMatrices& m) { return column(m.*member, by_rows); };

template <auto member>
constexpr auto at_impact = [](const std::vector<SectionPoint>& points) {
    return column(points, [](const SectionPoint& p) { return std::invoke(member, p.impact); });
};

template <std::size_t k>
constexpr auto exponent = [](const ExponentHistory& history) {
    return column(history.lambda, [](const Exponents& lambda) { return lambda[k]; });
};

template <auto member>
constexpr auto second_run = [](const Perturbation& p) { return column(p.series.*member); };

constexpr const char* since_start = "exponent from the window's start to tau";

constexpr Column<Series> series_table[] = {
    {quantity.tau.with("equal steps, then the end of the run"), list<&Series::tau>},
    {quantity.x, list<&Series::x>},
    {quantity.x_dot, list<&Series::x_dot>},
    {quantity.y, list<&Series::y>},
    {quantity.y_dot, list<&Series::y_dot>},
    {quantity.x_ddot, list<&Series::x_ddot>},
};

constexpr Column<std::vector<StickingPhase>> sticking_table[] = {
    {quantity.side.with("side of the wall"),
     [](const auto& sticks) { return column(sticks, [](auto& s) { return s.start.side; }); }},
    {quantity.tau_start.with("start: the end of the chatter"),
     [](const auto& sticks) { return column(sticks, [](auto& s) { return s.start.tau; }); }},
    {quantity.tau_end.with("release, or the end of the run"), each<&StickingPhase::tau_end>},
    {{"impacts",
      "impacts of the chatter, all on this side; it is followed until the remainder would last "
      "less than 1e-9 in tau",
      ValueType::whole},
     [](const auto& sticks) { return column(sticks, [](auto& s) { return s.start.impacts; }); }},
};

constexpr Column<std::vector<GrazingEvent>> touch_table[] = {
    {quantity.tau, each<&GrazingEvent::tau>},
    {quantity.side, each<&GrazingEvent::side>},
};

constexpr Column<TransferModuli> moduli_table[] = {
    {quantity.tau, list<&TransferModuli::tau>},
    {{"J", "transfer matrix of the flight before the impact: four moduli, descending",
      ValueType::moduli},
     list<&TransferModuli::J>},
    {{"M", "transfer matrix of the impact", ValueType::moduli}, list<&TransferModuli::M>},
    {{"T", "T = M J; null if rounding leaves no accurate digit, at the end of a chatter",
      ValueType::exponents},
     list<&TransferModuli::T>},
    {{"M_condition", "condition number of M in the Frobenius norm; null if R = 0",
      ValueType::number_or_null},
     list<&TransferModuli::M_condition>},
};

constexpr Column<TransferMatrices> matrix_table[] = {
    {quantity.tau, list<&TransferMatrices::tau>},
    {{"order", "order of rows and columns: x_dot, x, y_dot, y", ValueType::component},
     [](const TransferMatrices&) { return Json{"x_dot", "x", "y_dot", "y"}; }},
    {{"J", "transfer matrix of the flight before the impact, by rows", ValueType::matrix},
     matrices<&TransferMatrices::J>},
    {{"M", "transfer matrix of the impact, by rows", ValueType::matrix},
     matrices<&TransferMatrices::M>},
    {{"T", "T = M J, by rows", ValueType::matrix}, matrices<&TransferMatrices::T>},
};

constexpr Column<std::vector<SectionPoint>> impact_section_table[] = {
    {quantity.tau.with("time of each impact in the window"), at_impact<&Impact::tau>},
    {quantity.side, at_impact<&Impact::side>},
    {quantity.phase, at_impact<&Impact::phase>},
    {quantity.x, at_impact<&Impact::x>},
    {quantity.x_dot_after, at_impact<&Impact::x_dot_after>},
    {quantity.y_dot_after, at_impact<&Impact::y_dot_after>},
    {quantity.time_difference, each<&SectionPoint::since>},
};

constexpr Column<std::vector<State>> state_table[] = {
    {quantity.x, each<&State::x>},
    {quantity.x_dot, each<&State::x_dot>},
    {quantity.y, each<&State::y>},
    {quantity.y_dot, each<&State::y_dot>},
};

constexpr Column<std::vector<ManifoldPoint>> branch_table[] = {
    {quantity.C.with("amplitudes of the oscillator, m"), each<&ManifoldPoint::C>},
    {quantity.V.with("speeds of the ball, m per unit of tau"), each<&ManifoldPoint::V>},
};

constexpr Column<ExponentHistory> history_table[] = {
    {quantity.tau.with("every impact, or every second, fourth, ..."), list<&ExponentHistory::tau>},
    {{"lambda1", since_start, ValueType::number_or_null}, exponent<0>},
    {{"lambda2", since_start, ValueType::number_or_null}, exponent<1>},
    {{"lambda3", since_start, ValueType::number_or_null}, exponent<2>},
    {{"lambda4", since_start, ValueType::number_or_null}, exponent<3>},
};

constexpr Column<Regime> moving_z_table[] = {
    {quantity.tau.with("middle of ten cycles"), list<&Regime::moving_tau>},
    {{"z", "contacts per cycle in these ten"}, list<&Regime::moving_z>},
};

constexpr Column<std::vector<SynchronyStretch>> stretch_table[] = {
    {quantity.tau_start.with("start of each stretch"), each<&SynchronyStretch::tau_start>},
    {quantity.tau_end.with("end of each stretch"), each<&SynchronyStretch::tau_end>},
    {{"synchronised", "true for a synchronised stretch", ValueType::flag},
     each<&SynchronyStretch::synchronised>},
    {{"contacts", "number of contacts in the stretch", ValueType::whole},
     each<&SynchronyStretch::contacts>},
};

constexpr Column<Perturbation> perturbation_table[] = {
    {quantity.tau.with("times of the series, up to the end of the shorter run"),
     second_run<&Series::tau>},
    {quantity.x.with("displacement of the oscillator in the second run, m"),
     second_run<&Series::x>},
    {quantity.x_dot.with("velocity of the oscillator in the second run"),
     second_run<&Series::x_dot>},
    {quantity.y.with("displacement of the ball in the second run, m"), second_run<&Series::y>},
    {quantity.y_dot.with("velocity of the ball in the second run"), second_run<&Series::y_dot>},
};

constexpr Column<std::vector<IdentifiedImpact>> identified_wall_table[] = {
    {quantity.tau, each<&IdentifiedImpact::tau>},
    {quantity.side.with("wall"), each<&IdentifiedImpact::side>},
};

constexpr Column<std::vector<IdentifiedImpact>> identified_table[] = {
    {quantity.x.with("displacement, m").or_null(), each<&IdentifiedImpact::x>},
    {quantity.x_dot_before.with("estimated velocity of the oscillator").or_null(),
     each<&IdentifiedImpact::x_dot_before>},
    {quantity.x_dot_after.with("estimated velocity of the oscillator").or_null(),
     each<&IdentifiedImpact::x_dot_after>},
    {quantity.x_ddot_before.with("estimated acceleration of the oscillator").or_null(),
     each<&IdentifiedImpact::x_ddot_before>},
    {quantity.y_dot_before.with("velocity of the ball, from its flights, eq. (43)").or_null(),
     each<&IdentifiedImpact::y_dot_before>},
    {quantity.y_dot_after.with("velocity of the ball, from its flights, eq. (43)").or_null(),
     each<&IdentifiedImpact::y_dot_after>},
    {{"R", "restitution coefficient, eq. (4); null for the first and the last impact",
      ValueType::number_or_null},
     each<&IdentifiedImpact::R>},
    {{"momentum_error", "error of x' + epsilon y', over the median jump of x'",
      ValueType::number_or_null},
     each<&IdentifiedImpact::momentum_error>},
    {{"status",
      "ok, R is not known, hidden, or the reason why the exponents exclude the impact: R outside "
      "[0, 1], momentum not kept, picked twice, ...",
      ValueType::word},
     [](const auto& impacts) {
         return column(impacts, [](const IdentifiedImpact& i) -> std::string {
             if (i.is_left_out()) return text_of(i.fault);
             if (i.is_hidden) return "hidden";
             return std::isnan(i.R) ? "R is not known" : "ok";
         });
     }},
};

constexpr Column<std::vector<OscillatorMotion>> fitted_motion_table[] = {
    {quantity.x, each<&OscillatorMotion::x>},
    {quantity.x_dot, each<&OscillatorMotion::x_dot>},
    {quantity.x_ddot.with("acceleration of the oscillator, without the pulses of impacts"),
     each<&OscillatorMotion::x_ddot>},
};

constexpr Column<std::vector<Impact>> forward_impact_table[] = {
    {quantity.tau, each<&Impact::tau>},
    {quantity.side.with("wall"), each<&Impact::side>},
    {quantity.x.with("displacement, m"), each<&Impact::x>},
    {quantity.x_dot_after, each<&Impact::x_dot_after>},
};

using Scales = ImpactScales;

constexpr ImpactColumn impact_table[] = {
    {quantity.tau, [](const Impact& i, const Scales&) { return i.tau; }},
    {quantity.side, [](const Impact& i, const Scales&) { return static_cast<double>(i.side); }},
    {quantity.phase, [](const Impact& i, const Scales&) { return i.phase(); }},
    {quantity.x, [](const Impact& i, const Scales&) { return i.x; }},
    {quantity.x_dot_before, [](const Impact& i, const Scales&) { return i.x_dot_before; }},
    {quantity.x_dot_after, [](const Impact& i, const Scales&) { return i.x_dot_after; }},
    {quantity.y_dot_before, [](const Impact& i, const Scales&) { return i.y_dot_before; }},
    {quantity.y_dot_after, [](const Impact& i, const Scales&) { return i.y_dot_after; }},
    {quantity.x_ddot_before, [](const Impact& i, const Scales&) { return i.x_ddot_before; }},
    {quantity.relative_speed,
     [](const Impact& i, const Scales&) { return std::abs(i.relative_speed_before); }},
    {quantity.impulse, [](const Impact& i, const Scales& s) { return i.impulse(s.epsilon); }},
    {{"relative_speed_ratio", "relative_speed over its median; 0 for a grazing contact",
      ValueType::number_or_null},
     [](const Impact& i, const Scales& s) {
         return std::abs(i.relative_speed_before) / s.typical_speed;
     }},
    {{"grazing", "true for a nearly tangent impact", ValueType::flag},
     [](const Impact& i, const Scales&) { return i.grazing ? 1. : 0.; }},
};

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

}  // namespace

double value_bytes(const Quantity& q, bool si) {
    return type_bytes(q.type) + (si && q.si_name ? type_bytes(ValueType::number) : 0);
}

Columns<Series> series_columns() { return series_table; }
Columns<std::vector<StickingPhase>> sticking_columns() { return sticking_table; }
Columns<std::vector<GrazingEvent>> touch_columns() { return touch_table; }
Columns<TransferModuli> moduli_columns() { return moduli_table; }
Columns<TransferMatrices> matrix_columns() { return matrix_table; }
Columns<std::vector<SectionPoint>> impact_section_columns() { return impact_section_table; }
Columns<std::vector<State>> state_columns() { return state_table; }
Columns<std::vector<ManifoldPoint>> branch_columns() { return branch_table; }
Columns<ExponentHistory> history_columns() { return history_table; }
Columns<Regime> moving_z_columns() { return moving_z_table; }
Columns<std::vector<SynchronyStretch>> stretch_columns() { return stretch_table; }
Columns<Perturbation> perturbation_columns() { return perturbation_table; }
Columns<std::vector<IdentifiedImpact>> identified_wall_columns() { return identified_wall_table; }
Columns<std::vector<IdentifiedImpact>> identified_columns() { return identified_table; }
Columns<std::vector<OscillatorMotion>> fitted_motion_columns() { return fitted_motion_table; }
Columns<std::vector<Impact>> forward_impact_columns() { return forward_impact_table; }
std::span<const ImpactColumn> impact_columns() { return impact_table; }

Packed ImpactColumn::packing() const {
    return quantity.type == ValueType::wall   ? Packed::integers
           : quantity.type == ValueType::flag ? Packed::flags
                                              : Packed::numbers;
}

Json describe_impacts(const std::vector<Impact>& impacts, const ImpactScales& scales) {
    Json columns = Json::object();
    make_room(columns, std::size(impact_table));
    const auto list_of = [&](const ImpactColumn& c) {
        switch (c.packing()) {
            case Packed::integers:
                return column(
                    impacts, [&](const Impact& i) { return static_cast<int>(c.value(i, scales)); });
            case Packed::flags:
                return column(impacts, [&](const Impact& i) { return c.value(i, scales) != 0; });
            default: return column(impacts, [&](const Impact& i) { return c.value(i, scales); });
        }
    };
    for (const ImpactColumn& c : impact_table) append(columns, {{c.quantity.name, list_of(c)}});
    return columns;
}

}  // namespace vines::api
