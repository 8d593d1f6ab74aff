// Table 1; test whether the closed form (8)-(11), as printed, solves the equation of motion (1);
// test whether the transfer matrix carries the difference of two trajectories (Fig. 2).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "report/claims.hpp"

namespace vines::report {

namespace {

/// Eqs. (2), (3) and (25) as printed, at the impacts of a run.
void forms_of_the_equations(Report& report, const PaperRun& r) {
    const Parameters& p = r.parameters;
    const double e = p.epsilon, R = p.R_plus;  // of both walls
    double forcing = 0, impact = 0;
    for (const Impact& i : r.run.impacts) {
        const double theta = p.Omega * i.tau,
                     of_1 = p.G * (elementary::sin(theta) +
                                   e * p.lambda * p.Omega * elementary::cos(theta)),
                     of_2 = p.A() * elementary::sin(theta + p.phi());
        forcing = std::max(forcing, std::abs(of_1 - of_2) / p.A());
        const double x = i.x_dot_before, y = i.y_dot_before,
                     x_after = ((1 - R * e) * x + (e + R * e) * y) / (e + 1),
                     y_after = ((1 + R) * x + (-R + e) * y) / (e + 1),
                     off = std::max(
                         std::abs(i.x_dot_after - x_after), std::abs(i.y_dot_after - y_after));
        impact = std::max(impact, off / (std::abs(x) + std::abs(y)));
    }
    const Criterion identity = {{0, 1e-10}, "an identity: only rounding is left"};
    report.add(
        {"Eqs. (1) to (3)",
         "forcing by (2) and (3), and by (1): largest difference over its amplitude",
         "(1) \"can also be written as\" (2)"},
        result("{:.0e}", forcing), identity);
    report.add(
        {"Eqs. (4), (25)",
         "x' and y' after the impacts at b = 22 mm by S of (25), and by (4): largest difference, "
         "relative to the velocities before",
         "S is (4)"},
        result("{:.0e}", impact), identity);
}

/// x(tau) by (8) to (11) as printed, with the paper's names and tau_0 = 0: x20 = x(0), x10 = x'(0).
std::function<double(double tau)> printed_closed_form(const Parameters& p, double x20, double x10) {
    using elementary::cos, elementary::exp, elementary::sin;
    const double O = p.Omega, e = p.epsilon, l = p.lambda, A = p.A(), phi = p.phi(),
                 D = O * O * O * O + (4 * e * e * l * l - 2) * O * O + 1,
                 f1 = -e * A * ((O * O - 1) * cos(phi) - 2 * l * e * O * sin(phi)) / D,
                 f2 = -e * A * ((O * O - 1) * sin(phi) + 2 * l * e * cos(phi) * O) / D,
                 omega_d = std::sqrt(1 - e * e * l * l), q1 = x20 - f2,
                 p1 = -(-x10 - e * l * x20 + e * l * f2 + f1 * O) / omega_d;
    return [=](double tau) {
        return exp(-e * l * tau) * (p1 * sin(omega_d * tau) + q1 * cos(omega_d * tau)) +
               f1 * sin(O * tau) + f2 * cos(O * tau);
    };
}

/// The k for which a motion satisfies x'' + k epsilon lambda x' + x = epsilon A sin(Omega tau +
/// phi) at tau; derivatives by central differences of the fourth order.
double damping_factor_of(
    const Parameters& p, const std::function<double(double)>& motion, double tau) {
    // The error of x' is h^4/30 times its fourth derivative, far above rounding.
    constexpr double h = 0.01;
    const auto x = [&](int k) { return motion(tau + k * h); };
    const double x_dot = (x(-2) - 8 * x(-1) + 8 * x(1) - x(2)) / (12 * h),
                 x_ddot = (-x(-2) + 16 * x(-1) - 30 * x(0) + 16 * x(1) - x(2)) / (12 * h * h);
    return (p.epsilon * p.A() * elementary::sin(p.Omega * tau + p.phi()) - x_ddot - x(0)) /
           (p.epsilon * p.lambda * x_dot);
}

void closed_form(Report& report, const Parameters& p) {
    const auto motion = printed_closed_form(p, 0.01, 0.003);  // any start
    double least = infinity, most = -infinity;
    // Times at which x' is not small; the motion has an amplitude of about 10 mm.
    for (double tau : {1.0, 2.5, 4.0, 5.5, 7.0, 30.0}) {
        const double k = damping_factor_of(p, motion, tau);
        least = std::min(least, k), most = std::max(most, k);
    }
    report.add(
        {"Eqs. (8) to (11)",
         "factor k of the damping in x'' + k epsilon lambda x' + x = ..., which they satisfy",
         "1, eq. (1)"},
        {std::abs(least - 1) > std::abs(most - 1) ? least : most, "{:.5f} to {:.5f} at six times",
         least, most},
        {{0.999, 1.001}, "the finite differences give x' and x'' to 1e-4"}, not_reproduced);
    report.paragraph(fmt::format(
        "The equation of motion (1) has 2 zeta = epsilon lambda; the closed form (8)-(11), "
        "inserted into it as printed, has {:.4f} times that, and so has the transfer matrix (19), "
        "(20). This report therefore uses two dampings, that of the equation of motion and that of "
        "the closed form.",
        most));
}

/// Compares the distance of two neighbouring runs with the length of the tangent vector that M J
/// propagates through their impacts (Fig. 2).
void trajectory_difference(Report& report) {
    Parameters p;
    p.damping = Damping::closed_form;
    AnalysisRequest wanted{.parameters = p, .start = default_state(p), .tau_end = 60};
    constexpr double size = 1e-10;  // m: small against nonlinearity, large against rounding
    wanted.perturbation = random_difference(1, size);
    wanted.parts = {.impacts = true};
    const Analysis run = analyse(wanted);
    const Perturbation& second = *run.perturbation;
    double largest = 0;
    for (std::size_t i = 0; i < second.distance.size(); ++i)
        largest = std::max(largest, std::abs(second.distance[i] / second.tangent[i] - 1));
    report.picture(
        "fig2",
        "Fig. 2: distance of two trajectories through their impacts, and its "
        "prediction by (26) to (32)",
        {{.x_label = "tau",
          .y_label = "distance (m)",
          .curves =
              {{.x = second.series.tau, .y = second.distance, .label = "distance"},
               {.x = second.series.tau,
                .y = second.tangent,
                .colour = grey,
                .label = "tangent vector",
                .dash = "5 4"}},
          .logarithmic = true}});
    report.add(
        {"Fig. 2, eqs. (26) to (32)",
         fmt::format(
             "two runs, {:g} m apart, to tau = {:g}: largest relative error of the distance "
             "predicted by M J",
             size, wanted.tau_end),
         "the transfer matrix"},
        {largest,
         "{:.0e} through {} impacts, {} of them at x - y = -b, while the distance grows "
         "{:.0f}-fold",
         largest, run.impacts.size(), std::ranges::count(run.impacts, -1, &Impact::side),
         second.distance.back() / size},
        {{0, 1e-3},
         "exact to first order: the error is of the size of the distance, plus rounding"});
}

}  // namespace

void model(Report& report, RunCache& runs) {
    report.heading("Table 1 and the equations of motion");
    const Parameters p;
    report.add(
        {"Table 1", "epsilon = m2/m1", ".84 %"}, result("{:.4f} %", 100 * p.epsilon),
        {{0.835, 0.845}, "rounds to .84"});
    report.add(
        {"Table 1", "lambda = c1/(m2 omega0)", "1.43"}, result("{:.4f}", p.lambda),
        {{1.425, 1.435}, "rounds to 1.43"});
    forms_of_the_equations(report, runs.paper_run(p.b, Damping::closed_form));
    closed_form(report, p);
    trajectory_difference(report);
}

}  // namespace vines::report
