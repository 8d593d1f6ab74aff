// The lists of an answer: the columns of each, as quantities and their values for a source.
#pragma once

#include <span>
#include <vector>

#include "api/answer_json.hpp"
#include "api/quantity.hpp"
#include "core/analysis/analysis.hpp"
#include "core/measurement/measurement.hpp"

namespace vines::api {

/// A column of a list: `values` returns its list for a source.
template <class Source>
struct Column {
    Quantity quantity;
    Json (*values)(const Source& source);
};
template <class Source>
using Columns = std::span<const Column<Source>>;

/// The columns as an object of lists.
template <class Source>
Json describe(Columns<Source> columns, const Source& source) {
    Json lists = Json::object();
    make_room(lists, columns.size());
    for (const Column<Source>& c : columns) append(lists, {{c.quantity.name, c.values(source)}});
    return lists;
}

/// Upper bound of a value as JSON text with a comma, in bytes; `si`: and of its SI counterpart.
double value_bytes(const Quantity& quantity, bool si);
/// Upper bound of a row of these columns.
double row_bytes(const auto& columns, bool si) {
    double bytes = 0;
    for (const auto& column : columns) bytes += value_bytes(column.quantity, si);
    return bytes;
}

// Parts of a simulation. x and y in m, derivatives with respect to tau.

Columns<Series> series_columns();
Columns<std::vector<StickingPhase>> sticking_columns();
Columns<std::vector<GrazingEvent>> touch_columns();
/// Moduli of the eigenvalues of J, M, T at each impact.
Columns<TransferModuli> moduli_columns();
Columns<TransferMatrices> matrix_columns();
Columns<std::vector<SectionPoint>> impact_section_columns();
Columns<std::vector<State>> state_columns();
Columns<std::vector<ManifoldPoint>> branch_columns();
/// Exponents as functions of time.
Columns<ExponentHistory> history_columns();
Columns<Regime> moving_z_columns();
Columns<std::vector<SynchronyStretch>> stretch_columns();
/// The motion of the second run.
Columns<Perturbation> perturbation_columns();

// Parts of an identification.

/// Time and wall of an impact, which the direct estimate shares with the fit; the other columns.
Columns<std::vector<IdentifiedImpact>> identified_wall_columns();
Columns<std::vector<IdentifiedImpact>> identified_columns();
/// The fitted motion at chosen times, without these.
Columns<std::vector<OscillatorMotion>> fitted_motion_columns();
/// Impacts of a run of the identified system.
Columns<std::vector<Impact>> forward_impact_columns();

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
};
std::span<const ImpactColumn> impact_columns();

Json describe_impacts(const std::vector<Impact>& impacts, const ImpactScales& scales);

}  // namespace vines::api
