// Requests of peers.mjs to a peer, and the answers of a C++ peer: one line of JSON each.
#pragma once

#include <exception>
#include <map>
#include <string>
#include <vector>

namespace peers {

/// A motion to be followed: the system (docs/physics.md, damping by the equation of motion), the
/// state at tau, the wall just left (0: none), and the method.
struct Job {
    double epsilon, lambda, G, Omega, R, b;
    double x_dot, x, y_dot, y;
    int side;
    double tau, tau_end;
    double longest_step;  ///< largest step of the integrator, in tau; 0: the library's default
    double tolerance;     ///< relative; the absolute one is b times that
};

struct Contact {
    double tau;
    int side;
};

struct Answer {
    std::vector<Contact> contacts;
    std::string end = "tau_end";      ///< or "through the wall", "stalled", or an error
    std::vector<double> states = {};  ///< x', x, y', y after each contact, if the peer returns them
    std::vector<double> sticks = {};  ///< start times of sticking phases, if the peer detects them
};

/// Returns whether the contacts have stalled: 200 of them within .001 of tau; a chatter with the
/// benchmark's R needs 30.
bool stalled(const std::vector<Contact>& contacts);

using Method = Answer (*)(const Job&);

/// A method that adds to its answer; the text of an exception becomes the end of the motion.
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

/// Answers the lines of stdin until it ends. `forget` clears what is cached from a run for the next
/// one of the same system; it is called before each timed run if requested.
int serve(
    const std::string& versions, const std::map<std::string, Method>& methods,
    void (*forget)() = [] {});

}  // namespace peers
