// Gravity and friction of the ball, against an integrator that knows nothing but the equations of
// motion, and against closed forms.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "../support.hpp"
#include "core/measures/energy.hpp"
#include "core/motion/record.hpp"
#include "core/stability/exterior.hpp"
#include "core/stability/lyapunov.hpp"
#include "whole_run.hpp"

using namespace vines;
using namespace vines::test;

namespace {

using Real = long double;

/// Fourth-order Runge-Kutta method with small steps; events by bisection of the step.
class SmallSteps {
public:
    SmallSteps(const Parameters& p, const State& start)
        : p_(p),
          zeta_(p.zeta()),
          forcing_(p.epsilon * p.A()),
          phi_(p.phi()),
          z_{start.x_dot, start.x, start.y_dot, start.y} {
        sign_ = z_[0] > z_[2] ? 1 : -1;
    }

    struct Bounce {
        Real tau, w;
    };
    std::vector<Bounce> impacts;
    Real tau = 0;
    int rests = 0;

    void run(Real until) {
        constexpr Real step = 2e-3L;
        while (tau < until) {
            const Real h = std::min(step, until - tau);
            const Vector next = after(h);
            if (!event(next, tau + h)) {
                z_ = next, tau += h;
                continue;
            }
            Real low = 0, high = h;
            for (int i = 0; i < 70; ++i) {
                const Real middle = (low + high) / 2;
                (event(after(middle), tau + middle) ? high : low) = middle;
            }
            z_ = after(high), tau += high;
            happen();
        }
    }
    State state() const { return {double(z_[0]), double(z_[1]), double(z_[2]), double(z_[3])}; }

private:
    using Vector = std::array<Real, 4>;  // x', x, y', y

    Real own(const Vector& z, Real t) const {
        return forcing_ * std::sin(p_.Omega * t + phi_) - 2 * zeta_ * z[0] - z[1];
    }
    Real joint(const Vector& z, Real t) const {
        return (own(z, t) + p_.epsilon * p_.gravity) / (1 + p_.epsilon);
    }
    Vector rate(const Vector& z, Real t) const {
        if (together_) return {joint(z, t), z[0], joint(z, t), z[0]};
        return {
            own(z, t) - p_.epsilon * p_.friction * sign_, z[0], p_.gravity + p_.friction * sign_,
            z[2]};
    }
    Vector after(Real h) const {
        const auto plus = [](Vector a, const Vector& b, Real s) {
            for (int i = 0; i < 4; ++i) a[i] += s * b[i];
            return a;
        };
        const Vector k1 = rate(z_, tau), k2 = rate(plus(z_, k1, h / 2), tau + h / 2),
                     k3 = rate(plus(z_, k2, h / 2), tau + h / 2),
                     k4 = rate(plus(z_, k3, h), tau + h);
        Vector z = z_;
        for (int i = 0; i < 4; ++i) z[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
        return z;
    }
    /// Acceleration by which the oscillator would leave a ball behind that moves with it.
    Real pull(const Vector& z, Real t) const { return joint(z, t) - p_.gravity; }
    bool event(const Vector& z, Real t) const {
        if (together_ && wall_ != 0) return wall_ * pull(z, t) <= -p_.friction;
        if (together_) return std::abs(pull(z, t)) > p_.friction;
        const Real gap = z[1] - z[3], w = z[0] - z[2];
        return (std::abs(gap) >= p_.b && gap * w > 0) || (p_.friction > 0 && w * sign_ < 0);
    }
    void happen() {
        const Real gap = z_[1] - z_[3], w = z_[0] - z_[2];
        if (together_) {
            together_ = false;
            sign_ = wall_ != 0 ? -wall_ : pull(z_, tau) > 0 ? 1 : -1;
            z_[2] -= sign_ * 1e-17L;  // the direction in which it begins to slide
            return;
        }
        if (std::abs(gap) < p_.b - 1e-15L || gap * w <= 0) {
            z_[2] = z_[0];
            wall_ = 0;
            together_ = std::abs(pull(z_, tau)) <= p_.friction;
            if (together_) ++rests;
            sign_ = pull(z_, tau) > 0 ? 1 : -1;
            return;
        }
        impacts.push_back({tau, w});
        wall_ = gap > 0 ? 1 : -1;
        const Real R = gap > 0 ? p_.R_plus : p_.R_minus;
        z_[0] -= (1 + R) * p_.epsilon / (1 + p_.epsilon) * w;
        z_[2] = z_[0] + R * w;
        sign_ = -wall_;
        // The rest of a chatter takes 1e-7.
        together_ = std::abs(w) < 1e-8L && wall_ * pull(z_, tau) > -p_.friction;
        if (together_) z_[2] = z_[0];
    }

    const Parameters p_;
    const Real zeta_, forcing_, phi_;
    Vector z_;
    int sign_ = 0, wall_ = 0;
    bool together_ = false;
};

constexpr double least_speed = 1e-5;

Parameters machine(double gravity, double friction) {
    Parameters p;
    p.epsilon = 0.05, p.lambda = 0.4, p.G = 0.4, p.Omega = 0.93, p.b = 0.02;
    p.R_plus = 0.7, p.R_minus = 0.6, p.gravity = gravity, p.friction = friction;
    return p;
}

}  // namespace

struct Rests : Observer {
    int inside = 0, at_wall = 0, slips = 0;
    void on_slip(const Slip& slip) override { ++(slip.ratio == 0 ? inside : slips); }
    void on_stick(const StickStart&) override { ++at_wall; }
};

TEST_CASE("impacts under gravity and friction are those of a general integrator") {
    int all_rests = 0, all_sticks = 0;
    for (const auto& laws :
         {std::pair{0., 0.}, std::pair{0.02, 0.}, std::pair{-0.01, 0.}, std::pair{0., 0.004},
          std::pair{0.015, 0.003}, std::pair{0.01, 0.012}, std::pair{0., 0.015}}) {
        const double gravity = laws.first, friction = laws.second;
        CAPTURE(gravity);
        CAPTURE(friction);
        const Parameters p = machine(gravity, friction);
        const State start{0.01, 0.002, -0.02, 0.005};
        ImpactRecord impacts;
        Rests rests;
        Observer* const observers[] = {&impacts, &rests};
        const Outcome end = simulate(p, start, {20, 1000, {}}, observers);
        SmallSteps reference(p, start);
        reference.run(20);
        // Later impacts of a chatter shift by the rounding of the integrator.
        std::erase_if(impacts.entries, [](const Impact& i) {
            return std::abs(i.relative_speed_before) < least_speed;
        });
        std::erase_if(reference.impacts, [](const auto& i) { return std::abs(i.w) < least_speed; });
        REQUIRE(impacts.entries.size() > 4);
        CHECK(rests.inside == reference.rests);
        all_rests += rests.inside, all_sticks += rests.at_wall;
        REQUIRE(impacts.entries.size() == reference.impacts.size());
        for (std::size_t i = 0; i < impacts.entries.size(); ++i) {
            CHECK(
                impacts.entries[i].tau ==
                doctest::Approx(double(reference.impacts[i].tau)).epsilon(1e-9));
            CHECK(
                impacts.entries[i].relative_speed_before ==
                doctest::Approx(double(reference.impacts[i].w)).epsilon(1e-7));
        }
        CHECK((vector_of(end.state) - vector_of(reference.state())).norm() < 1e-9);
    }
    CHECK(all_rests > 5);
    CHECK(all_sticks > 2);
}

TEST_CASE("the transfer matrices under gravity and friction are the derivatives of whole runs") {
    for (const auto& laws :
         {std::tuple{0.01, 0., 6.}, std::tuple{0., 0.004, 6.}, std::tuple{0.003, 0.015, 7.},
          std::tuple{-0.004, 0.012, 7.}}) {
        const double gravity = std::get<0>(laws), friction = std::get<1>(laws),
                     until = std::get<2>(laws);
        CAPTURE(gravity);
        CAPTURE(friction);
        const Parameters p = machine(gravity, friction);
        const State start{0.01, 0.002, -0.02, 0.005};
        WholeRunProduct product(p);
        Rests rests;
        Observer* const observers[] = {&product, &rests};
        simulate(p, start, {until, 1000, {}}, observers);
        CHECK(rests.at_wall == 0);
        CHECK((friction == 0 || rests.slips + rests.inside > 0));
        const Matrix4 derivative = derivative_of_run(p, start, until);
        for (int k = 0; k < 4; ++k)
            CHECK((derivative.col(k) - product.m.col(k)).norm() < 1e-7 * (1 + product.m.norm()));
    }
}

TEST_CASE("the energy of a sliding ball balances") {
    for (const auto& [gravity, friction] :
         {std::pair{0.02, 0.}, std::pair{0., 0.004}, std::pair{0.01, 0.012},
          std::pair{0., 0.015}}) {
        const Parameters p = machine(gravity, friction);
        Energy energy(p, {0, 200});
        Observer* const observers[] = {&energy};
        simulate(p, {0.01, 0.002, -0.02, 0.005}, {200, 100000, {}}, observers);
        const EnergyBalance balance = energy.balance({0, 200});
        CHECK((balance.friction > 0) == (friction > 0));
        CHECK(
            std::abs(balance.residual) <
            1e-12 * (balance.damper + balance.impacts + balance.friction));
    }
}

TEST_CASE("without forcing a ball stays on an incline if and only if gravity is below friction") {
    Parameters p = machine(0.01, 0.01 * (1 + 1e-12));
    p.G = 0;
    // The oscillator rests where the spring carries the ball.
    const State start{0, p.epsilon * p.gravity, 0, 0};
    ImpactRecord impacts;
    Observer* const observers[] = {&impacts};
    const State end = simulate(p, start, {100, 100, {}}, observers).state;
    CHECK(impacts.entries.empty());
    CHECK(std::abs(end.y) < 1e-15);
    p.friction = 0.01 * (1 - 1e-12);
    simulate(p, start, {1e7, 1, {}}, observers);
    REQUIRE(impacts.entries.size() == 1);
    CHECK(impacts.entries[0].side == -1);
}

TEST_CASE("a ball that just reaches the upper wall without speed falls from rest") {
    Parameters p;
    p.epsilon = p.b = 1e-9, p.Omega = 0.001, p.G = 0.1, p.gravity = 5, p.R_minus = 1;
    ImpactRecord impacts;
    simulate(p, {0, 0, 0, -p.b}, {.tau_end = 0.01}, std::vector<Observer*>{&impacts});
    // At the upper wall rounding decides whether it is an impact.
    std::erase_if(impacts.entries, [](const Impact& impact) { return impact.side > 0; });
    const double fall = 2 * std::sqrt(p.b / p.gravity);
    REQUIRE(impacts.entries.size() > 100);
    double due = fall;
    for (const Impact& impact : impacts.entries) {
        CHECK(impact.tau == doctest::Approx(due).epsilon(1e-6));
        due += 2 * fall;
    }
}

TEST_CASE(
    "a ball that rests at a wall far from the oscillator's rest stays there in a second run") {
    // The static deflection, epsilon gravity = 1e-6, is 1000 b: x and y round more than their
    // values say.
    Parameters p;
    p.epsilon = p.b = 1e-9, p.lambda = p.Omega = 1, p.G = 0.01, p.gravity = 1000;
    p.R_plus = 0.1, p.R_minus = 0;
    StroboscopicRecord at_cycles(p);
    simulate(p, {}, {.tau_end = 100}, std::vector<Observer*>{&at_cycles});
    for (const State& s : at_cycles.states) {
        if (&s == at_cycles.states.data()) continue;
        ImpactRecord impacts;
        StickRecord sticks;
        simulate(p, s, {.tau_end = p.cycle()}, std::vector<Observer*>{&impacts, &sticks});
        CHECK(impacts.entries.empty());
        REQUIRE(sticks.entries.size() == 1);
        CHECK(sticks.entries[0].start.tau == 0);
    }
}

TEST_CASE("a bouncing ball on a heavy oscillator has the times of the closed form") {
    Parameters p;
    p.epsilon = 1e-9, p.lambda = 0, p.G = 0, p.b = 1, p.gravity = 0.5, p.R_minus = 0.8;
    ImpactRecord impacts;
    StickRecord sticks;
    Observer* const observers[] = {&impacts, &sticks};
    simulate(p, {0, 0, 0, 0.5}, {30, 1000, {}}, observers);
    double tau = std::sqrt(2 * 0.5 / p.gravity), w = p.gravity * tau;
    for (int i = 0; i < 20; ++i) {
        CHECK(
            impacts.entries.at(static_cast<std::size_t>(i)).tau ==
            doctest::Approx(tau).epsilon(1e-8));
        w *= p.R_minus;
        tau += 2 * w / p.gravity;
    }
    const double fall = std::sqrt(2 * 0.5 / p.gravity);
    REQUIRE(sticks.entries.size() == 1);
    CHECK(sticks.entries[0].start.tau == doctest::Approx(fall * (1 + 2 * 0.8 / 0.2)).epsilon(1e-7));
}

TEST_CASE("the chatter of a sliding ball between nearly elastic walls ends in sticking") {
    Parameters p;
    p.epsilon = 0.05, p.lambda = 0.4, p.b = 0.002, p.gravity = 0.02, p.R_plus = p.R_minus = 0.99;
    // Limits of runs in long double that end each chatter at shorter and shorter remainders.
    for (const auto& [friction, tau] : {std::pair(1e-4, 12.84962), std::pair(1e-5, 18.13573)}) {
        p.friction = friction;
        CAPTURE(p.friction);
        StickRecord sticks;
        record(p, default_state(p), 40, 20000, {&sticks});
        REQUIRE(sticks.entries.size() == 1);
        CHECK(sticks.entries[0].start.tau == doctest::Approx(tau).epsilon(1e-6));
        CHECK(sticks.entries[0].tau_end == 40);
    }
}

TEST_CASE("a rest inside the cavity has one exponent of minus infinity") {
    const Parameters p = machine(0, 0.012);
    Lyapunov lyapunov(p, {0, 1000}, {.qr = true, .eigenvalues = true});
    Rests rests;
    Observer* const observers[] = {&lyapunov, &rests};
    simulate(p, {0.01, 0.002, -0.02, 0.005}, {1000, 100000, {}}, observers);
    REQUIRE(rests.inside > 0);
    const TransferProduct& product = lyapunov.product();
    CHECK(product.rank() <= 3);
    CHECK(std::isinf(product.qr()[3]));
    if (rests.at_wall == 0) {
        CHECK(product.rank() == 3);
        CHECK(std::isfinite(product.qr()[2]));
    }
}

TEST_CASE("an impact after a rest inside the cavity begins a new chatter") {
    Parameters p;
    p.epsilon = 0.0084, p.lambda = 1.4, p.Omega = 4.5, p.G = 56, p.b = 0.1;
    p.R_plus = 0, p.R_minus = 0.5, p.gravity = 0.1, p.friction = 0.2;
    struct Chatters : Observer {
        void on_impact(const Impact&) override { ++since_rest; }
        void on_slip(const Slip& slip) override {
            if (slip.ratio == 0) since_rest = 0, ++rests;
        }
        void on_stick(const StickStart& start) override {
            CHECK(start.impacts <= since_rest);
            ++sticks;
        }
        int since_rest = 0, rests = 0, sticks = 0;
    } chatters;
    simulate(p, {0, 0, 17.5, -p.b}, {.tau_end = 2000}, std::vector<Observer*>{&chatters});
    CHECK(chatters.rests > 10);
    CHECK(chatters.sticks > 10);
}

TEST_CASE("slips change the sum of the exponents by the logarithms of their ratios") {
    Parameters p = machine(0, 0.0005);
    p.R_plus = p.R_minus = 0.95;
    struct Ratios : Observer {
        double sum = 0, from = -1, to = 0, pending = 0;
        void on_slip(const Slip& s) override {
            if (from >= 0) pending += std::log(std::abs(s.ratio));
        }
        void on_impact(const Impact& i) override {
            if (from < 0) from = i.tau;
            else sum += pending + 2 * std::log(i.R), to = i.tau;
            pending = 0;
        }
    } ratios;
    Lyapunov lyapunov(p, {0, 100}, {.qr = true});
    Rests rests;
    Observer* const observers[] = {&lyapunov, &ratios, &rests};
    simulate(p, {0.01, 0.002, -0.02, 0.005}, {100, 100000, {}}, observers);
    REQUIRE(rests.inside + rests.at_wall == 0);
    REQUIRE(rests.slips > 10);
    const Exponents lambda = lyapunov.product().qr();
    CHECK(
        lambda[0] + lambda[1] + lambda[2] + lambda[3] ==
        doctest::Approx(-2 * p.zeta() + ratios.sum / (ratios.to - ratios.from)).epsilon(1e-9));
}

TEST_CASE(
    "vanishing gravity and friction, and a table of equal R, leave a periodic motion as it is") {
    Parameters p;
    p.b = 0.015, p.damping = Damping::closed_form;
    const auto last_impacts = [](const Parameters& of) {
        ImpactRecord record;
        Observer* const observers[] = {&record};
        simulate(of, default_state(of), {of.cycle() * 2000, 100000, {}}, observers);
        return std::vector<Impact>(record.entries.end() - 8, record.entries.end());
    };
    const std::vector<Impact> plain = last_impacts(p);
    Parameters heavy = p, sliding = p, table = p;
    heavy.gravity = 1e-18, sliding.friction = 1e-18;
    table.table_plus = table.table_minus =
        std::make_shared<const RestitutionTable>(RestitutionTable{{0, 1}, {p.R_plus, p.R_minus}});
    for (const Parameters& of : {heavy, sliding, table}) {
        const std::vector<Impact> impacts = last_impacts(of);
        for (std::size_t k = 0; k < plain.size(); ++k) {
            CHECK(impacts[k].side == plain[k].side);
            CHECK(impacts[k].tau == doctest::Approx(plain[k].tau).epsilon(1e-14));
            CHECK(impacts[k].x == doctest::Approx(plain[k].x).epsilon(1e-12));
            CHECK(
                impacts[k].relative_speed_before ==
                doctest::Approx(plain[k].relative_speed_before).epsilon(1e-12));
        }
    }
}
