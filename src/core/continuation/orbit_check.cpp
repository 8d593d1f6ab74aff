// Whether the motion really follows an orbit with given impacts: the equations also have solutions
// that pass through a wall. Each flight is searched for contacts from its own start, so that the
// orbit's instability does not matter.
#include "core/continuation/periodic_impacts.hpp"

#include <algorithm>
#include <cmath>

#include "core/measures/energy.hpp"
#include "core/motion/record.hpp"

namespace vines {

namespace {

// Largest difference of a contact's tau between the equations and the search, in cycles: far above
// rounding, also at grazing, far below a flight.
constexpr double same_contact = 1e-6;
// Approach speeds whose square is below this, in units of b, lead less than 1e-13 b beyond a wall
// that accelerates by 0.01 b or more.
constexpr double shallow = 1e-15;

/// The ball's motion at the time s of a flight.
struct Ball {
    double y, y_dot;
};
Ball ball_at(const Parameters& p, const OrbitFlight& f, double s) {
    const double y_dot = f.x_dot - f.relative_speed;
    return {f.x - f.side * p.b + s * (y_dot + 0.5 * p.gravity * s), y_dot + p.gravity * s};
}

/// The first contact of a flight within `limit`.
std::optional<Contact> first_contact(
    const Flow& flow, const Parameters& p, const OrbitFlight& f, double limit) {
    // Without relative speed, up to rounding at a grazing contact, two derivatives vanish.
    const bool leaves = f.side * f.relative_speed < 0;
    const Ball ball = ball_at(p, f, 0);
    FlightStart start{
        f.oscillation(), ball.y,         ball.y_dot, f.side, leaves ? f.relative_speed : 0,
        leaves ? 1 : 2,  0.5 * p.gravity};
    std::vector<GrazingPoint> grazing;
    for (double passed = 0; passed < limit; passed += flow.reach()) {
        auto contact =
            fast_contact(flow, start, p.b, std::min(limit - passed, flow.reach()), grazing);
        if (contact) {
            contact->s += passed;
            return contact;
        }
        start.lo = flow.at(start.lo, Flow::cells);
        const Ball next = ball_at(p, f, passed + flow.reach());
        start.y = next.y, start.y_dot = next.y_dot;
        start.side = start.zeros = 0;
    }
    return std::nullopt;
}

std::optional<SequenceFault> sequence_fault(
    const ImpactEquations& equations, const Parameters& p, const std::vector<OrbitFlight>& flights,
    const std::vector<double>& approach) {
    using Kind = SequenceFault::Kind;
    for (std::size_t k = 0; k < approach.size(); ++k)
        if (!(approach[k] > 0)) return SequenceFault{Kind::missing, k};
    const auto flow = Flow::shared_free(p);
    const double tolerance = same_contact * p.cycle();
    for (std::size_t k = 0; k + 1 < flights.size(); ++k) {
        const OrbitFlight& f = flights[k];
        if (f.relative_speed == 0 && f.side * (flow->acceleration(f.oscillation()) - p.gravity) > 0)
            return SequenceFault{Kind::stick, k};
        const auto contact = first_contact(*flow, p, f, f.s + tolerance);
        // The search does not see contacts that are shallower than the rounding of positions.
        if (!contact && approach[k] * approach[k] < shallow * p.b * p.b) continue;
        if (!contact) return SequenceFault{Kind::missing, k};
        if (contact->s < f.s - tolerance || contact->side != equations.sequence().side_after(k))
            return SequenceFault{Kind::contact, k, contact->s, contact->side};
    }
    return std::nullopt;
}

/// Passes the flights and impacts of a period, which begins at tau, to the observer.
void replay(
    const ImpactEquations& equations, const Parameters& p, const std::vector<OrbitFlight>& flights,
    double tau, Observer& observer) {
    const auto flow = Flow::shared_free(p);
    const ImpactSequence& sequence = equations.sequence();
    Forces gravity;
    gravity.y_ddot = p.gravity;
    for (const int sign : {1, -1}) {
        if (sign < 0 && !sequence.mirrored) return;
        for (std::size_t k = 0; k < sequence.size(); ++k) {
            const OrbitFlight& f = flights[k];
            Oscillation start = f.oscillation();
            if (sign < 0) start = {-start.x, -start.x_dot, -start.sin_theta, -start.cos_theta};
            const Ball ball = ball_at(p, f, 0), ball_after = ball_at(p, f, f.s);
            observer.on_stretch(
                {*flow, tau, f.s, start, sign * ball.y, sign * ball.y_dot, 0,
                 p.gravity != 0 ? &gravity : nullptr});
            tau += f.s;
            const Oscillation end = flow->after(start, f.s);
            const double approach = end.x_dot - sign * ball_after.y_dot;
            observer.on_impact(impact_at(
                p, {f.s, sign * sequence.side_after(k), end, approach}, flow->acceleration(end),
                tau, p.gravity));
        }
    }
}

/// The state at the time s <= the period after the first impact.
State state_after(
    const ImpactEquations& equations, const Parameters& p, const std::vector<OrbitFlight>& flights,
    double s) {
    const auto flow = Flow::shared_free(p);
    const double duration = equations.sequence().half_cycles * 0.5 * p.cycle();
    const double sign = s > duration ? -1 : 1;
    if (s > duration) s -= duration;
    std::size_t k = 0;
    for (; k + 2 < flights.size() && s > flights[k].s; ++k) s -= flights[k].s;
    const OrbitFlight& f = flights[k];
    const Oscillation o = flow->after(f.oscillation(), std::max(s, 0.0));
    const Ball ball = ball_at(p, f, std::max(s, 0.0));
    return {sign * o.x_dot, sign * o.x, sign * ball.y_dot, sign * ball.y};
}

}  // namespace

OrbitCheck ImpactEquations::check(const Unknowns& z, const std::vector<double>& approach) const {
    const Parameters p = *system(z);
    const std::vector<OrbitFlight> all = flights(z, p);
    OrbitCheck check{sequence_fault(*this, p, all, approach)};
    const double period = sequence().cycles() * p.cycle();
    double tau = std::fmod((z(0) - p.phi()) / p.Omega, p.cycle());
    if (tau < 0) tau += p.cycle();
    // The last impact belongs to the period, however tau is rounded.
    Energy energy(p, {tau, tau + period + same_contact});
    replay(*this, p, all, tau, energy);
    const EnergyBalance balance = energy.balance({tau, tau + period});
    check.measures = {
        state_after(*this, p, all, p.cycle() - tau), balance.peak, balance.rms,
        balance.share_impacts};
    return check;
}

}  // namespace vines
