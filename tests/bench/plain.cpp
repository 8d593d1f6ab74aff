#include "plain.hpp"

#include <Eigen/QR>
#include <cmath>

#include "core/stability/exterior.hpp"

namespace vines::bench {

Plain plain(const Parameters& p, long impacts, double scan_step) {
    const double z = p.zeta(), W = p.Omega, a = p.epsilon * p.A(), wd = std::sqrt(1 - z * z);
    const double D = (1 - W * W) * (1 - W * W) + 4 * z * z * W * W, X = a * (1 - W * W) / D,
                 Y = -2 * z * W * a / D;
    double x = 0, v = 0, y = 0.95 * p.b, u = 0, theta = p.phi(), T = 0;
    int left = 0;  // the wall that the ball has just left
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

}  // namespace vines::bench
