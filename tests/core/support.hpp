// Shared by the tests: reference trajectories, recorded runs, random systems.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/motion/elementary.hpp"
#include "core/motion/record.hpp"
#include "core/stability/lyapunov.hpp"

namespace vines::test {

struct ReferenceImpact {
    double tau;
    int side;  ///< +1: x - y = b, -1: x - y = -b
    double x, x_dot_before, y_dot_before, x_dot_after, y_dot_after;
};

struct ReferenceStick {
    int side;
    double start, end;
};

/// One file of reference/: a trajectory in 250-digit arithmetic from Table 1's initial state to
/// tau = 1709, or law_*: one of laws.hpp, which has its parameters, in 60 digits.
struct Reference {
    Parameters parameters;
    std::vector<ReferenceImpact> impacts;
    std::vector<ReferenceStick> sticks;
    Exponents qr, eigenvalues;
};
Reference read_reference(const std::string& name);

/// Moduli of the eigenvalues by a general solver, descending.
Moduli eigenvalue_moduli(const Matrix4& m);

/// A run with all its events.
struct Record {
    Outcome outcome;
    std::vector<Impact> impacts;
    std::vector<StickingPhase> sticks;
    std::vector<ContactEvent> touches;
};
/// Simulates to tau_end or max_impacts, with additional observers.
Record record(
    const Parameters& parameters, const State& start, double tau_end, long max_impacts = 1000000,
    std::vector<Observer*> more = {});

/// Table 1 of the paper with this b, in m.
Parameters table1(double b, Damping damping);

/// A system whose chaotic transient from the default start is captured by a periodic orbit between
/// tau = 2000 and 9000. The capture time changes with the last bit of any earlier sum; the function
/// therefore searches the neighbours of b = 22 mm, R = .5, half of which are captured by
/// tau = 9000.
struct CapturedTransient {
    Parameters parameters;
    double tau;  ///< time of capture
};
CapturedTransient captured_transient();

/// A law of restitution with three points at speeds of order `speed`; rises and falls.
std::shared_ptr<const RestitutionTable> random_table(std::mt19937_64& engine, double speed);

/// A valid system and start, over the usual ranges and well beyond; reproducible by the seed.
struct System {
    Parameters parameters;
    State start;
};
System random_system(std::mt19937_64& engine);

}  // namespace vines::test
