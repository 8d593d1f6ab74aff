// What several tests of requests and answers need: answers to a JSON text, and what is at fault
// with one.
#pragma once

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "api/identify.hpp"
#include "api/json_text.hpp"
#include "api/parse_object.hpp"
#include "api/schema/tables.hpp"
#include "api/simulate.hpp"
#include "api/sweep.hpp"

namespace vines::test {

using namespace vines::api;

/// What an answer says to who reads its text.
inline Json read_back(Json answer) { return Json::parse(json_text(std::move(answer))); }

inline Json simulated(
    const SimulateRequest& request, const Stop& stop, std::size_t most_bytes = any_size) {
    return read_back(simulate_answer(request, stop, most_bytes));
}
inline Json identified(const IdentifyRequest& request) {
    return read_back(identify_answer(request));
}
inline Json slow_manifold(const ManifoldRequest& request, const Stop& stop = {}) {
    return read_back(manifold_answer(request, stop));
}
inline Json start_of_sweep(const SweepRequest& request) { return read_back(sweep_start(request)); }

/// Of /v1/simulate.
inline Json answer(const std::string& text) {
    return simulated(read_simulate_request(parse_object(text)), {});
}

/// All parts of such an answer.
inline const std::vector<std::string>& all_parts() {
    return find(simulate_fields(), "include")->choices;
}

inline bool warns(const Json& a, const std::string& of) {
    for (const Json& w : a["warnings"])
        if (w.get<std::string>().find(of) != std::string::npos) return true;
    return false;
}

/// The problem that reading a request, or answering it, ends with.
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

/// That of a request to /v1/simulate.
inline Problem refused(const std::string& text) {
    CAPTURE(text.substr(0, 200));
    return problem_of([&] { read_simulate_request(parse_object(text)); });
}

/// The fields at fault.
inline std::set<std::string> pointers(const Problem& problem) {
    std::set<std::string> all;
    for (const FieldError& e : problem.errors) all.insert(e.pointer);
    return all;
}

inline SweepRequest sweep_request(const std::string& text) {
    return read_sweep_request(parse_object(text), 100000);
}

/// Those of a request to /v1/sweep.
inline std::set<std::string> faults_of_sweep(const std::string& text) {
    CAPTURE(text);
    const Problem problem = problem_of([&] { sweep_request(text); });
    CHECK(problem.status == 422);
    return pointers(problem);
}

/// The lines of a sweep by their index, and what it warns of.
struct Swept {
    std::map<std::size_t, Json> lines;
    std::string warning;
};
inline Swept swept(const SweepRequest& r, int threads, Pace& pace) {
    Swept s;
    s.warning = run_sweep(r, threads, pace, [&](std::size_t index, const std::string& text) {
        const Json line = Json::parse(text);
        CHECK(line["index"] == index);
        CHECK_FALSE(s.lines.contains(index));
        s.lines[index] = line;
    });
    return s;
}
inline Swept swept(const SweepRequest& r, int threads = 2) {
    Pace pace;
    return swept(r, threads, pace);
}
inline Swept swept(const std::string& text) { return swept(sweep_request(text)); }

}  // namespace vines::test
