#include "api/design.hpp"

#include <doctest/doctest.h>

#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

namespace {

Json design_of_machine() {
    return {
        {"base", {{"m1", 2}, {"f0", 8}, {"damping_ratio", 0.01}, {"m2", 0.04}}},
        {"f", {7, 9}},
        {"acceleration", 5}};
}

/// Pointers of the errors of a request with these changes.
std::vector<std::string> design_faults(const Json& changes) {
    Json request = design_of_machine();
    request.merge_patch(changes);
    std::vector<std::string> pointers;
    for (const FieldError& e : problem_of([&] { read_design_request(request); }).errors)
        pointers.push_back(e.pointer);
    return pointers;
}

}  // namespace

TEST_CASE("a design's faults are named at their fields") {
    using Pointers = std::vector<std::string>;
    CHECK(design_faults({{"f", {9, 7}}}) == Pointers{"/f"});
    CHECK(design_faults({{"R", {0.5, 2}}}) == Pointers{"/R/1"});
    CHECK(design_faults({{"m2", Json::array()}}) == Pointers{"/m2"});
    CHECK(design_faults({{"F", 0.001}}) == Pointers{"/acceleration"});
    CHECK(design_faults({{"acceleration", nullptr}}) == Pointers{"/acceleration"});
    CHECK(design_faults({{"acceleration", -1}}) == Pointers{"/acceleration"});
    CHECK(design_faults({{"base", {{"b", 0.01}}}}) == Pointers{"/base/b"});
    CHECK(design_faults({{"base", {{"m1", -2}}}}) == Pointers{"/base/m1"});
    CHECK(design_faults({{"base", {{"m1", nullptr}}}}) == Pointers{"/base/m1"});
    CHECK(design_faults({{"base", {{"epsilon", 0.1}}}}).front() == "/base/epsilon");
    CHECK(design_faults({{"objective", "x"}}) == Pointers{"/objective"});
    CHECK(design_faults({{"q", 1}}) == Pointers{"/q"});
}

TEST_CASE("a range of amplitudes and lists of R and m2 are read, and b follows from the host") {
    Json request = design_of_machine();
    request["acceleration"] = {2, 5};
    request["R"] = 0.3;
    request["m2"] = {0.02, 0.04};
    const DesignRequest r = read_design_request(request);
    CHECK(r.plan.amplitude_ratio == doctest::Approx(0.4));
    CHECK(r.plan.R == std::vector{0.3});
    CHECK(r.plan.m2 == std::vector{0.02, 0.04});
    // 99 mm without absorber.
    CHECK(r.plan.b.to == doctest::Approx(1.2 * 0.0990).epsilon(1e-3));
    CHECK(r.host.f0() == doctest::Approx(8));
}
