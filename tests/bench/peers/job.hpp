// What peers.mjs asks of a peer, and how a C++ one answers: one line of JSON each.
#pragma once

#include <exception>
#include <map>
#include <string>
#include <vector>

namespace peers {

/// One motion to be followed: the system (docs/physics.md, damping by the equation of motion), the
/// state at tau, the wall just left (0: none), and how.
struct Job {
    double epsilon, lambda, G, Omega, R, b;
    double x_dot, x, y_dot, y;
    int side;
    double tau, tau_end;
    double longest_step;  ///< of the integrator, in tau; 0: its own
    double tolerance;     ///< relative; the absolute one is b times that
};

struct Contact {
    double tau;
    int side;
};

struct Answer {
    std::vector<Contact> contacts;
    std::string end = "tau_end";      ///< or "through the wall", "stalled", or an error
    std::vector<double> states = {};  ///< x', x, y', y behind each contact, if the peer tells
    std::vector<double> sticks = {};  ///< where they begin, if the peer knows of any
};

/// Whether the contacts have come to a standstill: 200 of them within a tau of .001, where a
/// chatter with the benchmark's R is over after 30.
bool stalled(const std::vector<Contact>& contacts);

using Method = Answer (*)(const Job&);

/// A method that adds to its answer; what it throws is how the motion ends.
template <void (*follow)(const Job&, Answer&)>
Answer guarded(const Job& job) {
    Answer answer;
    try {
        follow(job, answer);
    } catch (const std::exception& e) {
        answer.end = e.what();
    }
    return answer;
}

/// Answers the lines on standard input until it ends. `forget` drops what is kept of a run for the
/// next one of the same system; where asked for, before each run that is timed.
int serve(
    const std::string& versions, const std::map<std::string, Method>& methods,
    void (*forget)() = [] {});

}  // namespace peers
