// Motion between events: a harmonically forced linear oscillator, alone (free) or with the ball at
// rest on its wall (sticking), as a function of the time s since the last event.
//
// The flow is stored as the exponential of the matrix of (x, x', sin theta, cos theta): a table on
// a grid of s, and a Taylor series within a cell. It equals the closed form (8)-(11) to the last
// ulp for every zeta >= 0 and every Omega, without special cases: (8)-(11) divide by omega_d and by
// the distance to resonance. Absolute time does not occur; the forcing phase is a phasor.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <initializer_list>
#include <memory>

#include "core/motion/parameters.hpp"

namespace vines {

/// State of the linear oscillator and phasor of the forcing phase theta = Omega tau + phi.
struct Oscillation {
    double x, x_dot;
    double sin_theta, cos_theta;
};

/// A polynomial of the time s.
struct Polynomial {
    static constexpr int most = 14;  ///< coefficients
    std::array<double, most> c{};    ///< zero from `size` on
    int size = 0;

    Polynomial() = default;
    Polynomial(std::initializer_list<double> coefficients) {
        for (const double value : coefficients) c[static_cast<std::size_t>(size++)] = value;
    }
    double operator[](int n) const { return c[static_cast<std::size_t>(n)]; }
    /// Adds value s^n.
    void add(int n, double value) {
        c[static_cast<std::size_t>(n)] += value;
        if (size <= n) size = n + 1;
    }

    double at(double s) const {
        double sum = 0;
        for (int n = size - 1; n >= 0; --n) sum = sum * s + (*this)[n];
        return sum;
    }
    double rate(double s) const {
        double sum = 0;
        for (int n = size - 1; n >= 1; --n) sum = sum * s + n * (*this)[n];
        return sum;
    }
    double second(double s) const {
        double sum = 0;
        for (int n = size - 1; n >= 2; --n) sum = sum * s + n * (n - 1) * (*this)[n];
        return sum;
    }
    Polynomial derivative() const {
        Polynomial p;
        for (int n = 1; n < size; ++n) p.add(n - 1, n * (*this)[n]);
        return p;
    }
    /// The same polynomial as a function of the time since s.
    Polynomial about(double s) const {
        Polynomial moved = *this;
        for (int k = 0; k + 1 < size; ++k)
            for (int n = size - 2; n >= k; --n)
                moved.c[static_cast<std::size_t>(n)] += s * moved[n + 1];
        return moved;
    }
    /// Upper bound of |k-th derivative| over 0 <= s <= time.
    double bound(int k, double time) const {
        double sum = 0;
        for (int n = size - 1; n >= k; --n) {
            double factor = 1;
            for (int i = 0; i < k; ++i) factor *= n - i;
            sum = sum * time + factor * std::abs((*this)[n]);
        }
        return sum;
    }
    bool is_zero() const {
        for (int n = 0; n < size; ++n)
            if ((*this)[n] != 0) return false;
        return true;
    }
};

/// one + factor other
inline Polynomial sum(Polynomial one, const Polynomial& other, double factor = 1) {
    for (int n = 0; n < other.size; ++n) one.add(n, factor * other[n]);
    return one;
}

/// The 2x2 block [a11 a12; a21 a22] of the transfer matrix J (19), in the order (x', x).
struct Transfer {
    double a11 = 1, a12 = 0, a21 = 0, a22 = 1;
};

/// x'' = -stiffness x - damping x' + forcing sin(theta), theta' = Omega.
class Flow {
public:
    /// The grid covers 3 periods of the faster of forcing and oscillator.
    static constexpr int cells = 128;
    /// Degree of the Taylor series within a cell; its remainder is below 1e-20 of the motion.
    static constexpr int degree = 13;
    static constexpr int block = 4;  ///< grid points that relative_positions() evaluates at once
    using TaylorSeries = Eigen::Array<double, degree + 1, 1>;
    using Block = Eigen::Array<double, block, 1>;

    /// Stiffness, damping, forcing, Omega: they determine a flow.
    using Coefficients = std::array<double, 4>;

    Flow(double stiffness, double damping, double forcing, double Omega);

    /// The oscillator of eq. (2), while the ball flies freely. Flows come from the thread's cache:
    /// one table serves all systems of equal forcing and damping.
    static std::shared_ptr<const Flow> shared_free(const Parameters& parameters);
    /// Both masses moving as one: (1 + epsilon) x'' + 2 zeta x' + x = epsilon A sin(theta).
    static std::shared_ptr<const Flow> shared_sticking(const Parameters& parameters);

    static Coefficients free_coefficients(const Parameters& parameters);
    Coefficients coefficients() const { return {stiffness_, damping_, forcing_, Omega_}; }
    double cell() const { return cell_; }  ///< width h of a cell
    /// Longest time that one table look-up can bridge.
    double reach() const { return cell_ * cells; }
    /// The transfer matrix over s has the determinant e^(-damping s).
    double damping() const { return damping_; }
    /// Decay rate of the faster part of the unforced motion.
    double fastest_decay() const { return fastest_decay_; }

    double acceleration(const Oscillation& o) const {
        return -stiffness_ * o.x - damping_ * o.x_dot + forcing_ * o.sin_theta;
    }
    /// Third and fourth derivative of x.
    double jerk(const Oscillation& o) const {
        return -stiffness_ * o.x_dot - damping_ * acceleration(o) + forcing_ * Omega_ * o.cos_theta;
    }

    double snap(const Oscillation& o) const {
        return -stiffness_ * acceleration(o) - damping_ * jerk(o) -
               forcing_ * Omega_ * Omega_ * o.sin_theta;
    }

    /// Grid times, and the responses of x at these times to each part of the state with size 1.
    template <std::size_t size>
    struct Columns {
        std::array<double, size> time, x, x_dot, sin, cos;

        void set(std::size_t k, double at, const std::array<double, 4>& responses) {
            time[k] = at;
            x[k] = responses[0], x_dot[k] = responses[1], sin[k] = responses[2],
            cos[k] = responses[3];
        }
        /// x - y at the times k, ..., k + block - 1 for y = y0 + y_dot s: five multiply-adds each.
        Block relative_positions(const Oscillation& o, double y0, double y_dot, int k) const {
            const auto from = [k](const auto& column) {
                return Eigen::Map<const Block>(column.data() + k);
            };
            return from(x) * o.x + from(x_dot) * o.x_dot + from(sin) * o.sin_theta +
                   from(cos) * o.cos_theta - (y0 + from(time) * y_dot);
        }
        Block squared_times(int k) const {
            return Eigen::Map<const Block>(time.data() + k).square();
        }
    };
    // Long enough for a block that begins at the last grid time or block end.
    static constexpr std::size_t columns = cells + block * block + 1;
    Columns<columns> grid;                ///< at 0, h, 2 h, ...
    Columns<columns / block> block_ends;  ///< at block h, 2 block h, ...

    /// Columns::relative_positions() on the grid for a curved path of the ball.
    Block relative_positions(const Oscillation& o, const Polynomial& y, int k) const {
        Block g = grid.relative_positions(o, y[0], y[1], k);
        if (y.size <= 2) return g;
        const auto time = Eigen::Map<const Block>(grid.time.data() + k);
        Block curved = Block::Zero();
        for (int n = y.size - 1; n >= 2; --n) curved = curved * time + y[n];
        return g - time * time * curved;
    }
    /// The full state at grid time k h.
    Oscillation at(const Oscillation& o, int k) const;
    /// x' alone.
    double speed_at(const Oscillation& o, int k) const {
        const Row& r = rows_[static_cast<std::size_t>(k)];
        return r.x_dot[0] * o.x + r.x_dot[1] * o.x_dot + r.x_dot[2] * o.sin_theta +
               r.x_dot[3] * o.cos_theta;
    }
    /// The full state, except for the last ulp of the phasor's length.
    Oscillation roughly_at(const Oscillation& o, int k) const {
        const Row& r = rows_[static_cast<std::size_t>(k)];
        return {
            r.x[0] * o.x + r.x[1] * o.x_dot + r.x[2] * o.sin_theta + r.x[3] * o.cos_theta,
            r.x_dot[0] * o.x + r.x_dot[1] * o.x_dot + r.x_dot[2] * o.sin_theta +
                r.x_dot[3] * o.cos_theta,
            o.sin_theta * r.cos + o.cos_theta * r.sin, o.cos_theta * r.cos - o.sin_theta * r.sin};
    }
    /// Taylor coefficients of x(s + d) in d.
    TaylorSeries series(const Oscillation& o) const {
        return of_x_.series * o.x + of_x_dot_.series * o.x_dot + of_sin_.series * o.sin_theta +
               of_cos_.series * o.cos_theta;
    }
    /// The same, shorter, to 1e-18 of the motion: coefficients in pairs of even and odd powers.
    static constexpr int short_pairs = 6;
    using ShortCoefficients = Eigen::Array<double, 2 * short_pairs, 1>;
    struct ShortSeries {
        ShortCoefficients x, x_dot;
        /// x and x' at d.
        std::array<double, 2> at(double d) const {
            // Estrin's scheme: three levels of operations instead of eleven.
            const double q = d * d, q_squared = q * q, q_fourth = q_squared * q_squared;
            const auto value = [=](const ShortCoefficients& c) __attribute__((always_inline)) {
                const auto pair = [&c](Eigen::Index k) { return c.segment<2>(2 * k); };
                const Eigen::Array2d sum = pair(0) + pair(1) * q +
                                           (pair(2) + pair(3) * q) * q_squared +
                                           (pair(4) + pair(5) * q) * q_fourth;
                return sum[0] + d * sum[1];
            };
            return {value(x), value(x_dot)};
        }
    };
    ShortSeries short_series(const Oscillation& o) const {
        return {
            of_x_.near.x * o.x + of_x_dot_.near.x * o.x_dot + of_sin_.near.x * o.sin_theta +
                of_cos_.near.x * o.cos_theta,
            of_x_.near.x_dot * o.x + of_x_dot_.near.x_dot * o.x_dot +
                of_sin_.near.x_dot * o.sin_theta + of_cos_.near.x_dot * o.cos_theta};
    }
    /// The state with its phasor rotated over 0 <= d <= h; x and x' are unchanged.
    Oscillation rotated(const Oscillation& o, double d) const;
    /// The same for |d| Omega < 1e-6.
    Oscillation rotated_little(const Oscillation& o, double d) const {
        const double a = Omega_ * d, cos = 1 - 0.5 * a * a;
        return {
            o.x, o.x_dot, o.sin_theta * cos + o.cos_theta * a, o.cos_theta * cos - o.sin_theta * a};
    }
    /// The state after 0 <= d <= h, with `series` about o.
    Oscillation along(const TaylorSeries& series, const Oscillation& o, double d) const;
    /// The state after any s >= 0.
    Oscillation after(Oscillation o, double s) const;
    /// The transfer matrix over any s >= 0, eq. (19).
    Transfer transfer(double s) const;

    /// Upper bounds over the reach, or over `time`, from the growth of the energy: sqrt(stiffness
    /// x^2 + x'^2) grows no faster than |forcing|, for any damping >= 0.
    struct Bounds {
        double x, x_ddot, x_dddot;
    };
    Bounds bounds(const Oscillation& o) const { return bounds(o, reach()); }
    Bounds bounds(const Oscillation& o, double time) const {
        // d/ds (stiffness x^2 + x'^2)/2 = x' (forcing sin theta - damping x') <= |x'| |forcing|
        const double speed =
            std::sqrt(stiffness_ * o.x * o.x + o.x_dot * o.x_dot) + std::abs(forcing_) * time;
        const double x = speed * inverse_root_stiffness_;
        const double x_ddot = stiffness_ * x + damping_ * speed + std::abs(forcing_);
        return {x, x_ddot, stiffness_ * speed + damping_ * x_ddot + std::abs(forcing_) * Omega_};
    }

private:
    double stiffness_, damping_, forcing_, Omega_;
    double cell_;  // h
    double inverse_root_stiffness_, fastest_decay_;
    // Taylor coefficients of x within a cell, as response to one part of the state with size 1.
    struct Response {
        TaylorSeries series;
        ShortSeries near;
    };
    Response of_x_, of_x_dot_, of_sin_, of_cos_;
    // Responses of x and x' to the four parts by grid time, and the rotation of the phasor.
    struct Row {
        std::array<double, 4> x, x_dot;
        double cos, sin;
    };
    std::array<Row, cells + 1> rows_;
};

/// x, x' and x''/2 of a Taylor series at d.
struct SeriesValue {
    double x, x_dot, half_x_ddot;
};
SeriesValue value_at(const Flow::TaylorSeries& series, double d);

/// max(known, max |x|) over 0 <= s <= duration, m. In most of a long run a bound settles it.
double peak_beyond(double known, const Flow& flow, Oscillation start, double duration);

/// The same of the motion of a flow plus a polynomial.
double peak_beyond(
    double known, const Flow& flow, const Oscillation& start, const Polynomial& shift, double from,
    double to);

/// Total variation of x of that motion, in m.
double path_length(
    const Flow& flow, const Oscillation& start, const Polynomial& shift, double from, double to);

/// Caches a pure function of a few numbers for its most recent keys; a new entry replaces the
/// oldest. Declare it thread_local: no lock, and a thread's results do not depend on other threads.
template <class Key, class Table, std::size_t most = 4>
class SmallCache {
public:
    template <class Make>
    std::shared_ptr<const Table> get(const Key& key, Make make) {
        for (const Entry& e : entries_)
            if (e.table && e.key == key) return e.table;
        Entry& oldest = entries_[next_++ % most];
        oldest = {key, std::make_shared<const Table>(make())};
        return oldest.table;
    }

private:
    struct Entry {
        Key key;
        std::shared_ptr<const Table> table;
    };
    std::array<Entry, most> entries_;
    std::size_t next_ = 0;
};

}  // namespace vines
