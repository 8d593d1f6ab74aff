#include "api/fields.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "core/motion/parameters.hpp"

namespace vines::api {

namespace {

Field number(
    std::string name, std::string group, std::string unit, std::string symbol,
    std::string description, Json fallback, std::string note, double minimum, double maximum) {
    return {
        std::move(name),
        FieldType::number,
        std::move(group),
        std::move(unit),
        std::move(symbol),
        std::move(description),
        std::move(fallback),
        std::move(note),
        minimum,
        maximum,
        {}};
}

/// A number whose range is the core's.
Field core_number(
    const std::string& name, std::string group, std::string unit, std::string symbol,
    std::string description, Json fallback, std::string note = "") {
    for (const ParameterRange& r : parameter_ranges())
        if (r.name == name)
            return number(
                name, std::move(group), std::move(unit), std::move(symbol), std::move(description),
                std::move(fallback), std::move(note), r.minimum, r.maximum);
    throw std::logic_error("no core parameter " + name);
}

Field integer(
    std::string name, std::string description, long fallback, double minimum, double maximum) {
    return {
        std::move(name),
        FieldType::integer,
        "output",
        "",
        "",
        std::move(description),
        fallback,
        "",
        minimum,
        maximum,
        {}};
}

std::vector<Field> make_simulate_fields() {
    const Parameters p;
    const std::string whole = "none: a system in SI is given as a whole, or a preset for the rest";
    const std::string one = "dimensionless", speed = "m per unit of tau";
    const std::string reduced = "from the SI fields if any is given";
    return {
        {"preset",
         FieldType::choice,
         "system",
         "",
         "",
         "start from a figure or table of the paper (GET /v1/presets); each other field replaces "
         "its own value alone",
         // Any name: the reader of the request answers an unknown one with the list.
         nullptr,
         "none",
         {},
         {},
         {}},
        core_number(
            "b", "system", "m", "b", "half-width of the cavity in which the free mass moves", p.b),
        number(
            "R", "system", one, "R",
            "restitution coefficient of both walls; not together with R_plus or R_minus", p.R_plus,
            "", 0, 1),
        core_number(
            "R_plus", "system", one, "R+",
            "restitution coefficient of the wall met where x - y = +b", nullptr, "R"),
        core_number(
            "R_minus", "system", one, "R-",
            "restitution coefficient of the wall met where x - y = -b", nullptr, "R"),
        {"damping",
         FieldType::choice,
         "system",
         "",
         "zeta",
         "equation_of_motion: zeta = epsilon lambda/2, eqs. (1), (6), (17), what c1 means; "
         "closed_form: zeta = epsilon lambda, eqs. (8)-(11), "
         "(19), (20), what the paper's numbers were computed with",
         "equation_of_motion",
         "",
         {},
         {},
         {"equation_of_motion", "closed_form"}},
        core_number("epsilon", "reduced", one, "epsilon", "mass ratio m2/m1", p.epsilon, reduced),
        core_number(
            "lambda", "reduced", one, "lambda", "damping c1/(m2 omega0)", p.lambda, reduced),
        core_number("G", "reduced", "m", "G", "amplitude of the base over epsilon", p.G, reduced),
        core_number(
            "Omega", "reduced", one, "Omega", "forcing frequency over omega0", p.Omega, reduced),
        number(
            "m1", "SI", "kg", "m1",
            "mass of the linear oscillator; SI and reduced fields cannot be mixed", nullptr, whole,
            1e-9, 1e9),
        number(
            "f0", "SI", "Hz", "f0", "its natural frequency sqrt(k1/m1)/(2 pi), in place of k1",
            nullptr, "from k1", 1e-9, 1e9),
        number("k1", "SI", "N/m", "k1", "its stiffness", nullptr, whole, 1e-9, 1e15),
        number(
            "damping_ratio", "SI", one, "c1/(2 m1 omega0)", "its damping ratio, in place of c1",
            nullptr, "from c1", 0, 10),
        number("c1", "SI", "N s/m", "c1", "its damping", nullptr, whole, 0, 1e12),
        number(
            "mass_ratio", "SI", one, "m2/m1", "mass of the absorber over m1, in place of m2",
            nullptr, "from m2", 1e-9, 10),
        number("m2", "SI", "kg", "m2", "mass of the absorber", nullptr, whole, 1e-12, 1e9),
        number(
            "F", "SI", "m", "F", "amplitude of the base, which moves by F sin(2 pi f t)", nullptr,
            whole, 0, 1e3),
        number("f", "SI", "Hz", "f", "forcing frequency", nullptr, whole, 1e-9, 1e9),
        core_number(
            "x0", "start", "m", "x(0)", "displacement of the linear oscillator at tau = 0", 0),
        core_number("x_dot0", "start", speed, "x'(0)", "its velocity", 0),
        number(
            "x_velocity0", "start", "m/s", "dx/dt(0)", "the same in m/s, for a system in SI",
            nullptr, "from x_dot0", -1e9, 1e9),
        core_number(
            "y0", "start", "m", "y(0)", "displacement of the free mass; |x0 - y0| <= b", nullptr,
            "0.95 b"),
        core_number("y_dot0", "start", speed, "y'(0)", "its velocity", 0),
        number(
            "y_velocity0", "start", "m/s", "dy/dt(0)", "the same in m/s, for a system in SI",
            nullptr, "from y_dot0", -1e9, 1e9),
        number(
            "tau_end", "run", one, "tau", "how long to run; not together with cycles", 1709, "",
            1e-6, longest_run),
        number(
            "cycles", "run", one, "", "how many forcing cycles of 2 pi/Omega to run", nullptr,
            "from tau_end", 1e-6, 1e6),
        {"window",
         FieldType::interval,
         "run",
         one,
         "[tau_s, tau_e]",
         "the exponents are taken from the first impact at or after tau_s to the last at or before "
         "tau_e; regime, energy, section, eigenvalues and "
         "manifold are those of the window, too",
         nullptr,
         "the whole run",
         {},
         {},
         {}},
        {"windows",
         FieldType::intervals,
         "run",
         one,
         "[[tau_s, tau_e], ...]",
         "more windows, for which the exponents are given without histories",
         Json::array(),
         "",
         {},
         {},
         {}},
        {"include",
         FieldType::choices,
         "output",
         "",
         "",
         "parts of the answer",
         Json::array({"series", "impacts", "exponents"}),
         "",
         {},
         {},
         {"series", "impacts", "exponents", "eigenvalues", "matrices", "section", "energy",
          "regime", "manifold"}},
        {"exponents",
         FieldType::choices,
         "output",
         "",
         "",
         "estimators of the Lyapunov exponents: qr (Benettin), eigenvalues (33), raw_product "
         "((33) unscaled in double precision, as in the paper)",
         Json::array({"qr", "eigenvalues", "raw_product"}),
         "",
         {},
         {},
         {"qr", "eigenvalues", "raw_product"}},
        number(
            "samples_per_cycle", "output", one, "", "samples of the series per forcing cycle", 32,
            "", 1, 10000),
        number(
            "section_phase", "output", "rad", "",
            "phase of the stroboscopic section after each whole cycle", 0, "", 0,
            6.283185307179586),
        integer(
            "max_points",
            "longest series and histories; a longer series gets a larger step, longer histories "
            "are thinned",
            20000, 256, 1000000),
        integer("max_impacts", "end the run after so many impacts", 100000, 1, 2000000),
    };
}

std::vector<Field> make_manifold_fields() {
    std::vector<Field> fields;
    for (const Field& f : simulate_fields())
        if (f.group == "system" || f.group == "reduced" || f.group == "SI") fields.push_back(f);
    fields.push_back(number(
        "V_max", "output", "m per unit of tau", "V",
        "largest speed of the free mass on the branch beyond the symmetry breaking, which ends "
        "with the motion in any case",
        nullptr, "twice the speed of the symmetry breaking", 1e-12, 1e6));
    fields.push_back(integer("points", "points of each branch", 200, 2, 100000));
    return fields;
}

constexpr std::size_t most_windows = 1000;

std::vector<Field> make_identify_fields() {
    std::vector<Field> fields;
    for (Field f : simulate_fields()) {
        if (f.group != "system" && f.group != "reduced" && f.group != "SI" &&
            f.name != "exponents" && f.name != "max_points")
            continue;
        if (f.name == "F" || f.name == "G") f.description += "; of a record it is fitted";
        if (f.name == "R")
            f.fallback = nullptr, f.fallback_note = "estimated, each wall's from its impacts";
        if (f.name == "m1" || f.name == "k1")
            f.fallback = nullptr,
            f.fallback_note =
                "required for a record, or a preset: they give omega0, by which time is scaled";
        fields.push_back(std::move(f));
    }
    auto column = [](std::string name, std::string description, std::string note) {
        return Field{std::move(name), FieldType::choice, "record", "", "", std::move(description),
                     nullptr,         std::move(note),   {},       {}, {}};
    };
    auto unit = [](std::string name, std::string description, std::vector<std::string> choices) {
        const std::string first = choices[0];
        return Field{std::move(name),
                     FieldType::choice,
                     "record",
                     "",
                     "",
                     std::move(description),
                     first,
                     "",
                     {},
                     {},
                     std::move(choices)};
    };
    fields.push_back(column(
        "time_column", "name of the column of time", "time_s, or one that begins with time or t"));
    fields.push_back(column(
        "displacement_column", "name of the column of displacement",
        "displacement_m, or one that begins with displacement or x"));
    fields.push_back(column(
        "acceleration_column", "name of the column of acceleration",
        "acceleration_m_s2, or one that begins with acceleration or a"));
    fields.push_back(
        unit("time_unit", "unit of time, where the column's name says none", {"s", "ms"}));
    fields.push_back(unit(
        "displacement_unit", "unit of displacement, where the column's name says none",
        {"m", "mm", "um"}));
    fields.push_back(unit(
        "acceleration_unit", "unit of acceleration, where the column's name says none",
        {"m/s2", "g"}));
    fields.push_back(number(
        "threshold", "record", "standard deviations of the noise", "",
        "height from which on a spike of the acceleration is an impact", 6, "", 3, 1000));
    Field times{
        "impact_times_s",
        FieldType::numbers,
        "record",
        "s",
        "",
        "moments of the impacts, from an edited list: then they are not searched for",
        nullptr,
        "found from the spikes",
        {},
        {},
        {}};
    fields.push_back(std::move(times));
    return fields;
}

std::vector<Field> of_groups(const std::vector<std::string>& groups) {
    std::vector<Field> fields;
    for (const Field& f : simulate_fields())
        if (std::find(groups.begin(), groups.end(), f.group) != groups.end() ||
            f.name == "max_impacts")
            fields.push_back(f);
    return fields;
}

Field structured(
    FieldType type, std::string name, std::string description, Json fallback,
    std::string note = "") {
    return {std::move(name), type, "sweep", "", "", std::move(description), std::move(fallback),
            std::move(note), {},   {},      {}};
}

std::vector<Field> make_sweep_fields() {
    const std::string one = "dimensionless";
    Field cycles =
        integer("cycles", "forcing cycles that are measured at each point", 1000, 1, 1e6);
    Field transient = integer("transient_cycles", "forcing cycles run before them", 200, 0, 1e6);
    Field section_points = integer(
        "section_points", "the last so many points of the section are given at each point", 100, 1,
        100000);
    for (Field* f : {&cycles, &transient, &section_points}) f->group = "sweep", f->unit = one;
    Field starts = structured(
        FieldType::objects, "starts",
        "initial states {x0, x_dot0, y0, y_dot0}, each run at every point, to show coexisting "
        "attractors; or \"default set\": at rest in the middle, at a wall, moving, and the "
        "last states of both neighbours on the first axis, of which a line tells the worst and the "
        "best by x_max",
        Json::array(), "");
    starts.choices = {default_set_of_starts};
    return {
        structured(
            FieldType::object, "base",
            "fields of /v1/simulate that all points share: system, reduced or SI, start, preset, "
            "max_impacts",
            Json::object()),
        structured(
            FieldType::objects, "axes",
            "one to three: {parameter, from, to, count, scale} or {parameter, values}; the index "
            "of a point counts along the first axis fastest",
            nullptr, "required"),
        std::move(starts),
        std::move(cycles),
        std::move(transient),
        {"carry_state",
         FieldType::choice,
         "sweep",
         "",
         "",
         "none: each point starts afresh; up, down: from the last state of its neighbour on the "
         "first axis, in ascending or descending order of the axis' entries",
         "none",
         "",
         {},
         {},
         {"none", "up", "down"}},
        {"section",
         FieldType::choice,
         "sweep",
         "",
         "",
         "points for a bifurcation diagram: at impact or at whole forcing cycles",
         "none",
         "",
         {},
         {},
         {"none", "impact", "stroboscopic"}},
        std::move(section_points),
        number(
            "section_phase", "sweep", "rad", "",
            "phase of the stroboscopic section after each whole cycle", 0, "", 0,
            6.283185307179586),
        {"reduce",
         FieldType::choice,
         "sweep",
         "",
         "",
         "\"max over f\": of the points along that axis only the largest x_max and where it is, as "
         "x_peak; or \"min over f\"",
         nullptr,
         "none: a line for each point",
         {},
         {},
         {}},
        structured(
            FieldType::integers, "indices",
            "only these points: those that a broken stream did not bring", nullptr, "all"),
    };
}

std::vector<Field> make_axis_fields() {
    Field count = integer("count", "number of values", 2, 1, 1e6);
    count.group = "axis";
    Field values = structured(
        FieldType::numbers, "values", "the values themselves, in place of from, to, count, scale",
        nullptr, "from, to, count");
    return {
        {"parameter",
         FieldType::choice,
         "axis",
         "",
         "",
         "any number of system, reduced, SI or start",
         nullptr,
         "required",
         {},
         {},
         {}},
        number(
            "from", "axis", "", "", "first value", nullptr, "required without values", -1e300,
            1e300),
        number(
            "to", "axis", "", "", "last value", nullptr, "required without values", -1e300, 1e300),
        std::move(count),
        {"scale",
         FieldType::choice,
         "axis",
         "",
         "",
         "spacing",
         "linear",
         "",
         {},
         {},
         {"linear", "log"}},
        std::move(values),
    };
}

const char* type_name(FieldType type) {
    switch (type) {
        case FieldType::number: return "number";
        case FieldType::integer: return "integer";
        case FieldType::choice: return "choice";
        case FieldType::choices: return "choices";
        case FieldType::interval: return "interval";
        case FieldType::intervals: return "intervals";
        case FieldType::integers: return "integers";
        case FieldType::numbers: return "numbers";
        case FieldType::object: return "object";
        case FieldType::objects: return "objects";
    }
    return "";
}

const Field* find(const std::vector<Field>& fields, const std::string& name) {
    const auto it =
        std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
    return it == fields.end() ? nullptr : &*it;
}

/// Levenshtein distance, without regard to case: what a mistyped name was meant to be.
std::size_t distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = std::tolower(static_cast<unsigned char>(a[i - 1])) ==
                              std::tolower(static_cast<unsigned char>(b[j - 1]));
            const std::size_t next = std::min({row[j] + 1, row[j - 1] + 1, diagonal + !same});
            diagonal = std::exchange(row[j], next);
        }
    }
    return row.back();
}

std::string unknown_field(const std::vector<Field>& fields, const std::string& name) {
    std::string detail = "unknown field";
    if (name.size() > 64) return detail;
    const auto nearest =
        std::min_element(fields.begin(), fields.end(), [&](const Field& a, const Field& b) {
            return distance(name, a.name) < distance(name, b.name);
        });
    if (distance(name, nearest->name) <= std::max<std::size_t>(1, name.size() / 3))
        detail += "; did you mean " + nearest->name + "?";
    return detail;
}

std::string pointer(const std::string& name) {
    std::string escaped(1, '/');
    for (char c : name) {
        if (c == '~') escaped += "~0";
        else if (c == '/') escaped += "~1";
        else escaped += c;
    }
    return escaped;
}

Json range_of(const Field& f) {
    if (f.minimum) return Json::array({*f.minimum, *f.maximum});
    if (!f.choices.empty()) return f.choices;
    return nullptr;
}

std::string list(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
    return text;
}

void check_field(const Field& f, const Json& value, std::vector<FieldError>& errors) {
    auto fault = [&](const std::string& where, const Json& what, const std::string& detail) {
        errors.push_back({pointer(f.name) + where, what, range_of(f), f.name + " " + detail});
    };
    auto range_text = [&] {
        return "must lie in [" + Json(*f.minimum).dump() + ", " + Json(*f.maximum).dump() + "]" +
               (f.unit.empty() || f.unit == "dimensionless" ? "" : " " + f.unit);
    };
    auto check_interval = [&](const std::string& where, const Json& v) {
        if (!v.is_array() || v.size() != 2 || !v[0].is_number() || !v[1].is_number())
            return fault(where, v, "must be two numbers, [from, to]");
        if (!(v[0].get<double>() >= 0)) fault(where + "/0", v[0], "must not begin before 0");
        if (!(v[0].get<double>() < v[1].get<double>()))
            fault(where, v, "must begin before it ends");
    };
    switch (f.type) {
        case FieldType::number:
        case FieldType::integer: {
            if (!value.is_number()) return fault("", value, "must be a number");
            const double v = value.get<double>();
            if (!(v >= *f.minimum && v <= *f.maximum)) return fault("", value, range_text());
            if (f.type == FieldType::integer && v != std::floor(v))
                return fault("", value, "must be a whole number");
            return;
        }
        case FieldType::choice:
            if (!value.is_string()) return fault("", value, "must be a word");
            if (!f.choices.empty() &&
                std::find(f.choices.begin(), f.choices.end(), value.get<std::string>()) ==
                    f.choices.end())
                fault("", value, "must be one of " + list(f.choices));
            return;
        case FieldType::choices:
            if (!value.is_array()) return fault("", value, "must be an array of words");
            for (std::size_t i = 0; i < value.size() && errors.size() < most_errors; ++i)
                if (!value[i].is_string() ||
                    std::find(f.choices.begin(), f.choices.end(), value[i].get<std::string>()) ==
                        f.choices.end())
                    fault(pointer(std::to_string(i)), value[i], "may hold " + list(f.choices));
            return;
        case FieldType::interval: return check_interval("", value);
        case FieldType::intervals:
            if (!value.is_array())
                return fault("", value, "must be an array of intervals, [[from, to], ...]");
            if (value.size() > most_windows)
                return fault(
                    "", value.size(), "may hold " + std::to_string(most_windows) + " intervals");
            for (std::size_t i = 0; i < value.size() && errors.size() < most_errors; ++i)
                check_interval(pointer(std::to_string(i)), value[i]);
            return;
        case FieldType::integers:
            if (!value.is_array()) return fault("", value, "must be an array of whole numbers");
            for (std::size_t i = 0; i < value.size() && errors.size() < most_errors; ++i)
                if (!value[i].is_number_integer() || value[i] < 0)
                    fault(
                        pointer(std::to_string(i)), value[i], "must hold whole numbers from 0 on");
            return;
        case FieldType::numbers:
            if (!value.is_array()) return fault("", value, "must be an array of numbers");
            for (std::size_t i = 0; i < value.size() && errors.size() < most_errors; ++i)
                if (!value[i].is_number())
                    fault(pointer(std::to_string(i)), value[i], "must hold numbers");
            return;
        case FieldType::object:
            if (!value.is_object()) fault("", value, "must be an object");
            return;
        case FieldType::objects: {
            const bool named =
                value.is_string() &&
                std::find(f.choices.begin(), f.choices.end(), value.get<std::string>()) !=
                    f.choices.end();
            if (!value.is_array() && !named)
                fault(
                    "", value,
                    "must be an array" +
                        (f.choices.empty() ? "" : " or \"" + list(f.choices) + "\""));
            return;
        }
    }
}

Json describe(const std::vector<Field>& fields) {
    Json list = Json::array();
    for (const Field& f : fields) {
        Json entry = {{"name", f.name},       {"type", type_name(f.type)},
                      {"group", f.group},     {"unit", f.unit},
                      {"symbol", f.symbol},   {"description", f.description},
                      {"default", f.fallback}};
        if (!f.fallback_note.empty()) entry["default_note"] = f.fallback_note;
        if (f.minimum) entry["minimum"] = *f.minimum, entry["maximum"] = *f.maximum;
        if (!f.choices.empty()) entry["choices"] = f.choices;
        list.push_back(std::move(entry));
    }
    return list;
}

/// What the symbols are: eq. (1) of the paper, in SI and reduced.
Json describe_model() {
    return {
        {"equations",
         {"m1 x'' + c1 x' + k1 x = k1 F sin(2 pi f t) + 2 pi f c1 F cos(2 pi f t), m2 y'' = 0 "
          "while |x - y| < b, derivatives in t (s)",
          "x'' + 2 zeta x' + x = epsilon G sin(Omega tau) + epsilon^2 lambda G Omega cos(Omega "
          "tau), y'' = 0 while |x - y| < b, derivatives in tau = omega0 t",
          "at |x - y| = b: x' + epsilon y' is kept, x' - y' is reversed and shrunk by R"}},
        {"symbols",
         {{"x",
           "displacement of the linear oscillator (mass m1) from rest, absolute: that of an "
           "observer who does not move with the base"},
          {"y",
           "displacement of the free mass m2, absolute, from where x - y = 0 in the middle of its "
           "cavity"},
          {"F",
           "amplitude of the base in m: it moves by F sin(2 pi f t) and carries spring k1 and "
           "damper c1; F = epsilon G"},
          {"b",
           "half-width of the cavity: its free length is 2 b and the diameter of the ball, with "
           "walls where x - y = b (side 1) and x - y = -b (side -1)"},
          {"omega0", "sqrt(k1/m1), rad/s"},
          {"epsilon", "m2/m1"},
          {"lambda", "c1/(m2 omega0)"},
          {"Omega", "2 pi f/omega0"},
          {"G", "F/epsilon, m"},
          {"zeta",
           "epsilon lambda/2 = c1/(2 m1 omega0) with damping equation_of_motion, twice that with "
           "closed_form"}}},
        {"sketch", "system.svg"}};
}

/// The number that the whole of a text stands for, or the text.
Json number_or_text(const std::string& text) {
    double value;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return text;
    return value;
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t from = 0, at; !text.empty(); from = at + 1) {
        at = text.find(separator, from);
        parts.push_back(text.substr(from, at - from));
        if (at == std::string::npos) break;
    }
    return parts;
}

/// The value that a query's text stands for, by the type of its field.
Json from_text(FieldType type, const std::string& text) {
    Json array = Json::array();
    switch (type) {
        case FieldType::number:
        case FieldType::integer: return number_or_text(text);
        case FieldType::choice: return text;
        case FieldType::choices:
            for (const std::string& part : split(text, ',')) array.push_back(part);
            return array;
        case FieldType::interval:
            for (const std::string& part : split(text, ',')) array.push_back(number_or_text(part));
            return array;
        case FieldType::intervals:
            for (const std::string& part : split(text, ';'))
                array.push_back(from_text(FieldType::interval, part));
            return array;
        case FieldType::numbers:
            for (const std::string& part : split(text, ',')) array.push_back(number_or_text(part));
            return array;
        case FieldType::integers:
        case FieldType::object:
        case FieldType::objects: return text;  // of routes that take no query
    }
    return nullptr;
}

}  // namespace

const std::vector<Field>& simulate_fields() {
    static const std::vector<Field> fields = make_simulate_fields();
    return fields;
}

const std::vector<Field>& sweep_fields() {
    static const std::vector<Field> fields = make_sweep_fields();
    return fields;
}

const std::vector<Field>& sweep_base_fields() {
    static const std::vector<Field> fields = of_groups({"system", "reduced", "SI", "start"});
    return fields;
}

const std::vector<Field>& axis_fields() {
    static const std::vector<Field> fields = make_axis_fields();
    return fields;
}

const std::vector<Field>& start_fields() {
    static const std::vector<Field> fields = [] {
        std::vector<Field> list = of_groups({"start"});
        std::erase_if(list, [](const Field& f) { return f.name == "max_impacts"; });
        return list;
    }();
    return fields;
}

const std::vector<Field>& identify_fields() {
    static const std::vector<Field> fields = make_identify_fields();
    return fields;
}

const std::vector<Field>& manifold_fields() {
    static const std::vector<Field> fields = make_manifold_fields();
    return fields;
}

Json describe_fields() {
    return {
        {"model", describe_model()},
        {"fields", describe(simulate_fields())},
        {"manifold_fields", describe(manifold_fields())},
        {"sweep_fields", describe(sweep_fields())},
        {"axis_fields", describe(axis_fields())},
        {"identify_fields", describe(identify_fields())}};
}

Json from_query(
    const std::vector<Field>& fields,
    const std::vector<std::pair<std::string, std::string>>& query) {
    Json object = Json::object();
    for (const auto& [name, text] : query) {
        if (object.contains(name))
            throw Problem(400, "the name \"" + name + "\" comes twice in the query");
        const Field* f = find(fields, name);
        object[name] = f ? from_text(f->type, text) : Json(text);
    }
    return object;
}

std::vector<FieldError> check(const std::vector<Field>& fields, const Json& object) {
    std::vector<FieldError> errors;
    for (const auto& [name, value] : object.items()) {
        if (errors.size() >= most_errors) break;
        if (const Field* f = find(fields, name)) check_field(*f, value, errors);
        else errors.push_back({pointer(name), value, nullptr, unknown_field(fields, name)});
    }
    return errors;
}

}  // namespace vines::api
