#include <doctest/doctest.h>

#include <cmath>

#include "core/stability/verdict.hpp"

using namespace vines;

TEST_CASE(
    "chaos needs 4.5 standard errors, more growth than one unstable orbit gives, and continued "
    "growth") {
    CHECK(verdict_by_exponents({0.1, -0.1, {0.022}, 170, 85}) == Verdict::chaotic);
    CHECK(verdict_by_exponents({0.1, -0.1, {0.0222}, 170, 85}) == Verdict::not_decided);
    CHECK(verdict_by_exponents({0.1, -0.1, {0.01}, 30, 15}) == Verdict::not_decided);
    CHECK(verdict_by_exponents({0.1, -0.1, {0.01}, 170, 2}) == Verdict::not_decided);
    CHECK(verdict_by_exponents({-0.01, -0.1, {0.001}, -17, -8}) == Verdict::not_decided);
    CHECK(verdict_by_exponents({0.1, -0.1, {std::nan("")}, 170, 85}) == Verdict::not_decided);
}
