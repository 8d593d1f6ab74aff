// Requests and answers of /v1/identify.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <set>
#include <sstream>

#include "api/csv.hpp"
#include "api/identify.hpp"
#include "core/measurement/synthetic_record.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

namespace {

/// A measurement of the preset's oscillator by quiet sensors, from rest or `settling` s later.
std::string measured(
    const char* preset, double seconds, double settling = 0, char separator = ',') {
    const SimulateRequest r = read_simulate_request({{"preset", preset}});
    const double omega0 = r.system.si->omega0();
    const MeasuredRecord record = synthetic_record(
        true_motion(r.wanted.parameters, omega0, settling, seconds),
        {.noise_x = 1e-6, .noise_a = 0.025});
    std::string csv =
        std::string("time_s") + separator + "displacement_m" + separator + "acceleration_m_s2\n";
    for (std::size_t k = 0; k < record.tau.size(); ++k) {
        char line[96];
        std::snprintf(
            line, sizeof line, "%.7f%c%.8e%c%.5e\n", record.tau[k] / omega0, separator, record.x[k],
            separator, record.x_ddot[k] * omega0 * omega0);
        csv += line;
    }
    return csv;
}

Problem refused(const Json& fields, const std::string& csv) {
    CAPTURE(csv.substr(0, 100));
    return problem_of([&] { identified(read_identify_request(fields, csv)); });
}

const std::string header = "time_s,displacement_m,acceleration_m_s2\n";

std::string replaced_line(const std::string& csv, int line, const std::string& by) {
    std::size_t from = 0;
    for (int k = 1; k < line; ++k) from = csv.find('\n', from) + 1;
    return csv.substr(0, from) + by + csv.substr(csv.find('\n', from));
}

}  // namespace

TEST_CASE("a reduced field over a preset leaves a record its oscillator") {
    // A record in seconds needs omega0, which no reduced field tells.
    const std::string csv = measured("fig15", 3);
    const auto parameters = [&](const Json& given) {
        Json j = identified(read_identify_request(given, csv))["parameters"];
        j.erase("origin");
        return j;
    };
    const Json preset = parameters({{"preset", "fig15"}}),
               over = parameters({{"preset", "fig15"}, {"Omega", 1.0}});
    CHECK(over == preset);
    const Json lambda = parameters({{"preset", "fig15"}, {"lambda", 1.7}});
    CHECK(lambda["lambda"] == 1.7);
    CHECK(lambda["epsilon"] == preset["epsilon"]);
    CHECK(lambda["derived"]["omega0"] == preset["derived"]["omega0"]);
}

TEST_CASE(
    "a CSV file and the same record as JSON give the impacts, the restitution and the exponents of "
    "the motion") {
    const std::string csv = measured("fig15", 12);
    const Json a = identified(read_identify_request({{"preset", "fig15"}}, csv));
    CHECK(a["verdict"] == "regular");
    CHECK(a["restitution"]["plus"]["R"].get<double>() == doctest::Approx(0.85).epsilon(0.02));
    CHECK(a["signal"]["G"].get<double>() == doctest::Approx(0.01).epsilon(0.01));
    CHECK(a["exponents"]["qr"]["history"]["tau"].size() + 1 == a["impacts"]["tau"].size());
    CHECK(a["slope"]["low"] < a["slope"]["high"]);
    CHECK(a["forward"]["impacts"]["tau"].size() > 100);
    const double omega0 = a["parameters"]["derived"]["omega0"];
    CHECK(
        a["exponents"]["window_s"][0].get<double>() * omega0 ==
        doctest::Approx(a["exponents"]["window"][0].get<double>()));
    CHECK(
        a["exponents"]["stretches"]["time_start_s"].size() ==
        a["exponents"]["stretches"]["tau_start"].size());
    CHECK(
        a["impacts"]["x_velocity_before"][7].get<double>() ==
        doctest::Approx(a["impacts"]["x_dot_before"][7].get<double>() * omega0)
            .epsilon(1e-12)
            .scale(0));
    // The paper's direct estimate agrees, and scatters more.
    CHECK(
        a["direct"]["restitution"]["plus"]["R"].get<double>() ==
        doctest::Approx(0.85).epsilon(0.02));
    const auto R_off = [](const Json& walls) {
        return std::abs(walls["plus"]["R"].get<double>() - 0.85);
    };
    CHECK(R_off(a["direct"]["restitution"]) > R_off(a["restitution"]));
    CHECK(R_off(a["restitution"]) < 3 * a["restitution"]["plus"]["standard_error"].get<double>());
    CHECK(
        std::abs(
            a["direct"]["lambda"][0].get<double>() -
            a["exponents"]["qr"]["final"][0].get<double>()) < 0.02);
    CHECK(Json::parse(a.dump()) == a);
    Json record = Json::object();
    for (const CsvColumn& c : parse_csv(csv).columns) record[c.name] = c.values;
    CHECK(identified(read_identify_request({{"preset", "fig15"}, {"record", record}})) == a);
    // Other names, separators and units say the same.
    std::string german = measured("fig15", 12, 0, ';');
    std::replace(german.begin(), german.end(), '.', ',');
    german.replace(0, german.find('\n'), "Zeit;weg;\"acceleration (m/s^2)\"");
    const Json b = identified(read_identify_request(
        {{"preset", "fig15"},
         {"time_column", "Zeit"},
         {"displacement_column", "weg"},
         {"acceleration_column", "acceleration (m/s^2)"}},
        german));
    CHECK(b["impacts"]["tau"] == a["impacts"]["tau"]);
}

TEST_CASE("the fitted motion is given at the record's samples where it is asked for") {
    const std::string csv = measured("fig15", 3);
    const Json a =
        identified(read_identify_request({{"preset", "fig15"}, {"include", {"motion"}}}, csv));
    const Json &motion = a["motion"], &impacts = a["impacts"];
    const double omega0 = a["parameters"]["derived"]["omega0"];
    const std::vector<CsvColumn> record = parse_csv(csv).columns;
    const std::size_t n = record[0].values.size();
    for (const auto& [name, column] : motion.items()) CHECK(column.size() == n);
    std::size_t next = 0, far = 0;
    for (std::size_t k = 0; k < n; ++k) {
        CHECK(motion["time_s"][k].get<double>() == doctest::Approx(record[0].values[k]));
        far += std::abs(motion["x"][k].get<double>() - record[1].values[k]) > 3e-6;
        // The acceleration beside the pulses.
        const double t = record[0].values[k];
        while (next < impacts["time_s"].size() && impacts["time_s"][next].get<double>() < t - 1e-3)
            ++next;
        if (next < impacts["time_s"].size() && impacts["time_s"][next].get<double>() < t + 1e-3)
            continue;
        CHECK(
            std::abs(motion["x_acceleration"][k].get<double>() - record[2].values[k]) <
            0.025 * 5 + 1e-3);
    }
    CHECK(static_cast<double>(far) < 0.01 * static_cast<double>(n));  // 3 standard deviations
    CHECK(
        motion["x_velocity"][99].get<double>() ==
        doctest::Approx(motion["x_dot"][99].get<double>() * omega0).epsilon(1e-12));

    const Json few = identified(read_identify_request(
        {{"preset", "fig15"}, {"include", {"motion"}}, {"max_points", 1000}}, csv));
    const std::size_t every = (n + 999) / 1000;
    CHECK(few["motion"]["tau"].size() == (n + every - 1) / every);
    for (std::size_t k = 0; k < 5; ++k) CHECK(few["motion"]["x"][k] == motion["x"][every * k]);
    CHECK(warns(few, "the motion is given at one of"));
    CHECK_FALSE(warns(a, "the motion is given at one of"));
}

TEST_CASE("the direct estimate has the exponents of the answer, with histories, where asked for") {
    const std::string csv = measured("fig15", 6);
    const Json fields = {{"preset", "fig15"}, {"exponents", {"qr", "raw_product"}}};
    Json asking = fields;
    asking["include"] = {"direct_exponents"};
    Json a = identified(read_identify_request(asking, csv));
    const Json e = a["direct"]["exponents"];
    CHECK(e["qr"]["history"]["tau"] == a["exponents"]["qr"]["history"]["tau"]);
    CHECK(
        std::abs(
            e["qr"]["final"][0].get<double>() - a["exponents"]["qr"]["final"][0].get<double>()) <
        0.02);
    CHECK(e.contains("raw_product"));
    CHECK_FALSE(e.contains("eigenvalues"));
    for (const auto& [name, part] : a["exponents"].items()) CHECK(e.contains(name));
    const Json& history = e["raw_product"]["history"];
    CHECK(history["lambda1"].size() == history["time_s"].size());
    CHECK(history["lambda1"].back() == e["raw_product"]["final"][0]);
    CHECK(
        history["tau"].back().get<double>() ==
        doctest::Approx(a["impacts"]["tau"].back().get<double>()));
    // All else is as without.
    a["direct"].erase("exponents");
    CHECK(a == identified(read_identify_request(fields, csv)));
}

TEST_CASE("what is of a record cannot be included where impacts come without one") {
    const Json request =
        parse_object(R"({"b":0.015,"impacts":{"tau":[1,2]},"include":["motion"]})");
    CHECK(pointers(problem_of([&] {
              read_identify_request(request);
          })) == std::set<std::string>{"/include"});
}

TEST_CASE("a list without the chatter that came to rest says what was hidden, and where it stuck") {
    const Json run =
        simulated(read_simulate_request({{"preset", "fig20"}, {"b", 0.015}, {"R", 0.5}}), {});
    const Json& all = run["impacts"];
    Json strong = Json::object();
    for (const char* name : {"tau", "x", "x_dot_before", "x_dot_after"})
        for (std::size_t i = 0; i < all["tau"].size(); ++i)
            if (std::abs(
                    all["x_dot_after"][i].get<double>() - all["x_dot_before"][i].get<double>()) >
                2e-5)
                strong[name].push_back(all[name][i]);
    const Json a =
        identified(read_identify_request({{"preset", "fig20"}, {"b", 0.015}, {"impacts", strong}}));
    const Json& sticking = a["sticking"];
    REQUIRE(sticking["tau_start"].size() > 0);
    for (std::size_t i = 0; i < sticking["tau_start"].size(); ++i) {
        CHECK(sticking["tau_end"][i] > sticking["tau_start"][i]);
        CHECK(sticking["impacts"][i] > 1);
        double nearest = 1;
        for (const Json& tau : run["sticking"]["tau_end"])
            nearest = std::min(
                nearest, std::abs(tau.get<double>() - sticking["tau_end"][i].get<double>()));
        CHECK(nearest < 1e-6);
    }
    const Json& status = a["impacts"]["status"];
    CHECK(std::count(status.begin(), status.end(), "hidden") > 0);
    CHECK(a["impacts"]["tau"].size() < all["tau"].size());
    CHECK(a["warnings"].dump().find("that the list misses are put in") != std::string::npos);
    CHECK(a["verdict"] == "chaotic");
}

TEST_CASE("amplitude and phase of the forcing stay where they are fixed") {
    const std::string csv = measured("fig20", 8, 20);
    const Json free = identified(read_identify_request({{"preset", "fig20"}}, csv));
    const double F = free["fitted"]["F"]["value"], phase = free["fitted"]["phase"]["value"];
    const auto with = [&](double F_given, double phase_given) {
        return identified(read_identify_request(
            {{"preset", "fig20"},
             {"F", F_given},
             {"phase", phase_given},
             {"fixed", {"F", "phase"}}},
            csv));
    };
    const Json known = with(1.00001 * F, phase + 1e-5);
    CHECK(
        known["fitted"]["F"]["value"].get<double>() == doctest::Approx(1.00001 * F).epsilon(1e-8));
    CHECK(
        known["fitted"]["phase"]["value"].get<double>() ==
        doctest::Approx(phase + 1e-5).epsilon(1e-7));
    CHECK(known["fitted"]["phase"]["fixed"] == true);
    CHECK(known["fitted"]["F"]["standard_error"].is_null());
    CHECK(known["verdict"] == free["verdict"]);
    const Json wrong = with(F, phase + 0.2);
    CHECK(wrong["verdict"] == "not_decided");
    const Problem p = refused({{"preset", "fig20"}, {"fixed", {"phase"}}}, csv);
    CHECK(std::string(p.what()).find("phase is fixed, but neither given") != std::string::npos);
}

TEST_CASE("an edited list of moments is taken as it is") {
    const std::string csv = measured("fig15", 6);
    const Json a = identified(read_identify_request({{"preset", "fig15"}}, csv));
    CHECK(a["verdict"] == "not_decided");  // a chaotic motion may look like this for 6 s
    std::vector<double> times = a["impacts"]["time_s"];
    const Json same =
        identified(read_identify_request({{"preset", "fig15"}, {"impact_times_s", times}}, csv));
    CHECK(same["impacts"]["tau"].size() == times.size());
    CHECK(same["impacts"]["side"] == a["impacts"]["side"]);
    times.erase(times.begin() + 30);
    const Json without =
        identified(read_identify_request({{"preset", "fig15"}, {"impact_times_s", times}}, csv));
    CHECK(without["impacts"]["tau"].size() == times.size());
    CHECK(without["impacts"]["status"][30].get<std::string>().find("missing") != std::string::npos);
    CHECK(without["warnings"].dump().find("inconsistent") != std::string::npos);
}

TEST_CASE("impacts with their states give the exponents of the simulation that they come from") {
    const Json a = simulated(
        read_simulate_request(
            parse_object(R"({"preset":"fig20","include":["impacts","exponents"]})")),
        {});
    const Json b =
        identified(read_identify_request({{"preset", "fig20"}, {"impacts", a["impacts"]}}));
    for (int k = 0; k < 4; ++k)
        CHECK(
            b["exponents"]["qr"]["final"][k].get<double>() ==
            doctest::Approx(a["exponents"]["qr"]["final"][k].get<double>()).epsilon(1e-9));
    Json broken = a["impacts"];
    broken.erase("x_dot_after");
    broken.erase("x_velocity_after");
    broken["tau"][3] = 0;
    broken["x"][2] = "a";
    CHECK(pointers(problem_of([&] {
              read_identify_request({{"preset", "fig20"}, {"impacts", broken}});
          })) == std::set<std::string>{"/impacts/x_dot_after", "/impacts/x/2"});
}

TEST_CASE("what is wrong with a record is named with its line and column") {
    const std::string csv = measured("fig15", 3);
    const Json fields = {{"preset", "fig15"}};
    auto detail = [&](const std::string& text) {
        return std::string(refused(fields, text).what());
    };
    CHECK(
        detail(replaced_line(csv, 7, "0.003,abc,1")) ==
        "line 7, column displacement_m: \"abc\" is no number");
    CHECK(
        detail(replaced_line(csv, 7, "0.003,nan,1")) ==
        "line 7, column displacement_m: the number is not finite");
    CHECK(detail(replaced_line(csv, 7, "0.003,1")) == "line 7: has 2 columns, the header has 3");
    CHECK(
        detail(replaced_line(csv, 7, "0.003,,1")) ==
        "line 7, column displacement_m: there is no number");
    CHECK(
        detail(replaced_line(csv, 7, "0.0001,1e-3,1"))
            .find("line 7, column of time: time must increase") == 0);
    CHECK(
        detail(csv.substr(header.size()))
            .find("line 1: a line above the numbers must name the columns") == 0);
    CHECK(detail("") == "the record is empty: it needs a header and lines of numbers");
    CHECK(detail(header + "0,0,0\n1,0,0\n").find("at least 100") != std::string::npos);
    CHECK(
        detail("time_s,temperature\n0,1\n").find("neither a displacement nor an acceleration") !=
        std::string::npos);
    CHECK(detail("speed,x\n0,1\n").find("no column time_s") != std::string::npos);
    CHECK(
        refused({{"preset", "fig15"}, {"displacement_column", "weg"}}, csv).errors[0].pointer ==
        "/displacement_column");
    CHECK(refused({{"b", 0.009}}, csv).errors[0].pointer == "/m1");
    CHECK(refused({{"preset", "fig15"}, {"tau_end", 3}}, csv).errors[0].pointer == "/tau_end");
}

TEST_CASE("a quiet record, a clipped one, gaps, slow sampling and a wrong b are noticed") {
    std::string quiet = header;
    for (int k = 0; k < 5000; ++k) {
        char line[80];
        std::snprintf(
            line, sizeof line, "%.6f,%.7e,%.5e\n", k / 2048.0, 1e-3 * std::sin(k * 0.0256),
            -2.75 * std::sin(k * 0.0256) + 0.01 * std::sin(k * 1.7));
        quiet += line;
    }
    CHECK(
        std::string(refused({{"preset", "fig15"}}, quiet).what())
            .find("nothing in the record looks like impacts") == 0);

    const std::string csv = measured("fig15", 6);
    auto warnings = [&](const Json& fields, const std::string& text) {
        return identified(read_identify_request(fields, text))["warnings"].dump();
    };
    CHECK(warnings({{"preset", "fig15"}}, csv) == "[]");
    CHECK(
        warnings({{"preset", "fig15"}, {"b", 0.011}}, csv).find("momentum fits b = 0.0089") !=
        std::string::npos);
    std::string gap = header, slow = header, clipped = header;
    std::size_t number = 0;
    for (std::size_t from = header.size(), end; (end = csv.find('\n', from)) != std::string::npos;
         from = end + 1, ++number) {
        const std::string line = csv.substr(from, end - from + 1);
        if (number < 3000 || number > 3040) gap += line;
        if (number % 3 == 0) slow += line;
        const std::size_t comma = line.rfind(',');
        clipped += line.substr(0, comma + 1) +
                   std::to_string(std::min(std::stod(line.substr(comma + 1)), 3.0)) + "\n";
    }
    CHECK(warnings({{"preset", "fig15"}}, gap).find("1 gap(s)") != std::string::npos);
    CHECK(warnings({{"preset", "fig15"}}, clipped).find("clipped") != std::string::npos);
    CHECK(warnings({{"preset", "fig15"}}, slow).find("ms apart") != std::string::npos);
}

namespace {

/// The record with another header, its columns over these factors.
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
    "a unit in a column's name is obeyed, in CSV and JSON, or refused where it is not known or "
    "contradicts the field") {
    const std::string csv = measured("fig15", 3, 20);  // weak impacts move with every digit
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
    // A row of units below the names, whether these say it as well or not.
    for (const char* header :
         {"Time,Displacement,Acceleration 1\nms,mm,g", "t (ms),x,a\n(ms),[mm],[g]",
          "t,x mm,a\nms,,g"})
        same(identified(
            read_identify_request({{"preset", "fig15"}}, rescaled(csv, header, 1e-3, 1e-3, g))));
    // A name without a unit leaves it to the field.
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
            "column displacement_inch: the unit \"inch\" is not known; known are m, mm, um") == 0);
    CHECK(fault(Json::object(), "time (min),displacement_m,acceleration_m_s2").value == "min");
    const FieldError below = fault(Json::object(), "time_s,x,a\ns,inch,m/s^2");
    CHECK(below.pointer == "/record/x");
    CHECK(below.value == "inch");
    CHECK(
        fault(Json::object(), "time_s,x_mm,a\ns,um,m/s^2").detail ==
        "column x_mm says mm, but the row of units um");
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
    CHECK(contradiction.detail == "displacement_unit is mm, but the column displacement_m says m");
}

TEST_CASE("a field that names or measures a column is refused where it is at fault itself") {
    const std::string csv = header + "0,1e-3,1\n0.001,2e-3,1\n";
    for (const auto& [field, value] : std::vector<std::pair<const char*, Json>>{
             {"time_unit", "furlong"},
             {"time_unit", 1},
             {"time_column", 1},
             {"base_acceleration_column", Json::array()}}) {
        const Problem problem = refused({{"preset", "fig15"}, {field, value}}, csv);
        CAPTURE(problem.what());
        CHECK(problem.status == 422);
        CHECK(pointers(problem) == std::set<std::string>{std::string("/") + field});
    }
}

TEST_CASE(
    "impacts in a list are judged as those of a record: momentum over the typical jump, R within "
    "[0, 1], no missing one flown over") {
    const Json run = simulated(
        read_simulate_request(
            {{"preset", "fig20"}, {"include", {"impacts", "exponents"}}, {"cycles", 200}}),
        {});
    Json impacts = run["impacts"];
    const double epsilon = run["parameters"]["epsilon"];
    const std::size_t n = impacts["tau"].size();
    REQUIRE(n > 100);
    std::vector<double> jumps;
    for (std::size_t i = 0; i < n; ++i)
        jumps.push_back(std::abs(
            impacts["x_dot_after"][i].get<double>() - impacts["x_dot_before"][i].get<double>()));
    std::sort(jumps.begin(), jumps.end());
    const double typical = 0.5 * (jumps[(n - 1) / 2] + jumps[n / 2]);
    // No momentum.
    impacts["x_dot_after"][20] = impacts["x_dot_after"][20].get<double>() + 0.5 * typical;
    // R twice as large.
    impacts["y_dot_after"][30] =
        2 * impacts["y_dot_after"][30].get<double>() - impacts["x_dot_after"][30].get<double>();
    const Json a = identified(read_identify_request({{"preset", "fig20"}, {"impacts", impacts}}));
    const Json& error = a["impacts"]["momentum_error"];
    CHECK(error[20].get<double>() == doctest::Approx(0.5).epsilon(0.01));
    const double change =
        impacts["y_dot_after"][30].get<double>() - run["impacts"]["y_dot_after"][30].get<double>();
    CHECK(error[30].get<double>() == doctest::Approx(epsilon * change / typical).epsilon(0.01));
    CHECK(std::abs(error[10].get<double>()) < 1e-9);
    CHECK(a["impacts"]["status"][10] == "ok");
    CHECK(a["impacts"]["status"][20].get<std::string>().find("momentum") == 0);
    CHECK(a["impacts"]["status"][30].get<std::string>().find("R lies outside [0, 1]") == 0);
    CHECK(a["exponents"]["stretches"]["tau_start"].size() == 3);
    CHECK(a["exponents"]["sum_rule_residual"].get<double>() < 1e-12);
    CHECK(a["verdict"] == "chaotic");

    const auto thinned = [&](const auto& is_left) {
        Json rest = Json::object();
        for (const auto& [name, column] : run["impacts"].items())
            for (std::size_t i = 0; i < n; ++i)
                if (is_left(i)) rest[name].push_back(column[i]);
        return identified(read_identify_request({{"preset", "fig20"}, {"impacts", rest}}));
    };
    // One in ten, and now and then seven in a row.
    const Json few = thinned([](std::size_t i) { return i % 10 != 5; }),
               gaps = thinned([](std::size_t i) { return i % 200 < 193; }),
               many = thinned([](std::size_t i) { return i % 15 < 8; });
    CHECK(few["verdict"] == "chaotic");
    CHECK(few["warnings"].dump().find("that the list misses are put in") != std::string::npos);
    CHECK(few["impacts"]["tau"].size() <= n);
    CHECK(few["impacts"]["tau"].size() + 2 >= n);
    CHECK(
        few["exponents"]["qr"]["final"][0].get<double>() ==
        doctest::Approx(run["exponents"]["qr"]["final"][0].get<double>()).epsilon(0.01));
    CHECK(gaps["verdict"] == "chaotic");
    CHECK(gaps["warnings"].dump().find("did not fly freely") != std::string::npos);
    CHECK(
        gaps["exponents"]["duration"].get<double>() <
        gaps["exponents"]["window"][1].get<double>() -
            gaps["exponents"]["window"][0].get<double>());
    CHECK(gaps["exponents"]["eigenvalues"]["window"][0] >= gaps["exponents"]["window"][0]);
    CHECK(many["verdict"] == "not_decided");
    CHECK(
        many["verdict_reason"].get<std::string>().find(
            "% of the impacts are left out or missing") != std::string::npos);
}

TEST_CASE(
    "a wrong frequency is found, with its error, and said; fixed, it leaves the record "
    "unexplained, "
    "and there is no verdict") {
    const std::string csv = measured("fig15", 12);
    const Json good = identified(read_identify_request({{"preset", "fig15"}}, csv));
    CAPTURE(good["warnings"].dump());
    CHECK(good["verdict"] == "regular");
    CHECK(good["signal"]["misfit"]["displacement"] < 1.1);
    CHECK(good["signal"]["misfit"]["acceleration"] < 1.1);
    CHECK(good["fitted"]["omega0"]["fixed"] == true);
    CHECK(good["fitted"]["omega0"]["standard_error"].is_null());
    const double f = 52.45873984186567 / (2 * std::numbers::pi);
    for (const double wrong : {1.002 * f, 0.997 * f}) {
        const Json found =
            identified(read_identify_request({{"preset", "fig15"}, {"f", wrong}}, csv));
        const Json& fitted = found["fitted"]["f"];
        CHECK(fitted["value"].get<double>() == doctest::Approx(f).epsilon(5e-6));
        CHECK(fitted["standard_error"].get<double>() < 5e-6 * f);
        CHECK(found["parameters"]["si"]["f"] == doctest::Approx(f).epsilon(1e-4));
        CHECK(found["parameters"]["origin"]["f"] == "fitted to the record");
        CHECK(found["warnings"].dump().find("the forcing has f = 8.349") != std::string::npos);
        CHECK(found["verdict"] == "regular");
    }
    for (const Json& wrong :
         {Json{{"f", 1.002 * f}, {"fixed", {"f"}}}, Json{{"f", 1.0005 * f}, {"fixed", {"f"}}},
          Json{{"b", 0.011}, {"fixed", {"b"}}}}) {
        CAPTURE(wrong.dump());
        Json fields = wrong;
        fields["preset"] = "fig15";
        const Json a = identified(read_identify_request(fields, csv));
        CHECK(a["verdict"] == "not_decided");
        CHECK(
            a["warnings"].dump().find(
                "no verdict: " + a["verdict_reason"].get<std::string>().substr(0, 20)) !=
            std::string::npos);
        if (!a["b_fitted"]["b"].is_null()) CHECK(a["b_fitted"]["b"].get<double>() > 0.004);
        else
            CHECK(
                a["warnings"].dump().find("no b is fitted to the impacts' momentum: ") !=
                std::string::npos);
        CHECK(a["warnings"].dump().find("fits b = -") == std::string::npos);
        // The pulse is seen well.
        CHECK(a["warnings"].dump().find("sample at") == std::string::npos);
    }
}

TEST_CASE("a b that the impacts contradict is replaced by theirs, and that is said") {
    const Json a = identified(
        read_identify_request({{"preset", "fig15"}, {"b", 0.011}}, measured("fig15", 12)));
    const Json& fitted = a["fitted"]["b"];
    CHECK(fitted["value"].get<double>() == doctest::Approx(0.009).epsilon(0.005));
    CHECK(fitted["standard_error"].get<double>() < 5e-5);
    CHECK(fitted["fixed"] == false);
    CHECK(a["b_fitted"]["b"] == fitted["value"]);
    CHECK(a["parameters"]["b"] == fitted["value"]);
    CHECK(a["parameters"]["origin"]["b"] == "fitted to the record");
    CHECK(a["warnings"].dump().find("which is taken, not b = 0.011 m") != std::string::npos);
    CHECK(a["verdict"] == "regular");
    for (const char* wall : {"plus", "minus"})
        CHECK(a["restitution"][wall]["R"] == a["fitted"][std::string("R_") + wall]["value"]);
}

namespace {

/// A record with one more column.
std::string with_column(
    const std::string& csv, const std::string& name, const std::function<double(double)>& of_time) {
    std::string all;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);)
        all += line + ',' + (all.empty() ? name : std::to_string(of_time(std::stod(line)))) + '\n';
    return all;
}

}  // namespace

TEST_CASE("a channel of the base or of a force gives the forcing, its frequency and its phase") {
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
    for (const Channel& c : {Channel{"base_acceleration_g", base}, Channel{"force_N", force}}) {
        CAPTURE(c.name);
        // f is not given.
        const Json a =
            identified(read_identify_request(system, with_column(csv, c.name, c.of_time)));
        const Json& forcing = a["signal"]["forcing"];
        CHECK(forcing["f"].get<double>() == doctest::Approx(f).epsilon(2e-5));
        CHECK(forcing["F"].get<double>() == doctest::Approx(F).epsilon(1e-3));
        CHECK(std::abs(forcing["phase"].get<double>()) < 0.02);
        for (const auto& [key, truth] : {std::pair("F", F), std::pair("phase", 0.0)}) {
            const Json& fitted = a["fitted"][key];
            CHECK(
                std::abs(fitted["value"].get<double>() - truth) <
                4 * fitted["standard_error"].get<double>());
            CHECK(fitted["standard_error"].get<double>() < 5e-4);
        }
        CHECK(a["impacts"]["side"] == known["impacts"]["side"]);
        CHECK(a["verdict"] == known["verdict"]);
        CHECK(a["warnings"].dump().find("channel") == std::string::npos);
        Json as_measured = system;
        as_measured["fixed"] = {"F", "phase"};
        const Json fixed =
            identified(read_identify_request(as_measured, with_column(csv, c.name, c.of_time)));
        CHECK(
            fixed["fitted"]["F"]["value"].get<double>() ==
            doctest::Approx(fixed["signal"]["forcing"]["F"].get<double>()).epsilon(1e-6));
        // At the time 0, from which the fitted frequency leads a bit elsewhere than the channel's.
        CHECK(std::abs(fixed["signal"]["forcing"]["phase"].get<double>()) < 1e-4);
    }
    const std::string inverted =
        with_column(csv, "base_acceleration_g", [&](double t) { return -1.2 * base(t); });
    const std::string said = identified(read_identify_request(system, inverted))["warnings"].dump();
    CHECK(said.find("is it inverted, or late?") != std::string::npos);
    CHECK(said.find("is a sensitivity wrong?") != std::string::npos);
    const std::string noise =
        with_column(csv, "force_N", [&](double t) { return std::sin(1e6 * t * t); });
    CHECK(
        std::string(refused(system, noise).what()).find("force_N is no harmonic") !=
        std::string::npos);
}

TEST_CASE("a list of impacts needs no more than what a laboratory knows of them") {
    const Json run = simulated(
        read_simulate_request({{"preset", "fig20"}, {"include", {"impacts"}}, {"cycles", 200}}),
        {});
    const Json& all = run["impacts"];
    Json few = {
        {"time_s", all["time_s"]},
        {"x", all["x"]},
        {"x_velocity_before", all["x_velocity_before"]},
        {"x_velocity_after", all["x_velocity_after"]}};
    const Json whole = identified(read_identify_request({{"preset", "fig20"}, {"impacts", all}}));
    Json system = run["parameters"]["si"];
    const Json request = {{"m1", system["m1"]}, {"c1", system["c1"]}, {"k1", system["k1"]},
                          {"m2", system["m2"]}, {"f", system["f"]},   {"b", run["parameters"]["b"]},
                          {"impacts", few}};
    const Json a = identified(read_identify_request(request));
    CHECK(a["parameters"]["origin"]["F"] == "fitted to the impacts");
    CHECK(
        a["parameters"]["si"]["F"].get<double>() ==
        doctest::Approx(system["F"].get<double>()).epsilon(1e-6));
    CHECK(a["impacts"]["side"] == all["side"]);
    for (const char* name : {"R", "y_dot_before"})
        for (std::size_t i = 2; i < all["x"].size(); i += 17)
            CHECK(
                a["impacts"][name][i].get<double>() ==
                doctest::Approx(whole["impacts"][name][i].get<double>()).epsilon(1e-6));
    CHECK(a["verdict"] == whole["verdict"]);
    CHECK(
        a["exponents"]["qr"]["final"][0].get<double>() ==
        doctest::Approx(whole["exponents"]["qr"]["final"][0].get<double>()).epsilon(1e-5));
    // An answer's impacts are a list.
    Json again = request;
    again["impacts"] = a["impacts"];
    CHECK(
        identified(read_identify_request(again))["exponents"]["qr"]["final"][0].get<double>() ==
        doctest::Approx(a["exponents"]["qr"]["final"][0].get<double>()).epsilon(1e-9));
    Json wrong = request;
    wrong["f"] = 0.97 * system["f"].get<double>();
    const Json off = identified(read_identify_request(wrong));
    CHECK(off["warnings"].dump().find("no forcing at this") != std::string::npos);
    CHECK(off["verdict"] == "not_decided");
}

TEST_CASE("moments in seconds beside a list of impacts are refused: it has its own in tau") {
    for (const char* system : {R"("b":0.015)", R"("preset":"fig20")"}) {
        const Json request = parse_object(
            std::string("{") + system + R"(,"impacts":{"tau":[1,2]},"impact_times_s":[0.1]})");
        CHECK_THROWS_AS(read_identify_request(request), Problem);
    }
}
