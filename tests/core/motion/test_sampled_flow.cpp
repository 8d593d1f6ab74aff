#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../support.hpp"
#include "core/motion/record.hpp"

using namespace vines;
using namespace vines::test;

namespace {

constexpr double ulp = std::numeric_limits<double>::epsilon();

/// The samples of a series, each computed directly, and the motion's size there.
class Direct : public Observer {
public:
    explicit Direct(double step) : step_(step) {}
    void on_stretch(const Stretch& stretch) override {
        for (double at = next_ * step_; at < stretch.tau + stretch.duration; at = ++next_ * step_) {
            const double s = std::max(0.0, at - stretch.tau);
            states.push_back(stretch.at(s));
            x_ddot.push_back(stretch.x_ddot(s));
            sizes.push_back(stretch.flow.bounds(stretch.flow.after(stretch.start, s)).x);
        }
        if (stretch.sticking_side != 0) ++sticking;
    }
    std::vector<State> states;
    std::vector<double> x_ddot, sizes;
    int sticking = 0;

private:
    const double step_;
    long next_ = 0;
};

}  // namespace

TEST_CASE("a sampled flow equals the flow to 16 ulp of the motion's size") {
    const Oscillation start{0.003, -0.004, std::sin(0.7), std::cos(0.7)};
    for (const double damping : {0.0, 0.02, 0.7, 3.0})
        for (const double Omega : {0.3, 1.0, 4.0})
            for (const double step : {0.001, 0.0491, 0.1963, 1.0, 6.3})
                for (const double tau : {0.0, 1234.5678, 5e6 + 0.1}) {
                    CAPTURE(damping);
                    CAPTURE(Omega);
                    CAPTURE(step);
                    CAPTURE(tau);
                    const Flow flow(1, damping, 0.0001, Omega);
                    SampledFlow sampled(step);
                    sampled.begin(flow, start);
                    double worst = 0;
                    for (int k = 0; k < 300; ++k) {
                        const double s = (tau + k * step) - tau;
                        if (s > flow.reach()) break;  // no stretch is longer
                        const Oscillation direct = flow.after(start, s), o = sampled.at(s);
                        const double size = flow.bounds(direct).x;
                        worst = std::max(
                            {worst, std::abs(o.x - direct.x) / size,
                             std::abs(o.x_dot - direct.x_dot) / size,
                             std::abs(o.sin_theta - direct.sin_theta),
                             std::abs(o.cos_theta - direct.cos_theta)});
                    }
                    CHECK(worst <= 16 * ulp);
                }
}

TEST_CASE("a series equals the motion of each stretch, free and sticking, up to rounding") {
    std::mt19937_64 engine(20);
    int sticking = 0;
    for (int system = 0; system < 40; ++system) {
        CAPTURE(system);
        const System s = random_system(engine);
        const double step = s.parameters.cycle() / 40;
        SeriesRecord series(step);
        Direct direct(step);
        record(s.parameters, s.start, 30 * s.parameters.cycle(), 3000, {&series, &direct});
        REQUIRE(series.series.tau.size() == direct.states.size());
        double worst = 0;
        for (std::size_t k = 0; k < direct.states.size(); ++k) {
            const Series& r = series.series;
            const State& d = direct.states[k];
            worst = std::max(
                {worst, std::abs(r.x[k] - d.x) / direct.sizes[k],
                 std::abs(r.x_dot[k] - d.x_dot) / direct.sizes[k],
                 std::abs(r.y[k] - d.y) / (direct.sizes[k] + std::abs(d.y)),
                 std::abs(r.y_dot[k] - d.y_dot) / (direct.sizes[k] + std::abs(d.y_dot))});
        }
        CHECK(worst <= 32 * ulp);
        sticking += direct.sticking;
    }
    CHECK(sticking > 0);
}
