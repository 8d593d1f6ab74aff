// The tables of /v1/simulate, of /v1/manifold, and of the response's format.
//
// The rows of /v1/simulate are grouped as a form shows them; the other routes select rows from them
// (simulate_fields_where). Ranges of physical quantities are those of the core (parameter_ranges),
// defaults are Table 1 of the paper.
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
// Doubles hold every whole number up to 2^53.
constexpr Range any_seed{0, 9007199254740992};

const char* const whole = "none: give all SI fields, or a preset for the rest";
const char* const from_si = "from the SI fields if any is given";
const char* const speed = "m per unit of tau";

FieldTable system_rows() {
    using enum FieldType;
    const Parameters table_1;  // the defaults
    return {
        // The reader of the request reports an unknown preset with the list of presets.
        {"preset",
         "figure or table of the paper (GET /v1/presets); each other field that is given "
         "replaces one value of the preset",
         choice, any_value, nullptr, "none"},
        {"b", "clearance: half-width of the cavity in which the ball moves", number,
         core_range("b"), table_1.b, "", "m", "b"},
        {"R", "restitution coefficient of both walls; not together with R_plus or R_minus", number,
         core_range("R_plus"), table_1.R_plus, "", dimensionless, "R"},
        {"R_plus", "restitution coefficient of the wall at x - y = +b", number,
         core_range("R_plus"), nullptr, "R", dimensionless, "R+"},
        {"R_minus", "restitution coefficient of the wall at x - y = -b", number,
         core_range("R_minus"), nullptr, "R", dimensionless, "R-"},
        {"damping",
         "equation_of_motion: zeta = epsilon lambda/2, eqs. (1), (6), (17), the physical damper "
         "c1; closed_form: zeta = epsilon lambda, eqs. (8)-(11), (19), (20), used for the numbers "
         "in the paper",
         choice, enum_choices<Damping>(), enum_json(table_1.damping), "", "", "zeta"},
    };
}

FieldTable reduced_rows() {
    using enum FieldType;
    const Parameters table_1;  // the defaults
    return {
        {"epsilon", "mass ratio m2/m1", number, core_range("epsilon"), table_1.epsilon, from_si,
         dimensionless, "epsilon"},
        {"lambda", "damping c1/(m2 omega0)", number, core_range("lambda"), table_1.lambda, from_si,
         dimensionless, "lambda"},
        {"G", "amplitude of the base over epsilon", number, core_range("G"), table_1.G, from_si,
         "m", "G"},
        {"Omega", "forcing frequency over omega0", number, core_range("Omega"), table_1.Omega,
         from_si, dimensionless, "Omega"},
    };
}

FieldTable si_rows() {
    using enum FieldType;
    return {
        {"m1", "mass of the linear oscillator; SI and reduced fields exclude each other", number,
         any_mass, nullptr, whole, "kg", "m1"},
        {"f0", "natural frequency of the oscillator, sqrt(k1/m1)/(2 pi), instead of k1", number,
         any_frequency, nullptr, "from k1", "Hz", "f0"},
        {"k1", "stiffness of the oscillator", number, any_stiffness, nullptr, whole, "N/m", "k1"},
        {"damping_ratio", "damping ratio of the oscillator, instead of c1", number, Range{0, 10},
         nullptr, "from c1", dimensionless, "c1/(2 m1 omega0)"},
        {"c1", "damping of the oscillator", number, any_damping, nullptr, whole, "N s/m", "c1"},
        {"mass_ratio", "mass ratio m2/m1, instead of m2", number, core_range("epsilon"), nullptr,
         "from m2", dimensionless, "m2/m1"},
        {"m2", "mass of the ball", number, any_absorber_mass, nullptr, whole, "kg", "m2"},
        {"F", "amplitude of the base, which moves by F sin(2 pi f t)", number, any_amplitude,
         nullptr, whole, "m", "F"},
        {"acceleration", "amplitude of the base's acceleration, instead of F", number,
         any_acceleration, nullptr, "from F", "m/s^2"},
        {"f", "forcing frequency", number, any_frequency, nullptr, whole, "Hz", "f"},
    };
}

/// Laws of the ball and of the walls beyond the paper.
FieldTable law_rows() {
    using enum FieldType;
    const auto table = [](const char* name, const char* description) {
        const FieldTable columns = {
            {"speed", "speeds |x' - y'| before the impact, ascending", numbers, any_value, nullptr,
             "", speed},
            {"speed_m_s", "the same in m/s, for a system in SI", numbers, any_value, nullptr, "",
             "m/s"},
            {"R", "restitution coefficient at each speed", numbers, any_value, nullptr, "",
             dimensionless}};
        return Field(name, description, object, columns, nullptr, "none: a constant R", "", "R(w)");
    };
    return {
        {"gravity",
         "acceleration of the free ball along its track, g sin(inclination)/omega0^2, positive "
         "along +x; x is measured from the oscillator's rest without ball",
         number, core_range("gravity"), 0, "", "m", "g'"},
        {"inclination",
         "inclination of the track, for a system in SI; pi/2: the ball falls along +x", number,
         Range{-std::numbers::pi / 2, std::numbers::pi / 2}, nullptr, "from gravity", "rad"},
        {"friction", "deceleration of the sliding ball, mu g cos(inclination)/omega0^2", number,
         core_range("friction"), 0, "", "m", "f'"},
        {"mu", "friction coefficient of the ball, for a system in SI", number, Range{0, 100},
         nullptr, "from friction", dimensionless, "mu"},
        table(
            "restitution",
            "R of both walls as a function of the speed: {speed or speed_m_s, R}, linear between "
            "the points, constant outside; instead of R"),
        table("restitution_plus", "the same for the wall at x - y = +b"),
        table("restitution_minus", "the same for the wall at x - y = -b"),
    };
}

FieldTable load_rows() {
    using enum FieldType;
    constexpr Range any{-1e9, 1e9};  // of a list: a number, too, which a formula needs
    const FieldTable rows = {
        {"kind",
         "half_sine, of half a period: acceleration_m_s2, displacement_m or force_N as a "
         "number, and duration_s; chirp: the same, f_from, f_to, rate, phase; noise of an "
         "acceleration, normally distributed: rms_m_s2, f_low, f_high, duration_s, seed; "
         "harmonics, the sum of F sin(2 pi f t + phase): f, F, phase",
         choice, Choices{"half_sine", "chirp", "noise", "harmonics"}, nullptr, "none: a record"},
        {"time_s", "ascending times; the first one is tau = 0", numbers, any_value, nullptr, "none",
         "s"},
        {"acceleration_m_s2",
         "acceleration of the base, which starts at rest: at each time, or the amplitude", numbers,
         any, nullptr, "none", "m/s^2"},
        {"displacement_m", "displacement of the base: at each time, or the amplitude", numbers, any,
         nullptr, "none", "m"},
        {"force_N", "force on m1: at each time, or the amplitude", numbers, any, nullptr, "none",
         "N"},
        {"duration_s", "duration of half_sine, chirp or noise", number, Range{1e-9, 1e9}, nullptr,
         "none", "s"},
        {"f_from", "frequency at the beginning of a chirp", number, any_frequency, nullptr, "none",
         "Hz"},
        {"f_to", "frequency at its end", number, any_frequency, nullptr, "none", "Hz"},
        {"rate", "growth of the frequency of a chirp", choice, Choices{"linear", "logarithmic"},
         "linear"},
        {"phase", "phase of a chirp at its beginning, or of each of harmonics", numbers,
         Range{-1e3, 1e3}, nullptr, "none", "rad"},
        {"rms_m_s2", "root mean square of noise", number, Range{0, 1e9}, nullptr, "none", "m/s^2"},
        {"f_low", "lowest frequency of noise", number, any_frequency, nullptr, "none", "Hz"},
        {"f_high", "highest frequency of noise", number, any_frequency, nullptr, "none", "Hz"},
        {"seed", "seed of noise, the same on every computer", integer, any_seed, 1},
        {"f", "frequencies of harmonics", numbers, any_value, nullptr, "none", "Hz"},
        {"F", "amplitudes of the base at these frequencies", numbers, any_value, nullptr, "none",
         "m"},
    };
    return {
        {"forcing",
         "load instead of F and f, for a system in SI: a record, time_s and one of "
         "acceleration_m_s2, displacement_m and force_N, linear between the samples; or a formula, "
         "kind",
         object, rows, nullptr, "none: F and f"}};
}

FieldTable start_rows() {
    using enum FieldType;
    return {
        {"x0", "displacement of the linear oscillator at tau = 0", number, core_range("x0"), 0, "",
         "m", "x(0)"},
        {"x_dot0", "velocity of the linear oscillator at tau = 0", number, core_range("x_dot0"), 0,
         "", speed, "x'(0)"},
        {"x_velocity0", "x_dot0 in m/s, for a system in SI", number, any_velocity, nullptr,
         "from x_dot0", "m/s", "dx/dt(0)"},
        {"y0", "displacement of the ball at tau = 0; |x0 - y0| <= b", number, core_range("y0"),
         nullptr, "x0 + 0.95 b", "m", "y(0)"},
        {"y_dot0", "velocity of the ball at tau = 0", number, core_range("y_dot0"), 0, "", speed,
         "y'(0)"},
        {"y_velocity0", "y_dot0 in m/s, for a system in SI", number, any_velocity, nullptr,
         "from y_dot0", "m/s", "dy/dt(0)"},
    };
}

FieldTable perturbation_rows() {
    using enum FieldType;
    const auto component = [](const char* name, const char* unit, const std::string& of_start) {
        return Field(
            name, "difference added to " + of_start, number, core_range(of_start), 0, "", unit);
    };
    return {
        component("x", "m", "x0"),
        component("x_dot", speed, "x_dot0"),
        component("y", "m", "y0"),
        component("y_dot", speed, "y_dot0"),
        {"seed",
         "seed of a random direction in (x', x, y', y), the same on every computer; only with "
         "size",
         integer, any_seed, 1},
        {"size", "Euclidean length of the random difference", number, Range{1e-18, 1e3}, nullptr,
         "none"},
    };
}

FieldTable run_rows() {
    using enum FieldType;
    return {
        {"tau_end", "length of the run; not together with cycles", number, Range{1e-6, longest_run},
         1709, "", dimensionless, "tau"},  // beyond the end of the first window of Table 2
        {"cycles", "length of the run in forcing cycles of 2 pi/Omega", number, Range{1e-6, 1e6},
         nullptr, "from tau_end", dimensionless},
        {"window",
         "interval for exponents, regime, energy, section, eigenvalues, matrices and manifold; the "
         "exponents refer to the part from its first to its last impact",
         interval, any_value, nullptr, "the whole run", dimensionless, "[tau_s, tau_e]"},
        {"windows", "additional windows for the exponents, without histories", intervals, any_value,
         Json::array(), "", dimensionless, "[[tau_s, tau_e], ...]"},
        {"perturbation",
         "second run with a slightly different start, and its distance from the first run; the "
         "difference of the starts is {x, x_dot, y, y_dot}, or a random one by {seed, size}",
         object, perturbation_rows(), nullptr, "none"},
    };
}

FieldTable output_rows() {
    using enum FieldType;
    const std::vector<std::string> estimators = {"qr", "eigenvalues", "raw_product"};
    return {
        {"include", "parts of the response", choices,
         Choices{
             "series", "impacts", "exponents", "eigenvalues", "matrices", "section", "energy",
             "regime", "manifold"},
         Json{"series", "impacts", "exponents"}},
        {"exponents",
         "estimators of the Lyapunov exponents: qr (Benettin), eigenvalues (33), raw_product "
         "((33) unscaled in double precision, as in the paper)",
         choices, estimators, estimators},
        {"settle_cycles",
         "with regime: further cycles, at most, for which a chaotic run is continued to find "
         "out whether a periodic orbit captures it",
         integer, Range{0, 1e6}, 0, "", dimensionless},
        {"samples_per_cycle", "samples of the series per forcing cycle", number, Range{1, 10000},
         32, "", dimensionless},
        section_phase_row(),
        {"max_points",
         "maximum length of series and histories; longer series get a larger step, longer "
         "histories are thinned",
         integer, Range{256, 1000000}, 20000},
        {"max_impacts", "number of impacts after which the run ends", integer, Range{1, 2000000},
         100000},
    };
}

FieldTable manifold_rows() {
    using enum FieldType;
    return {
        {"V_max",
         "largest speed of the ball on the branch beyond the symmetry breaking; the branch ends "
         "earlier if the motion does",
         number, Range{1e-12, 1e6}, nullptr, "twice the speed at the symmetry breaking", speed,
         "V"},
        {"points", "points on each branch", integer, Range{2, 100000}, 200}};
}

}  // namespace

Field section_phase_row() {
    return {
        "section_phase",
        "value of Omega tau, modulo 2 pi, at which the stroboscopic section samples the state",
        FieldType::number,
        Range{0, 2 * std::numbers::pi},
        0,
        "",
        "rad"};
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
    using enum FieldType;
    static const FieldTable table = grouped(
        "answer",
        {{"format",
          "format of the response: json; csv: one table; cbor: with typed arrays (RFC 8746); "
          "npz: arrays for numpy.load",
          choice, Choices{"json", "csv", "cbor", "npz"}, nullptr,
          "the format that the header Accept requests, otherwise json"},
         {"fields",
          "keys to keep in the response: names, or paths with dots as in impacts.tau; version, "
          "status, warnings and provenance are always kept. Other keys are not computed, unless "
          "include requests them",
          choices, any_value, nullptr, "everything"}});
    return table;
}

bool is_of_system(const Field& f) {
    return f.group == "system" || f.group == "reduced" || f.group == "SI";
}

bool is_continued(const Field& f) {
    return f.type == FieldType::number &&
           (is_of_system(f) || f.name == "gravity" || f.name == "inclination" ||
            f.name == "friction" || f.name == "mu");
}

FieldTable simulate_fields_where(bool (*keep)(const Field&)) {
    FieldTable table;
    std::ranges::copy_if(simulate_fields(), std::back_inserter(table), keep);
    return table;
}

}  // namespace vines::api
