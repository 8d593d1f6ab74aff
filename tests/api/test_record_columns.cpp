// Columns, units and channels of a record.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <functional>
#include <numbers>
#include <sstream>

#include "api/csv.hpp"
#include "api/identify.hpp"
#include "core/measurement/measured_load.hpp"
#include "core/measurement/synthetic_record.hpp"
#include "record_support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

namespace {

/// The record with another header and its columns divided by these factors.
std::string rescaled(
    const std::string& csv, const std::string& new_header, double time, double displacement,
    double acceleration) {
    std::string out = new_header + "\n";
    for (std::size_t from = csv.find('\n') + 1, end;
         (end = csv.find('\n', from)) != std::string::npos; from = end + 1) {
        double t, x, a;
        std::sscanf(csv.c_str() + from, "%lf,%lf,%lf", &t, &x, &a);
        char line[120];
        std::snprintf(
            line, sizeof line, "%.12g,%.12g,%.12g\n", t / time, x / displacement, a / acceleration);
        out += line;
    }
    return out;
}

}  // namespace

TEST_CASE(
    "a unit in a column's name is applied, in CSV and JSON, or refused if unknown or "
    "contradictory" *
    doctest::test_suite("long")) {
    const std::string csv = measured("fig15", 3, 20);  // weak impacts depend on every digit
    const Json a = identified(read_identify_request({{"preset", "fig15"}}, csv));
    const auto same = [&](const Json& b) {
        REQUIRE(b["impacts"]["side"] == a["impacts"]["side"]);
        CHECK(
            b["signal"]["G"].get<double>() ==
            doctest::Approx(a["signal"]["G"].get<double>()).epsilon(1e-6));
        for (std::size_t i = 0; i < a["impacts"]["tau"].size(); ++i)
            CHECK(
                b["impacts"]["tau"][i].get<double>() ==
                doctest::Approx(a["impacts"]["tau"][i].get<double>()).epsilon(1e-6));
    };
    constexpr double g = 9.80665;
    for (const char* header :
         {"time_ms,displacement_mm,acceleration_g", "time (ms),displacement (mm),acceleration (g)",
          "Time [ms],Displacement [mm],Acceleration [g]", "t ms,x mm,a g", "t(ms),x[mm],a(g)"}) {
        CAPTURE(header);
        same(identified(
            read_identify_request({{"preset", "fig15"}}, rescaled(csv, header, 1e-3, 1e-3, g))));
    }
    same(identified(read_identify_request(
        {{"preset", "fig15"}},
        rescaled(csv, "time_s,displacement (\xc2\xb5m),acceleration (m/s\xc2\xb2)", 1, 1e-6, 1))));
    same(identified(read_identify_request(
        {{"preset", "fig15"}, {"displacement_column", "laser_mm"}, {"displacement_unit", "mm"}},
        rescaled(csv, "time_s,laser_mm,acceleration_m_s2", 1, 1e-3, 1))));
    // A row of units below names with or without units.
    for (const char* header :
         {"Time,Displacement,Acceleration 1\nms,mm,g", "t (ms),x,a\n(ms),[mm],[g]",
          "t,x mm,a\nms,,g"})
        same(identified(
            read_identify_request({{"preset", "fig15"}}, rescaled(csv, header, 1e-3, 1e-3, g))));
    // The field gives the unit of a name without one.
    same(identified(read_identify_request(
        {{"preset", "fig15"},
         {"time_unit", "ms"},
         {"displacement_column", "laser"},
         {"displacement_unit", "um"}},
        rescaled(csv, "t,laser,a", 1e-3, 1e-6, 1))));
    same(identified(read_identify_request(
        {{"preset", "fig15"}, {"displacement_column", "laser_left"}},
        rescaled(csv, "time,laser_left,acceleration_1", 1, 1, 1))));
    Json record = Json::object();
    for (const CsvColumn& c :
         parse_csv(rescaled(csv, "time_ms,displacement_mm,acceleration_g", 1e-3, 1e-3, g)).columns)
        record[c.name] = c.values;
    same(identified(read_identify_request({{"preset", "fig15"}, {"record", record}})));

    const auto fault = [&](Json fields, const char* header) {
        fields["preset"] = "fig15";
        const Problem p = refused(fields, rescaled(csv, header, 1, 1, 1));
        REQUIRE(p.errors.size() == 1);
        return p.errors[0];
    };
    const FieldError unknown = fault(Json::object(), "time_s,displacement_inch,acceleration_m_s2");
    CHECK(unknown.pointer == "/record/displacement_inch");
    CHECK(unknown.value == "inch");
    CHECK(unknown.range == Json({"m", "mm", "um"}));
    CHECK(
        unknown.detail.find(
            "column displacement_inch: the unit \"inch\" is unknown; known units: m, mm, um") == 0);
    CHECK(fault(Json::object(), "time (min),displacement_m,acceleration_m_s2").value == "min");
    const FieldError below = fault(Json::object(), "time_s,x,a\ns,inch,m/s^2");
    CHECK(below.pointer == "/record/x");
    CHECK(below.value == "inch");
    CHECK(
        fault(Json::object(), "time_s,x_mm,a\ns,um,m/s^2").detail ==
        "column x_mm has the unit mm, but the row of units has um");
    CHECK(fault({{"time_unit", "s"}}, "t,x,a\nms,mm,g").pointer == "/time_unit");
    CHECK(
        fault(
            {{"acceleration_column", "sensor [mV]"}, {"acceleration_unit", "g"}},
            "time_s,displacement_m,sensor [mV]")
            .pointer == "/record/sensor [mV]");
    CHECK(
        fault({{"displacement_column", "laser_cm"}}, "time_s,laser_cm,acceleration_m_s2").value ==
        "cm");
    const FieldError contradiction =
        fault({{"displacement_unit", "mm"}}, "time_s,displacement_m,acceleration_m_s2");
    CHECK(contradiction.pointer == "/displacement_unit");
    CHECK(contradiction.value == "mm");
    CHECK(
        contradiction.detail ==
        "displacement_unit is mm, but column displacement_m has the unit m");
}

TEST_CASE("an invalid column or unit field is refused at that field") {
    const std::string csv = header + "0,1e-3,1\n0.001,2e-3,1\n";
    for (const auto& [field, value] : std::vector<std::pair<const char*, Json>>{
             {"time_unit", "furlong"},
             {"time_unit", 1},
             {"time_column", 1},
             {"base_acceleration_column", Json::array()}}) {
        const Problem problem = refused({{"preset", "fig15"}, {field, value}}, csv);
        CAPTURE(problem.what());
        CHECK(problem.status == 422);
        CHECK(pointers(problem) == std::string("/") + field);
    }
}

namespace {

/// A record with an additional column.
std::string with_column(
    const std::string& csv, const std::string& name, const std::function<double(double)>& of_time) {
    std::string all;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);)
        all += line + ',' + (all.empty() ? name : std::to_string(of_time(std::stod(line)))) + '\n';
    return all;
}

}  // namespace

TEST_CASE(
    "a channel of the base or of a force gives the amplitude, frequency and phase of the forcing" *
    doctest::test_suite("long")) {
    const std::string csv = measured("fig20", 12);
    const Json known = identified(read_identify_request({{"preset", "fig20"}}, csv));
    CHECK(known["signal"]["forcing"].is_null());
    const Json si = simulated(
        read_simulate_request({{"preset", "fig20"}, {"cycles", 1}}), {})["parameters"]["si"];
    const double F = si["F"], f = si["f"], k1 = si["k1"], c1 = si["c1"],
                 omega = 2 * std::numbers::pi * f;
    const Json system = {{"m1", si["m1"]}, {"c1", c1}, {"k1", k1}, {"m2", si["m2"]}, {"b", 0.015}};
    const auto base = [&](double t) { return -F * omega * omega * std::sin(omega * t) / 9.80665; };
    const auto force = [&](double t) {
        return F * (k1 * std::sin(omega * t) + c1 * omega * std::cos(omega * t));
    };
    struct Channel {
        std::string name;
        std::function<double(double)> of_time;
    };
    const auto moved = [&](double t) { return 1000 * F * std::sin(omega * t); };
    for (const Channel& c :
         {Channel{"base_acceleration_g", base}, Channel{"base_displacement_mm", moved},
          Channel{"force_N", force}}) {
        CAPTURE(c.name);
        // f is omitted.
        const Json a =
            identified(read_identify_request(system, with_column(csv, c.name, c.of_time)));
        const Json& forcing = a["signal"]["forcing"];
        CHECK(forcing["f"].get<double>() == doctest::Approx(f).epsilon(2e-5));
        CHECK(forcing["F"].get<double>() == doctest::Approx(F).epsilon(1e-3));
        CHECK(std::abs(forcing["phase"].get<double>()) < 0.02);
        CHECK(forcing["load"] == "sine");
        for (const auto& [key, truth] : {std::pair("F", F), std::pair("phase", 0.0)}) {
            const Json& fitted = a["fitted"][key];
            CHECK(
                std::abs(fitted["value"].get<double>() - truth) <
                4 * fitted["standard_error"].get<double>());
            CHECK(fitted["standard_error"].get<double>() < 5e-4);
        }
        CHECK(a["impacts"]["side"] == known["impacts"]["side"]);
        CHECK(a["verdict"] == known["verdict"]);
        CHECK_FALSE(contains(a["warnings"].dump(), "channel"));
        Json as_measured = system;
        as_measured["fixed"] = {"F", "phase"};
        const Json fixed =
            identified(read_identify_request(as_measured, with_column(csv, c.name, c.of_time)));
        CHECK(
            fixed["fitted"]["F"]["value"].get<double>() ==
            doctest::Approx(fixed["signal"]["forcing"]["F"].get<double>()).epsilon(1e-6));
        // At t = 0, extrapolated with the fitted frequency, which differs slightly from the
        // channel's.
        CHECK(std::abs(fixed["signal"]["forcing"]["phase"].get<double>()) < 1e-4);
    }
    // A harmonic of the base becomes part of the load, whichever channel shows it.
    const double second = 0.05;
    const Channel base_with_harmonic{
        "base_acceleration_g",
        [&](double t) {
            return base(t) - 4 * second * F * omega * omega * std::sin(2 * omega * t) / 9.80665;
        }},
        displacement_with_harmonic{
            "base_displacement_mm",
            [&](double t) { return moved(t) + second * 1000 * F * std::sin(2 * omega * t); }},
        force_with_harmonic{"force_N", [&](double t) {
                                return force(t) + second * F *
                                                      (k1 * std::sin(2 * omega * t) +
                                                       2 * c1 * omega * std::cos(2 * omega * t));
                            }};
    std::vector<std::complex<double>> excess;
    for (const Channel& c : {base_with_harmonic, displacement_with_harmonic, force_with_harmonic}) {
        const IdentifyRequest r =
            read_identify_request(system, with_column(csv, c.name, c.of_time));
        const MeasuredLoad* load = r.measurement.forcing.load.get();
        REQUIRE(load);
        CHECK(
            elementary::modulus(load->fundamental) ==
            doctest::Approx(F * std::hypot(1, c1 * omega / k1)).epsilon(1e-4));
        UnknownValues values{};
        values[Unknown::Omega] = load->Omega;
        values[Unknown::force_cos] = load->fundamental.real();
        values[Unknown::force_sin] = -load->fundamental.imag();
        excess.push_back(load->excess(3, values));
    }
    CHECK(elementary::modulus(excess[0]) == doctest::Approx(second).epsilon(0.02));
    CHECK(elementary::modulus(excess[0] - excess[1]) < 0.02 * second);
    CHECK(elementary::modulus(excess[1] - excess[2]) < 0.02 * second);
    const std::string inverted =
        with_column(csv, "base_acceleration_g", [&](double t) { return -1.2 * base(t); });
    const std::string said = identified(read_identify_request(system, inverted))["warnings"].dump();
    CHECK(contains(said, "is the channel inverted or delayed?"));
    CHECK(contains(said, "is a sensitivity wrong?"));
    const std::string noise =
        with_column(csv, "force_N", [&](double t) { return std::sin(1e6 * t * t); });
    CHECK(contains(refused(system, noise).what(), "force_N is not harmonic"));
}
