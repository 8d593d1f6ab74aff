// Helpers for tests of requests and answers: answers to JSON texts, and the errors of refused ones.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "api/identify.hpp"
#include "api/json_text.hpp"
#include "api/parse.hpp"
#include "api/schema/tables.hpp"
#include "api/simulate.hpp"
#include "api/sweep.hpp"

namespace vines::test {

using namespace vines::api;

/// The answer as a client reads it.
inline Json read_back(Json answer) { return Json::parse(json_text(std::move(answer))); }

inline Json simulated(
    const SimulateRequest& request, const Stop& stop, std::size_t most_bytes = any_size) {
    return read_back(simulate_in_parts(request, stop, most_bytes).json);
}
inline Json identified(const IdentifyRequest& request) {
    return read_back(identify_answer(request));
}
inline Json slow_manifold(const ManifoldRequest& request, const Stop& stop = {}) {
    return read_back(manifold_answer(request, stop));
}
inline Json start_of_sweep(const SweepRequest& request) { return read_back(sweep_start(request)); }

/// The answer of /v1/simulate.
inline Json answer(const std::string& text) {
    return simulated(read_simulate_request(parse_object(text)), {});
}

/// All parts that /v1/simulate can include.
inline const std::vector<std::string>& all_parts() {
    return find(simulate_fields(), "include")->choices;
}

/// True if two numbers agree relatively. (doctest's Approx treats small ones as equal.)
inline bool is_near(const Json& value, double expected, double relative) {
    return std::abs(value.get<double>() - expected) <= relative * std::abs(expected);
}

/// A platform of 12 kg, 14 Hz and .6 % of damping on a base that moves by .4 mm, with an absorber
/// of .12 kg.
inline const std::string platform =
    R"("m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"F":0.0004,"R":0.4,"b":0.03)";

inline bool warns(const Json& a, const std::string& of) {
    for (const Json& w : a["warnings"])
        if (w.get<std::string>().find(of) != std::string::npos) return true;
    return false;
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// The Problem thrown by reading or answering a request.
template <class Work>
Problem problem_of(Work work) {
    try {
        work();
    } catch (const Problem& problem) {
        return problem;
    }
    FAIL("not refused");
    return {0, ""};
}

/// The Problem of a request to /v1/simulate.
inline Problem refused(const std::string& text) {
    CAPTURE(text.substr(0, 200));
    return problem_of([&] { read_simulate_request(parse_object(text)); });
}

/// The invalid fields, in alphabetical order: "/R /b".
inline std::string pointers(const Problem& problem) {
    std::set<std::string> all;
    for (const FieldError& e : problem.errors) all.insert(e.pointer);
    std::string text;
    for (const std::string& pointer : all) text += (text.empty() ? "" : " ") + pointer;
    return text;
}

inline SweepRequest sweep_request(const std::string& text) {
    return read_sweep_request(parse_object(text), 100000);
}

/// The invalid fields of a request to /v1/sweep.
inline std::string faults_of_sweep(const std::string& text) {
    CAPTURE(text);
    const Problem problem = problem_of([&] { sweep_request(text); });
    CHECK(problem.status == 422);
    return pointers(problem);
}

/// The lines of a sweep by index, and its warning.
struct Swept {
    std::map<std::size_t, Json> lines;
    std::string warning;
};
inline Swept swept(const SweepRequest& r, int threads, RunControl& control) {
    Swept s;
    s.warning = run_sweep(r, threads, control, [&](std::size_t index, const std::string& text) {
        const Json line = Json::parse(text);
        CHECK(line["index"] == index);
        CHECK_FALSE(s.lines.contains(index));
        s.lines[index] = line;
    });
    return s;
}
inline Swept swept(const SweepRequest& r, int threads = 2) {
    RunControl control;
    return swept(r, threads, control);
}
inline Swept swept(const std::string& text) { return swept(sweep_request(text)); }

}  // namespace vines::test
