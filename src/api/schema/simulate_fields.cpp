// The tables of /v1/simulate, of /v1/manifold, and of the response's format.
//
// The rows of /v1/simulate are grouped as a form shows them; the other routes select rows from them
// (simulate_fields_where). Ranges of physical quantities are those of
// the core (parameter_ranges), defaults are Table 1 of the paper.
#include <algorithm>
#include <iterator>
#include <numbers>
#include <stdexcept>

#include "api/schema/enum_names.hpp"
#include "api/schema/tables.hpp"
#include "core/motion/parameters.hpp"

namespace vines::api {

namespace {

/// The range of the core's parameter or initial state of this name.
Range core_range(const std::string& name) {
    for (const ParameterRange& r : parameter_ranges())
        if (r.name == name) return {r.minimum, r.maximum};
    throw std::logic_error("no core parameter " + name);
}

// Wider than any real system: these ranges only prevent overflow and division by zero. The core
// checks the reduced parameters that result.
constexpr Range any_mass{1e-9, 1e9}, any_absorber_mass{1e-12, 1e9}, any_frequency{1e-9, 1e9},
    any_stiffness{1e-9, 1e15}, any_damping{0, 1e12}, any_amplitude{0, 1e3},
    any_acceleration{0, 1e9}, any_velocity{-1e9, 1e9};

const char* const whole = "none: give all SI fields, or a preset for the rest";
const char* const from_si = "from the SI fields if any is given";
const char* const speed = "m per unit of tau";

/// A number; its range is that of the core's parameter or initial state of this name, unless given.
Field number(
    const char* name, const char* unit, const char* symbol, const char* description, Json fallback,
    const char* fallback_note = "", std::optional<Range> range = {}) {
    return {
        .name = name,
        .unit = unit,
        .symbol = symbol,
        .description = description,
        .fallback = std::move(fallback),
        .fallback_note = fallback_note,
        .range = range ? range : core_range(name)};
}

FieldTable system_rows() {
    const Parameters table_1;  // the defaults
    return {
        // The reader of the request reports an unknown preset with the list of presets.
        choice(
            "preset",
            "figure or table of the paper (GET /v1/presets); each other field that is given "
            "replaces one value of the preset",
            {}, nullptr, "none"),
        number(
            "b", "m", "b", "clearance: half-width of the cavity in which the ball moves",
            table_1.b),
        number(
            "R", dimensionless, "R",
            "restitution coefficient of both walls; not together with R_plus or R_minus",
            table_1.R_plus, "", core_range("R_plus")),
        number(
            "R_plus", dimensionless, "R+", "restitution coefficient of the wall at x - y = +b",
            nullptr, "R"),
        number(
            "R_minus", dimensionless, "R-", "restitution coefficient of the wall at x - y = -b",
            nullptr, "R"),
        {.name = "damping",
         .type = FieldType::choice,
         .symbol = "zeta",
         .description = "equation_of_motion: zeta = epsilon lambda/2, eqs. (1), (6), (17), the "
                        "physical damper c1; closed_form: zeta = epsilon lambda, eqs. (8)-(11), "
                        "(19), (20), used for the numbers in the paper",
         .fallback = enum_json(table_1.damping),
         .choices = enum_choices<Damping>()},
    };
}

FieldTable reduced_rows() {
    const Parameters table_1;  // the defaults
    return {
        number("epsilon", dimensionless, "epsilon", "mass ratio m2/m1", table_1.epsilon, from_si),
        number(
            "lambda", dimensionless, "lambda", "damping c1/(m2 omega0)", table_1.lambda, from_si),
        number("G", "m", "G", "amplitude of the base over epsilon", table_1.G, from_si),
        number(
            "Omega", dimensionless, "Omega", "forcing frequency over omega0", table_1.Omega,
            from_si),
    };
}

// NOLINTNEXTLINE(readability-function-size): a table
FieldTable si_rows() {
    return {
        number(
            "m1", "kg", "m1",
            "mass of the linear oscillator; SI and reduced fields exclude each other", nullptr,
            whole, any_mass),
        number(
            "f0", "Hz", "f0",
            "natural frequency of the oscillator, sqrt(k1/m1)/(2 pi), instead of k1", nullptr,
            "from k1", any_frequency),
        number("k1", "N/m", "k1", "stiffness of the oscillator", nullptr, whole, any_stiffness),
        number(
            "damping_ratio", dimensionless, "c1/(2 m1 omega0)",
            "damping ratio of the oscillator, instead of c1", nullptr, "from c1", Range{0, 10}),
        number("c1", "N s/m", "c1", "damping of the oscillator", nullptr, whole, any_damping),
        number(
            "mass_ratio", dimensionless, "m2/m1", "mass ratio m2/m1, instead of m2", nullptr,
            "from m2", core_range("epsilon")),
        number("m2", "kg", "m2", "mass of the ball", nullptr, whole, any_absorber_mass),
        number(
            "F", "m", "F", "amplitude of the base, which moves by F sin(2 pi f t)", nullptr, whole,
            any_amplitude),
        number(
            "acceleration", "m/s^2", "", "amplitude of the base's acceleration, instead of F",
            nullptr, "from F", any_acceleration),
        number("f", "Hz", "f", "forcing frequency", nullptr, whole, any_frequency),
    };
}

/// Laws of the ball and of the walls beyond the paper.
FieldTable law_rows() {
    const auto table = [](const char* name, const char* description) {
        const auto list = [](const char* column, const char* unit, const char* text) {
            return Field{
                .name = column, .type = FieldType::numbers, .unit = unit, .description = text};
        };
        return Field{
            .name = name,
            .type = FieldType::object,
            .symbol = "R(w)",
            .description = description,
            .fallback_note = "none: a constant R",
            .fields = {
                list("speed", speed, "speeds |x' - y'| before the impact, ascending"),
                list("speed_m_s", "m/s", "the same in m/s, for a system in SI"),
                list("R", dimensionless, "restitution coefficient at each speed")}};
    };
    return {
        number(
            "gravity", "m", "g'",
            "acceleration of the free ball along its track, g sin(inclination)/omega0^2, positive "
            "along +x; x is measured from the oscillator's rest without ball",
            0),
        number(
            "inclination", "rad", "",
            "inclination of the track, for a system in SI; pi/2: the ball falls along +x", nullptr,
            "from gravity", Range{-std::numbers::pi / 2, std::numbers::pi / 2}),
        number(
            "friction", "m", "f'",
            "deceleration of the sliding ball, mu g cos(inclination)/omega0^2", 0),
        number(
            "mu", dimensionless, "mu", "friction coefficient of the ball, for a system in SI",
            nullptr, "from friction", Range{0, 100}),
        table(
            "restitution",
            "R of both walls as a function of the speed: {speed or speed_m_s, R}, linear between "
            "the points, constant outside; instead of R"),
        table("restitution_plus", "the same for the wall at x - y = +b"),
        table("restitution_minus", "the same for the wall at x - y = -b"),
    };
}

// NOLINTNEXTLINE(readability-function-size): a table
FieldTable load_rows() {
    // With a range: a number for a formula.
    const auto list = [](const char* name, const char* unit, const char* description,
                         std::optional<Range> range = {}) {
        return Field{
            .name = name,
            .type = FieldType::numbers,
            .unit = unit,
            .description = description,
            .fallback_note = "none",
            .range = range};
    };
    const auto frequency = [](const char* name, const char* description) {
        return number(name, "Hz", "", description, nullptr, "none", any_frequency);
    };
    constexpr Range any{-1e9, 1e9};
    const FieldTable rows = {
        choice(
            "kind",
            "half_sine, of half a period: acceleration_m_s2, displacement_m or force_N as a "
            "number, and duration_s; chirp: the same, f_from, f_to, rate, phase; noise of an "
            "acceleration, normally distributed: rms_m_s2, f_low, f_high, duration_s, seed; "
            "harmonics, the sum of F sin(2 pi f t + phase): f, F, phase",
            {"half_sine", "chirp", "noise", "harmonics"}, nullptr, "none: a record"),
        list("time_s", "s", "ascending times; the first one is tau = 0"),
        list(
            "acceleration_m_s2", "m/s^2",
            "acceleration of the base, which starts at rest: at each time, or the amplitude", any),
        list(
            "displacement_m", "m", "displacement of the base: at each time, or the amplitude", any),
        list("force_N", "N", "force on m1: at each time, or the amplitude", any),
        number(
            "duration_s", "s", "", "duration of half_sine, chirp or noise", nullptr, "none",
            Range{1e-9, 1e9}),
        frequency("f_from", "frequency at the beginning of a chirp"),
        frequency("f_to", "frequency at its end"),
        choice("rate", "growth of the frequency of a chirp", {"linear", "logarithmic"}, "linear"),
        list(
            "phase", "rad", "phase of a chirp at its beginning, or of each of harmonics",
            Range{-1e3, 1e3}),
        number(
            "rms_m_s2", "m/s^2", "", "root mean square of noise", nullptr, "none", Range{0, 1e9}),
        frequency("f_low", "lowest frequency of noise"),
        frequency("f_high", "highest frequency of noise"),
        integer("seed", "seed of noise, the same on every computer", {0, 9007199254740992}, 1),
        list("f", "Hz", "frequencies of harmonics"),
        list("F", "m", "amplitudes of the base at these frequencies"),
    };
    return {
        {.name = "forcing",
         .type = FieldType::object,
         .description = "load instead of F and f, for a system in SI: a record, time_s and one of "
                        "acceleration_m_s2, displacement_m and force_N, linear between the "
                        "samples; or a formula, kind",
         .fallback_note = "none: F and f",
         .fields = rows}};
}

FieldTable start_rows() {
    return {
        number("x0", "m", "x(0)", "displacement of the linear oscillator at tau = 0", 0),
        number("x_dot0", speed, "x'(0)", "velocity of the linear oscillator at tau = 0", 0),
        number(
            "x_velocity0", "m/s", "dx/dt(0)", "x_dot0 in m/s, for a system in SI", nullptr,
            "from x_dot0", any_velocity),
        number(
            "y0", "m", "y(0)", "displacement of the ball at tau = 0; |x0 - y0| <= b", nullptr,
            "x0 + 0.95 b"),
        number("y_dot0", speed, "y'(0)", "velocity of the ball at tau = 0", 0),
        number(
            "y_velocity0", "m/s", "dy/dt(0)", "y_dot0 in m/s, for a system in SI", nullptr,
            "from y_dot0", any_velocity),
    };
}

FieldTable perturbation_rows() {
    const auto component = [](const char* name, const char* unit, const std::string& of_start) {
        const std::string description = "difference added to " + of_start;
        return number(name, unit, "", description.c_str(), 0, "", core_range(of_start));
    };
    return {
        component("x", "m", "x0"),
        component("x_dot", speed, "x_dot0"),
        component("y", "m", "y0"),
        component("y_dot", speed, "y_dot0"),
        integer(
            "seed",
            "seed of a random direction in (x', x, y', y), the same on every computer; only with "
            "size",
            {0, 9007199254740992}, 1),  // 2^53: doubles hold every whole number up to it
        number(
            "size", "", "", "Euclidean length of the random difference", nullptr, "none",
            Range{1e-18, 1e3}),
    };
}

FieldTable run_rows() {
    return {
        number(
            "tau_end", dimensionless, "tau", "length of the run; not together with cycles",
            1709,  // beyond the end of the first window of Table 2
            "", Range{1e-6, longest_run}),
        number(
            "cycles", dimensionless, "", "length of the run in forcing cycles of 2 pi/Omega",
            nullptr, "from tau_end", Range{1e-6, 1e6}),
        {.name = "window",
         .type = FieldType::interval,
         .unit = dimensionless,
         .symbol = "[tau_s, tau_e]",
         .description =
             "interval for exponents, regime, energy, section, eigenvalues, matrices and "
             "manifold; the exponents refer to the part from its first to its last impact",
         .fallback_note = "the whole run"},
        {.name = "windows",
         .type = FieldType::intervals,
         .unit = dimensionless,
         .symbol = "[[tau_s, tau_e], ...]",
         .description = "additional windows for the exponents, without histories",
         .fallback = Json::array()},
        {.name = "perturbation",
         .type = FieldType::object,
         .description =
             "second run with a slightly different start, and its distance from the first "
             "run; the difference of the starts is {x, x_dot, y, y_dot}, or a random "
             "one by {seed, size}",
         .fallback_note = "none",
         .fields = perturbation_rows()},
    };
}

FieldTable output_rows() {
    const std::vector<std::string> estimators = {"qr", "eigenvalues", "raw_product"};
    return {
        {.name = "include",
         .type = FieldType::choices,
         .description = "parts of the response",
         .fallback = Json::array({"series", "impacts", "exponents"}),
         .choices =
             {"series", "impacts", "exponents", "eigenvalues", "matrices", "section", "energy",
              "regime", "manifold"}},
        {.name = "exponents",
         .type = FieldType::choices,
         .description = "estimators of the Lyapunov exponents: qr (Benettin), eigenvalues (33), "
                        "raw_product ((33) unscaled in double precision, as in the paper)",
         .fallback = estimators,
         .choices = estimators},
        integer(
            "settle_cycles",
            "with regime: further cycles, at most, for which a chaotic run is continued to find "
            "out whether a periodic orbit captures it",
            {0, 1e6}, 0, dimensionless),
        number(
            "samples_per_cycle", dimensionless, "", "samples of the series per forcing cycle", 32,
            "", Range{1, 10000}),
        section_phase_row(),
        integer(
            "max_points",
            "maximum length of series and histories; longer series get a larger step, longer "
            "histories are thinned",
            {256, 1000000}, 20000),
        integer("max_impacts", "number of impacts after which the run ends", {1, 2000000}, 100000),
    };
}

FieldTable manifold_rows() {
    return {
        number(
            "V_max", speed, "V",
            "largest speed of the ball on the branch beyond the symmetry breaking; the branch ends "
            "earlier if the motion does",
            nullptr, "twice the speed at the symmetry breaking", Range{1e-12, 1e6}),
        integer("points", "points on each branch", {2, 100000}, 200)};
}

FieldTable form_rows() {
    return {
        choice(
            "format",
            "format of the response: json; csv: one table; cbor: with typed arrays (RFC 8746); "
            "npz: arrays for numpy.load",
            {"json", "csv", "cbor", "npz"}, nullptr,
            "the format that the header Accept requests, otherwise json"),
        {.name = "fields",
         .type = FieldType::choices,
         .description =
             "keys to keep in the response: names, or paths with dots as in impacts.tau; "
             "version, status, warnings and provenance are always kept. Other keys are "
             "not computed, unless include requests them",
         .fallback_note = "everything"}};
}

}  // namespace

Field section_phase_row() {
    return number(
        "section_phase", "rad", "",
        "value of Omega tau, modulo 2 pi, at which the stroboscopic section samples the state", 0,
        "", Range{0, 2 * std::numbers::pi});
}

const FieldTable& simulate_fields() {
    static const FieldTable table = grouped("system", system_rows()) +
                                    grouped("reduced", reduced_rows()) + grouped("SI", si_rows()) +
                                    grouped("laws", law_rows()) + grouped("load", load_rows()) +
                                    grouped("start", start_rows()) + grouped("run", run_rows()) +
                                    grouped("output", output_rows());
    return table;
}

const FieldTable& manifold_fields() {
    static const FieldTable table =
        simulate_fields_where(is_of_system) + grouped("output", manifold_rows());
    return table;
}

const FieldTable& form_fields() {
    static const FieldTable table = grouped("answer", form_rows());
    return table;
}

bool is_of_system(const Field& f) {
    return f.group == "system" || f.group == "reduced" || f.group == "SI";
}

FieldTable simulate_fields_where(bool (*keep)(const Field&)) {
    FieldTable table;
    std::copy_if(
        simulate_fields().begin(), simulate_fields().end(), std::back_inserter(table), keep);
    return table;
}

}  // namespace vines::api
