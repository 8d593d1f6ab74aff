#include "judgement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vines::hunt {

namespace {

// Longest period that must be found.
constexpr int longest_sought = 64;
// Distances from an orbit, relative to the size of the motion: so close that the orbit attracts the
// motion; and the largest at which a capture can be reported.
constexpr double next_to = 0.01, around = 0.5;
// The time of capture depends on the norm: a difference of 1 % is not an error.
constexpr double capture_time_tolerance = 0.01;
// In chaos a deviation grows by more e-folds than this over the whole long run. On a torus it grows
// in proportion to the number of cycles, in a slow approach even less.
constexpr double least_growth = 25;
constexpr double sigmas = 5;
// Growth before a capture, as a logarithm, that is a chaotic transient, and that which is none.
constexpr double chaotic_transient = 40, no_transient = 15;
// On a torus the length of a deviation varies by fewer e-folds than this.
constexpr double most_shrinking = 7;
// Among the points of a closed curve none is as close to another as this.
constexpr double no_chance_return = 1e-8;
// Largest distance from the curve of a quasi-periodic motion, relative to its size.
constexpr double off_the_curve = 0.01;
constexpr double rotation_tolerance = 1e-7;

template <class... Values>
std::string sentence(const char* format, Values... values) {
    char text[300];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

/// Returns whether the motion is irregular over an interval of the long run.
bool chaotic(const LongRun& run, int from, int to) {
    if (to - from < 100) return false;
    const auto exponent = run.exponent(from, to);
    return run.growth(from, to) > 2 * least_growth && exponent.lambda1 > sigmas * exponent.error;
}

const char* type_expected(int period, int impacts, bool symmetric) {
    if (impacts == 0) return "none";
    if (impacts != 2 * period) return "V";
    return period == 1 && symmetric ? "III" : "IV";
}

void judge_orbit(
    const Parameters& p, const Statement& s, const LongRun& run, int period,
    std::vector<std::string>& wrong) {
    const int end = run.cycles();
    if (period == 0) {
        if (chaotic(run, s.cycles, end)) {
            const auto exponent = run.exponent(s.cycles, end);
            wrong.push_back(sentence(
                "periodic (%d cycles) is reported, but the run remains irregular: lambda1 = %.4g "
                "+- %.2g "
                "over "
                "the next %d cycles",
                s.period, exponent.lambda1, exponent.error, end - s.cycles));
        } else if (
            end > s.period &&
            run.miss(end, s.period) >
                std::max(1e-3, run.miss(s.cycles, std::min(s.period, s.cycles)))) {
            wrong.push_back(sentence(
                "periodic (%d cycles) is reported, but the run does not return: it misses by %.2g, "
                "at the end of the long run by %.2g",
                s.period, run.miss(s.cycles, std::min(s.period, s.cycles)),
                run.miss(end, s.period)));
        }
        return;
    }
    const int captured = run.captured_from(period, around);
    if (s.captured_at && captured > s.cycles) {
        wrong.push_back(sentence(
            "periodic (%d cycles) is reported, but the run is captured only at cycle %d, by %d "
            "cycles",
            s.period, captured, period));
    } else if (s.period != period) {
        wrong.push_back(
            sentence("a period of %d cycles is reported, but it is %d", s.period, period));
    } else {
        if (s.captured_at && captured > *s.captured_at + 1 + capture_time_tolerance * captured)
            wrong.push_back(sentence(
                "a capture at cycle %.0f is reported, but the run leaves the orbit until cycle %d",
                *s.captured_at, captured));
        const auto contacts = run.contacts_at_end(period);
        // After a complete chatter the walls' R no longer matter, but during it they do.
        const bool walls_differ = p.R_plus != p.R_minus && contacts.impacts > 0,
                   symmetric = !walls_differ && run.ends_symmetric(period);
        if (s.symmetric != symmetric)
            wrong.push_back(sentence(
                "symmetric: %d is reported for a period of %d cycles, the opposite is true",
                s.symmetric, period));
        const char* type = p.G > 0 ? type_expected(period, contacts.impacts, symmetric) : "none";
        if (contacts.sticks == 0 && s.type != type)
            wrong.push_back(sentence(
                "type %s is reported for %d impacts in %d cycles, but it is %s", s.type.c_str(),
                contacts.impacts, period, type));
    }
}

void judge_transient(const Statement& s, const LongRun& run, int period, Judgement& j) {
    if (period == 0 || !s.periodic) return;
    const auto rise = run.rise(0, std::min(run.captured_from(period, next_to), s.cycles));
    j.transient = rise.sustained > chaotic_transient;
    j.transient_missed = j.transient && !s.chaotic_before;
    if (j.transient_missed && s.verdict == Verdict::regular && s.covers_start &&
        s.captured_at > 1.0)
        j.wrong.push_back(sentence(
            "regular is reported without chaos before the capture, but deviations grow by %.1f "
            "e-folds before it",
            rise.sustained));
    if (s.chaotic_before && rise.whole < no_transient)
        j.wrong.push_back(sentence(
            "chaos before the capture is reported, but deviations grow by %.1f e-folds at most",
            rise.whole));
}

void judge_torus(
    const Statement& s, const LongRun& run, int period, const std::optional<SectionCurve>& curve,
    std::vector<std::string>& wrong) {
    const Statement::QuasiPeriodic& q = *s.quasi_periodic;
    const int end = run.cycles();
    const auto add = [&](const std::string& why) {
        wrong.push_back(
            sentence(
                "quasi-periodic (rotation number %.9g +- %.2g, %d curves) is reported, but ",
                q.rotation_number, q.error, q.curves) +
            why);
    };
    const double growth = run.growth(s.cycles, end);
    if (s.verdict != Verdict::regular) add("the verdict is not regular");
    if (period > 0) add(sentence("the long run returns every %d cycles", period));
    else if (growth > least_growth)
        add(sentence("deviations grow by %.1f e-folds in the long run", growth));
    else if (growth < -most_shrinking)
        add(sentence("deviations shrink by %.1f e-folds in the long run", -growth));
    else if (run.closest_return(s.cycles) < no_chance_return)
        add(sentence("the long run returns to within %.1g", run.closest_return(s.cycles)));
    else if (!curve) add("the section of the long run is no smooth closed curve");
    else if (curve->curves != q.curves) add(sentence("there are %d", curve->curves));
    else if (curve->farthest > off_the_curve)
        add(sentence("the long run leaves the curve by %.2g", curve->farthest));
    else {
        double miss = INFINITY;
        for (const double sign : {1., -1.}) {
            const double difference = sign * q.rotation_number * q.curves - curve->rotation;
            miss = std::min(miss, std::abs(difference - std::round(difference)) / q.curves);
        }
        if (miss > 5 * q.error + rotation_tolerance + 3 * curve->error)
            add(sentence(
                "it is %.9g +- %.1g: %.2g off", std::abs(curve->rotation) / q.curves, curve->error,
                miss));
    }
}

void judge_verdict(
    const Statement& s, const LongRun& run, int period, std::vector<std::string>& wrong) {
    const int end = run.cycles(), captured = period > 0 ? run.captured_from(period, next_to) : end;
    if (s.verdict == Verdict::regular) {
        const int from = s.covers_start ? 0 : s.cycles;
        if (chaotic(run, from, captured) && captured > s.cycles) {
            const auto exponent = run.exponent(from, captured);
            wrong.push_back(sentence(
                "regular is reported, but the run is irregular from cycle %d to %d: lambda1 = %.4g "
                "+- %.2g",
                from, captured, exponent.lambda1, exponent.error));
        }
    } else if (s.verdict == Verdict::chaotic) {
        if (period > 0 && captured <= 1)
            wrong.push_back(sentence(
                "chaotic is reported for a run that is always on an orbit of %d cycles", period));
        else if (
            run.growth(0, captured) < least_growth && (captured <= s.cycles || captured == end))
            wrong.push_back(sentence(
                "chaotic is reported, but a deviation grows only by %.1f e-folds in the %d cycles "
                "up "
                "to %s",
                run.growth(0, captured), captured,
                period > 0 ? "the capture" : "the end of the long run"));
        else if (run.growth(0, std::min(captured, s.cycles)) <= 0)
            wrong.push_back(sentence(
                "chaotic is reported, but a deviation has shrunk by %.1f e-folds",
                -run.growth(0, std::min(captured, s.cycles))));
        else if (!chaotic(run, 0, captured) && run.returns_throughout(0, s.cycles))
            wrong.push_back("chaotic is reported for a motion that always returns");
    }
    if (s.verdict == Verdict::regular && s.lambda1 > student_three_sigma * s.error &&
        !s.chaotic_before && !s.periodic &&
        !(s.quasi_periodic && run.growth(0, s.cycles) < least_growth))
        wrong.push_back(
            sentence("regular is reported with lambda1 = %.4g +- %.2g", s.lambda1, s.error));
    if (s.verdict == Verdict::chaotic && s.lambda1 < 0)
        wrong.push_back(
            sentence("chaotic is reported with lambda1 = %.4g +- %.2g", s.lambda1, s.error));
    if (s.verdict == Verdict::chaotic && s.periodic && !s.chaotic_before)
        wrong.push_back(
            "chaotic is reported for a periodic motion without chaos before its capture");
    if (s.verdict == Verdict::none && s.type != "none")
        wrong.push_back("no verdict is given for a motion of type " + s.type);
    if (!s.periodic && (s.type == "III" || s.type == "IV" || s.type == "V"))
        wrong.push_back(
            "type " + s.type + ", a periodic type, is reported for a motion that is not periodic");
}

}  // namespace

bool torus_possible(const LongRun& run) {
    const int end = run.cycles();
    const double growth = run.growth(end / 4, end);
    return end >= 2000 && run.period_at(end) == 0 && growth < least_growth &&
           growth > -most_shrinking && run.closest_return(end / 4) > no_chance_return;
}

Judgement judge(
    const Parameters& p, const Statement& s, const LongRun& run,
    const std::optional<SectionCurve>& curve) {
    Judgement j;
    if (run.cycles() <= s.cycles) return j;
    const int period = run.period_at(run.cycles());
    if (s.periodic) judge_orbit(p, s, run, period, j.wrong);
    judge_verdict(s, run, period, j.wrong);
    judge_transient(s, run, period, j);
    if (s.quasi_periodic) judge_torus(s, run, period, curve, j.wrong);
    j.torus = curve && curve->farthest < off_the_curve;
    j.torus_missed = j.torus && !s.quasi_periodic;
    const int returned = run.period_at(s.cycles);
    if (returned > 0 && returned <= longest_sought && returned == period &&
        run.captured_from(period, next_to) <= s.cycles) {
        j.recurrent = returned;
        j.missed = !s.periodic;
    }
    return j;
}

std::vector<std::string> contradictions(const std::vector<Statement>& runs, const LongRun& run) {
    std::vector<std::string> wrong;
    const int period = run.period_at(run.cycles()),
              captured = period > 0 ? run.captured_from(period, around) : run.cycles();
    for (std::size_t i = 1; i < runs.size(); ++i) {
        const Statement &shorter = runs[i - 1], &longer = runs[i];
        if (shorter.verdict == Verdict::regular && longer.verdict == Verdict::chaotic)
            wrong.push_back(sentence(
                "regular after %d cycles, chaotic after %d", shorter.cycles, longer.cycles));
        // A torus can capture a motion, too; judge_torus() compares it with the long run.
        if (shorter.verdict == Verdict::chaotic && longer.verdict == Verdict::regular &&
            captured > longer.cycles && !longer.quasi_periodic)
            wrong.push_back(sentence(
                "chaotic after %d cycles, regular after %d, without a capture", shorter.cycles,
                longer.cycles));
    }
    return wrong;
}

}  // namespace vines::hunt
