// How fast the core is, as a ratio to the plain program that one writes first: the closed form with
// the library's sin, cos and exp, a scan for a change of sign, bisection, and a dense QR at each
// impact. Both run in turn, the medians count.
#include <Eigen/QR>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/stability/lyapunov.hpp"
#include "core/sweep/parallel.hpp"
#include "core/sweep/point.hpp"

using namespace vines;

namespace {

struct Plain {
    long impacts = 0;
    double lambda1 = 0;
};

Plain plain(const Parameters& p, long impacts, double scan_step) {
    const double z = p.zeta(), W = p.Omega, a = p.epsilon * p.A(), wd = std::sqrt(1 - z * z);
    const double D = (1 - W * W) * (1 - W * W) + 4 * z * z * W * W, X = a * (1 - W * W) / D,
                 Y = -2 * z * W * a / D;
    double x = 0, v = 0, y = 0.95 * p.b, u = 0, theta = p.phi(), T = 0;
    int left = 0;  // the wall that the mass has just left
    Matrix4 frame = Matrix4::Identity();
    double growth = 0;
    Plain result;
    while (result.impacts < impacts) {
        const double q = x - X * std::sin(theta) - Y * std::cos(theta),
                     r = (v - W * (X * std::cos(theta) - Y * std::sin(theta)) + z * q) / wd;
        auto position = [&](double s) {
            return std::exp(-z * s) * (q * std::cos(wd * s) + r * std::sin(wd * s)) +
                   X * std::sin(theta + W * s) + Y * std::cos(theta + W * s);
        };
        auto beyond = [&](double s) { return std::abs(position(s) - y - u * s) - p.b; };
        double low = left ? 1e-7 : 0, s = low;
        do s = (low = s) + scan_step;
        while (beyond(s) < 0);
        for (double high = s;
             high - low > 1e-15 * s && 0.5 * (low + high) != low && 0.5 * (low + high) != high;) {
            s = 0.5 * (low + high);
            (beyond(s) < 0 ? low : high) = s;
        }
        const double e = std::exp(-z * s), c = std::cos(wd * s), n = std::sin(wd * s),
                     t = theta + W * s;
        x = position(s);
        v = e * ((wd * r - z * q) * c - (wd * q + z * r) * n) +
            W * (X * std::cos(t) - Y * std::sin(t));
        y += u * s;
        theta = std::remainder(t, 2 * 3.14159265358979323846);
        T += s;
        left = x > y ? 1 : -1;
        const Contact contact{s, left, {x, v, std::sin(theta), std::cos(theta)}, v - u};
        const Impact i = impact_at(p, contact, a * std::sin(theta) - x - 2 * z * v, T);
        const Leg flight{
            {e * (c - z / wd * n), -e / wd * n, e / wd * n, e * (z / wd * n + c)},
            s,
            -2 * z * s,
            1,
            false};
        frame = saltation(p, i).matrix() * transfer_of(flight, p.epsilon) * frame;
        const Eigen::HouseholderQR<Matrix4> qr(frame);
        growth += std::log(std::abs(qr.matrixQR()(0, 0)));
        frame = qr.householderQ();
        v = i.x_dot_after, u = i.y_dot_after;
        ++result.impacts;
    }
    result.lambda1 = growth / T;
    return result;
}

template <class Work>
double nanoseconds(long impacts, Work work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start)
               .count() /
           impacts;
}

double median(std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + v.size() / 2, v.end());
    return v[v.size() / 2];
}

/// Points per second of the sweep of Table 3's range on one and on two threads, taken in turn.
void bench_sweep() {
    constexpr std::size_t points = 200;
    const auto run = [&](int threads) {
        const auto start = std::chrono::steady_clock::now();
        parallel(points, threads, [&](std::size_t i) {
            Parameters p;
            p.b = 0.003 + 0.037 * static_cast<double>(i) / (points - 1);
            p.damping = Damping::closed_form;
            measure(p, default_state(p), {}, {});
        });
        return points /
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    std::vector<double> one, two, efficiency;
    for (int k = 0; k < 9; ++k) {
        one.push_back(run(1));
        two.push_back(run(2));
        efficiency.push_back(two.back() / one.back() / 2);
    }
    std::printf(
        "\nsweep of b from 3 to 40 mm, 200 + 1000 cycles a point, exponents, regime and energy; "
        "median of 9\n");
    std::printf(
        "points per second: %.0f on one thread, %.0f on two; parallel efficiency %.0f %%\n",
        median(one), median(two), 100 * median(efficiency));
}

}  // namespace

int main() {
    const struct {
        double b;
        Damping damping;
        const char* name;
    } cases[] = {
        {0.015, Damping::closed_form, "b = 15 mm, two impacts per cycle"},
        {0.008, Damping::equation_of_motion, "b = 8 mm, three impacts per cycle"},
        {0.003, Damping::closed_form, "b = 3 mm, irregular"},
        {0.034, Damping::closed_form, "b = 34 mm, sparse"}};
    const long impacts = 2000;
    std::printf(
        "%-36s %12s %12s %12s %8s\n", "ns per impact, median of 9", "trajectory", "with qr",
        "plain", "ratio");
    for (const auto& c : cases) {
        Parameters p;
        p.b = c.b;
        p.damping = c.damping;
        const Limits limits{1e9, impacts, {}};
        std::vector<double> trajectory, spectrum, scan;
        for (int k = 0; k < 9; ++k) {
            trajectory.push_back(
                nanoseconds(impacts, [&] { simulate(p, default_state(p), limits, {}); }));
            spectrum.push_back(nanoseconds(impacts, [&] {
                Lyapunov lyapunov(p, 0, 1e9, qr_alone);
                Observer* const observers[] = {&lyapunov};
                simulate(p, default_state(p), limits, observers);
            }));
            // A step of .05 still misses contacts, but few enough that it gets through; in a
            // chatter it never ends.
            scan.push_back(
                nanoseconds(impacts, [&] { plain(p, c.b == 0.034 ? 300 : impacts, 0.05); }) *
                (c.b == 0.034 ? impacts / 300.0 : 1));
        }
        std::printf(
            "%-36s %12.0f %12.0f %12.0f %8.1f\n", c.name, median(trajectory), median(spectrum),
            median(scan), median(scan) / median(spectrum));
    }
    bench_sweep();
}
