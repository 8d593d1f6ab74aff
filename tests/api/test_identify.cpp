// Requests and answers of /v1/identify.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <sstream>

#include "api/csv.hpp"
#include "api/identify.hpp"
#include "core/measurement/synthetic_record.hpp"
#include "record_support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

TEST_CASE("a reduced field over a preset keeps the oscillator that a record needs") {
    // A record in seconds needs omega0, which reduced fields do not determine.
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

TEST_CASE("the warning about a clipped channel gives the extreme in the unit of the record") {
    std::string csv = header;
    for (int k = 0; k < 200; ++k)
        csv += std::to_string(0.001 * k) + "," + std::to_string(1e-5 * k) + "," +
               std::to_string(std::min(12.5, 20 * std::sin(0.1 * k))) + "\n";
    const std::vector<std::string> notes =
        read_identify_request({{"preset", "fig15"}}, csv).system.notes;
    CHECK(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
        return note.starts_with("the acceleration reaches its extreme 12.5 m/s^2 exactly ");
    }));
}

TEST_CASE(
    "a record as CSV or JSON gives the impacts, the restitution and the exponents of the motion") {
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
    // The paper's direct estimate agrees with more scatter.
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
    // Other names, separators and units give the same record.
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

TEST_CASE(
    "laws of the ball are fitted to a record without friction: none, with their errors" *
    doctest::test_suite("long")) {
    const std::string csv = measured("fig15", 12);
    const Json a = identified(read_identify_request({{"preset", "fig15"}, {"fit", {"mu"}}}, csv)),
               &laws = a["laws"];
    CHECK(
        std::abs(laws["mu"]["value"].get<double>()) <
        4 * laws["mu"]["standard_error"].get<double>());
    CHECK(laws["mu"]["standard_error"].get<double>() < 0.02);
    CHECK(laws["R_slope"]["fixed"] == true);
    CHECK(laws["R_slope"]["standard_error"].is_null());
    CHECK(laws["chi_square_decrease"].get<double>() < 20);
    CHECK(!identified(read_identify_request({{"preset", "fig15"}}, csv)).contains("laws"));
    const Json table = {
        {"preset", "fig15"},
        {"fit", {"R_of_speed"}},
        {"restitution", {{"speed_m_s", {0, 1}}, {"R", {0.9, 0.8}}}}};
    CHECK_THROWS_AS(read_identify_request(table, csv), Problem);
}

TEST_CASE("the fitted motion is given at the record's samples if included") {
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
        // The acceleration outside the pulses.
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

TEST_CASE("the direct estimate has exponents with histories if included") {
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
    // All other parts are unchanged.
    a["direct"].erase("exponents");
    CHECK(a == identified(read_identify_request(fields, csv)));
}

TEST_CASE("fixed amplitude and phase of the forcing are not fitted" * doctest::test_suite("long")) {
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
    CHECK(contains(p.what(), "phase is fixed, but neither given"));
}

TEST_CASE("an edited list of impact times is used unchanged") {
    const std::string csv = measured("fig15", 6);
    const Json a = identified(read_identify_request({{"preset", "fig15"}}, csv));
    CHECK(a["verdict"] == "not_decided");  // a chaotic motion can look like this for 6 s
    std::vector<double> times = a["impacts"]["time_s"];
    const Json same =
        identified(read_identify_request({{"preset", "fig15"}, {"impact_times_s", times}}, csv));
    CHECK(same["impacts"]["tau"].size() == times.size());
    CHECK(same["impacts"]["side"] == a["impacts"]["side"]);
    times.erase(times.begin() + 30);
    const Json without =
        identified(read_identify_request({{"preset", "fig15"}, {"impact_times_s", times}}, csv));
    CHECK(without["impacts"]["tau"].size() == times.size());
    CHECK(contains(without["impacts"]["status"][30], "missing"));
    CHECK(contains(without["warnings"].dump(), "inconsistent"));
}

TEST_CASE("errors of a record are named with line and column") {
    const std::string csv = measured("fig15", 3);
    const Json fields = {{"preset", "fig15"}};
    auto detail = [&](const std::string& text) {
        return std::string(refused(fields, text).what());
    };
    CHECK(
        detail(replaced_line(csv, 7, "0.003,abc,1")) ==
        "line 7, column displacement_m: \"abc\" is not a number");
    CHECK(
        detail(replaced_line(csv, 7, "0.003,nan,1")) ==
        "line 7, column displacement_m: the number is not finite");
    CHECK(detail(replaced_line(csv, 7, "0.003,1")) == "line 7: has 2 columns, the header has 3");
    CHECK(
        detail(replaced_line(csv, 7, "0.003,,1")) ==
        "line 7, column displacement_m: a number is missing");
    CHECK(detail(replaced_line(csv, 7, ",1,1")) == "line 7, column time_s: a number is missing");
    CHECK(
        detail(replaced_line(csv, 7, "0.0001,1e-3,1"))
            .find("line 7, column of time: time must increase") == 0);
    CHECK(
        detail(csv.substr(header.size()))
            .find("line 1: a line above the numbers must name the columns") == 0);
    CHECK(
        detail("time_s,displacement 1_mm,displacement 2_mm\n0,1,2\n")
            .find("several columns can be the displacement: choose one by displacement_column") ==
        0);
    CHECK(detail("") == "the record is empty: it needs a header and lines of numbers");
    CHECK(contains(detail(header + "0,0,0\n1,0,0\n"), "at least 100"));
    CHECK(contains(
        detail("time_s,temperature\n0,1\n"), "neither a displacement nor an acceleration"));
    CHECK(contains(detail("speed,x\n0,1\n"), "no column time_s"));
    CHECK(
        refused({{"preset", "fig15"}, {"displacement_column", "weg"}}, csv).errors[0].pointer ==
        "/displacement_column");
    CHECK(refused({{"b", 0.009}}, csv).errors[0].pointer == "/m1");
    CHECK(refused({{"preset", "fig15"}, {"tau_end", 3}}, csv).errors[0].pointer == "/tau_end");
}

TEST_CASE("a record that consists of a gap is refused") {
    std::string sparse = header;
    for (int k = 0; k < 200; ++k)
        sparse += fmt::format("{:.3f},{},{}\n", k * 1e-3 + (k < 100 ? 0 : 1e8), k % 3, k % 7);
    const Problem problem = refused({{"preset", "fig15"}}, sparse);
    CHECK(problem.errors[0].pointer == "/record/time_s");
    CHECK(contains(problem.what(), "spans 1e+08 s, of which 0.2 s have samples"));
}

TEST_CASE(
    "a record without impacts, clipping, gaps, slow sampling and a wrong b cause warnings" *
    doctest::test_suite("long")) {
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
            .find("no impacts found in the record") == 0);

    const std::string csv = measured("fig15", 6);
    auto warnings = [&](const Json& fields, const std::string& text) {
        return identified(read_identify_request(fields, text))["warnings"].dump();
    };
    CHECK(warnings({{"preset", "fig15"}}, csv) == "[]");
    CHECK(contains(warnings({{"preset", "fig15"}, {"b", 0.011}}, csv), "momentum fits b = 0.0089"));
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
    CHECK(contains(warnings({{"preset", "fig15"}}, gap), "1 gap(s)"));
    CHECK(contains(warnings({{"preset", "fig15"}}, clipped), "clipped"));
    CHECK(contains(warnings({{"preset", "fig15"}}, slow), "ms apart"));
}

TEST_CASE(
    "a wrong frequency is corrected with a warning; if fixed, the record is unexplained and there "
    "is no verdict" *
    doctest::test_suite("long")) {
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
        CAPTURE(found["warnings"].dump());
        CHECK(fitted["value"].get<double>() == doctest::Approx(f).epsilon(5e-6));
        CHECK(fitted["standard_error"].get<double>() < 5e-6 * f);
        CHECK(found["parameters"]["si"]["f"] == doctest::Approx(f).epsilon(1e-4));
        CHECK(found["parameters"]["origin"]["f"] == "fitted to the record");
        CHECK(contains(found["warnings"].dump(), "the forcing has f = 8.349"));
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
        CHECK(contains(
            a["warnings"].dump(),
            "no verdict: " + a["verdict_reason"].get<std::string>().substr(0, 20)));
        if (!a["b_fitted"]["b"].is_null()) CHECK(a["b_fitted"]["b"].get<double>() > 0.004);
        else CHECK(contains(a["warnings"].dump(), "no b is fitted to the impacts' momentum: "));
        CHECK_FALSE(contains(a["warnings"].dump(), "fits b = -"));
        // The pulse is well resolved.
        CHECK_FALSE(contains(a["warnings"].dump(), "sample at"));
    }
}

TEST_CASE("a b that contradicts the impacts is replaced by the fitted one, with a warning") {
    const Json a = identified(
        read_identify_request({{"preset", "fig15"}, {"b", 0.011}}, measured("fig15", 12)));
    const Json& fitted = a["fitted"]["b"];
    CHECK(fitted["value"].get<double>() == doctest::Approx(0.009).epsilon(0.005));
    CHECK(fitted["standard_error"].get<double>() < 5e-5);
    CHECK(fitted["fixed"] == false);
    CHECK(a["b_fitted"]["b"] == fitted["value"]);
    CHECK(a["parameters"]["b"] == fitted["value"]);
    CHECK(a["parameters"]["origin"]["b"] == "fitted to the record");
    CHECK(contains(a["warnings"].dump(), "which is used instead of b = 0.011 m"));
    CHECK(a["verdict"] == "regular");
    for (const char* wall : {"plus", "minus"})
        CHECK(a["restitution"][wall]["R"] == a["fitted"][std::string("R_") + wall]["value"]);
}
