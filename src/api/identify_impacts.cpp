#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <optional>

#include "api/columns.hpp"
#include "api/identify_parts.hpp"
#include "api/parse.hpp"
#include "api/schema/check.hpp"
#include "core/measurement/identified_impact.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

// Largest misfit, as a fraction of the oscillator's speed, of a list that belongs to this
// oscillator and frequency.
constexpr double most_misfit = 0.1;

/// The name under which a list gives a column: in units of tau or in SI; null if it is missing.
const char* name_in(const Json& list, const Quantity& q) {
    if (list.contains(q.name)) return q.name;
    return q.si_name && list.contains(q.si_name) ? q.si_name : nullptr;
}

class ImpactColumnReader {
public:
    ImpactColumnReader(const IdentifyRequest& r, Json& given, std::size_t most, CancelCheck& cancel)
        : given_(given),
          most_(most),
          cancel_(cancel),
          omega0_(r.system.si ? std::optional(r.system.si->omega0()) : std::nullopt) {}

    /// The column in units of tau; empty, with an error, if it is missing. A column that may hold
    /// nulls has NaN for them.
    std::vector<double> column(const Quantity& q) {
        const char* const name = name_in(given_, q);
        if (!name) {
            const std::string other = q.si_name ? std::string(" or ") + q.si_name : "";
            fail(q.name, nullptr, q.name + other + " is missing");
            return {};
        }
        const bool is_si = !given_.contains(q.name);
        if (is_si && !omega0_)
            fail(
                name, nullptr,
                std::string(name) + " is in SI: give m1, c1, k1, m2 and f, or a preset, or " +
                    q.name);
        double factor = 1;
        for (int k = 0; is_si && omega0_ && k < std::abs(q.power); ++k)
            q.power > 0 ? factor /= * omega0_ : factor *= *omega0_;
        return values_of(name, factor, q.type == ValueType::number_or_null);
    }
    std::vector<double> optional_column(const Quantity& q) {
        return name_in(given_, q) ? column(q) : std::vector<double>();
    }
    const char* name_of(const Quantity& q) const { return name_in(given_, q); }
    void fail(const std::string& at, const Json& value, const std::string& text) {
        if (errors_.size() < most_errors)
            errors_.push_back({"/impacts/" + at, value, nullptr, text});
    }
    void refuse_faults() {
        if (!errors_.empty()) refuse(std::move(errors_));
    }

private:
    std::vector<double> values_of(const std::string& name, double factor, bool may_be_null) {
        Json& given = given_[name];
        std::vector<double> values;
        if (!given.is_array()) {
            fail(name, nullptr, name + " is an array of numbers");
            return values;
        }
        const std::size_t size = entries_of(given);
        if (size > most_)
            throw Problem(
                413, fmt::format(
                         "the list has {} impacts, more than this server's limit of {}: send a "
                         "part of them",
                         size, most_));
        if (!first_.empty() && size != size_)
            fail(name, size, name + " differs in length from " + first_);
        if (first_.empty()) first_ = name, size_ = size;
        values.reserve(size);
        take_entries(given, [&](std::size_t i, double number, const Json& value) {
            cancel_.step();
            if (!std::isnan(number)) values.push_back(factor * number);
            else if (may_be_null && value.is_null()) values.push_back(nan);
            else fail(name + "/" + std::to_string(i), beginning_of(value), "must be a number");
        });
        return values;
    }

    Json& given_;
    const std::size_t most_;
    CancelCheck& cancel_;
    const std::optional<double> omega0_;
    std::string first_;  // name and length of the first column
    std::size_t size_ = 0;
    std::vector<FieldError> errors_;
};

/// The columns of the list; empty if not given.
struct ListedColumns {
    std::vector<double> tau, x, before, after, side, phase, acceleration, y_before, y_after;
};

ListedColumns read_columns(ImpactColumnReader& list) {
    ListedColumns c{
        .tau = list.column(impact_list.tau),
        .x = list.column(impact_list.x),
        .before = list.column(impact_list.x_dot_before),
        .after = list.column(impact_list.x_dot_after),
        .side = list.optional_column(impact_list.side),
        .phase = list.optional_column(impact_list.phase),
        .acceleration = {},
        .y_before = list.optional_column(impact_list.y_dot_before),
        .y_after = list.optional_column(impact_list.y_dot_after)};
    if (c.phase.empty()) c.acceleration = list.optional_column(impact_list.x_ddot_before);
    list.refuse_faults();
    if (c.tau.size() < 2)
        refuse({{"/impacts", c.tau.size(), nullptr, "exponents need at least two impacts"}});
    for (std::size_t i = 0; i < c.tau.size(); ++i) {
        if (i > 0 && !(c.tau[i] > c.tau[i - 1]))
            list.fail(
                list.name_of(impact_list.tau) + ("/" + std::to_string(i)), c.tau[i],
                "the times of the impacts must increase");
        if (!c.side.empty() && std::abs(c.side[i]) != 1)
            list.fail("side/" + std::to_string(i), c.side[i], "a side is 1 or -1");
    }
    list.refuse_faults();
    return c;
}

/// The wall of an impact: x' decreases at side 1 and increases at side -1.
int side_of(const ListedColumns& c, std::size_t i) {
    if (!c.side.empty()) return static_cast<int>(c.side[i]);
    return c.after[i] > c.before[i] ? -1 : 1;
}

/// Fits the forcing to the list if needed, and restores impacts that it lacks.
void take_motion(IdentifyRequest& r, CancelCheck& cancel) {
    Parameters& p = r.measurement.parameters;
    std::vector<IdentifiedImpact>& impacts = r.measurement.impacts;
    const ListedForcing forcing = fit_forcing(p, impacts, [&cancel] { cancel.step(); });
    if (r.forcing_fitted) p.G = G_of(p, forcing.sin, forcing.cos);
    if (!(forcing.misfit < most_misfit)) {
        r.notes.push_back(fmt::format(
            "no forcing at this frequency leads from each impact to the next: the states miss it "
            "by {:.2g} of the oscillator's speed. Is f, a mass, a stiffness or a unit wrong, or "
            "are impacts missing?",
            forcing.misfit));
        r.measurement.doubts.push_back(Doubt::no_forcing);
        return;
    }
    insert_missing_impacts(p, forcing, impacts, [&cancel] { cancel.step(); });
}

}  // namespace

bool has_phase(const Json& impacts) {
    return impacts.is_object() && name_in(impacts, impact_list.phase);
}

void read_impact_list(IdentifyRequest& r, Json given, std::size_t most, CancelCheck& cancel) {
    if (!given.is_object())
        refuse("/impacts", "impacts is an object of columns, as in the answer of /v1/simulate");
    ImpactColumnReader list(r, given, most, cancel);
    ListedColumns c = read_columns(list);
    given = nullptr;
    const Parameters& p = r.system.parameters;
    const auto flow = Flow::shared_free(p);
    std::vector<IdentifiedImpact>& impacts = r.measurement.impacts;
    impacts.reserve(c.tau.size());
    for (std::size_t i = 0; i < c.tau.size(); ++i) {
        cancel.step();
        IdentifiedImpact impact{
            .tau = c.tau[i],
            .side = side_of(c, i),
            .x = c.x[i],
            .x_dot_before = c.before[i],
            .x_dot_after = c.after[i],
            .x_ddot_before = c.acceleration.empty() ? nan : c.acceleration[i]};
        if (!c.phase.empty())
            impact.x_ddot_before = flow->acceleration(
                {c.x[i], c.before[i], elementary::sin(c.phase[i]), elementary::cos(c.phase[i])});
        if (!c.y_before.empty()) impact.y_dot_before = c.y_before[i];
        if (!c.y_after.empty()) impact.y_dot_after = c.y_after[i];
        impacts.push_back(impact);
    }
    c = {};
    take_motion(r, cancel);
    set_flight_velocities(p, impacts);
    complete_impacts(p, impacts, 0);
}

}  // namespace vines::api
