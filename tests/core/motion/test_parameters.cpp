#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "../support.hpp"

using namespace vines;

TEST_CASE("Table 1 is the default, and its reduced values follow from its SI values") {
    const Parameters p;
    CHECK(std::round(p.epsilon * 1e4) == 84);
    CHECK(std::round(p.lambda * 100) == 143);
    CHECK(p.G == 0.02);
    CHECK(p.Omega == 1);
    CHECK(p.R_plus == 0.6);
    CHECK(p.R_minus == 0.6);
    CHECK(SiParameters{}.Omega() == doctest::Approx(1).epsilon(1e-15));
    CHECK(SiParameters{}.G() == doctest::Approx(0.02).epsilon(1e-15));
    CHECK(validate(p, default_state(p)).empty());
}

TEST_CASE("the two dampings differ by a factor of two") {
    Parameters p;
    CHECK(p.zeta() == p.epsilon * p.lambda / 2);
    p.damping = Damping::closed_form;
    CHECK(p.zeta() == p.epsilon * p.lambda);
}

TEST_CASE("validation returns every fault with its field, value and range") {
    Parameters p;
    p.b = -1;
    p.R_plus = 1.5;
    p.Omega = std::numeric_limits<double>::quiet_NaN();
    const auto faults = validate(p, {0, 1e9, 0, 0});
    REQUIRE(faults.size() == 4);
    CHECK(faults[0].field == "Omega");
    CHECK(faults[1].field == "R_plus");
    CHECK(faults[1].value == 1.5);
    CHECK(faults[1].minimum == 0);
    CHECK(faults[1].maximum == 1);
    CHECK(faults[2].field == "b");
    CHECK(faults[3].field == "x0");
    CHECK(faults[3].message == "x0 must lie in [-1000, 1000]");
}

TEST_CASE("a start outside the cavity is a fault, one on a wall is not") {
    Parameters p;
    p.b = 0.022;
    CHECK(validate(p, {0, 0.001, 0, 0.0230001}).size() == 1);
    CHECK(validate(p, {0, 0.001, 0, 0.001 + 0.022}).empty());
    CHECK(wall_of({0, 0.001, 0, 0.001 + 0.022}, p.b) == -1);
    CHECK(wall_of({0, 0.001, 0, 0.001 - 0.022}, p.b) == 1);
    CHECK(wall_of({0, 0.001, 0, 0}, p.b) == 0);
}

TEST_CASE("is_physical accepts more than a request can contain, but not everything") {
    Parameters p;
    p.b = 1e6;
    CHECK_FALSE(validate(p, default_state(p)).empty());
    CHECK(is_physical(p));
    p.R_minus = 1.001;
    CHECK_FALSE(is_physical(p));
    p.R_minus = 1;
    p.G = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(is_physical(p));
}

TEST_CASE("a damping ratio that needs too fine a grid is a fault of lambda") {
    Parameters p;
    p.epsilon = 0.5;
    p.lambda = 100;
    const auto faults = validate(p, default_state(p));
    REQUIRE(faults.size() == 1);
    CHECK(faults[0].field == "lambda");
    CHECK(faults[0].maximum == doctest::Approx(40));
    p.lambda = 40;
    CHECK(validate(p, default_state(p)).empty());
    p.lambda = 0;
    CHECK(validate(p, default_state(p)).empty());
}
