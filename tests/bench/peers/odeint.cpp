// Boost.odeint: dense output, a sign test at the end of each step, and a bracketed root on the
// step's interpolant. bulirsch_stoer_dense_out was tried and is slower at this accuracy.
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/numeric/odeint.hpp>
#include <boost/version.hpp>
#include <limits>
#include <stdexcept>

#include "bench/peers/flight.hpp"

namespace {

namespace odeint = boost::numeric::odeint;
using namespace peers;

/// Time of the contact in (from, to], where beyond(to) >= 0 at the step's end. At the flight's
/// start the ball is on the wall that it leaves: the bracket begins after it has left. Without a
/// bracket, within rounding, the contact is at `to`.
template <class Beyond>
double root(double from, double to, const Beyond& beyond) {
    double at_from = beyond(from);
    if (at_from >= 0) at_from = beyond(from += 1e-3 * (to - from));
    const double at_to = beyond(to);
    if (at_from >= 0 || at_to <= 0 || from >= to) return to;
    std::uintmax_t evaluations = 60;
    const auto [low, high] = boost::math::tools::toms748_solve(
        beyond, from, to, at_from, at_to,
        boost::math::tools::eps_tolerance<double>(std::numeric_limits<double>::digits - 2),
        evaluations);
    return 0.5 * (low + high);
}

void follow(const Job& job, Answer& answer) {
    Flight flight(job);
    const auto oscillator = [&](const Motion& m, Motion& derivative, double tau) {
        derivative = {m[1], flight.acceleration(tau, m[0], m[1])};
    };
    const double longest = job.longest_step > 0 ? job.longest_step : 1;
    auto stepper = odeint::make_dense_output(
        job.tolerance * job.b, job.tolerance, longest, odeint::runge_kutta_dopri5<Motion>());
    Motion m = {job.x, job.x_dot};
    stepper.initialize(m, job.tau, flight.first_step(m[1], 0.01));
    while (stepper.current_time() < job.tau_end) {
        const auto [from, to] = stepper.do_step(oscillator);
        if (flight.beyond(to, stepper.current_state()[0]) < 0) continue;
        const double tau = root(from, to, [&](double t) {
            stepper.calc_state(t, m);
            return flight.beyond(t, m[0]);
        });
        if (tau > job.tau_end) break;
        stepper.calc_state(tau, m);
        const double step = stepper.current_time_step();
        m[1] = flight.strike(tau, m[0], m[1]);
        answer.contacts.push_back({tau, flight.side()});
        if (stalled(answer.contacts)) throw std::runtime_error("stalled");
        stepper.initialize(m, tau, flight.first_step(m[1], step));
    }
}

}  // namespace

int main() { return serve("Boost.odeint " BOOST_LIB_VERSION, {{"dopri5", guarded<follow>}}); }
