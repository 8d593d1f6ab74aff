// The tables of /v1/simulate, of /v1/manifold, and of the response's format.
//
// The rows of /v1/simulate are grouped as a form shows them; the other routes select rows from them
// (simulate_fields_where). Ranges of physical quantities are those of the core (parameter_ranges),
// defaults are Table 1 of the paper.
#include <algorithm>
#include <iterator>

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

const Note whole{"none: give all SI fields, or a preset for the rest"};
const char* const speed = "m per unit of tau";

FieldTable system_rows() {
    using namespace kinds;
    const Parameters table_1;  // the defaults
    return {
        // The reader of the request reports an unknown preset with the list of presets.
        {"preset", choice(), none,
         "figure or table of the paper, or machine (GET /v1/presets); each other given field "
         "replaces one value of the preset"},
        {"b", number(core_range("b"), "m", "b"), table_1.b,
         "clearance: half-width of the cavity in which the ball moves"},
        {"R", number(core_range("R_plus"), dimensionless, "R"), table_1.R_plus,
         "restitution coefficient of both walls; not together with R_plus or R_minus"},
        {"R_plus", number(core_range("R_plus"), dimensionless, "R+"), Note{"R"},
         "restitution coefficient of the wall at x - y = +b"},
        {"R_minus", number(core_range("R_minus"), dimensionless, "R-"), Note{"R"},
         "restitution coefficient of the wall at x - y = -b"},
        {"damping", choice(enum_choices<Damping>(), "", "zeta"), enum_json(table_1.damping),
         "equation_of_motion: zeta = epsilon lambda/2, eqs. (1), (6), (17), the physical damper "
         "c1; closed_form: zeta = epsilon lambda, eqs. (8)-(11), (19), (20), used for the numbers "
         "in the paper"},
    };
}

FieldTable reduced_rows() {
    using namespace kinds;
    const Parameters table_1;  // the defaults
    FieldTable rows = {
        {"epsilon", number(core_range("epsilon"), dimensionless, "epsilon"), table_1.epsilon,
         "mass ratio m2/m1"},
        {"lambda", number(core_range("lambda"), dimensionless, "lambda"), table_1.lambda,
         "damping c1/(m2 omega0)"},
        {"G", number(core_range("G"), "m", "G"), table_1.G, "amplitude of the base over epsilon"},
        {"Omega", number(core_range("Omega"), dimensionless, "Omega"), table_1.Omega,
         "forcing frequency over omega0"},
    };
    for (Field& row : rows) row.fallback_note = "from the SI fields if any is given";
    return rows;
}

FieldTable si_rows() {
    using namespace kinds;
    return {
        {"m1", number(any_mass, "kg", "m1"), whole,
         "mass of the linear oscillator; SI and reduced fields exclude each other"},
        {"f0", number(any_frequency, "Hz", "f0"), Note{"from k1"},
         "natural frequency of the oscillator, sqrt(k1/m1)/(2 pi), instead of k1"},
        {"k1", number(any_stiffness, "N/m", "k1"), whole, "stiffness of the oscillator"},
        {"damping_ratio", number({0, 10}, dimensionless, "c1/(2 m1 omega0)"), Note{"from c1"},
         "damping ratio of the oscillator, instead of c1"},
        {"c1", number(any_damping, "N s/m", "c1"), whole, "damping of the oscillator"},
        {"mass_ratio", number(core_range("epsilon"), dimensionless, "m2/m1"), Note{"from m2"},
         "mass ratio m2/m1, instead of m2"},
        {"m2", number(any_absorber_mass, "kg", "m2"), whole, "mass of the ball"},
        {"F", number(any_amplitude, "m", "F"), whole,
         "amplitude of the base, which moves by F sin(2 pi f t)"},
        {"acceleration", number(any_acceleration, "m/s^2"), Note{"from F"},
         "amplitude of the base's acceleration, instead of F"},
        {"f", number(any_frequency, "Hz", "f"), whole, "forcing frequency"},
    };
}

/// Laws of the ball and of the walls beyond the paper.
FieldTable law_rows() {
    using namespace kinds;
    const auto table = [](const char* name, const char* description) {
        const FieldTable columns = {
            {"speed", numbers({}, speed), nullptr, "speeds |x' - y'| before the impact, ascending"},
            {"speed_m_s", numbers({}, "m/s"), nullptr, "the same in m/s, for a system in SI"},
            {"R", numbers({}, dimensionless), nullptr, "restitution coefficient at each speed"}};
        return Field(
            name, json_object(columns, "", "R(w)"), Note{"none: a constant R"}, description);
    };
    return {
        {"gravity", number(core_range("gravity"), "m", "g'"), 0,
         "acceleration of the free ball along its track, g sin(inclination)/omega0^2, positive "
         "along +x; x is measured from the oscillator's rest without ball"},
        {"inclination", number({-std::numbers::pi / 2, std::numbers::pi / 2}, "rad"),
         Note{"from gravity"},
         "inclination of the track, for a system in SI; pi/2: the ball falls along +x"},
        {"friction", number(core_range("friction"), "m", "f'"), 0,
         "deceleration of the sliding ball, mu g cos(inclination)/omega0^2"},
        {"mu", number({0, 100}, dimensionless, "mu"), Note{"from friction"},
         "friction coefficient of the ball, for a system in SI"},
        table(
            "restitution",
            "R of both walls as a function of the speed: {speed or speed_m_s, R}, linear between "
            "the points, constant outside; instead of R"),
        table("restitution_plus", "the same for the wall at x - y = +b"),
        table("restitution_minus", "the same for the wall at x - y = -b"),
    };
}

FieldTable load_rows() {
    using namespace kinds;
    constexpr Range any{-1e9, 1e9};  // of a list: a number, too, which a formula needs
    const FieldTable rows = {
        {"kind", choice({"half_sine", "chirp", "noise", "harmonics"}), Note{"none: a record"},
         "half_sine, of half a period: acceleration_m_s2, displacement_m or force_N as a "
         "number, and duration_s; chirp: the same, f_from, f_to, rate, phase; noise of an "
         "acceleration, normally distributed: rms_m_s2, f_low, f_high, duration_s, seed; "
         "harmonics, the sum of F sin(2 pi f t + phase): f, F, phase"},
        {"time_s", numbers({}, "s"), none, "ascending times; the first one is tau = 0"},
        {"acceleration_m_s2", numbers(any, "m/s^2"), none,
         "acceleration of the base, which starts at rest: at each time, or the amplitude"},
        {"displacement_m", numbers(any, "m"), none,
         "displacement of the base: at each time, or the amplitude"},
        {"force_N", numbers(any, "N"), none, "force on m1: at each time, or the amplitude"},
        {"duration_s", number({1e-9, 1e9}, "s"), none, "duration of half_sine, chirp or noise"},
        {"f_from", number(any_frequency, "Hz"), none, "frequency at the beginning of a chirp"},
        {"f_to", number(any_frequency, "Hz"), none, "frequency at its end"},
        {"rate", choice({"linear", "logarithmic"}), "linear", "growth of the frequency of a chirp"},
        {"phase", numbers(Range{-1e3, 1e3}, "rad"), none,
         "phase of a chirp at its beginning, or of each of harmonics"},
        {"rms_m_s2", number({0, 1e9}, "m/s^2"), none, "root mean square of noise"},
        {"f_low", number(any_frequency, "Hz"), none, "lowest frequency of noise"},
        {"f_high", number(any_frequency, "Hz"), none, "highest frequency of noise"},
        {"seed", integer(any_seed), 1, "seed of noise, the same on every computer"},
        {"f", numbers({}, "Hz"), none, "frequencies of harmonics"},
        {"F", numbers({}, "m"), none, "amplitudes of the base at these frequencies"},
    };
    return {
        {"forcing", json_object(rows), Note{"none: F and f"},
         "load instead of F and f, for a system in SI: a record, time_s and one of "
         "acceleration_m_s2, displacement_m and force_N, linear between the samples; or a formula, "
         "kind"}};
}

FieldTable start_rows() {
    using namespace kinds;
    return {
        {"x0", number(core_range("x0"), "m", "x(0)"), 0,
         "displacement of the linear oscillator at tau = 0"},
        {"x_dot0", number(core_range("x_dot0"), speed, "x'(0)"), 0,
         "velocity of the linear oscillator at tau = 0"},
        {"x_velocity0", number(any_velocity, "m/s", "dx/dt(0)"), Note{"from x_dot0"},
         "x_dot0 in m/s, for a system in SI"},
        {"y0", number(core_range("y0"), "m", "y(0)"), Note{"x0 + 0.95 b"},
         "displacement of the ball at tau = 0; |x0 - y0| <= b"},
        {"y_dot0", number(core_range("y_dot0"), speed, "y'(0)"), 0,
         "velocity of the ball at tau = 0"},
        {"y_velocity0", number(any_velocity, "m/s", "dy/dt(0)"), Note{"from y_dot0"},
         "y_dot0 in m/s, for a system in SI"},
    };
}

FieldTable perturbation_rows() {
    using namespace kinds;
    const auto component = [](const char* name, const char* unit, const std::string& of_start) {
        return Field(
            name, number(core_range(of_start), unit), 0, "difference added to " + of_start);
    };
    return {
        component("x", "m", "x0"),
        component("x_dot", speed, "x_dot0"),
        component("y", "m", "y0"),
        component("y_dot", speed, "y_dot0"),
        {"seed", integer(any_seed), 1,
         "seed of a random direction (x', x, y', y), equal on every computer; only with size"},
        {"size", number({1e-18, 1e3}), none, "Euclidean length of the random difference"},
    };
}

FieldTable run_rows() {
    using namespace kinds;
    return {
        // The default is beyond the end of the first window of Table 2.
        {"tau_end", number({1e-6, longest_run}, dimensionless, "tau"), 1709,
         "length of the run; with a load by default the load's; not together with cycles"},
        {"cycles", number({1e-6, 1e6}, dimensionless), Note{"from tau_end"},
         "length of the run in forcing cycles of 2 pi/Omega"},
        {"window", interval({}, dimensionless, "[tau_s, tau_e]"), Note{"the whole run"},
         "interval for exponents, regime, energy, section, eigenvalues, matrices and manifold; the "
         "exponents refer to the part from its first to its last impact"},
        {"windows", intervals({}, dimensionless, "[[tau_s, tau_e], ...]"), Json::array(),
         "additional windows for the exponents, without histories"},
        {"perturbation", json_object(perturbation_rows()), none,
         "second run with a slightly different start, and its distance from the first run; the "
         "difference of the starts is {x, x_dot, y, y_dot}, or a random one by {seed, size}"},
    };
}

FieldTable output_rows() {
    using namespace kinds;
    const std::vector<std::string> estimators = {"qr", "eigenvalues", "raw_product"};
    return {
        {"include",
         choices(
             {"series", "impacts", "exponents", "eigenvalues", "matrices", "section", "energy",
              "regime", "manifold"}),
         Json{"series", "impacts", "exponents"}, "parts of the response"},
        {"exponents", choices(estimators), estimators,
         "estimators of the Lyapunov exponents: qr (Benettin), eigenvalues (33), raw_product "
         "((33) unscaled in double precision, as in the paper)"},
        {"settle_cycles", integer({0, 1e6}, dimensionless), 0,
         "with regime: further cycles, at most, for which a chaotic run is continued to find "
         "out whether a periodic orbit captures it"},
        {"samples_per_cycle", number({1, 10000}, dimensionless), 32,
         "samples of the series per forcing cycle"},
        {"section_phase", number({0, 2 * std::numbers::pi}, "rad"), 0,
         "value of Omega tau, modulo 2 pi, at which the stroboscopic section samples the state"},
        {"max_points", integer({256, 1000000}), 20000,
         "maximum length of series and histories; longer series get a larger step, longer "
         "histories are thinned"},
        {"max_impacts", integer({1, 2000000}), 100000,
         "number of impacts after which the run ends"},
    };
}

FieldTable manifold_rows() {
    using namespace kinds;
    return {
        {"V_max", number({1e-12, 1e6}, speed, "V"),
         Note{"twice the speed at the symmetry breaking"},
         "largest speed of the ball on the branch beyond the symmetry breaking; the branch ends "
         "earlier if the motion does"},
        {"points", integer({2, 100000}), 200, "points on each branch"}};
}

}  // namespace

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
    using namespace kinds;
    static const FieldTable table = grouped(
        "answer",
        {{"format", choice({"json", "csv", "cbor", "npz"}),
          Note{"the format that the header Accept requests, otherwise json"},
          "format of the response: json; csv: one table; cbor: with typed arrays (RFC 8746); "
          "npz: arrays for numpy.load"},
         {"fields", choices(), Note{"everything"},
          "keys to keep in the response: names, or paths with dots as in impacts.tau; version, "
          "status, warnings and provenance are always kept. Other keys are not computed, unless "
          "include requests them"}});
    return table;
}

bool is_of_system(const Field& f) {
    return f.group == "system" || f.group == "reduced" || f.group == "SI";
}

std::vector<std::string> continued_names() {
    const FieldTable continued = simulate_fields_where([](const Field& f) {
        return f.type == FieldType::number &&
               (is_of_system(f) || f.name == "gravity" || f.name == "inclination" ||
                f.name == "friction" || f.name == "mu");
    });
    return texts_of(continued, &Field::name);
}

FieldTable simulate_fields_where(bool (*keep)(const Field&)) {
    FieldTable table;
    std::ranges::copy_if(simulate_fields(), std::back_inserter(table), keep);
    return table;
}

}  // namespace vines::api
