// Comparison with trajectories in 250-digit arithmetic.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "../support.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// Largest tau up to which impacts agree with the reference to 1e-9 in tau and 1e-10 in x; in a
/// chatter the nearest one counts.
double agreement(const Reference& reference, const Record& run) {
    std::size_t j = 0;
    for (const ReferenceImpact& r : reference.impacts) {
        while (j + 1 < run.impacts.size() &&
               std::abs(run.impacts[j + 1].tau - r.tau) <= std::abs(run.impacts[j].tau - r.tau))
            ++j;
        const Impact& i = run.impacts[j];
        if (std::abs(i.tau - r.tau) > 1e-9 || i.side != r.side || std::abs(i.x - r.x) > 1e-10)
            return r.tau;
    }
    return 1709;
}

}  // namespace

TEST_CASE("impacts follow the reference to the end where the motion is regular") {
    for (const char* name : {"closed_b0.008", "closed_b0.015", "eom_b0.008", "eom_b0.018"}) {
        CAPTURE(name);
        const Reference reference = read_reference(name);
        CHECK(
            agreement(
                reference,
                record(reference.parameters, default_state(reference.parameters), 1709)) == 1709);
    }
}

TEST_CASE("impacts follow the reference until chaos has magnified the rounding of the input") {
    // The relative rounding of b alone, 1e-16, grows to 1e-9 within these times.
    const std::pair<const char*, double> cases[] = {
        {"closed_b0.003", 110},
        {"closed_b0.018", 180},
        {"closed_b0.022", 100},
        {"eom_b0.022", 240}};
    for (const auto& known : cases) {
        const char* const name = known.first;
        const double until = known.second;
        CAPTURE(name);
        const Reference reference = read_reference(name);
        CHECK(
            agreement(
                reference,
                record(reference.parameters, default_state(reference.parameters), 1709)) > until);
    }
}

TEST_CASE("every velocity before and after every impact agrees with the reference") {
    const Reference reference = read_reference("eom_b0.008");
    const Record run = record(reference.parameters, default_state(reference.parameters), 1709);
    REQUIRE(run.impacts.size() == reference.impacts.size());
    double worst = 0;
    for (std::size_t k = 0; k < run.impacts.size(); ++k) {
        const Impact& i = run.impacts[k];
        const ReferenceImpact& r = reference.impacts[k];
        worst = std::max(
            {worst, std::abs(i.x_dot_before - r.x_dot_before),
             std::abs(i.y_dot_before - r.y_dot_before), std::abs(i.x_dot_after - r.x_dot_after),
             std::abs(i.y_dot_after - r.y_dot_after)});
    }
    CHECK(worst < 1e-13);
}

TEST_CASE("a sticking phase begins and ends as in the reference") {
    const Reference reference = read_reference("closed_b0.015");
    const Record run = record(reference.parameters, default_state(reference.parameters), 1709);
    REQUIRE(run.sticks.size() == 1);
    REQUIRE(reference.sticks.size() == 1);
    CHECK(run.sticks[0].start.side == reference.sticks[0].side);
    CHECK(std::abs(run.sticks[0].start.tau - reference.sticks[0].start) < 1e-10);
    CHECK(std::abs(run.sticks[0].tau_end - reference.sticks[0].end) < 1e-10);
}

TEST_CASE("all four exponents of a regular window without sticking agree with the reference") {
    for (const char* name : {"closed_b0.008", "eom_b0.008", "eom_b0.018"}) {
        CAPTURE(name);
        const Reference reference = read_reference(name);
        Lyapunov lyapunov(reference.parameters, {0, 1709}, all_estimators);
        record(
            reference.parameters, default_state(reference.parameters), 1709, 1000000, {&lyapunov});
        const Exponents qr = lyapunov.product().qr(),
                        eigenvalues = lyapunov.product().eigenvalues();
        for (int k = 0; k < 4; ++k) {
            CAPTURE(k);
            CHECK(std::abs(qr[k] - reference.qr[k]) < 1e-11);
            CHECK(std::abs(eigenvalues[k] - reference.eigenvalues[k]) < 1e-11);
        }
    }
}

TEST_CASE("the eigenvalues of a product that spans 300 digits add up to its determinant") {
    const Reference reference = read_reference("eom_b0.008");
    Lyapunov lyapunov(reference.parameters, {0, 1709}, all_estimators);
    record(reference.parameters, default_state(reference.parameters), 1709, 1000000, {&lyapunov});
    const Exponents eigenvalues = lyapunov.product().eigenvalues();
    CHECK(
        std::abs(
            eigenvalues[0] + eigenvalues[1] + eigenvalues[2] + eigenvalues[3] -
            -0.460519228019486) < 1e-12);
}
