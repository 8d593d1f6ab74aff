// Checks whether a line can belong to a sweep, without computing it: compares it with sample lines,
// described for made-up results with every possible set of fields.
#include <fmt/format.h>

#include <algorithm>

#include "api/provenance.hpp"
#include "api/sweep.hpp"

namespace vines::api {

namespace {

/// The line after writing and parsing.
Json read_back(Json line) { return Json::parse(json_text(std::move(line))); }

/// Adds a line unless it is there already.
void add(std::vector<Json>& samples, Json line) {
    line = read_back(std::move(line));
    if (std::ranges::count(samples, line) == 0) samples.push_back(std::move(line));
}

/// One motion of each kind, with arbitrary numbers.
std::vector<Motion> sample_motions() {
    Motion not_measured{"", {}, PointResult{}}, measured = not_measured;
    measured.result.measured = true;
    Motion periodic = measured;
    periodic.result.regime.orbit.emplace();
    periodic.result.name.mirror.emplace();
    measured.result.verdict = Verdict::none;
    return {periodic, measured, not_measured};
}

std::vector<Json> sample_points(const SweepRequest& r, bool second) {
    // Arbitrary values.
    const PointSystem system{Parameters(), State(), 0};
    std::vector<Json> samples;
    for (const Motion& motion : sample_motions())
        for (const Motion& other : sample_motions())
            for (const bool afresh : {false, true}) {
                SweepPoint point;
                point.system = system;
                point.afresh = afresh && r.plan.carry != Carry::none;
                point.motions = {motion};
                if (r.plan.default_set) point.motions.push_back(other);
                if (second) point.second = other;
                add(samples, describe_point(r, 0, point));
            }
    return samples;
}

std::vector<Json> sample_rows(const SweepRequest& r) {
    std::vector<Motion> motions = sample_motions();
    std::vector<const Motion*> peaks = {nullptr};  // a row without a motion
    for (Motion& motion : motions) {
        if (r.plan.default_set) motion.start = "middle";
        if (motion.result.measured) peaks.push_back(&motion);
    }
    std::vector<Json> samples;
    for (const Motion* motion : peaks)
        for (const std::optional<bool> depends : {std::optional<bool>(), std::optional(false)}) {
            RowSummary row;
            row.worst = row.best = {0, motion};
            row.starts = {{"middle", {0, motion}}};
            row.depends_on_start = depends;
            add(samples, describe_row(r, 0, row));
        }
    return samples;
}

/// True if the values can replace each other. null stands for numbers that do not exist and for
/// quantities that were not measured.
bool is_alike(const Json& one, const Json& other) {
    const auto is_number = [](const Json& value) { return value.is_number() || value.is_null(); };
    return one.type() == other.type() || (is_number(one) && is_number(other));
}

using Samples = std::vector<const Json*>;

/// The difference between an object's fields and those of the nearest sample; empty if none.
std::string fault_of_names(const std::string& name, const Json& object, const Samples& samples) {
    const auto likeness = [&object](const Json* sample) {
        auto common = -static_cast<long>(sample->size());
        for (const auto& [field, value] : object.items()) common += sample->contains(field) ? 2 : 0;
        return common;
    };
    const Json& nearest = **std::ranges::max_element(samples, {}, likeness);
    const std::string where = name.empty() ? "" : " in " + name;
    for (const auto& [field, value] : nearest.items())
        if (!object.contains(field)) return fmt::format("{} is missing{}", field, where);
    for (const auto& [field, value] : object.items())
        if (!nearest.contains(field)) return fmt::format("{} is an unknown field{}", field, where);
    const bool same = std::equal(
        object.items().begin(), object.items().end(), nearest.items().begin(),
        [](const auto& a, const auto& b) { return a.key() == b.key(); });
    return same ? "" : "its fields are in another order" + where;
}

/// The fault of a value that must resemble one of the samples; empty if none. Lists that are empty
/// in all samples are not checked.
std::string fault_among(const std::string& name, const Json& value, const Samples& samples) {
    Samples alike, parts;
    std::ranges::copy_if(
        samples, std::back_inserter(alike), [&](auto* sample) { return is_alike(*sample, value); });
    if (alike.empty()) return fmt::format("{} is {}", name, shortened(value.dump()));
    if (value.is_object()) {
        if (std::string fault = fault_of_names(name, value, alike); !fault.empty()) return fault;
        for (const auto& [field, of_field] : value.items()) {
            parts.clear();
            for (const Json* sample : alike)
                if (sample->contains(field)) parts.push_back(&(*sample)[field]);
            const std::string path = name.empty() ? field : name + "." + field;
            if (std::string fault = fault_among(path, of_field, parts); !fault.empty())
                return fault;
        }
    } else if (value.is_array()) {
        for (const Json* sample : alike)
            for (const Json& entry : *sample) parts.push_back(&entry);
        if (parts.empty()) return "";
        for (const Json& entry : value)
            if (std::string fault = fault_among(name, entry, parts); !fault.empty()) return fault;
        const bool of_objects = parts[0]->is_object();  // a set of starts has any size
        if (!of_objects && std::ranges::find(alike, value.size(), &Json::size) == alike.end())
            return fmt::format("{} has {} entries", name, value.size());
    }
    return "";
}

/// All or nothing is measured at a point: nothing if its transient did not end.
bool is_measured(const Json& line) { return line.value("reason", "") != "transient_max_impacts"; }

Samples samples_for(const Json& line, const std::vector<Json>& all) {
    Samples samples;
    for (const Json& sample : all)
        if (is_measured(sample) == is_measured(line)) samples.push_back(&sample);
    return samples;
}

}  // namespace

std::vector<Json> sample_lines(const SweepRequest& r) {
    if (r.plan.grid.reduced) return sample_rows(r);
    std::vector<Json> samples = sample_points(r, r.plan.tries_second_start(0));
    // All starts of basins are valid.
    if (!r.basins) samples.push_back(read_back(describe_point(r, 0, SweepPoint())));
    return samples;
}

SweepLineCheck::SweepLineCheck(const SweepRequest& request) : request_(request) {
    const bool reduced = request.plan.grid.reduced.has_value();
    single_ = reduced ? sample_rows(request) : sample_points(request, false);
    tried_ = reduced ? single_ : sample_points(request, true);
    if (!reduced) without_system_ = {read_back(describe_point(request, 0, SweepPoint()))};
}

std::string SweepLineCheck::fault_of_index(const Json& parsed) const {
    const std::size_t lines = request_.plan.grid.lines();
    if (!parsed.contains("index")) return "index is missing";
    const Json index = canonical(parsed["index"]);  // 7.0 equals 7
    if (index.is_number_integer() && index >= 0 && index < lines) return "";
    return fmt::format(
        "point {} is outside the sweep, which has {} points, from 0", shortened(index.dump()),
        lines);
}

std::string SweepLineCheck::fault_of_place(const std::string& line, const Json& parsed) const {
    if (std::string fault = fault_of_index(parsed); !fault.empty()) return fault;
    const Json& index = parsed["index"];
    const std::string place_text = json_text(describe_place(request_, index.get<std::size_t>()));
    if (line.starts_with(place_text.substr(0, place_text.size() - 1) + ",")) return "";
    const Json place = Json::parse(place_text);
    for (const auto& [name, value] : place.items()) {
        const auto given = parsed.find(name);
        if (given == parsed.end()) return name + " is missing";
        if (given->type() != value.type() || *given != value)
            return fmt::format(
                "{} is {}, but point {} lies at {}", name, shortened(given->dump()), index.dump(),
                value.dump());
    }
    return "";
}

std::string SweepLineCheck::fault_of(const std::string& line, const Json& parsed) const {
    if (std::string fault = fault_of_place(line, parsed); !fault.empty()) return fault;
    const std::size_t index = parsed["index"].get<std::size_t>();
    const bool has_system =
        request_.plan.grid.reduced || request_.plan.system_at(request_.plan.grid.place_of(index));
    const std::vector<Json>& samples = !has_system                               ? without_system_
                                       : request_.plan.tries_second_start(index) ? tried_
                                                                                 : single_;
    if (const auto reason = parsed.find("reason"); reason != parsed.end() && !reason->is_string())
        return "reason is " + shortened(reason->dump());
    const Samples of_kind = samples_for(parsed, samples);
    if (of_kind.empty()) return "reason does not belong to such a line";
    if (std::string fault = fault_among("", parsed, of_kind); !fault.empty()) return fault;
    return json_text(parsed) == line ? "" : "it is written in another way than by this program";
}

}  // namespace vines::api
