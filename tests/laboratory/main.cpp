// Makes the table of docs/measurements.md: the error of identification under each effect of a
// measuring chain.
//
//     scripts/laboratory --seeds 3 --seconds 20 --only Butterworth
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <numbers>

#include "effects.hpp"
#include "many_impacts.hpp"
#include "score.hpp"

namespace {

const char* words_of(vines::Verdict verdict) {
    switch (verdict) {
        case vines::Verdict::regular: return "regular";
        case vines::Verdict::chaotic: return "chaotic";
        case vines::Verdict::none: return "none";
        case vines::Verdict::not_decided: break;
    }
    return "not decided";
}

/// Identifies random regular motions with three to eight impacts per cycle; returns the exit code.
int identify_many_impacts(int systems, std::uint64_t first_seed) {
    using namespace vines::test;
    fmt::print("| seed | impacts per cycle | found of | false | R off by | b off by | verdict |\n");
    fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
    int found = 0, wrong = 0;
    for (int k = 0; k < systems; ++first_seed) {
        const auto motion = motion_with_many_impacts(first_seed);
        if (!motion) continue;
        ++k;
        const Score s = score_of(experiment_of(*motion));
        const bool complete = 100 * (s.found - s.flipped) >= 99 * s.impacts;
        found += complete;
        // A b is withheld where a doubt remains.
        wrong += !complete && (s.b_error == s.b_error || s.verdict_wrong);
        const vines::Parameters& p = motion->parameters;
        const double cycles = motion->seconds * motion->omega0 * p.Omega / (2 * std::numbers::pi);
        fmt::print(
            "| {} | {:.1f} | {} of {} | {} | {:.4f} | {:.2f} % | {} |{}\n", first_seed,
            static_cast<double>(s.impacts) / cycles, s.found - s.flipped, s.impacts, s.false_ones,
            s.R_error, 100 * s.b_error, words_of(s.verdict), complete ? "" : " !");
        std::fflush(stdout);
    }
    fmt::print("\n{} of {} found, {} wrong with confidence\n", found, systems, wrong);
    return wrong > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace vines;
    using namespace vines::test;
    int seeds = 1, first_seed = 1;
    double seconds = 20, R = 0.85, settling = 0;
    std::vector<double> widths = {0.015, 0.009};
    std::string only;
    int many_impacts = 0;
    CLI::App app(
        "Identifies records of a simulated laboratory and compares the results with the truth");
    app.add_option("--seeds", seeds, "number of records for each effect and b");
    app.add_option("--first-seed", first_seed, "seed of the first record");
    app.add_option("--seconds", seconds, "length of a record");
    app.add_option("--b", widths, "clearance b, m");
    app.add_option("--R", R, "coefficient of restitution of both walls");
    app.add_option(
        "--settling", settling,
        "s from the start to the record; default: a settled part of the motion without sticking");
    app.add_option("--only", only, "only effects whose names contain this text");
    app.add_option(
        "--many-impacts", many_impacts,
        "instead: this many random regular motions with three to eight impacts per cycle");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    if (many_impacts > 0)
        return identify_many_impacts(many_impacts, static_cast<std::uint64_t>(first_seed));
    fmt::print(
        "| effect | b, mm | found of | false | within .1 ms | R off by | b off by | lambda1 off by "
        "| verdict | s |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    int right = 0, wrong_verdicts = 0, records = 0;
    for (const double b : widths) {
        const TrueMotion motion = settling > 0 ? motion_after(settling, b, R, R, seconds)
                                               : settled_motion(b, R, R, seconds);
        for (const LaboratoryEffect& effect : laboratory_effects()) {
            if (effect.name.find(only) == std::string::npos) continue;
            for (int k = 0; k < seeds; ++k) {
                Sensors sensors = effect.sensors;
                sensors.seed = static_cast<std::uint64_t>(first_seed + k);
                const Score s = score_of(measured(motion, sensors, effect.given_errors));
                ++records, right += s.is_right(), wrong_verdicts += s.verdict_wrong;
                fmt::print(
                    "| {} | {:g} | {} of {} | {} | {:.1f} % | {:.4f} | {:.2f} % | {:.1f} % | {}{} "
                    "| {:.2f} |{}\n",
                    effect.name, 1000 * b, s.found - s.flipped, s.impacts, s.false_ones,
                    100 * s.within_100_us, s.R_error, 100 * s.b_error, 100 * s.lambda1_error,
                    words_of(s.verdict), s.verdict_wrong ? " (wrong)" : "", s.seconds,
                    s.is_right() ? "" : " !");
                std::fflush(stdout);
            }
        }
    }
    fmt::print("\n{} of {} right, {} wrong verdicts\n", right, records, wrong_verdicts);
    return wrong_verdicts > 0 ? 1 : 0;
}
