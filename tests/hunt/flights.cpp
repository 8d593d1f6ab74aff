#include "flights.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>

#include "../core/support.hpp"
#include "core/motion/contact_search.hpp"
#include "core/sweep/parallel.hpp"
#include "dense_flight.hpp"
#include "systems.hpp"

namespace vines::hunt {

namespace {

using Real = SeriesMotion::Real;

// Largest number of searches for one flight: a search without a contact within its reach is
// continued.
constexpr int max_searches = 8;

/// A flight from a wall, with any state of the oscillator and any speed of the ball.
struct RandomFlight {
    Flow flow;
    double b;
    Oscillation lo;
    int side;
    double w;  ///< speed at which it leaves the wall

    FlightStart start() const {
        return {lo, lo.x - side * b, lo.x_dot + side * w, side, -side * w, 1};
    }
};

double power_of_ten(std::mt19937_64& engine, double from, double to) {
    return std::pow(10, uniform(engine, from, to));
}

RandomFlight any_flight(std::mt19937_64& engine) {
    Parameters p;
    State s;
    if (engine() % 4 != 0) {
        const test::System system = test::random_system(engine);
        p = system.parameters, s = system.start;
    } else {
        const System system =
            engine() % 2 ? random_system(Kind::wide, engine) : strongly_damped(engine);
        p = system.parameters, s = system.start;
    }
    const double theta = uniform(engine, 0, 6.3);
    const double speed = std::abs(s.x_dot) + std::abs(s.y_dot) + 1e-12;
    return {
        *Flow::shared_free(p),
        p.b,
        {s.x, s.x_dot, std::sin(theta), std::cos(theta)},
        engine() % 2 ? 1 : -1,
        speed * (engine() % 2 ? uniform(engine, 0.01, 2) : power_of_ten(engine, -13, 0))};
}

/// Changes the flight so that x - y reaches a wall at s, except for the fraction `off` of b; s is a
/// grid point of the search or any time.
void reach_wall_at(RandomFlight& f, Real s, int wall, double off) {
    const Real x = SeriesMotion(f.flow.coefficients()).after(place_of(f.lo), s).x;
    const Real y_dot = (x - wall * f.b * (1 + Real(off)) - (f.lo.x - f.side * Real(f.b))) / s,
               w = f.side * (y_dot - f.lo.x_dot);
    if (w > 0) f.w = static_cast<double>(w);
}

/// Changes the flight so that it grazes, or nearly grazes, a wall at s: the other wall by the
/// choice of b, its own wall by that of the oscillator's speed.
void graze_at(RandomFlight& f, Real s, bool own, double off) {
    const SeriesMotion motion(f.flow.coefficients());
    // x(s) - x(0) - x'(s) s: change of x - y up to s, if x' - y' = 0 there.
    const auto turned = [&](Real x_dot) {
        SeriesMotion::Place from = place_of(f.lo);
        from.x_dot = x_dot;
        const SeriesMotion::Place to = motion.after(from, s);
        return std::pair{to.x - from.x - to.x_dot * s, to.x_dot};
    };
    RandomFlight g = f;
    if (own) {
        const Real at_0 = turned(0).first, at_1 = turned(1).first;
        g.lo.x_dot = static_cast<double>(-at_0 / (at_1 - at_0));
    }
    const auto [way, x_dot] = turned(g.lo.x_dot);
    if (!own) g.b = static_cast<double>(-f.side * way / (2 + off));
    g.w = static_cast<double>(f.side * (x_dot - g.lo.x_dot));
    if (own) g.w *= 1 + off;
    if (g.b > 1e-6 && g.w > 0 && std::isfinite(g.lo.x_dot)) f = g;
}

RandomFlight random_flight(std::mt19937_64& engine) {
    RandomFlight f = any_flight(engine);
    const double off = (engine() % 2 ? 1 : -1) * power_of_ten(engine, -17, -2);
    const Real somewhere = uniform(engine, 1e-3, 1) * f.flow.reach();
    switch (engine() % 8) {
        case 0: {
            const Real grid_time = (1 + engine() % Flow::cells) * Real(f.flow.cell());
            reach_wall_at(f, grid_time, engine() % 2 ? 1 : -1, engine() % 2 ? 0 : off * 1e-8);
            break;
        }
        case 1: graze_at(f, somewhere, false, off); break;
        case 2: graze_at(f, somewhere, true, off); break;
        default: break;
    }
    return f;
}

struct Tally {
    long searches = 0, contacts = 0, own_wall = 0, hops = 0, touches = 0, wrong = 0;
    Real worst = 0;

    void operator+=(const Tally& t) {
        searches += t.searches, contacts += t.contacts, own_wall += t.own_wall, hops += t.hops,
            touches += t.touches, wrong += t.wrong;
        worst = std::max(worst, t.worst);
    }
};

void report(
    int number, const RandomFlight& f, const FlightStart& s, double limit, const char* wrong) {
    const Flow::Coefficients c = f.flow.coefficients();
    std::printf(
        "WRONG  flight %d: %s\n    flow %.17g %.17g %.17g %.17g, b %.17g, limit %.17g, x %.17g, x' "
        "%.17g, sin %.17g, cos %.17g, y %.17g, y' %.17g, side %d, x' - y' %.17g\n",
        number, wrong, c[0], c[1], c[2], c[3], f.b, limit, s.lo.x, s.lo.x_dot, s.lo.sin_theta,
        s.lo.cos_theta, s.y, s.y_dot, s.side, s.relative_speed);
    std::fflush(stdout);
}

Tally hunt_flight(std::uint64_t seed, int number) {
    std::mt19937_64 engine = engine_of(seed, number);
    const RandomFlight f = random_flight(engine);
    FlightStart start = f.start();
    const double reach = f.flow.reach();
    // A run can end within the flight.
    const double last = engine() % 3 ? max_searches : uniform(engine, 0, 2);
    Tally tally;
    for (int k = 0; k < last; ++k) {
        const double limit = std::min(1.0, last - k) * reach;
        std::vector<GrazingPoint> touches;
        const auto found = fast_contact(f.flow, start, f.b, limit, touches);
        const FlightJudgement judgement = judge_flight(f.flow, start, f.b, limit, found);
        ++tally.searches;
        tally.touches += static_cast<long>(touches.size());
        tally.worst = std::max(tally.worst, judgement.worst);
        if (!judgement.wrong.empty()) {
            ++tally.wrong;
            report(number, f, start, limit, judgement.wrong.c_str());
        }
        if (found) {
            ++tally.contacts;
            const bool own = found->side == start.side;
            tally.own_wall += own;
            tally.hops += own && found->s < f.flow.cell();
            break;
        }
        // Continues like simulate().
        start = {f.flow.at(start.lo, Flow::cells), start.y + start.y_dot * reach, start.y_dot};
    }
    return tally;
}

}  // namespace

bool hunt_contacts(int flights, std::uint64_t seed, int first, int threads) {
    constexpr int batch = 1000;
    Tally all;
    std::mutex adding;
    int done = 0;
    parallel(
        static_cast<std::size_t>((flights + batch - 1) / batch), threads, nullptr,
        [&](std::size_t i) {
            const int from = static_cast<int>(i) * batch, to = std::min(flights, from + batch);
            Tally tally;
            for (int n = from; n < to; ++n) tally += hunt_flight(seed, first + n);
            const std::lock_guard hold(adding);
            all += tally;
            done += to - from;
            if (done % 100000 == 0) std::fprintf(stderr, "%d of %d flights\n", done, flights);
        });
    std::printf(
        "%d flights, %ld searches, %ld contacts (%ld with the wall left, %ld of these within a "
        "cell), %ld grazing contacts: %ld contacts missed or wrong; x - y off by %.2f "
        "of "
        "the rounding that is allowed\n",
        flights, all.searches, all.contacts, all.own_wall, all.hops, all.touches, all.wrong,
        static_cast<double>(all.worst));
    return all.wrong == 0;
}

}  // namespace vines::hunt
