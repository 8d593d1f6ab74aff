// vines, through its public functions.
#include "bench/peers/job.hpp"
#include "core/motion/record.hpp"
#include "core/stability/lyapunov.hpp"

namespace {

using namespace vines;

Parameters system_of(const peers::Job& job) {
    Parameters p;
    p.epsilon = job.epsilon, p.lambda = job.lambda, p.G = job.G, p.Omega = job.Omega;
    p.R_plus = p.R_minus = job.R, p.b = job.b;
    return p;
}

class Contacts : public Observer {
public:
    void on_impact(const Impact& i) override { answer.contacts.push_back({i.tau, i.side}); }
    peers::Answer answer;
};

/// The motion from which the others start and with which they are compared.
class Reference : public Contacts {
public:
    explicit Reference(double b) : b_(b) {}
    void on_impact(const Impact& i) override {
        Contacts::on_impact(i);
        answer.states.insert(
            answer.states.end(), {i.x_dot_after, i.x, i.y_dot_after, i.x - i.side * b_});
    }
    void on_stick(const StickStart& s) override { answer.sticks.push_back(s.tau); }

private:
    const double b_;
};

void run(const peers::Job& job, std::initializer_list<Observer*> observers) {
    Limits limits;
    limits.tau_start = job.tau, limits.tau_end = job.tau_end;
    simulate(
        system_of(job), {job.x_dot, job.x, job.y_dot, job.y}, limits,
        {observers.begin(), observers.size()});
}

peers::Answer motion(const peers::Job& job) {
    Contacts contacts;
    run(job, {&contacts});
    return std::move(contacts.answer);
}

peers::Answer exponents(const peers::Job& job) {
    Contacts contacts;
    Lyapunov lyapunov(system_of(job), {job.tau, job.tau_end}, qr_alone);
    run(job, {&contacts, &lyapunov});
    return std::move(contacts.answer);
}

peers::Answer reference(const peers::Job& job) {
    Reference contacts(job.b);
    run(job, {&contacts});
    return std::move(contacts.answer);
}

/// A thread keeps the tables of its last four systems (Flow::shared_free).
void forget() {
    for (int i = 1; i <= 4; ++i) {
        Parameters other;
        other.G *= 1 + i;
        Flow::shared_free(other);
        Flow::shared_sticking(other);
    }
}

}  // namespace

int main() {
    return peers::serve(
        "vines and the others' C++ by g++ " __VERSION__,
        {{"motion", motion}, {"exponents", exponents}, {"reference", reference}}, forget);
}
