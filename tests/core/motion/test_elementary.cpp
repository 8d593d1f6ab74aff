#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "../support.hpp"
#include "core/motion/elementary.hpp"

using namespace vines;
using namespace vines::test;

namespace {

using Wide = long double;  // 64 bits: its errors are below 0.001 ulp of a double

constexpr int calls = 20000;

/// Error in ulps of the true result.
double error_in_ulps(double result, Wide truth) {
    const int exponent = std::max(std::ilogb(truth), std::numeric_limits<double>::min_exponent - 1);
    return static_cast<double>(std::abs((result - truth) * std::scalbn(Wide{1}, 52 - exponent)));
}

struct Two {
    double a, b;
};

/// Largest error over random arguments.
double worst_of(
    unsigned seed, const std::function<Two(std::mt19937_64&)>& arguments,
    const std::function<double(double, double)>& tested,
    const std::function<Wide(Wide, Wide)>& true_one) {
    std::mt19937_64 engine(seed);
    double worst = 0;
    for (int i = 0; i < calls; ++i) {
        const auto [a, b] = arguments(engine);
        const double error = error_in_ulps(tested(a, b), true_one(a, b));
        if (!(error <= worst)) worst = error;
    }
    return worst;
}

double worst_of(
    const std::function<double(std::mt19937_64&)>& argument, double (*tested)(double),
    Wide (*true_one)(Wide)) {
    return worst_of(
        1, [&](std::mt19937_64& engine) { return Two{argument(engine), 0}; },
        [&](double x, double) { return tested(x); }, [&](Wide x, Wide) { return true_one(x); });
}

auto evenly(double from, double to) {
    return [=](std::mt19937_64& engine) { return uniform(engine, from, to); };
}

/// Log-uniform between e^from and e^to.
auto of_any_size(double from, double to) {
    return [=](std::mt19937_64& engine) { return std::exp(uniform(engine, from, to)); };
}

double sign(std::mt19937_64& engine) { return uniform(engine, 0, 1) < 0.5 ? -1 : 1; }

constexpr double smallest = std::numeric_limits<double>::denorm_min(),
                 largest = std::numeric_limits<double>::max();

bool is_zero(double x, bool negative) { return x == 0 && std::signbit(x) == negative; }

}  // namespace

TEST_CASE("log is accurate to 0.51 ulp for large and small numbers, near 1, and for subnormals") {
    const auto log = [](const auto& argument) {
        return worst_of(argument, elementary::log, [](Wide x) { return std::log(x); });
    };
    CHECK(log(of_any_size(-708, 709)) < 0.51);
    CHECK(log(evenly(0.5, 2)) < 0.51);
    CHECK(log(evenly(0.98, 1.02)) < 0.51);
    CHECK(log([](std::mt19937_64& e) { return 1 + sign(e) * of_any_size(-36, -4)(e); }) < 0.51);
    CHECK(log([](std::mt19937_64& e) { return (e() >> (12 + e() % 40)) * smallest; }) < 0.51);
}

TEST_CASE("exp is accurate to 0.51 ulp, and to 0.76 ulp where it is subnormal") {
    const auto exp = [](const auto& argument) {
        return worst_of(argument, elementary::exp, [](Wide x) { return std::exp(x); });
    };
    CHECK(exp(evenly(-708, 709.7)) < 0.51);
    CHECK(exp(evenly(-1, 1)) < 0.51);
    CHECK(exp(evenly(-0.01, 0.01)) < 0.51);
    CHECK(exp(evenly(-745, -708)) < 0.76);
}

TEST_CASE("sin and cos are accurate to 0.51 ulp for angles up to 2^31 and near their zeros") {
    for (const double limit : {1.0, 10.0, 1e3, 1e6, 0x1p31}) {
        CAPTURE(limit);
        CHECK(worst_of(evenly(-limit, limit), elementary::sin, [](Wide x) {
                  return std::sin(x);
              }) < 0.51);
        CHECK(worst_of(evenly(-limit, limit), elementary::cos, [](Wide x) {
                  return std::cos(x);
              }) < 0.51);
    }
    const auto beside_zero = [](std::mt19937_64& engine) {
        return static_cast<double>(std::numbers::pi_v<Wide> / 2 * (engine() % 1000000000));
    };
    CHECK(worst_of(beside_zero, elementary::sin, [](Wide x) { return std::sin(x); }) < 0.51);
    CHECK(worst_of(beside_zero, elementary::cos, [](Wide x) { return std::cos(x); }) < 0.51);
    CHECK(
        worst_of(of_any_size(-40, 0), elementary::sin, [](Wide x) { return std::sin(x); }) < 0.51);
}

TEST_CASE("sin and cos of larger angles equal those of an angle closer than the next double") {
    std::mt19937_64 engine(3);
    for (int i = 0; i < calls; ++i) {
        const double near = of_any_size(std::log(0x1p31), std::log(0x1p47))(engine),
                     far = of_any_size(std::log(0x1p47), 700)(engine);
        CHECK(std::abs(elementary::sin(near) - std::sin(Wide{near})) < 1.2e-16);
        CHECK(std::abs(elementary::cos(near) - std::cos(Wide{near})) < 1.2e-16);
        const double rest = std::fmod(far, 2 * std::numbers::pi);
        CHECK(elementary::sin(far) == elementary::sin(rest));
        CHECK(elementary::cos(-far) == elementary::cos(rest));
    }
}

TEST_CASE("atan2 is accurate to 0.51 ulp in all quadrants and for arguments of any size") {
    const auto atan2 = [](const std::function<Two(std::mt19937_64&)>& sides) {
        return worst_of(
            4, sides, [](double y, double x) { return elementary::atan2(y, x); },
            [](Wide y, Wide x) { return std::atan2(y, x); });
    };
    CHECK(atan2([](auto& e) {
              const double angle = uniform(e, -4, 4);
              return Two{std::sin(angle), std::cos(angle)};
          }) < 0.51);
    CHECK(atan2([](auto& e) {
              return Two{sign(e) * of_any_size(-40, 40)(e), sign(e) * of_any_size(-40, 40)(e)};
          }) < 0.51);
    CHECK(atan2([](auto& e) {
              const double x = sign(e) * of_any_size(-700, 700)(e);
              return Two{x * uniform(e, -2, 2), x};
          }) < 0.51);
    CHECK(worst_of(evenly(-2, 2), elementary::atan, [](Wide x) { return std::atan(x); }) < 0.51);
}

TEST_CASE("hypot is accurate to 0.51 ulp, and exact where the result is a double") {
    const auto hypot = [](const std::function<Two(std::mt19937_64&)>& sides) {
        return worst_of(
            5, sides, [](double x, double y) { return elementary::hypot(x, y); },
            [](Wide x, Wide y) { return std::hypot(x, y); });
    };
    CHECK(hypot([](auto& e) { return Two{1, of_any_size(-25, 5)(e)}; }) < 0.51);
    CHECK(hypot([](auto& e) {
              const double x = sign(e) * of_any_size(-700, 700)(e);
              return Two{x, x * uniform(e, -2, 2)};
          }) < 0.51);
    CHECK(elementary::hypot(3, -4) == 5);
    CHECK(elementary::hypot(0x3p1000, 0x4p1000) == 0x5p1000);
    CHECK(elementary::hypot(3 * smallest, 4 * smallest) == 5 * smallest);
    CHECK(elementary::modulus({-5, 12}) == 13);
}

TEST_CASE("pow is right to 0.51 ulp and 2^-15 for each unit of the exponent, and exact roots are") {
    const auto worst = [](const std::function<Two(std::mt19937_64&)>& arguments) {
        return worst_of(
            6, arguments, [](double x, double y) { return elementary::pow(x, y); },
            [](Wide x, Wide y) { return std::pow(x, y); });
    };
    CHECK(worst([](auto& e) { return Two{of_any_size(-700, 700)(e), uniform(e, -1, 1)}; }) < 0.51);
    CHECK(worst([](auto& e) {
              return Two{of_any_size(-20, 20)(e), static_cast<double>(e() % 9) - 4};
          }) < 0.51);
    CHECK(worst([](auto& e) {
              return Two{uniform(e, 0.5, 2), uniform(e, -1000, 1000)};
          }) < 0.51 + 1000 * 0x1p-15);
    CHECK(elementary::pow(1e4, 0.25) == 10);
    CHECK(elementary::pow(100, 0.5) == 10);
    CHECK(elementary::pow(1e-6, 0.5) == 1e-3);
    CHECK(elementary::pow(7, 3) == 343);
    CHECK(elementary::pow(8, -1) == 0.125);
}

TEST_CASE("zeros, infinities and NaN give the same results as in C") {
    CHECK(elementary::log(0) == -infinity);
    CHECK(elementary::log(-0.0) == -infinity);
    CHECK(is_zero(elementary::log(1), false));
    CHECK(elementary::log(infinity) == infinity);
    for (const double none : {-1.0, -smallest, -infinity, vines::nan})
        CHECK(std::isnan(elementary::log(none)));
    CHECK(elementary::exp(0) == 1);
    CHECK(elementary::exp(-infinity) == 0);
    CHECK(elementary::exp(infinity) == infinity);
    CHECK(elementary::exp(709.8) == infinity);
    CHECK(elementary::exp(-745) == smallest);
    CHECK(elementary::exp(-746) == 0);
    CHECK(std::isnan(elementary::exp(vines::nan)));
    CHECK(is_zero(elementary::sin(0), false));
    CHECK(is_zero(elementary::sin(-0.0), true));
    CHECK(elementary::sin(smallest) == smallest);
    CHECK(elementary::cos(0) == 1);
    CHECK(elementary::cos(smallest) == 1);
    CHECK(std::abs(elementary::sin(largest)) <= 1);
    for (const double none : {infinity, -infinity, vines::nan}) {
        CHECK(std::isnan(elementary::sin(none)));
        CHECK(std::isnan(elementary::cos(none)));
    }
    CHECK(elementary::hypot(0, -0.0) == 0);
    CHECK(elementary::hypot(-infinity, vines::nan) == infinity);
    CHECK(elementary::hypot(vines::nan, infinity) == infinity);
    CHECK(std::isnan(elementary::hypot(1, vines::nan)));
    CHECK(std::isnan(elementary::hypot(vines::nan, 1)));
    CHECK(elementary::hypot(largest, largest) == infinity);
    CHECK(elementary::hypot(-largest, smallest) == largest);
    CHECK(elementary::hypot(smallest, 0) == smallest);
}

TEST_CASE("atan2 of points on the axes, at infinity and of NaN agrees with C") {
    const double values[] = {0,        -0.0,     1,         -1,     smallest, -smallest, largest,
                             -largest, infinity, -infinity, 1e-300, -1e300,   vines::nan};
    for (const double y : values)
        for (const double x : values) {
            CAPTURE(y);
            CAPTURE(x);
            const double angle = elementary::atan2(y, x), in_c = std::atan2(y, x);
            if (std::isnan(in_c)) CHECK(std::isnan(angle));
            else CHECK((angle == in_c && std::signbit(angle) == std::signbit(in_c)));
        }
    CHECK(elementary::atan(infinity) == std::numbers::pi / 2);
    CHECK(is_zero(elementary::atan(-0.0), true));
}

TEST_CASE("pow agrees with C at the limits, and is NaN for a negative base") {
    const double values[] = {0, 1, 0.5, 2, smallest, 1e300, infinity, vines::nan};
    for (const double x : values)
        for (const double y :
             {0.0, 1.0, -1.0, 0.5, -3.0, 1e300, -1e300, smallest, infinity, vines::nan}) {
            CAPTURE(x);
            CAPTURE(y);
            const double power = elementary::pow(x, y), in_c = std::pow(x, y);
            if (std::isnan(in_c)) CHECK(std::isnan(power));
            else CHECK(power == in_c);
        }
    CHECK(std::isnan(elementary::pow(-1, 2)));
}
