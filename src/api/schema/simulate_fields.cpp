// The tables of /v1/simulate, of /v1/manifold, and of the response's format.
//
// The rows of /v1/simulate are grouped as a form shows them; the other routes select rows from them
// (is_of_system, sweep_base_fields, identify_fields). Ranges of physical quantities are those of
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
    any_stiffness{1e-9, 1e15}, any_damping{0, 1e12}, any_amplitude{0, 1e3}, any_velocity{-1e9, 1e9};

const char* const whole = "none: give all SI fields, or a preset for the rest";
const char* const from_si = "from the SI fields if any is given";
const char* const speed = "m per unit of tau";

FieldTable system_rows() {
    const Parameters table_1;  // the defaults
    return {
        {.name = "preset",
         // Any string: the reader of the request reports an unknown preset with the list of
         // presets.
         .type = FieldType::choice,
         .group = "system",
         .description = "figure or table of the paper (GET /v1/presets); each other field that is "
                        "given replaces one value of the preset",
         .fallback_note = "none"},
        {.name = "b",
         .group = "system",
         .unit = "m",
         .symbol = "b",
         .description = "clearance: half-width of the cavity in which the ball moves",
         .fallback = table_1.b,
         .range = core_range("b")},
        {.name = "R",
         .group = "system",
         .unit = dimensionless,
         .symbol = "R",
         .description =
             "restitution coefficient of both walls; not together with R_plus or R_minus",
         .fallback = table_1.R_plus,
         .range = core_range("R_plus")},
        {.name = "R_plus",
         .group = "system",
         .unit = dimensionless,
         .symbol = "R+",
         .description = "restitution coefficient of the wall at x - y = +b",
         .fallback_note = "R",
         .range = core_range("R_plus")},
        {.name = "R_minus",
         .group = "system",
         .unit = dimensionless,
         .symbol = "R-",
         .description = "restitution coefficient of the wall at x - y = -b",
         .fallback_note = "R",
         .range = core_range("R_minus")},
        {.name = "damping",
         .type = FieldType::choice,
         .group = "system",
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
        {.name = "epsilon",
         .group = "reduced",
         .unit = dimensionless,
         .symbol = "epsilon",
         .description = "mass ratio m2/m1",
         .fallback = table_1.epsilon,
         .fallback_note = from_si,
         .range = core_range("epsilon")},
        {.name = "lambda",
         .group = "reduced",
         .unit = dimensionless,
         .symbol = "lambda",
         .description = "damping c1/(m2 omega0)",
         .fallback = table_1.lambda,
         .fallback_note = from_si,
         .range = core_range("lambda")},
        {.name = "G",
         .group = "reduced",
         .unit = "m",
         .symbol = "G",
         .description = "amplitude of the base over epsilon",
         .fallback = table_1.G,
         .fallback_note = from_si,
         .range = core_range("G")},
        {.name = "Omega",
         .group = "reduced",
         .unit = dimensionless,
         .symbol = "Omega",
         .description = "forcing frequency over omega0",
         .fallback = table_1.Omega,
         .fallback_note = from_si,
         .range = core_range("Omega")},
    };
}

// NOLINTNEXTLINE(readability-function-size): a table
FieldTable si_rows() {
    return {
        {.name = "m1",
         .group = "SI",
         .unit = "kg",
         .symbol = "m1",
         .description = "mass of the linear oscillator; SI and reduced fields exclude each other",
         .fallback_note = whole,
         .range = any_mass},
        {.name = "f0",
         .group = "SI",
         .unit = "Hz",
         .symbol = "f0",
         .description = "natural frequency of the oscillator, sqrt(k1/m1)/(2 pi), instead of k1",
         .fallback_note = "from k1",
         .range = any_frequency},
        {.name = "k1",
         .group = "SI",
         .unit = "N/m",
         .symbol = "k1",
         .description = "stiffness of the oscillator",
         .fallback_note = whole,
         .range = any_stiffness},
        {.name = "damping_ratio",
         .group = "SI",
         .unit = dimensionless,
         .symbol = "c1/(2 m1 omega0)",
         .description = "damping ratio of the oscillator, instead of c1",
         .fallback_note = "from c1",
         .range = Range{0, 10}},
        {.name = "c1",
         .group = "SI",
         .unit = "N s/m",
         .symbol = "c1",
         .description = "damping of the oscillator",
         .fallback_note = whole,
         .range = any_damping},
        {.name = "mass_ratio",
         .group = "SI",
         .unit = dimensionless,
         .symbol = "m2/m1",
         .description = "mass ratio m2/m1, instead of m2",
         .fallback_note = "from m2",
         .range = core_range("epsilon")},
        {.name = "m2",
         .group = "SI",
         .unit = "kg",
         .symbol = "m2",
         .description = "mass of the ball",
         .fallback_note = whole,
         .range = any_absorber_mass},
        {.name = "F",
         .group = "SI",
         .unit = "m",
         .symbol = "F",
         .description = "amplitude of the base, which moves by F sin(2 pi f t)",
         .fallback_note = whole,
         .range = any_amplitude},
        {.name = "f",
         .group = "SI",
         .unit = "Hz",
         .symbol = "f",
         .description = "forcing frequency",
         .fallback_note = whole,
         .range = any_frequency},
    };
}

FieldTable start_rows() {
    return {
        {.name = "x0",
         .group = "start",
         .unit = "m",
         .symbol = "x(0)",
         .description = "displacement of the linear oscillator at tau = 0",
         .fallback = 0,
         .range = core_range("x0")},
        {.name = "x_dot0",
         .group = "start",
         .unit = speed,
         .symbol = "x'(0)",
         .description = "velocity of the linear oscillator at tau = 0",
         .fallback = 0,
         .range = core_range("x_dot0")},
        {.name = "x_velocity0",
         .group = "start",
         .unit = "m/s",
         .symbol = "dx/dt(0)",
         .description = "x_dot0 in m/s, for a system in SI",
         .fallback_note = "from x_dot0",
         .range = any_velocity},
        {.name = "y0",
         .group = "start",
         .unit = "m",
         .symbol = "y(0)",
         .description = "displacement of the ball at tau = 0; |x0 - y0| <= b",
         .fallback_note = "0.95 b",
         .range = core_range("y0")},
        {.name = "y_dot0",
         .group = "start",
         .unit = speed,
         .symbol = "y'(0)",
         .description = "velocity of the ball at tau = 0",
         .fallback = 0,
         .range = core_range("y_dot0")},
        {.name = "y_velocity0",
         .group = "start",
         .unit = "m/s",
         .symbol = "dy/dt(0)",
         .description = "y_dot0 in m/s, for a system in SI",
         .fallback_note = "from y_dot0",
         .range = any_velocity},
    };
}

FieldTable perturbation_rows() {
    const auto component = [](const char* name, const char* unit, const char* of_start) {
        return Field{
            .name = name,
            .unit = unit,
            .description = std::string("difference added to ") + of_start,
            .fallback = 0,
            .range = core_range(of_start)};
    };
    return {
        component("x", "m", "x0"),
        component("x_dot", speed, "x_dot0"),
        component("y", "m", "y0"),
        component("y_dot", speed, "y_dot0"),
        {.name = "seed",
         .type = FieldType::integer,
         .description = "seed of a random direction in (x', x, y', y), the same on every computer; "
                        "only with size",
         .fallback = 1,
         .range = Range{0, 9007199254740992}},  // 2^53: doubles hold every whole number up to it
        {.name = "size",
         .description = "Euclidean length of the random difference",
         .fallback_note = "none",
         .range = Range{1e-18, 1e3}},
    };
}

FieldTable run_rows() {
    return {
        {.name = "tau_end",
         .group = "run",
         .unit = dimensionless,
         .symbol = "tau",
         .description = "length of the run; not together with cycles",
         .fallback = 1709,  // beyond the end of the first window of Table 2
         .range = Range{1e-6, longest_run}},
        {.name = "cycles",
         .group = "run",
         .unit = dimensionless,
         .description = "length of the run in forcing cycles of 2 pi/Omega",
         .fallback_note = "from tau_end",
         .range = Range{1e-6, 1e6}},
        {.name = "window",
         .type = FieldType::interval,
         .group = "run",
         .unit = dimensionless,
         .symbol = "[tau_s, tau_e]",
         .description =
             "interval for exponents, regime, energy, section, eigenvalues, matrices and "
             "manifold; the exponents refer to the part from its first to its last impact",
         .fallback_note = "the whole run"},
        {.name = "windows",
         .type = FieldType::intervals,
         .group = "run",
         .unit = dimensionless,
         .symbol = "[[tau_s, tau_e], ...]",
         .description = "additional windows for the exponents, without histories",
         .fallback = Json::array()},
        {.name = "perturbation",
         .type = FieldType::object,
         .group = "run",
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
         .group = "output",
         .description = "parts of the response",
         .fallback = Json::array({"series", "impacts", "exponents"}),
         .choices =
             {"series", "impacts", "exponents", "eigenvalues", "matrices", "section", "energy",
              "regime", "manifold"}},
        {.name = "exponents",
         .type = FieldType::choices,
         .group = "output",
         .description = "estimators of the Lyapunov exponents: qr (Benettin), eigenvalues (33), "
                        "raw_product ((33) unscaled in double precision, as in the paper)",
         .fallback = estimators,
         .choices = estimators},
        {.name = "samples_per_cycle",
         .group = "output",
         .unit = dimensionless,
         .description = "samples of the series per forcing cycle",
         .fallback = 32,
         .range = Range{1, 10000}},
        {.name = "section_phase",
         .group = "output",
         .unit = "rad",
         .description =
             "value of Omega tau, modulo 2 pi, at which the stroboscopic section samples the state",
         .fallback = 0,
         .range = Range{0, 2 * std::numbers::pi}},
        {.name = "max_points",
         .type = FieldType::integer,
         .group = "output",
         .description = "maximum length of series and histories; longer series get a larger step, "
                        "longer histories are thinned",
         .fallback = 20000,
         .range = Range{256, 1000000}},
        {.name = "max_impacts",
         .type = FieldType::integer,
         .group = "output",
         .description = "number of impacts after which the run ends",
         .fallback = 100000,
         .range = Range{1, 2000000}},
    };
}

FieldTable make_manifold_fields() {
    FieldTable table;
    std::copy_if(
        simulate_fields().begin(), simulate_fields().end(), std::back_inserter(table),
        is_of_system);
    table.push_back(
        {.name = "V_max",
         .group = "output",
         .unit = speed,
         .symbol = "V",
         .description = "largest speed of the ball on the branch beyond the symmetry breaking; the "
                        "branch ends earlier if the motion does",
         .fallback_note = "twice the speed at the symmetry breaking",
         .range = Range{1e-12, 1e6}});
    table.push_back(
        {.name = "points",
         .type = FieldType::integer,
         .group = "output",
         .description = "points on each branch",
         .fallback = 200,
         .range = Range{2, 100000}});
    return table;
}

}  // namespace

const FieldTable& simulate_fields() {
    static const FieldTable table = [] {
        FieldTable all;
        for (const auto& rows :
             {system_rows(), reduced_rows(), si_rows(), start_rows(), run_rows(), output_rows()})
            all.insert(all.end(), rows.begin(), rows.end());
        return all;
    }();
    return table;
}

const FieldTable& manifold_fields() {
    static const FieldTable table = make_manifold_fields();
    return table;
}

const FieldTable& form_fields() {
    static const FieldTable table = {
        {.name = "format",
         .type = FieldType::choice,
         .group = "answer",
         .description =
             "format of the response: json; csv: one table; cbor: with typed arrays (RFC "
             "8746); npz: arrays for numpy.load",
         .fallback_note = "the format that the header Accept requests, otherwise json",
         .choices = {"json", "csv", "cbor", "npz"}},
        {.name = "fields",
         .type = FieldType::choices,
         .group = "answer",
         .description =
             "keys to keep in the response: names, or paths with dots as in impacts.tau; "
             "version, status, warnings and provenance are always kept. Other keys are "
             "not computed, unless include requests them",
         .fallback_note = "everything"}};
    return table;
}

bool is_of_system(const Field& f) {
    return f.group == "system" || f.group == "reduced" || f.group == "SI";
}

}  // namespace vines::api
