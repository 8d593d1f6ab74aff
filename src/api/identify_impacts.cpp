#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "api/columns.hpp"
#include "api/identify_parts.hpp"
#include "api/parse.hpp"
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
    void refuse_faults() const { refuse_any(errors_); }

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

/// Reads the columns into impacts, as far as the list states them; a wall follows from the jump of
/// x', which decreases at side 1, an acceleration from the phase.
std::vector<IdentifiedImpact> read_impacts(
    ImpactColumnReader& list, const Parameters& p, CancelCheck& cancel) {
    const auto flow = Flow::shared_free(p);
    std::vector<IdentifiedImpact> impacts;
    const auto take = [&impacts](
                          const std::vector<double>& column, double IdentifiedImpact::* value) {
        if (impacts.empty()) impacts.resize(column.size(), {0, 0, 0, 0, 0, nan});
        for (std::size_t i = 0; i < std::min(column.size(), impacts.size()); ++i)
            impacts[i].*value = column[i];
    };
    take(list.column(impact_list.tau), &IdentifiedImpact::tau);
    take(list.column(impact_list.x), &IdentifiedImpact::x);
    take(list.column(impact_list.x_dot_before), &IdentifiedImpact::x_dot_before);
    take(list.column(impact_list.x_dot_after), &IdentifiedImpact::x_dot_after);
    const std::vector<double> side = list.optional_column(impact_list.side),
                              phase = list.optional_column(impact_list.phase);
    take(list.optional_column(impact_list.y_dot_before), &IdentifiedImpact::y_dot_before);
    take(list.optional_column(impact_list.y_dot_after), &IdentifiedImpact::y_dot_after);
    if (phase.empty())
        take(list.optional_column(impact_list.x_ddot_before), &IdentifiedImpact::x_ddot_before);
    list.refuse_faults();
    if (impacts.size() < 2)
        refuse({{"/impacts", impacts.size(), nullptr, "exponents need at least two impacts"}});
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        cancel.step();
        IdentifiedImpact& i = impacts[k];
        if (k > 0 && !(i.tau > impacts[k - 1].tau))
            list.fail(
                list.name_of(impact_list.tau) + ("/" + std::to_string(k)), i.tau,
                "the times of the impacts must increase");
        if (!side.empty() && std::abs(side[k]) != 1)
            list.fail("side/" + std::to_string(k), side[k], "a side is 1 or -1");
        i.side = (side.empty() ? i.x_dot_after > i.x_dot_before : side[k] < 0) ? -1 : 1;
        if (!phase.empty())
            i.x_ddot_before =
                flow->acceleration(
                    {i.x, i.x_dot_before, elementary::sin(phase[k]), elementary::cos(phase[k])}) -
                p.epsilon * p.friction * i.side;
    }
    list.refuse_faults();
    return impacts;
}

/// Fits the forcing to the list if needed, and restores impacts that it lacks.
void take_motion(IdentifyRequest& r, CancelCheck& cancel) {
    Parameters& p = r.measurement.parameters;
    std::vector<IdentifiedImpact>& impacts = r.measurement.impacts;
    const ListedForcing forcing = fit_forcing(p, impacts, [&cancel] { cancel.step(); });
    if (r.forcing_fitted) p.G = G_of(p, forcing.sin, forcing.cos);
    if (!(forcing.misfit < most_misfit)) {
        r.system.notes.push_back(fmt::format(
            "no forcing at this frequency leads from each impact to the next: the states miss it "
            "by {:.2g} of the oscillator's speed. Is f, a mass, a stiffness or a unit wrong, or "
            "are impacts missing?",
            forcing.misfit));
        r.measurement.doubts.push_back(Doubt::no_forcing);
        return;
    }
    r.measurement.listed_forcing = forcing;
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
    const Parameters& p = r.system.parameters;
    std::vector<IdentifiedImpact>& impacts = r.measurement.impacts;
    impacts = read_impacts(list, p, cancel);
    given = nullptr;
    take_motion(r, cancel);
    set_flight_velocities(p, impacts);
    complete_impacts(p, impacts, 0);
}

}  // namespace vines::api
