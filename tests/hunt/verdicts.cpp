#include "verdicts.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "core/sweep/parallel.hpp"
#include "judgement.hpp"

namespace vines::hunt {

namespace {

constexpr int transient = 200, measured = 1000;
// Length of the reference run, relative to the shortest run under test.
constexpr int longer = 20;

struct Findings {
    std::string report;  ///< description of the errors
    int wrong = 0, statements = 0, unjudged = 0;
    int verdicts[4] = {};
    int recurrent = 0, missed = 0, longest = 0;
};

void add(
    Findings& f, const char* kind, const Statement& s, const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences) {
        ++f.wrong;
        f.report +=
            "WRONG  " + s.interface + ", " + kind + ": " + sentence + "\n    " + s.request + "\n";
    }
}

void judge_statement(
    const Parameters& p, const Statement& s, const LongRun& run, const char* kind, Findings& f) {
    if (!s.complete || run.cycles() <= s.cycles) {
        ++f.unjudged;
        return;
    }
    ++f.statements;
    ++f.verdicts[static_cast<int>(s.verdict)];
    const Judgement j = judge(p, s, run);
    add(f, kind, s, j.wrong);
    if (j.recurrent > 0) ++f.recurrent;
    f.longest = std::max(f.longest, j.recurrent);
    if (!j.missed) return;
    ++f.missed;
    f.report += "MISSED " + s.interface + ", " + kind + ": the state returns every " +
                std::to_string(j.recurrent) + " cycles\n    " + s.request + "\n";
}

Findings hunt_one(std::uint64_t seed, int number) {
    std::mt19937_64 engine = engine_of(seed, number);
    const Kind kind = random_kind(engine);
    const System system = random_system(kind, engine);
    Findings f;
    const Statement point = sweep_point(system, transient, measured);
    judge_statement(
        system.parameters, point, LongRun(system.parameters, point.start, longer * measured),
        name_of(kind), f);

    const LongRun from_start(system.parameters, system.start, longer * measured);
    std::vector<Statement> runs;
    for (int cycles : {measured, 2 * measured, 4 * measured}) {
        runs.push_back(simulation(system, cycles));
        if (!runs.back().complete) {
            runs.pop_back();
            break;
        }
        judge_statement(system.parameters, runs.back(), from_start, name_of(kind), f);
    }
    if (!runs.empty()) add(f, name_of(kind), runs.back(), contradictions(runs, from_start));
    return f;
}

}  // namespace

bool hunt_verdicts(int systems, std::uint64_t seed, int first, int threads) {
    std::vector<Findings> found(static_cast<std::size_t>(systems));
    std::atomic<int> done = 0;
    parallel(found.size(), threads, [&](std::size_t i) {
        const int number = first + static_cast<int>(i);
        found[i] = hunt_one(seed, number);
        if (!found[i].report.empty())
            std::printf("system %d\n%s", number, found[i].report.c_str()), std::fflush(stdout);
        if (++done % 100 == 0) std::fprintf(stderr, "%d of %d systems\n", done.load(), systems);
    });
    Findings all;
    int systems_wrong = 0;
    for (const Findings& f : found) {
        systems_wrong += f.wrong > 0;
        all.wrong += f.wrong, all.statements += f.statements, all.unjudged += f.unjudged,
            all.recurrent += f.recurrent, all.missed += f.missed;
        for (int k = 0; k < 4; ++k) all.verdicts[k] += f.verdicts[k];
    }
    std::printf(
        "%d systems, %d statements (chaotic %d, regular %d, not decided %d, nothing to judge %d; "
        "%d runs cut short and not judged): %d "
        "wrong with confidence in %d systems, %d of %d periodic orbits missed\n",
        systems, all.statements, all.verdicts[0], all.verdicts[1], all.verdicts[2], all.verdicts[3],
        all.unjudged, all.wrong, systems_wrong, all.missed, all.recurrent);
    return all.wrong == 0 && 1000L * all.missed <= all.recurrent;
}

}  // namespace vines::hunt
