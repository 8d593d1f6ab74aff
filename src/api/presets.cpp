#include "api/presets.hpp"

#include <fmt/format.h>

#include <iterator>
#include <numbers>

#include "api/simulate.hpp"
#include "core/measurement/synthetic_record.hpp"

namespace vines::api {

namespace {

const char* const doi = "10.1007/s11071-017-4015-y";
const char* const of_a_machine = "machine";  // in place of a figure or table
const char* const citation =
    "T. Li, C.-H. Lamarque, S. Seguy, A. Berlioz: Chaotic characteristic of a linear oscillator "
    "coupled with vibro-impact nonlinear energy sink. Nonlinear Dynamics 91 (2018) 2319-2330";

// The window of the paper's exponents (Table 2, first row).
constexpr double window_start = 18.13, window_end = 1708.9;

Json closed_form(double b, double tau_end = window_end) {
    Json p = {{"b", b}, {"damping", "closed_form"}, {"tau_end", tau_end}};
    if (tau_end > 2000) p["samples_per_cycle"] = 20;  // enough for a plot of a thousand cycles
    return p;
}

Json with(Json parameters, const Json& more) {
    parameters.update(more);
    return parameters;
}

// Table 4. The amplitude of the base is not printed; G = .01 m at resonance and R = .85 reproduce
// both responses of section 5.
Json experiment(double b, double cycles) {
    const SiParameters si{
        .m1 = 4.168, .c1 = 3.02, .k1 = 11.47e3, .m2 = 0.032, .F = 0.01 * 0.032 / 4.168};
    Json p = {{"m1", si.m1}, {"c1", si.c1}, {"k1", si.k1},
              {"m2", si.m2}, {"F", si.F},   {"f", si.f0()}};
    p.update({{"R", 0.85}, {"b", b}, {"damping", "equation_of_motion"}, {"cycles", cycles}});
    return p;
}

const std::string smr = "Type II, chaotic strongly modulated response";

/// Simulations with Table 1.
std::vector<Preset> figures() {
    return {
        {"fig3", "Fig. 3", smr + ", b = 22 mm: displacement x of the linear oscillator",
         "The exponents are those of the window between the paper's broken lines.",
         with(closed_form(0.022, 5521.3), {{"window", {window_start, window_end}}})},
        {"fig4", "Fig. 4", smr + ", b = 22 mm: relative displacement y - x enlarged", "",
         closed_form(0.022, 600)},
        {"fig5", "Fig. 5", smr + ", b = 22 mm: transient Lyapunov exponents",
         "The paper's four positive values are presumably those of raw_product: except for lambda1 "
         "they are its rounding floor. qr has one positive exponent. The deepest spikes of lambda1 "
         "by (33) occur where the product's leading eigenvalue is nearly zero, not at grazing. The "
         "motion from this start sticks twice: lambda3 is minus infinity from tau = 1174 on; "
         "with y0 = 0.02089998 it does not stick.",
         closed_form(0.022)},
        {"fig6", "Fig. 6", smr + ", b = 22 mm: transfer matrices J_i of the flights", "",
         closed_form(0.022)},
        {"fig7", "Fig. 7", smr + ", b = 22 mm: transfer matrices M_i of the impacts", "",
         closed_form(0.022)},
        {"fig8", "Fig. 8", smr + ", b = 22 mm: transfer matrices T_i = M_i J_i", "",
         closed_form(0.022)},
        {"fig9", "Fig. 9", smr + ", b = 22 mm: envelope of x against the matrices T_i", "",
         closed_form(0.022)},
        {"fig10", "Fig. 10", "Type I, sparse irregular impacts, b = 40 mm",
         "Four positive values, as printed, are rounding (raw_product); qr has one.",
         closed_form(0.040)},
        {"fig11", "Fig. 11", "Type III, two symmetric impacts per cycle, b = 15 mm",
         "A sticking phase at tau = 76.2 makes lambda3 and lambda4 of a window from the start "
         "minus infinity; the orbit's own are in its Floquet multipliers.",
         closed_form(0.015)},
        {"fig12", "Fig. 12", "Type IV, two asymmetric impacts per cycle, b = 6.5 mm",
         "The paper prints b = 8 mm. From its initial state, and from each of 200 random ones, the "
         "two impacts are symmetric there; they are asymmetric from 7.0 to about 5.5 mm.",
         closed_form(0.0065)},
        {"fig13", "Fig. 13", "Type V, three impacts per cycle, b = 4.6 mm",
         "The paper prints b = 4 mm, where the response is irregular from its initial state and "
         "from each of 200 random ones; three impacts per cycle hold from about 4.3 to 5.2 mm.",
         closed_form(0.0046)},
        {"fig14", "Fig. 14", "Type VI, irregular, about three impacts per cycle, b = 3 mm", "",
         closed_form(0.003)},
        {"table1", "Table 1", "the paper's parameters, with b = 22 mm",
         "The paper varies b. Its numbers come from zeta = epsilon lambda (closed_form); its "
         "equation of motion has half of that.",
         closed_form(0.022)},
    };
}

/// Rows of Table 2: windows of one motion.
void add_table_2(std::vector<Preset>& list) {
    const Json windows = {{18.13, 1708.9}, {1708.9, 3652.7}, {3652.7, 5521.3}};
    for (std::size_t row = 0; row < windows.size(); ++row) {
        const std::string number = std::to_string(row + 1);
        list.push_back(
            {"table2_" + number, "Table 2, row " + number,
             smr + ", b = 22 mm: window of the exponents",
             "The printed lambda3 is lambda1 - ln(1/2.2e-16)/T: rounding. By qr: minus infinity.",
             with(closed_form(0.022, 5521.3), {{"window", windows[row]}, {"windows", windows}})});
    }
}

/// Rows of Table 3: one half-width b each, over the time of about 400 contacts. The length of the
/// paper's windows follows from the printed lambda1 - lambda3, which is rounding (docs/paper.md).
/// At 22 mm it is printed in Table 2.
void add_table_3(std::vector<Preset>& list) {
    struct Row {
        const char* b;
        double tau_end;
    };
    constexpr Row rows[] = {
        {"0.040", 3900},       {"0.034", 3500}, {"0.031", 2900}, {"0.028", 2500}, {"0.025", 2200},
        {"0.022", window_end}, {"0.020", 1700}, {"0.018", 1600}, {"0.017", 1500}, {"0.0165", 1400}};
    for (const auto& [b, tau_end] : rows)
        list.push_back(
            {"table3_b" + std::string(b), "Table 3",
             (std::stod(b) > 0.032 ? "Type I" : smr) + ", b = " + Json(std::stod(b) * 1000).dump() +
                 " mm",
             "The printed lambda3 is lambda1 - ln(1/2.2e-16)/T, which is rounding; the length of "
             "the window follows from it: about 400 contacts. One window determines lambda1 to "
             "7 to 25 %. At 31 mm it is too short for a stretch of two impacts per cycle.",
             closed_form(std::stod(b), tau_end)});
}

/// The experiment, Table 4.
void add_experiments(std::vector<Preset>& list) {
    const std::string excitation =
        "Forced at resonance with G = 10 mm; the paper does not print its excitation.";
    for (int figure = 15; figure <= 24; ++figure) {
        const bool is_periodic = figure < 20;
        list.push_back(
            {"fig" + std::to_string(figure), "Fig. " + std::to_string(figure) + ", Table 4",
             is_periodic ? "experiment, b = 9 mm: two impacts per cycle"
                         : "experiment, b = 15 mm: chaotic strongly modulated response",
             excitation, is_periodic ? experiment(0.009, 100) : experiment(0.015, 170)});
    }
    list.push_back(
        {"table4", "Table 4", "experimental parameters, with b = 15 mm", excitation,
         experiment(0.015, 170)});
}

/// Machines under the laws and loads beyond the paper.
void add_machines(std::vector<Preset>& list) {
    const Json base = {{"m1", 12}, {"f0", 14}, {"damping_ratio", 0.01}, {"mass_ratio", 0.03}};
    const Json harmonic = with(base, {{"F", 0.0002}, {"f", 14}});
    list.push_back(
        {"shock", of_a_machine, "a hammer blow on a machine: the ball takes up 40 % of the energy",
         "A half sine of 3000 N over 5 ms. The motion after it is a free decay.",
         with(
             base,
             {{"b", 0.004},
              {"R", 0.6},
              {"y0", 0},
              {"tau_end", 300},
              {"forcing", {{"kind", "half_sine"}, {"force_N", 3000}, {"duration_s", 0.005}}}})});
    list.push_back(
        {"chirp", of_a_machine, "a platform whose base sweeps through its resonance",
         "A chirp from 10 to 18 Hz in a minute; series.x_relative is relative to the base.",
         with(
             base, {{"b", 0.006},
                    {"R", 0.6},
                    {"y0", 0},
                    {"forcing",
                     {{"kind", "chirp"},
                      {"displacement_m", 0.0002},
                      {"f_from", 10},
                      {"f_to", 18},
                      {"duration_s", 60}}}})});
    list.push_back(
        {"vertical", of_a_machine,
         "a vertical absorber: gravity returns the ball to the lower wall",
         "The ball falls along +x to the wall at x - y = -b, and is thrown from it.",
         with(
             harmonic,
             {{"b", 0.006}, {"R", 0.6}, {"inclination", std::numbers::pi / 2}, {"cycles", 300}})});
    list.push_back(
        {"friction", of_a_machine, "friction from which the ball never moves",
         "Twice its resonance frequency moves the machine too little: mu g exceeds the largest "
         "acceleration, and the ball adds its mass only.",
         with(
             base, {{"F", 0.0002},
                    {"f", 28},
                    {"b", 0.006},
                    {"R", 0.6},
                    {"mu", 0.3},
                    {"y0", 0},
                    {"cycles", 300}})});
}

constexpr const char* example_preset = "fig20";
constexpr double example_seconds = 20;

}  // namespace

const std::vector<Preset>& presets() {
    static const std::vector<Preset> list = [] {
        std::vector<Preset> all = figures();
        for (const auto add : {add_table_2, add_table_3, add_experiments, add_machines}) add(all);
        return all;
    }();
    return list;
}

Json describe_presets() {
    Json list = Json::array();
    for (const Preset& p : presets())
        list.push_back(
            {{"name", p.name},
             {"source", p.source},
             {"doi", p.source == of_a_machine ? Json(nullptr) : Json(doi)},
             {"title", p.title},
             {"note", p.note},
             {"parameters", p.parameters}});
    return {{"citation", citation}, {"doi", doi}, {"presets", std::move(list)}};
}

std::string example_record() {
    const SimulateRequest request = read_simulate_request({{"preset", example_preset}});
    const double omega0 = request.system.si->omega0();
    const MeasuredRecord record =
        synthetic_record(true_motion(request.wanted.parameters, omega0, 0, example_seconds), {});
    std::string csv = "time_s,displacement_m,acceleration_m_s2\n";
    for (std::size_t k = 0; k < record.tau.size(); ++k)
        fmt::format_to(
            std::back_inserter(csv), "{:.7f},{:.8e},{:.5e}\n", record.tau[k] / omega0, record.x[k],
            record.x_ddot[k] * omega0 * omega0);
    return csv;
}

}  // namespace vines::api
