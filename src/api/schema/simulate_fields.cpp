// The rows of the table of /v1/simulate, of which those of the other routes are made.
#include <numbers>
#include <stdexcept>

#include "api/schema/tables.hpp"
#include "api/schema/words.hpp"
#include "core/motion/parameters.hpp"

namespace vines::api {

namespace {

/// That of the core's parameter or initial state of this name.
Range core_range(const std::string& name) {
    for (const ParameterRange& r : parameter_ranges())
        if (r.name == name) return {r.minimum, r.maximum};
    throw std::logic_error("no core parameter " + name);
}

// Wider than any machine: these ranges only keep the arithmetic far from overflow and from a
// division by zero. The core checks the reduced parameters that follow.
constexpr Range any_mass{1e-9, 1e9}, any_absorber_mass{1e-12, 1e9}, any_frequency{1e-9, 1e9},
    any_stiffness{1e-9, 1e15}, any_damping{0, 1e12}, any_amplitude{0, 1e3}, any_velocity{-1e9, 1e9};

const char* const whole = "none: a system in SI is given as a whole, or a preset for the rest";
const char* const from_si = "from the SI fields if any is given";
const char* const speed = "m per unit of tau";

FieldTable system_rows() {
    const Parameters table_1;  // of the paper: the defaults
    return {
        {.name = "preset",
         // Any word: the reader of the request answers an unknown one with the list.
         .type = FieldType::choice,
         .group = "system",
         .description = "start from a figure or table of the paper (GET /v1/presets); each other "
                        "field replaces its own value alone",
         .fallback_note = "none"},
        {.name = "b",
         .group = "system",
         .unit = "m",
         .symbol = "b",
         .description = "half-width of the cavity in which the free mass moves",
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
         .description = "restitution coefficient of the wall met where x - y = +b",
         .fallback_note = "R",
         .range = core_range("R_plus")},
        {.name = "R_minus",
         .group = "system",
         .unit = dimensionless,
         .symbol = "R-",
         .description = "restitution coefficient of the wall met where x - y = -b",
         .fallback_note = "R",
         .range = core_range("R_minus")},
        {.name = "damping",
         .type = FieldType::choice,
         .group = "system",
         .symbol = "zeta",
         .description = "equation_of_motion: zeta = epsilon lambda/2, eqs. (1), (6), (17), what c1 "
                        "means; closed_form: zeta = epsilon lambda, eqs. (8)-(11), (19), (20), "
                        "what the paper's numbers were computed with",
         .fallback = word(table_1.damping),
         .choices = all_words<Damping>()},
    };
}

FieldTable reduced_rows() {
    const Parameters table_1;  // of the paper: the defaults
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
         .description = "mass of the linear oscillator; SI and reduced fields cannot be mixed",
         .fallback_note = whole,
         .range = any_mass},
        {.name = "f0",
         .group = "SI",
         .unit = "Hz",
         .symbol = "f0",
         .description = "its natural frequency sqrt(k1/m1)/(2 pi), in place of k1",
         .fallback_note = "from k1",
         .range = any_frequency},
        {.name = "k1",
         .group = "SI",
         .unit = "N/m",
         .symbol = "k1",
         .description = "its stiffness",
         .fallback_note = whole,
         .range = any_stiffness},
        {.name = "damping_ratio",
         .group = "SI",
         .unit = dimensionless,
         .symbol = "c1/(2 m1 omega0)",
         .description = "its damping ratio, in place of c1",
         .fallback_note = "from c1",
         .range = Range{0, 10}},
        {.name = "c1",
         .group = "SI",
         .unit = "N s/m",
         .symbol = "c1",
         .description = "its damping",
         .fallback_note = whole,
         .range = any_damping},
        {.name = "mass_ratio",
         .group = "SI",
         .unit = dimensionless,
         .symbol = "m2/m1",
         .description = "mass of the absorber over m1, in place of m2",
         .fallback_note = "from m2",
         .range = core_range("epsilon")},
        {.name = "m2",
         .group = "SI",
         .unit = "kg",
         .symbol = "m2",
         .description = "mass of the absorber",
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
         .description = "its velocity",
         .fallback = 0,
         .range = core_range("x_dot0")},
        {.name = "x_velocity0",
         .group = "start",
         .unit = "m/s",
         .symbol = "dx/dt(0)",
         .description = "the same in m/s, for a system in SI",
         .fallback_note = "from x_dot0",
         .range = any_velocity},
        {.name = "y0",
         .group = "start",
         .unit = "m",
         .symbol = "y(0)",
         .description = "displacement of the free mass; |x0 - y0| <= b",
         .fallback_note = "0.95 b",
         .range = core_range("y0")},
        {.name = "y_dot0",
         .group = "start",
         .unit = speed,
         .symbol = "y'(0)",
         .description = "its velocity",
         .fallback = 0,
         .range = core_range("y_dot0")},
        {.name = "y_velocity0",
         .group = "start",
         .unit = "m/s",
         .symbol = "dy/dt(0)",
         .description = "the same in m/s, for a system in SI",
         .fallback_note = "from y_dot0",
         .range = any_velocity},
    };
}

FieldTable perturbation_rows() {
    const auto component = [](const char* name, const char* unit, const char* of_start) {
        return Field{
            .name = name,
            .unit = unit,
            .description = std::string("is added to ") + of_start,
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
         .description = "of a random direction in (x', x, y', y), the same on every machine; with "
                        "size",
         .fallback = 1,
         .range = Range{0, 9007199254740992}},  // 2^53: every whole number up to there is a double
        {.name = "size",
         .description = "Euclidean length of that difference",
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
         .description = "how long to run; not together with cycles",
         .fallback = 1709,  // the first window of Table 2 ends before it
         .range = Range{1e-6, longest_run}},
        {.name = "cycles",
         .group = "run",
         .unit = dimensionless,
         .description = "how many forcing cycles of 2 pi/Omega to run",
         .fallback_note = "from tau_end",
         .range = Range{1e-6, 1e6}},
        {.name = "window",
         .type = FieldType::interval,
         .group = "run",
         .unit = dimensionless,
         .symbol = "[tau_s, tau_e]",
         .description = "the exponents are taken from the first impact at or after tau_s to the "
                        "last at or before tau_e; regime, energy, section, eigenvalues and "
                        "manifold are those of the window, too",
         .fallback_note = "the whole run"},
        {.name = "windows",
         .type = FieldType::intervals,
         .group = "run",
         .unit = dimensionless,
         .symbol = "[[tau_s, tau_e], ...]",
         .description = "more windows, for which the exponents are given without histories",
         .fallback = Json::array()},
        {.name = "perturbation",
         .type = FieldType::object,
         .group = "run",
         .description = "a second run that starts a little off, and how its distance from the "
                        "first one grows: either the difference {x, x_dot, y, y_dot} of the start, "
                        "or a random one {seed, size}",
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
         .description = "parts of the answer",
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
         .description = "phase of the stroboscopic section after each whole cycle",
         .fallback = 0,
         .range = Range{0, 2 * std::numbers::pi}},
        {.name = "max_points",
         .type = FieldType::integer,
         .group = "output",
         .description = "longest series and histories; a longer series gets a larger step, longer "
                        "histories are thinned",
         .fallback = 20000,
         .range = Range{256, 1000000}},
        {.name = "max_impacts",
         .type = FieldType::integer,
         .group = "output",
         .description = "end the run after so many impacts",
         .fallback = 100000,
         .range = Range{1, 2000000}},
    };
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

bool is_of_system(const Field& f) {
    return f.group == "system" || f.group == "reduced" || f.group == "SI";
}

}  // namespace vines::api
