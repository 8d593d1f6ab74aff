// Makes law_*.txt beside it: make_laws gravity|friction|restitution|load|all writes one to standard
// output; scripts/references makes them all.
//
// The motion beyond the paper's laws in 60 digits, by a method that shares no code with the program
// under test: the closed form of each part of the motion, and a march to its end in steps within
// which no event is possible (safe_step). Parameters are doubles, those of laws.hpp.
//
// A line an impact, as in the other files: tau side x x'- y'- x'+ y'+; other events after a #.
#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdio>
#include <cstring>
#include <optional>
#include <vector>

#include "laws.hpp"

namespace {

namespace mp = boost::multiprecision;
using Real = mp::number<mp::cpp_bin_float<60>, mp::et_off>;
using vines::test::LawCase;

const Real smallest_step("1e-50");
/// An impact that leaves the ball with less speed at a wall that presses it ends a chatter.
const Real stick_speed("1e-25");

int sign_of(const Real& v) { return (v > 0) - (v < 0); }

/// x and its derivatives.
struct Position {
    Real x, x_dot, x_ddot, x_dddot;
};

/// The solution of mass x'' + 2 zeta x' + x = c0 + c1 s + c2 s^2 + c3 s^3 + F sin(theta + Omega s)
/// from (x, x') on, s >= 0.
class Motion {
public:
    struct Force {
        Real c[4];
        Real F, theta;
    };
    Motion(
        const LawCase& law, const Real& mass, const Force& force, const Real& x, const Real& x_dot)
        : k_(1 / mass),
          alpha_(Real(law.epsilon) * Real(law.lambda) / (2 * mass)),
          w_(sqrt(k_ - alpha_ * alpha_)),
          Omega_(law.Omega),
          theta_(force.theta) {
        const Real f = force.F / mass, detuning = k_ - Omega_ * Omega_;
        const Real D = detuning * detuning + 4 * alpha_ * alpha_ * Omega_ * Omega_;
        X_ = f * detuning / D;
        Y_ = -2 * alpha_ * Omega_ * f / D;
        for (int n = 3; n >= 0; --n) {
            p_[n] = force.c[n] / mass;
            if (n < 3) p_[n] -= 2 * alpha_ * (n + 1) * p_[n + 1];
            if (n < 2) p_[n] -= Real(n + 1) * (n + 2) * p_[n + 2];
            p_[n] /= k_;
        }
        const Real sine = sin(theta_), cosine = cos(theta_);
        q_ = x - p_[0] - X_ * sine - Y_ * cosine;
        r_ = (x_dot - p_[1] - Omega_ * (X_ * cosine - Y_ * sine) + alpha_ * q_) / w_;
    }
    Position at(const Real& s) const {
        const Real decay = exp(-alpha_ * s), C = cos(w_ * s), S = sin(w_ * s);
        const Real free = decay * (q_ * C + r_ * S);
        const Real free_dot = decay * ((w_ * r_ - alpha_ * q_) * C - (w_ * q_ + alpha_ * r_) * S);
        const Real free_ddot = -k_ * free - 2 * alpha_ * free_dot;
        const Real sine = sin(theta_ + Omega_ * s), cosine = cos(theta_ + Omega_ * s);
        const Real forced = X_ * sine + Y_ * cosine, rate = Omega_ * (X_ * cosine - Y_ * sine);
        const Real square = Omega_ * Omega_;
        return {
            free + forced + p_[0] + s * (p_[1] + s * (p_[2] + s * p_[3])),
            free_dot + rate + p_[1] + s * (2 * p_[2] + s * 3 * p_[3]),
            free_ddot - square * forced + 2 * p_[2] + 6 * s * p_[3],
            -k_ * free_dot - 2 * alpha_ * free_ddot - square * rate + 6 * p_[3]};
    }
    /// Upper bound of the n-th derivative of x up to `time`, n = 2, 3 or 4: the unforced part is
    /// the real part of (q - i r) e^((i w - alpha) s), and |i w - alpha|^2 = k.
    Real bound(int n, const Real& time) const {
        const Real polynomial = n == 2   ? 2 * abs(p_[2]) + 6 * time * abs(p_[3])
                                : n == 3 ? 6 * abs(p_[3])
                                         : Real(0);
        return pow(sqrt(k_), n) * sqrt(q_ * q_ + r_ * r_) +
               pow(Omega_, n) * sqrt(X_ * X_ + Y_ * Y_) + polynomial;
    }

private:
    Real k_, alpha_, w_, Omega_, theta_, X_, Y_, q_, r_, p_[4];
};

/// For how long a function cannot come down to zero that has this value and slope now, and a second
/// derivative of modulus `bound` at most.
Real safe_step(const Real& value, const Real& slope, const Real& bound) {
    const Real root = sqrt(slope * slope + 2 * bound * value);
    return slope < 0 ? 2 * value / (root - slope) : (slope + root) / bound;
}

class Run {
public:
    explicit Run(const LawCase& law) : law_(law), x_(0), v_(0), y_(law.y0), y_dot_(law.y_dot0) {
        epsilon_ = law.epsilon, gravity_ = law.gravity, friction_ = law.friction, b_ = law.b;
        for (std::size_t i = 0; i < law.load_tau.size(); ++i) {
            base_.push_back(state_of_base_);
            if (i + 1 == law.load_tau.size()) break;
            const Real h = Real(law.load_tau[i + 1]) - Real(law.load_tau[i]), a = law.load[i],
                       slope = (Real(law.load[i + 1]) - a) / h;
            auto& [place, speed] = state_of_base_;
            place += h * (speed + h * (a / 2 + h * slope / 6));
            speed += h * (a + h * slope / 2);
        }
        direction_ = sign_of(v_ - y_dot_);
    }

    void run(int impacts) {
        while (impacts_ < impacts) together_ ? follow_together() : fly();
    }

private:
    /// The right-hand side of the oscillator's equation from now on, without the ball.
    Motion::Force force() const {
        const Real lambda_epsilon = Real(law_.lambda) * epsilon_;
        Motion::Force f{};
        f.F = epsilon_ * Real(law_.G) * sqrt(1 + pow(lambda_epsilon * Real(law_.Omega), 2));
        f.theta = Real(law_.Omega) * tau_ + atan(lambda_epsilon * Real(law_.Omega));
        if (base_.empty()) return f;
        const Real from = law_.load_tau[interval_], h = Real(law_.load_tau[interval_ + 1]) - from,
                   slope = (Real(law_.load[interval_ + 1]) - Real(law_.load[interval_])) / h,
                   s = tau_ - from, a = Real(law_.load[interval_]) + slope * s;
        const Real v = base_[interval_].second + s * (Real(law_.load[interval_]) + slope * s / 2),
                   x = base_[interval_].first +
                       s * (base_[interval_].second +
                            s * (Real(law_.load[interval_]) / 2 + s * slope / 6));
        f.c[0] = x + lambda_epsilon * v;
        f.c[1] = v + lambda_epsilon * a;
        f.c[2] = a / 2 + lambda_epsilon * slope / 2;
        f.c[3] = slope / 6;
        return f;
    }
    Real until_boundary() const {
        return base_.empty() ? Real(1) : Real(law_.load_tau[interval_ + 1]) - tau_;
    }
    Motion joint() const {
        Motion::Force f = force();
        f.c[0] += epsilon_ * gravity_;
        return {law_, 1 + epsilon_, f, x_, v_};
    }
    /// x'' - gravity of the joint motion.
    Real pull() const { return joint().at(0).x_ddot - gravity_; }

    void advance(const Position& at, const Real& s, const Real& y_ddot) {
        x_ = at.x, v_ = at.x_dot;
        y_ += s * (y_dot_ + s * y_ddot / 2);
        y_dot_ += s * y_ddot;
        tau_ += s;
    }

    /// Free flight up to the next event, or to the end of the load's interval.
    void fly() {
        Motion::Force f = force();
        f.c[0] -= epsilon_ * friction_ * direction_;
        const Motion motion(law_, 1, f, x_, v_);
        const Real a = gravity_ + friction_ * direction_, end = until_boundary(),
                   bound2 = motion.bound(2, end) + abs(a), bound3 = motion.bound(3, end);
        // After a release x - y, its rate and x'' - y'' begin at zero.
        Real s = released_
                     ? std::min(end, Real(2 * abs(motion.at(0).x_dddot) / motion.bound(4, end)))
                     : Real(0);
        released_ = false;
        while (s < end) {
            const Position at = motion.at(s);
            const Real y = y_ + s * (y_dot_ + s * a / 2), y_dot = y_dot_ + s * a,
                       w = at.x_dot - y_dot;
            Real step = end - s;
            for (const int side : {1, -1}) {
                const Real gap = b_ - side * (at.x - y), safe = safe_step(gap, -side * w, bound2);
                if (side * w > 0 && safe < smallest_step) {
                    advance(at, s, a);
                    return strike(side);
                }
                step = std::min(step, safe);
            }
            if (friction_ > 0) {
                const Real slope = direction_ * (at.x_ddot - a),
                           safe = safe_step(direction_ * w, slope, bound3);
                if (slope < 0 && safe < smallest_step) {
                    advance(at, s, a);
                    return stop_sliding();
                }
                step = std::min(step, safe);
            }
            s += step;
        }
        advance(motion.at(end), end, a);
        if (!base_.empty()) ++interval_;
    }

    void strike(int side) {
        const Real x_dot = v_, y_dot = y_dot_, w = abs(v_ - y_dot_), R = restitution(w),
                   change = (1 + R) * (x_dot - y_dot) / (1 + epsilon_);
        v_ -= epsilon_ * change;
        y_dot_ += change;
        y_ = x_ - side * b_;
        ++impacts_;
        std::printf("%.17g %d", static_cast<double>(tau_), side);
        for (const Real& value : {x_, x_dot, y_dot, v_, y_dot_})
            std::printf(" %.17g", static_cast<double>(value));
        std::printf("\n");
        direction_ = -side;
        if (R * w < stick_speed && side * pull() > -friction_) {
            v_ += epsilon_ / (1 + epsilon_) * (y_dot_ - v_);
            stay_together(side, "stick");
        }
    }
    Real restitution(const Real& w) const {
        if (law_.speed.empty()) return law_.R;
        std::size_t k = 0;
        while (k < law_.speed.size() && Real(law_.speed[k]) <= w) ++k;
        if (k == 0) return law_.table.front();
        if (k == law_.speed.size()) return law_.table.back();
        const Real from = law_.table[k - 1], at = law_.speed[k - 1];
        return from + (Real(law_.table[k]) - from) * (w - at) / (Real(law_.speed[k]) - at);
    }

    void stay_together(int wall, const char* name) {
        together_ = true;
        wall_ = wall;
        y_dot_ = v_;
        std::printf("# %s %.17g\n", name, static_cast<double>(tau_));
    }
    void stop_sliding() {
        y_dot_ = v_;
        if (abs(pull()) <= friction_) return stay_together(0, "rest");
        direction_ = sign_of(pull());
        std::printf("# slip %.17g\n", static_cast<double>(tau_));
    }

    void follow_together() {
        const Motion motion = joint();
        const Real end = until_boundary(), bound = motion.bound(4, end), apart = x_ - y_;
        Real s = 0;
        bool released = false;
        while (s < end && !released) {
            const Position at = motion.at(s);
            Real step = end - s;
            for (const int side : {1, -1}) {
                if (wall_ == -side) continue;
                const Real slope = side * at.x_dddot,
                           safe =
                               safe_step(friction_ + side * (at.x_ddot - gravity_), slope, bound);
                released = released || (slope < 0 && safe < smallest_step);
                step = std::min(step, safe);
            }
            if (!released) s += step;
        }
        const Position at = motion.at(s);
        tau_ += s, x_ = at.x, v_ = y_dot_ = at.x_dot, y_ = x_ - apart;
        if (!released) {
            if (!base_.empty()) ++interval_;
            return;
        }
        direction_ = wall_ != 0 ? -wall_ : sign_of(at.x_ddot - gravity_);
        together_ = false, released_ = true;
        std::printf("# release %.17g\n", static_cast<double>(tau_));
    }

    const LawCase& law_;
    Real epsilon_, gravity_, friction_, b_;
    std::pair<Real, Real> state_of_base_{0, 0};
    std::vector<std::pair<Real, Real>> base_;  // displacement and velocity at the samples
    Real tau_ = 0, x_, v_, y_, y_dot_;
    std::size_t interval_ = 0;
    int direction_ = 0, wall_ = 0, impacts_ = 0;
    bool together_ = false, released_ = false;
};

}  // namespace

int main(int argc, char** argv) {
    for (const LawCase& law : vines::test::law_cases())
        if (argc == 2 && law.name == argv[1]) {
            std::printf(
                "# %s; impacts: tau side x x'- y'- x'+ y'+; 60-digit arithmetic, 17 digits kept\n",
                argv[1]);
            Run(law).run(vines::test::law_impacts);
            return 0;
        }
    std::fprintf(stderr, "usage: make_laws gravity|friction|restitution|load|all\n");
    return 2;
}
