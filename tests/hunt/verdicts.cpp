// Random systems; for each, a sweep point and simulations of 1, 2 and 4 times `measured_cycles`
// state a verdict and a period. A reference run of 20 times `measured_cycles` judges each
// statement:
// - wrong: the reference contradicts a confident statement, or longer runs contradict each other;
// - missed: the reference is periodic, and the statement does not report it; tori and chaotic
//   transients that are not reported are counted;
// - unjudged: the run is incomplete, or the reference ended before it became longer than the run.
#include "verdicts.hpp"

#include <atomic>
#include <cstdio>

#include "core/sweep/parallel.hpp"
#include "judgement.hpp"

namespace vines::hunt {

namespace {

constexpr int transient_cycles = 200, measured_cycles = 1000;
// Length of the reference run, relative to the shortest run under test.
constexpr int reference_factor = 20;
// Largest number of missed orbits per thousand periodic references.
constexpr int most_missed_per_thousand = 1;
constexpr int verdict_count = 4;
// Largest number of curves of a torus in the section that the reference looks for.
constexpr int most_curves = 12;

struct Findings {
    std::string report;  ///< description of the errors
    int wrong = 0, statements = 0, unjudged = 0;
    int verdicts[verdict_count] = {};  ///< statements of each Verdict, in the order of the enum
    int periodic = 0;                  ///< statements whose reference is periodic
    int missed = 0;                    ///< those of them that do not report it
    int tori = 0, tori_missed = 0;     ///< the same of tori
    int transients = 0, transients_missed = 0;  ///< the same of chaos before a capture
};

void add(
    Findings& f, const char* kind, const Statement& s, const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences) {
        ++f.wrong;
        f.report +=
            "WRONG  " + s.interface + ", " + kind + ": " + sentence + "\n    " + s.request + "\n";
    }
}

/// A long run, with the curves of its section if it lies on a torus.
struct Reference {
    LongRun run;
    std::optional<SectionCurve> curve;

    Reference(const Parameters& p, const State& start)
        : run(p, start, reference_factor * measured_cycles) {
        if (torus_possible(run)) curve = section_curve(p, run, run.cycles() / 4, most_curves);
    }
};

void judge_statement(
    const Parameters& p, const Statement& s, const Reference& reference, const char* kind,
    Findings& f) {
    const LongRun& run = reference.run;
    if (!s.complete || run.cycles() <= s.cycles) {
        ++f.unjudged;
        return;
    }
    ++f.statements;
    ++f.verdicts[static_cast<int>(s.verdict)];
    const Judgement j = judge(p, s, run, reference.curve);
    add(f, kind, s, j.wrong);
    if (j.recurrent > 0) ++f.periodic;
    f.tori += j.torus, f.tori_missed += j.torus_missed;
    f.transients += j.transient, f.transients_missed += j.transient_missed;
    if (!j.missed) return;
    ++f.missed;
    f.report += "MISSED " + s.interface + ", " + kind + ": the state returns every " +
                std::to_string(j.recurrent) + " cycles\n    " + s.request + "\n";
}

/// Checks random system `number` of the series `seed`.
Findings hunt_one(std::uint64_t seed, int number) {
    std::mt19937_64 engine = engine_of(seed, number);
    const Kind kind = random_kind(engine);
    const System system = random_system(kind, engine);
    Findings f;
    const Statement point = sweep_point(system, transient_cycles, measured_cycles);
    judge_statement(
        system.parameters, point, Reference(system.parameters, point.start), name_of(kind), f);

    const Reference from_start(system.parameters, system.start);
    std::vector<Statement> runs;
    for (int cycles : {measured_cycles, 2 * measured_cycles, 4 * measured_cycles}) {
        runs.push_back(simulation(system, cycles));
        if (!runs.back().complete) {
            runs.pop_back();
            break;
        }
        judge_statement(system.parameters, runs.back(), from_start, name_of(kind), f);
    }
    if (!runs.empty()) add(f, name_of(kind), runs.back(), contradictions(runs, from_start.run));
    return f;
}

}  // namespace

bool hunt_verdicts(int systems, std::uint64_t seed, int first, int threads) {
    std::vector<Findings> found(static_cast<std::size_t>(systems));
    std::atomic<int> done = 0;
    parallel(found.size(), threads, nullptr, [&](std::size_t i) {
        const int number = first + static_cast<int>(i);
        found[i] = hunt_one(seed, number);
        if (!found[i].report.empty()) {
            std::printf("system %d\n%s", number, found[i].report.c_str());
            std::fflush(stdout);
        }
        if (++done % 100 == 0) std::fprintf(stderr, "%d of %d systems\n", done.load(), systems);
    });
    Findings all;
    int systems_wrong = 0;
    for (const Findings& f : found) {
        systems_wrong += f.wrong > 0;
        all.wrong += f.wrong;
        all.statements += f.statements;
        all.unjudged += f.unjudged;
        all.periodic += f.periodic;
        all.missed += f.missed;
        all.tori += f.tori;
        all.tori_missed += f.tori_missed;
        all.transients += f.transients;
        all.transients_missed += f.transients_missed;
        for (int k = 0; k < verdict_count; ++k) all.verdicts[k] += f.verdicts[k];
    }
    std::printf(
        "%d systems, %d statements (chaotic %d, regular %d, not decided %d, no motion to judge %d; "
        "%d incomplete runs skipped): %d "
        "wrong with confidence in %d systems, %d of %d periodic orbits, %d of %d tori, %d of %d "
        "chaotic transients missed\n",
        systems, all.statements, all.verdicts[0], all.verdicts[1], all.verdicts[2], all.verdicts[3],
        all.unjudged, all.wrong, systems_wrong, all.missed, all.periodic, all.tori_missed, all.tori,
        all.transients_missed, all.transients);
    return all.wrong == 0 && 1000L * all.missed <= most_missed_per_thousand * all.periodic;
}

}  // namespace vines::hunt
