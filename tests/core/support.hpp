// What several test files need: reference trajectories, recorded runs, random systems.
#pragma once

#include <string>
#include <vector>

#include "core/motion/random.hpp"
#include "core/motion/record.hpp"
#include "core/stability/lyapunov.hpp"

namespace vines::test {

struct ReferenceImpact {
    double tau;
    int side;
    double x, x_dot_before, y_dot_before, x_dot_after, y_dot_after;
};

struct ReferenceStick {
    int side;
    double start, end;
};

/// One file of reference/: a trajectory in 250-digit arithmetic from Table 1's initial state to
/// tau = 1709.
struct Reference {
    Parameters parameters;
    std::vector<ReferenceImpact> impacts;
    std::vector<ReferenceStick> sticks;
    Exponents qr, eigenvalues;
};
Reference read_reference(const std::string& name);

struct Record {
    Outcome outcome;
    std::vector<Impact> impacts;
    std::vector<StuckPhase> sticks;
    std::vector<TangentContact> touches;
};
Record record(
    const Parameters& parameters, const State& start, double tau_end, long max_impacts = 1000000,
    std::vector<Observer*> more = {});

Parameters table1(double b, Damping damping);

/// A system whose chaotic transient from the default start an orbit captures between tau = 2000 and
/// 9000. When that is rests on the last bit of every sum on the way, so it is looked for: by then
/// half of the neighbours of b = 22 mm, R = .5 are captured.
struct CapturedTransient {
    Parameters parameters;
    double tau;
};
CapturedTransient captured_transient();

/// A system and a start that validate, over the ranges that people study and well beyond;
/// reproducible from the engine's seed.
struct System {
    Parameters parameters;
    State start;
};
System random_system(std::mt19937_64& engine);

}  // namespace vines::test
