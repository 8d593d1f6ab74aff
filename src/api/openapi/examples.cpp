// Examples: requests that are valid as they stand, and real responses, copied from the service.
#include <algorithm>
#include <iterator>
#include <string_view>

#include "api/format/answer_request.hpp"
#include "api/openapi/parts.hpp"

namespace vines::api::document {

namespace {

struct Example {
    std::string_view name;  ///< of the operation or the schema
    std::string_view json;
};

constexpr Example requests[] = {
    {"simulate_by_query", R"({"preset": "fig11", "include": ["regime", "energy"]})"},
    {"manifold_by_query", R"({"preset": "fig11", "points": 5})"},
    {"simulate", R"({
        "figure": {
            "summary": "energies in Fig. 11 of the paper",
            "value": {"preset": "fig11", "include": ["energy"]}},
        "machine": {
            "summary": "a platform of 12 kg with an absorber of 1 % of its mass, in SI",
            "value": {"m1": 12, "f0": 14, "damping_ratio": 0.006, "mass_ratio": 0.01, "F": 0.0004,
                "f": 14, "R": 0.4, "b": 0.03, "include": ["impacts", "exponents", "regime"]}},
        "perturbed": {
            "summary": "two runs with slightly different starts",
            "value": {"b": 0.022, "tau_end": 400, "perturbation": {"size": 1e-8}}}})"},
    {"manifold", R"({
        "default": {"summary": "system of Table 1", "value": {"points": 3}}})"},
    {"sweep", R"({
        "clearances": {
            "summary": "four values of the clearance b",
            "value": {"base": {"damping": "closed_form"}, "cycles": 500,
                "axes": [{"parameter": "b", "from": 0.006, "to": 0.015, "count": 4}]}},
        "worst motion": {
            "summary": "the largest peak of x between 13 and 15 Hz over the default set of starts",
            "value": {"base": {"m1": 12, "f0": 14, "damping_ratio": 0.006, "mass_ratio": 0.01,
                "F": 0.0004, "R": 0.4, "b": 0.03}, "starts": "default set",
                "reduce": "max over f", "cycles": 200,
                "axes": [{"parameter": "f", "from": 13, "to": 15, "count": 9}]}}})"},
    {"identify", R"(
        {"impacts": {
            "summary": "a list of impacts, in SI: x in m, velocities in m/s",
            "value": {"preset": "fig20", "b": 0.015, "exponents": ["qr"], "impacts": {
                "time_s": [1.403385, 1.461862, 1.607638, 1.984774, 2.058772],
                "x": [0.0004349904, -0.0006110741, 0.002128898, 0.002552786, -0.001091305],
                "x_velocity_before": [-0.1111193, 0.1141878, 0.05954217, -0.0625302, 0.1405365],
                "x_velocity_after": [-0.1126914, 0.1123261, 0.06186857, -0.06275421, 0.1378615]
            }}}})"},
};

constexpr Example answers[] = {
    {"Simulation", R"json(
        {"version": "0.2.0", "parameters": {"epsilon": 0.008405568689256633, "lambda":
        1.427383130909598, "G": 0.02, "Omega": 1.0, "R_plus": 0.6, "R_minus": 0.6, "b": 0.015,
        "damping": "closed_form", "origin": {"G": "default", "Omega": "default", "R_minus":
        "default", "R_plus": "default", "b": "preset fig11", "cycles": "follows from tau_end",
        "damping": "preset fig11", "epsilon": "default", "lambda": "default", "max_impacts":
        "default", "max_points": "default", "samples_per_cycle": "default", "section_phase":
        "default", "tau_end": "preset fig11", "window": "default", "x0": "default", "x_dot0":
        "default", "y0": "default", "y_dot0": "default"}, "x0": 0.0, "x_dot0": 0.0, "y0":
        0.014249999999999999, "y_dot0": 0.0, "tau_end": 1708.9, "cycles": 271.97988224973994,
        "window": [0.0, 1708.9], "samples_per_cycle": 32.0, "section_phase": 0.0, "max_points":
        20000, "max_impacts": 100000, "derived": {"zeta": 0.011997966952746818, "omega_d":
        0.99992802180407, "A": 0.020001439460308842, "phi": 0.01199739129517517, "cycle":
        6.283185307179586}}, "status": {"reason": "tau_end", "tau": 1708.9, "message":
        "the run is complete"}, "warnings": [], "sticking": {"side": [1], "tau_start":
        [76.218681995522], "tau_end": [76.93258276016763], "impacts": [43]}, "energy": {"window":
        [0.0, 1708.9], "input": 0.0003832565844363229, "damper": 0.00015595402733830385,
        "impacts": 0.00022344359270527823, "stored": 3.858964392740874e-06, "residual":
        -4.828087799349512e-20, "share_impacts": 0.5889430531472782, "at_start": 0.0, "at_end":
        3.858964392740874e-06, "rms": 0.0019503445624733475, "peak": 0.004412822703226359,
        "without_absorber": {"rms": 0.0047694437883577185, "peak": 0.00700633172747234,
        "amplitude": 0.0070063317364423925}, "rms_ratio": 0.4089249499562542, "peak_ratio":
        0.6298335384154533}})json"},
    {"Manifold", R"json(
        {"version": "0.2.0", "parameters": {"epsilon": 0.008405568689256633, "lambda":
        1.427383130909598, "G": 0.02, "Omega": 1.0, "R_plus": 0.6, "R_minus": 0.6, "b": 0.022,
        "damping": "equation_of_motion", "origin": {"G": "default", "Omega": "default", "R_minus":
        "default", "R_plus": "default", "b": "default", "damping": "default", "epsilon":
        "default", "lambda": "default"}, "derived": {"zeta": 0.005998983476373409, "omega_d":
        0.9999820059367319, "A": 0.020001439460308842, "phi": 0.01199739129517517, "cycle":
        6.283185307179586}}, "warnings": [], "manifold": {"R": 0.6, "Omega": 1.0, "b": 0.022,
        "fold": {"C": 0.0034578879605069762, "V": 0.013659632459848988}, "activation_amplitude":
        0.0034578879605069762, "symmetry_breaking": {"C": 0.01610707719387171, "V":
        0.023550152158856964}, "second_contact": {"C": 0.08784275243568175, "V":
        0.06884417141336961}, "stable_ends_by": "symmetry_breaking", "stable": {"C":
        [0.0034578879605069767, 0.008592277101729193, 0.01610707719387171], "V":
        [0.013659632459848988, 0.018604892309352975, 0.023550152158856964]}, "unstable": {"C":
        [0.022, 0.011400339550231139, 0.0034578879605069767], "V": [0.0, 0.006829816229924494,
        0.013659632459848988]}, "asymmetric": {"C": [0.01610707719387171, 0.034633619621815485,
        0.053301886303371945], "V": [0.023550152158856964, 0.03532522823828545,
        0.04710030431771393]}, "free_amplitude": 0.014012663472884785, "b_at_free_amplitude":
        0.08915228021392202, "recommended": {"b": 0.0133728420320883, "fold_share": 0.15,
        "x_rms_ratio": 0.39762881873188344, "x_max": 0.005579549947188446, "regime": "III",
        "start": "moving"}}})json"},
    {"SweepLine", R"json(
        {"type": "point", "index": 3, "b": 0.015, "lambda": [-0.017292164199193074,
        -0.017714767132891843, -0.1567136890297202, -0.1574770058647871], "status": ["ok", "ok",
        "ok", "ok"], "standard_error": [0.0006590601740416505, 0.00012351049050881354,
        0.00028940522091801507, 0.0007839464854422758], "verdict": "regular", "z": 2.0, "regime":
        "III", "periodic": true, "period_cycles": 1, "impacts_per_period": 2, "symmetric": true,
        "capture_cycle": 0.0, "multiplier": 0.8939384886493448, "synchronised": 1.0, "x_max":
        0.0026225699229105825, "x_rms": 0.0018494877730348767, "x_rms_ratio": 0.3733152797297098,
        "x_free": 0.0070063317364423925, "share_impacts": 0.6208537885311941, "impacts": 1000,
        "sticks": 0, "reason": "complete", "second_start": {"start": "middle", "state": {"x0":
        0.0, "x_dot0": 0.0, "y0": 0.0, "y_dot0": 0.0}, "x_max": 0.007006331736442396, "x_rms":
        0.004954224645060263, "regime": "none", "verdict": null, "z": 0.0, "lambda1": null},
        "depends_on_start": true})json"},
    {"Identification",
     R"json(
        {"version": "0.2.0", "parameters": {"epsilon": 0.007677543186180422, "lambda":
        1.7990329215777745, "G": 0.010000021960875441, "Omega": 1.0, "R_plus": 0.8499869280560888,
        "R_minus": 0.8500001916130229, "b": 0.015, "damping": "equation_of_motion", "origin":
        {"F": "fitted to the impacts", "G": "fitted to the impacts", "Omega":
        "follows from f, k1, m1", "R_minus": "estimated from the impacts", "R_plus":
        "estimated from the impacts", "b": "given", "c1": "preset fig20", "damping":
        "preset fig20", "epsilon": "follows from m2, m1", "f": "preset fig20", "k1":
        "preset fig20", "lambda": "follows from c1, k1, m1, m2", "m1": "preset fig20", "m2":
        "preset fig20"}, "si": {"m1": 4.168, "c1": 3.02, "k1": 11470.0, "m2": 0.032, "F":
        7.677560046737383e-05, "f": 8.349067754204674}, "derived": {"zeta": 0.00690607647438685,
        "omega_d": 0.9999761527695198, "A": 0.010000975795325733, "phi": 0.013811274708853198,
        "cycle": 6.283185307179586, "omega0": 52.45873984186567, "f0": 8.349067754204674,
        "damping_ratio": 0.00690607647438685, "mass_ratio": 0.007677543186180422, "cycle_s":
        0.11977385133764067}}, "impacts": {"tau": [73.61980861297666, 76.68743834270944,
        84.33466360189723, 104.1187429108991, 108.00058474171746], "side": [1, 1, -1, 1, 1], "x":
        [0.0004349904, -0.0006110741, 0.002128898, 0.002552786, -0.001091305], "x_dot_before":
        [-0.0021182228230217453, 0.002176716412636171, 0.001135028599228403,
        -0.001191988221381113, 0.0026789911542602907], "x_dot_after": [-0.0021481911372576382,
        0.0021412275692973483, 0.0011793758330165727, -0.0011962584345176711,
        0.002627998697940073], "x_ddot_before": [-0.00048107798120746, 0.0006550547645106404,
        -0.0021094889601623607, -0.0025704066941613464, 0.0011258727621065564], "y_dot_before":
        [null, -0.00034100090042194213, 0.004281287786137125, -0.0014949450787200749,
        -0.0009387530865037236], "y_dot_after": [-0.00034100090042194213, 0.004281287786137125,
        -0.0014949450787200749, -0.0009387530865037236, null], "R": [null, 0.8500001988866575,
        0.8500001916130229, 0.8499736572255201, null], "momentum_error": [null,
        -2.8807046834242753e-05, -1.2253204665508019e-06, -7.071661679366508e-07, null], "status":
        ["R is not known", "ok", "ok", "ok", "R is not known"], "time_s": [1.403385,
        1.4618620000000002, 1.607638, 1.9847740000000003, 2.058772], "x_velocity_before":
        [-0.1111193, 0.11418780000000002, 0.059542170000000005, -0.0625302, 0.1405365],
        "x_velocity_after": [-0.1126914, 0.1123261, 0.06186857, -0.06275421000000002, 0.1378615],
        "y_velocity_before": [null, -0.017888477521076605, 0.22459096216112448,
        -0.07842293496245381, -0.04924580394064726], "y_velocity_after": [-0.017888477521076605,
        0.22459096216112448, -0.07842293496245381, -0.04924580394064726, null],
        "x_acceleration_before": [-1.323887822564675, 1.8026579052152218, -5.805143563594595,
        -7.0735520110438195, 3.0983110799813343]}, "sticking": {"side": [], "tau_start": [],
        "tau_end": [], "impacts": [], "time_start_s": [], "time_end_s": []}, "restitution":
        {"plus": {"R": 0.8499869280560888, "standard_error": 1.739070208755082e-05, "impacts": 2},
        "minus": {"R": 0.8500001916130229, "standard_error": 0.0, "impacts": 1}}, "b_fitted":
        {"b": null, "standard_error": null}, "exponents": {"window": [73.61980861297666,
        108.00058474171746], "impacts": 5, "sum_rule_residual": 3.2291970968539577e-18, "qr":
        {"final": [0.28128864639595036, -0.00014539576468680654, -0.0482077094958919,
        -0.2845665976921973], "status": ["ok", "ok", "ok", "ok"], "standard_error": [null, null,
        null, null], "history": {"tau": [76.68743834270944, 84.33466360189723, 104.1187429108991,
        108.00058474171746], "lambda1": [0.23741408792127178, 0.26946324800140614,
        0.2753870121763359, 0.28128864639595036], "lambda2": [0.22942957050090465,
        0.006020888458494494, -0.004699074014266503, -0.00014539576468680654], "lambda3":
        [0.07331829915110005, -0.10284871204609097, -0.06141567182641272, -0.0482077094958919],
        "lambda4": [-0.6599414681846908, -0.2471209159715331, -0.255058475561608,
        -0.2845665976921973], "time_s": [1.4618620000000002, 1.607638, 1.9847740000000003,
        2.058772]}}, "stretches": {"tau_start": [73.61980861297666], "tau_end":
        [108.00058474171746], "time_start_s": [1.403385], "time_end_s": [2.058772]}, "duration":
        34.380776128740806, "window_s": [1.403385, 2.058772]}, "slope": {"lambda1": null, "low":
        null, "high": null}, "verdict": "not_decided", "verdict_reason":
        "the record is too short for a verdict: the slope's 90 % interval contains the )json"
     R"json(oscillator's own damping zeta, or there are too few impacts (chaotic needs 24; )json"
     R"json(regular needs 200, or 80 with similar jumps, since a chaotic motion can be )json"
     R"json(synchronised for a while)", "warnings": []})json"},
    {"Version", R"json(
        {"name": "vines", "version": "0.2.0", "commit": "fcd41c5a1b2c", "compiler": "g++ 12.2.0"}
    )json"},
    {"Status", R"({"status": "ok"})"},
};

/// Responses with a provenance block. It contains the commit of this build, so it is computed here
/// instead of stored. The stored response answers the first example of `operation` in key order.
struct AnswerWithProvenance {
    const char *schema, *operation, *route;
};
constexpr AnswerWithProvenance answers_with_provenance[] = {
    {"Simulation", "simulate", "/v1/simulate"},
    {"Manifold", "manifold", "/v1/manifold"},
    {"Identification", "identify", "/v1/identify"}};

template <std::size_t n>
Json example_of(const Example (&table)[n], std::string_view name) {
    for (const Example& example : table)
        if (example.name == name) return Json::parse(example.json);
    return nullptr;
}

}  // namespace

Json request_example(const char* operation) { return example_of(requests, operation); }

Json answer_example(const char* schema) {
    Json example = example_of(answers, schema);
    const auto found = std::find_if(
        std::begin(answers_with_provenance), std::end(answers_with_provenance),
        [schema](const AnswerWithProvenance& answer) {
            return answer.schema == std::string_view(schema);
        });
    if (found == std::end(answers_with_provenance)) return example;
    const Json request = request_example(found->operation).begin()->at("value");
    const AnswerRequest answer_request =
        read_answer_request(found->route, request, {.text = request.dump(), .is_columns = false});
    example["provenance"] = describe(answer_request.provenance, sha256(example.dump()));
    return example;
}

}  // namespace vines::api::document
