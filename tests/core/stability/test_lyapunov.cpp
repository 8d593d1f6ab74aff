#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "../support.hpp"
#include "core/stability/lyapunov.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// lambda1 over consecutive windows of one run.
struct WindowsInARow {
    double mean, deviation, standard_error;
};
WindowsInARow windows(double b, int count, double length, double start) {
    const Parameters p = table1(b, Damping::closed_form);
    Lyapunov lyapunov(p, {start, 1e9}, {.qr = true, .history = 1000000});
    record(p, default_state(p), start + (count + 1) * length, 10000000, {&lyapunov});
    const ExponentHistory& h = lyapunov.product().qr_history();
    const double from = lyapunov.product().start_tau();
    double sum = 0, squares = 0, log_before = 0, tau_before = from;
    std::size_t i = 0;
    int n = 0;
    for (int k = 1; k <= count; ++k) {
        while (i + 1 < h.tau.size() && h.tau[i + 1] <= from + k * length) ++i;
        // a window without an impact is joined to the next one.
        if (h.tau[i] <= tau_before) continue;
        ++n;
        const double log = h.lambda[i][0] * (h.tau[i] - from),
                     mean = (log - log_before) / (h.tau[i] - tau_before);
        log_before = log;
        tau_before = h.tau[i];
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / n, deviation = std::sqrt(squares / n - mean * mean);
    return {mean, deviation, deviation / std::sqrt(n)};
}

}  // namespace

TEST_CASE("lambda1 over 100 windows of 1700 is the known value of each response") {
    const std::pair<double, double> chaotic[] = {
        {0.034, 0.149}, {0.025, 0.120}, {0.017, 0.049}, {0.003, 0.189}};
    for (const auto& known : chaotic) {
        const double b = known.first, lambda1 = known.second;
        CAPTURE(b);
        const WindowsInARow w = windows(b, 100, 1700, 1700);
        CHECK(std::abs(w.mean - lambda1) < 4 * w.standard_error);
        CHECK(w.standard_error < 0.003);
    }
    const std::pair<double, double> periodic[] = {{0.015, -0.0178}, {0.008, -0.0132}};
    for (const auto& known : periodic) {
        const double b = known.first, lambda1 = known.second;
        CAPTURE(b);
        CHECK(std::abs(windows(b, 100, 1700, 1700).mean - lambda1) < 1e-4);
    }
}

TEST_CASE(
    "the sum rule holds to 1e-10 in every window without sticking" * doctest::test_suite("long")) {
    int free_of_sticks = 0;
    for (double b : {0.040, 0.034, 0.028, 0.025, 0.022, 0.018, 0.0165, 0.015, 0.008, 0.0046, 0.003})
        for (Damping damping : {Damping::closed_form, Damping::equation_of_motion}) {
            const Parameters p = table1(b, damping);
            std::vector<std::unique_ptr<Lyapunov>> all;
            std::vector<Observer*> observers;
            for (int k = 0; k < 30; ++k) {
                all.push_back(std::make_unique<Lyapunov>(
                    p, Interval{1700.0 * k, 1700.0 * (k + 1)}, qr_alone));
                observers.push_back(all.back().get());
            }
            record(p, default_state(p), 1700 * 30, 1000000, observers);
            for (const auto& l : all) {
                if (l->product().rank() < 4) continue;
                ++free_of_sticks;
                CHECK(l->product().sum_rule_residual() < 1e-10);
            }
        }
    CHECK(free_of_sticks > 300);
}

TEST_CASE("the sum rule holds through nearly grazing impacts, where entries of M reach 1e8") {
    std::mt19937_64 engine(9);
    const Parameters p = table1(0.022, Damping::closed_form);
    for (double speed : {1e-4, 1e-6, 1e-8, 1e-10}) {
        TransferProduct product(
            p.epsilon, {.qr = true, .eigenvalues = true, .history = shortest_history});
        product.start(0);
        // Sum of the largest entry of each M, and the rounding of 1.
        double tau = 0, entries = 0;
        constexpr double ulp = std::numeric_limits<double>::epsilon();
        for (int n = 0; n < 300; ++n) {
            const double s = uniform(engine, 0.5, 5);
            tau += s;
            Contact c{
                0,
                n % 2 ? 1 : -1,
                {uniform(engine, -.005, .005), uniform(engine, -.005, .005), std::sin(n),
                 std::cos(n)},
                0};
            c.relative_speed = c.side * (n % 10 == 0 ? speed : uniform(engine, 0.002, 0.02));
            const Impact i = impact_at(p, c, Flow::shared_free(p)->acceleration(c.lo), tau);
            const Leg flight = leg_of(*Flow::shared_free(p), s, false);
            const Saltation M = saltation(p, i);
            entries += M.r().cwiseAbs().maxCoeff();
            product.append({&flight, 1}, M, tau);
        }
        CAPTURE(speed);
        // An entry magnifies the rounding of its operand.
        CHECK(product.sum_rule_residual() < std::max(1e-10, entries * ulp / tau));
    }
}

TEST_CASE(
    "on a periodic orbit the eigenvalues estimator and QR agree with the orbit's multipliers") {
    // closed form, b = 15 mm: two symmetric impacts per cycle after the transient.
    const Parameters p = table1(0.015, Damping::closed_form);
    const Record run = record(p, default_state(p), 6000);
    const std::size_t last = run.impacts.size() - 1;
    Matrix4 cycle = Matrix4::Identity();
    for (std::size_t k = last - 1; k <= last; ++k) {
        const double s = run.impacts[k].tau - run.impacts[k - 1].tau;
        cycle = saltation(p, run.impacts[k]).matrix() *
                transfer_of(leg_of(*Flow::shared_free(p), s, false), p.epsilon) * cycle;
    }
    const double period = run.impacts[last].tau - run.impacts[last - 2].tau;
    CHECK(period == doctest::Approx(2 * 3.14159265358979323846).epsilon(1e-9));
    Moduli multipliers = eigenvalue_moduli(cycle);
    for (double& m : multipliers) m = std::log(m) / period;

    Lyapunov lyapunov(p, {run.impacts[last - 401].tau - 1e-6, 6001}, all_estimators);
    record(p, default_state(p), 6000, 1000000, {&lyapunov});
    const Exponents eigenvalues = lyapunov.product().eigenvalues(), qr = lyapunov.product().qr();
    for (int k = 0; k < 4; ++k) {
        // 200 whole cycles: exactly the same number.
        CHECK(std::abs(eigenvalues[k] - multipliers[k]) < 1e-8);
        // QR differs by the transient of the frame.
        CHECK(std::abs(qr[k] - multipliers[k]) < 0.01);
    }
}

TEST_CASE(
    "raw_product shows the paper's four positive exponents, three of them the rounding floor") {
    const Parameters p = table1(0.022, Damping::closed_form);
    Lyapunov lyapunov(p, {0, 1709}, all_estimators);
    record(p, default_state(p), 1709, 100000, {&lyapunov});
    const TransferProduct& product = lyapunov.product();
    const Exponents raw = product.raw_product(), qr = product.qr();
    const double floor = rounding_floor(raw[0], product.end_tau() - product.start_tau());
    CHECK(raw[2] > 0);
    CHECK(std::abs(raw[2] - floor) < 0.01);
    CHECK(qr[0] > 0.06);
    CHECK(qr[0] < 0.15);
    CHECK(qr[1] < 0);
    CHECK(std::abs(raw[0] - product.eigenvalues()[0]) < 1e-9);
}

TEST_CASE("beyond the range of double raw_product has no value, eigenvalues and qr do") {
    const Parameters p = table1(0.034, Damping::closed_form);
    Lyapunov lyapunov(p, {0, 20000}, all_estimators);
    record(p, default_state(p), 20000, 100000, {&lyapunov});
    CHECK(status_of(lyapunov.product().raw_product()[0]) == Status::not_converged);
    CHECK(status_of(infinity) == Status::not_converged);
    CHECK(std::abs(lyapunov.product().eigenvalues()[0] - lyapunov.product().qr()[0]) < 1e-3);
}

TEST_CASE("after sticking two exponents are minus infinity, after R = 0 one is") {
    Parameters p = table1(0.015, Damping::closed_form);
    Lyapunov stick(p, {0, 1709}, all_estimators);
    record(p, default_state(p), 1709, 100000, {&stick});
    const Exponents qr = stick.product().qr(), eigenvalues = stick.product().eigenvalues();
    for (const Exponents& e : {qr, eigenvalues}) {
        CHECK(status_of(e[0]) == Status::ok);
        CHECK(status_of(e[1]) == Status::ok);
        CHECK(status_of(e[2]) == Status::minus_infinity);
        CHECK(status_of(e[3]) == Status::minus_infinity);
    }
    // The sum rule does not apply at rank 2; the area spanned by two deviations is checked instead.
    CHECK(stick.product().sum_rule_residual() < 1e-10);
    Lyapunov before(p, {0, 70}, all_estimators);
    record(p, default_state(p), 1709, 100000, {&before});
    CHECK(before.product().rank() == 4);

    p.b = 0.05;
    p.R_plus = p.R_minus = 0;
    Lyapunov plastic(p, {0, 1e9}, all_estimators);
    const Record run = record(p, {0.02, 0, -0.3, 0}, 8, 100000, {&plastic});
    REQUIRE(run.sticks.empty());
    REQUIRE(run.impacts.size() > 1);
    CHECK(plastic.product().rank() == 3);
}

TEST_CASE("a window with fewer than two impacts has no exponents") {
    const Parameters p = table1(0.022, Damping::closed_form);
    Lyapunov lyapunov(p, {0, 20}, all_estimators);
    record(p, default_state(p), 100, 100000, {&lyapunov});
    CHECK(lyapunov.product().impacts() == 1);
    CHECK(status_of(lyapunov.product().qr()[0]) == Status::not_converged);
    CHECK(status_of(lyapunov.product().eigenvalues()[0]) == Status::not_converged);
}

TEST_CASE("a thinned history keeps every second, fourth, ... impact and ends near the end") {
    const Parameters p = table1(0.008, Damping::closed_form);
    Lyapunov full(p, {0, 1e9}, {.qr = true, .history = 100000}), thin(p, {0, 1e9}, qr_alone);
    record(p, default_state(p), 3000, 100000, {&full, &thin});
    const ExponentHistory &f = full.product().qr_history(), &t = thin.product().qr_history();
    CHECK(f.tau.size() == static_cast<std::size_t>(full.product().impacts() - 1));
    CHECK(t.tau.size() <= 256);
    for (std::size_t k = 0; k < t.tau.size(); ++k) {
        CHECK(t.tau[k] == f.tau[4 * k]);
        CHECK(std::abs(t.lambda[k][0] - f.lambda[4 * k][0]) < 1e-12);
    }
}

namespace {

/// A run recomputed, with its tangent, in at least a hundred digits: exponents of the whole run.
struct StrongDamping {
    const char* what;
    double epsilon, lambda;
    Damping damping;
    double G, Omega, R_plus, R_minus, b;
    State start;  ///< {x', x, y', y}
    double tau_end;
    long max_impacts;
    int rank;
    Exponents qr, eigenvalues;
};

constexpr double none = -std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("under strong damping all four exponents are accurate, at any rank") {
    constexpr Damping closed = Damping::closed_form, eom = Damping::equation_of_motion;
    const StrongDamping known[] = {
        {"zeta 10",
         0.05,
         200,
         closed,
         20,
         0.3,
         0.9,
         0.9,
         0.3,
         {0, 0, 0, 0.95 * 0.3},
         40,
         100000,
         4,
         {0.0056723236839369, -0.12984378119204, -2.6680087027799, -17.232506894841},
         {0.070372431439586, -0.050132058578645, -0.11973908807599, -19.925188339914}},
        {"zeta 8.6",
         0.80917866769974689,
         21.363503334655736,
         eom,
         0.26780170460853864,
         0.21131234520997721,
         0.81772560131210015,
         0.81772560131210015,
         0.07112859158384742,
         {-0.0031710484321584775, 0.0029965901031818623, -0.065598170880527967,
          -0.0041769171892573828},
         2366.1655901038775,
         35,
         4,
         {-0.34366741113086, -1.6135158820599, -2.9607132928161, -13.953785470029},
         {0.040390259097347, -0.058209029265579, -2.2499438291075, -16.60391945676}},
        {"zeta 5.6, unequal walls",
         0.15064434455945627,
         73.960004802397734,
         eom,
         0.0086122554350312082,
         0.33739170999697005,
         0.90235070591500022,
         0.84645249893577612,
         0.00037441434807136936,
         {-0.00040230575317433512, 0.00090751325457271164, -0.00084329953683750245,
          0.00074916792598473867},
         1481.9569811140002,
         40,
         4,
         {-0.032690384256406, -0.12600170652154, -0.2180006222215, -10.833989923581},
         {-0.013869373448737, -0.090602251398699, -0.21744948660788, -10.888761525125}},
        {"a stick",
         0.024276304435937958,
         294.85623717481195,
         closed,
         0.0014247957227879831,
         0.54562696648383391,
         0.48324236909615015,
         0.48324236909615015,
         1.8598019189242804e-06,
         {9.680602585311668e-06, 2.378384782140888e-07, 1.6699791909377704e-05,
          6.4177043543955012e-07},
         916.37699511469111,
         35,
         2,
         {-0.33118025668333, -5.9743513608014, none, none},
         {-0.070204260802211, -1.6171952809562, none, none}},
        {"R+ = 0",
         0.052667565342183663,
         229.59525056812129,
         eom,
         0.11437367683122851,
         0.29326411690417381,
         0,
         0.80022174105769761,
         0.00091501298544069117,
         {0.00039746910119850011, 0.0015260214031807325, 0.0023582740947381883,
          0.001599835056365465},
         300,
         5,
         3,
         {-0.058072070404582, -0.41083814072606, -2.9950275161035, none},
         {0.16052985541372, -0.083302379384022, -0.69334846528586, none}},
        {"zeta 1",
         2,
         1,
         eom,
         0.5,
         0.8,
         0.9,
         0.95,
         0.2,
         {0, 0, 0, 0.95 * 0.2},
         100,
         100000,
         4,
         {-0.15183909027258, -0.31160048928563, -0.32179478866042, -1.4993668652669},
         {-0.15541299039932, -0.29526281326432, -0.3218819275795, -1.5120435022424}},
        {"R+ = 0 and sticks",
         0.2,
         40,
         eom,
         0.5,
         1.8,
         0,
         1,
         0.01,
         {0, 0, 0, 0.95 * 0.01},
         60,
         100000,
         2,
         {-0.15656933619226, -3.119792010623, none, none},
         {-0.12743595432885, -3.1563190620616, none, none}},
    };
    for (const StrongDamping& k : known) {
        CAPTURE(k.what);
        Parameters p;
        p.epsilon = k.epsilon, p.lambda = k.lambda, p.damping = k.damping, p.G = k.G,
        p.Omega = k.Omega, p.R_plus = k.R_plus, p.R_minus = k.R_minus, p.b = k.b;
        Lyapunov lyapunov(p, {0, k.tau_end}, all_estimators);
        record(p, k.start, k.tau_end, k.max_impacts, {&lyapunov});
        const TransferProduct& product = lyapunov.product();
        CHECK(product.rank() == k.rank);
        CHECK(product.sum_rule_residual() < 1e-9);
        for (int i = 0; i < 4; ++i) {
            CAPTURE(i);
            if (i >= k.rank) {
                CHECK(product.qr()[i] == none);
                CHECK(product.eigenvalues()[i] == none);
            } else {
                CHECK(std::abs(product.qr()[i] - k.qr[i]) < 1e-8);
                CHECK(std::abs(product.eigenvalues()[i] - k.eigenvalues[i]) < 1e-8);
            }
        }
    }
}

TEST_CASE(
    "after a tiny R exponents dominated by rounding have no value, and the others are accurate") {
    Parameters p;
    p.epsilon = 3.5777223771207137e-05, p.lambda = 11105.539493358499, p.G = 0.061658938846328282;
    p.Omega = 0.15725674231722098, p.b = 0.026854170639768374;
    const State start{0.0059149439149146985, 0, -0.056531687868110039, -0.020834212450224508};
    const auto product_of = [&](double R) {
        p.R_plus = p.R_minus = R;
        Lyapunov lyapunov(p, {0, 4000}, qr_alone);
        record(p, start, 4000, 6, {&lyapunov});
        return lyapunov.take();
    };
    // According to the product in 400 digits lambda1 would be off by 2e-6.
    const TransferProduct lost = product_of(1.0249004442604184e-12);
    CHECK(lost.sum_rule_residual() > most_residual);
    for (const double lambda : lost.qr()) CHECK(status_of(lambda) == Status::not_converged);
    for (const double R : {1e-60, 1e-82, 1e-170, 1e-300}) {
        CAPTURE(R);
        const TransferProduct product = product_of(R);
        const Exponents qr = product.qr();
        const double T = product.end_tau() - product.start_tau();
        CHECK(product.sum_rule_residual() < 1e-12);
        CHECK(qr[0] == doctest::Approx(-0.10411285435765848).epsilon(1e-9));
        const double law =
            -2 * p.zeta() + 2 / T * static_cast<double>(product.impacts() - 1) * std::log(R);
        CHECK(qr[0] + qr[1] + qr[2] + qr[3] == doctest::Approx(law).epsilon(1e-12));
    }
}

TEST_CASE(
    "exponents are accurate for tiny restitution coefficients: their sum obeys the sum rule") {
    for (double R : {0.5, 1e-2, 1e-4, 1e-8, 1e-12}) {
        CAPTURE(R);
        Parameters p = table1(0.02, Damping::closed_form);
        p.R_plus = p.R_minus = R;
        for (double from : {0.0, 300.0, 600.0}) {
            Lyapunov lyapunov(p, {from, from + 60}, all_estimators);
            record(p, default_state(p), 800, 100000, {&lyapunov});
            if (lyapunov.product().impacts() < 2) continue;
            CHECK(lyapunov.product().sum_rule_residual() < 1e-6);
            CHECK(std::isfinite(lyapunov.product().qr()[1]));
        }
    }
}

TEST_CASE(
    "the exponents of a sticking motion exist wherever in its chatter the window ends" *
    doctest::test_suite("long")) {
    Parameters p;
    p.epsilon = 0.08577200056792593, p.Omega = 1.0140062, p.lambda = 0.35414361799157534;
    p.R_plus = p.R_minus = 0.6472643271251156, p.b = 0.00010228962122445021;
    // One chatter has about 75 impacts.
    for (long impacts = 2000; impacts < 2080; ++impacts) {
        CAPTURE(impacts);
        Lyapunov lyapunov(p, {0, infinity}, all_estimators);
        record(p, default_state(p), 1e9, impacts, {&lyapunov});
        const TransferProduct& product = lyapunov.product();
        CHECK(product.sum_rule_residual() < most_residual);
        CHECK(product.qr()[0] == doctest::Approx(-0.0114).epsilon(0.03));
        CHECK(product.qr()[1] == doctest::Approx(-0.0125).epsilon(0.04));
        CHECK(product.rank() == 2);
    }
}

TEST_CASE("the exponents of a sticking motion exist in windows of any length") {
    struct Sticking {
        double epsilon, Omega, R, lambda, b;
    };
    for (const Sticking& s :
         {Sticking{0.121984693, 0.957746029, 0.849820454, 0.568043085, 0.000126880746},
          Sticking{0.128932037, 0.907642031, 0.861796350, 0.190270287, 0.000326024514},
          Sticking{0.123298169, 0.937840662, 0.896354367, 0.127458243, 0.000487547751}}) {
        Parameters p;
        p.epsilon = s.epsilon, p.Omega = s.Omega, p.lambda = s.lambda, p.b = s.b;
        p.R_plus = p.R_minus = s.R;
        WindowedExponents windows(p, {.qr = true});
        const int lengths[] = {20, 25, 40, 100, 200};
        for (const int cycles : lengths) windows.add({0, cycles * p.cycle()});
        simulate(
            p, default_state(p), {.tau_end = 200 * p.cycle()}, std::vector<Observer*>{&windows});
        double lambda1 = 0;
        for (std::size_t i = 0; i < windows.size(); ++i) {
            CAPTURE(lengths[i]);
            lambda1 = windows.product(i).qr()[0];
            CHECK(std::isfinite(lambda1));
        }
        CHECK(lambda1 == doctest::Approx(-p.zeta()).epsilon(0.1));
    }
}

TEST_CASE("the exponents obey the sum rule with a restitution that depends on the speed") {
    std::mt19937_64 engine(12);
    for (int n = 0; n < 10; ++n) {
        Parameters p = table1(0.02, Damping::equation_of_motion);
        p.table_plus = random_table(engine, 0.02), p.table_minus = random_table(engine, 0.02);
        Lyapunov lyapunov(p, {0, 800}, all_estimators);
        const Record run = record(p, default_state(p), 800, 100000, {&lyapunov});
        if (!run.sticks.empty()) continue;
        const TransferProduct& product = lyapunov.product();
        double log_det = 0;
        for (std::size_t k = 1; k < run.impacts.size(); ++k) {
            const Impact& i = run.impacts[k];
            const double w = std::abs(i.relative_speed_before);
            CHECK(i.R == p.restitution(i.side, w));
            log_det += std::log(i.R * std::abs(p.restitution_derivative(i.side, w)));
        }
        const double T = product.end_tau() - product.start_tau(), law = -2 * p.zeta() + log_det / T;
        const Exponents qr = product.qr();
        CHECK(qr[0] + qr[1] + qr[2] + qr[3] == doctest::Approx(law).epsilon(1e-10));
        CHECK(product.sum_rule_residual() < 1e-10);
        const Exponents eigenvalues = product.eigenvalues();
        CHECK(
            eigenvalues[0] + eigenvalues[1] + eigenvalues[2] + eigenvalues[3] ==
            doctest::Approx(law).epsilon(1e-6));
    }
}

TEST_CASE("a table with one R everywhere gives the motion and exponents of a constant R") {
    Parameters constant = table1(0.018, Damping::closed_form), table = constant;
    table.table_plus = table.table_minus = std::make_shared<const RestitutionTable>(
        RestitutionTable{{0, 0.01, 0.05}, {0.6, 0.6, 0.6}});
    Lyapunov one(constant, {0, 1000}, qr_alone), other(table, {0, 1000}, qr_alone);
    const Record a = record(constant, default_state(constant), 1000, 100000, {&one}),
                 b = record(table, default_state(table), 1000, 100000, {&other});
    CHECK(a.outcome.state.x == b.outcome.state.x);
    CHECK(a.impacts.size() == b.impacts.size());
    CHECK(one.product().qr() == other.product().qr());
}
