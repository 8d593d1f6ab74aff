#include "api/answers/asked.hpp"

#include <array>
#include <utility>

#include "api/problem.hpp"
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

/// The fields of an identification without what was measured.
Json without_record(const Json& fields) {
    Json others = Json::object();
    for (const auto& [name, value] : fields.items())
        if (name != "record" && name != "impacts") others[name] = value;
    return others;
}

/// How many numbers and texts are in a value.
std::size_t count(const Json& value) {
    if (!value.is_structured()) return 1;
    std::size_t all = 0;
    for (const Json& entry : value) all += count(entry);
    return all;
}

/// Each of them is copied and checked some times, which a record's are not.
void check_beside_record(const Json& fields, std::size_t most) {
    std::size_t all = 0;
    for (const auto& [name, value] : fields.items())
        if (name != "record" && name != "impacts") all += count(value);
    if (all > most)
        throw Problem(
            413, "the fields beside the record hold more than " + std::to_string(most) +
                     " numbers and texts");
}

Asked read_identification(Json fields, const Sent& sent, const Reading& reading) {
    check_beside_record(fields, reading.most_beside);
    Provenance provenance{
        .route = "/v1/identify", .request = canonical(without_record(fields)), .record = {}};
    AnswerForm form = take_form(fields, identify_fields());
    IdentifyRequest request = sent.is_columns ? read_identify_request(fields, sent.text, reading)
                                              : read_identify_request(std::move(fields), reading);
    provenance.record = sha256(sent.text);  // of what has no fault
    return {std::move(request), std::move(form), std::move(provenance)};
}

template <class Request>
Asked read_run(
    const std::string& route, Json fields, const FieldTable& table,
    Request (*read)(const Json& fields)) {
    Provenance provenance{.route = route, .request = canonical(fields)};
    AnswerForm form = take_form(fields, table);
    return {read(fields), std::move(form), std::move(provenance)};
}

Answer computed(SimulateRequest request, const AnswerForm& form, const Means& means) {
    // Only text is written while its lists are made.
    const bool is_text = form.format.value_or(Format::json) == Format::json;
    return simulate_in_parts(
        std::move(request), means.stop, means.most_bytes, is_text ? means.most_kept : everything);
}

Answer computed(const ManifoldRequest& request, const AnswerForm&, const Means& means) {
    return {.json = manifold_answer(request, means.stop)};
}

Answer computed(const IdentifyRequest& request, const AnswerForm&, const Means& means) {
    return {.json = identify_answer(request, {.stop = means.stop.asked, .reached = means.reached})};
}

}  // namespace

Asked read_asked(const std::string& route, Json fields, const Sent& sent, const Reading& reading) {
    if (route == "/v1/simulate")
        return read_run(route, std::move(fields), simulate_fields(), read_simulate_request);
    if (route == "/v1/manifold")
        return read_run(route, std::move(fields), manifold_fields(), read_manifold_request);
    if (route == "/v1/identify") return read_identification(std::move(fields), sent, reading);
    throw Problem(422, "no answer of this program has the route " + shortened(route));
}

Answer answered(Asked asked, const Means& means) {
    Answer answer = std::visit(
        [&](auto& request) { return computed(std::move(request), asked.form, means); },
        asked.computation);
    thin(answer.json, asked.form.fields);
    answer.provenance = std::move(asked.provenance);
    if (answer.is_fitted) answer.provenance->answer_limit = means.most_bytes;
    return answer;
}

}  // namespace vines::api
