// The product of all transfer matrices of a run, and the derivative of its end with respect to its
// start, which must be equal.
#pragma once

#include "core/stability/exterior.hpp"

namespace vines::test {

/// Observer of the product.
struct WholeRunProduct : Observer {
    explicit WholeRunProduct(const Parameters& parameters) : p(parameters) {}
    void on_stretch(const Stretch& s) override { m = transfer_of(leg_of(s), p.epsilon) * m; }
    void on_impact(const Impact& i) override { m = saltation(p, i).matrix() * m; }
    void on_slip(const Slip& s) override { m = saltation(p.epsilon, s).matrix() * m; }

    const Parameters p;
    Matrix4 m = Matrix4::Identity();
};

/// Differences of fourth order of runs from tau = 0 to `until`.
inline Matrix4 derivative_of_run(const Parameters& p, const State& start, double until) {
    constexpr double h = 1e-6;
    Matrix4 derivative;
    for (int k = 0; k < 4; ++k) {
        const auto run = [&](double by) {
            const Eigen::Vector4d from = vector_of(start) + by * Eigen::Vector4d::Unit(k);
            return vector_of(simulate(p, state_of(from), {until, 1000, {}}, {}).state);
        };
        derivative.col(k) = (8 * (run(h) - run(-h)) - (run(2 * h) - run(-2 * h))) / (12 * h);
    }
    return derivative;
}

}  // namespace vines::test
