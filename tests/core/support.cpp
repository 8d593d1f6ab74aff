#include "support.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "core/analysis/analysis.hpp"
#include "core/stability/linear.hpp"

namespace vines::test {

Reference read_reference(const std::string& name) {
    std::ifstream file(REFERENCE_DIRECTORY + name + ".txt");
    if (!file) throw std::runtime_error("no reference " + name);
    Reference r;
    if (const std::size_t b = name.find("_b"); b != std::string::npos)
        r.parameters = table1(
            std::stod(name.substr(b + 2)),
            name[0] == 'c' ? Damping::closed_form : Damping::equation_of_motion);
    for (std::string line; std::getline(file, line);) {
        std::istringstream in(line);
        if (std::isdigit(static_cast<unsigned char>(line[0]))) {
            ReferenceImpact i;
            in >> i.tau >> i.side >> i.x >> i.x_dot_before >> i.y_dot_before >> i.x_dot_after >>
                i.y_dot_after;
            r.impacts.push_back(i);
            continue;
        }
        std::string word, skip;
        in >> word;
        if (word == "qr")
            for (double& v : r.qr) in >> v;
        if (word == "eig")
            for (double& v : r.eigenvalues) in >> v;
        if (word == "#" && in >> word && word == "stick") {
            ReferenceStick s;
            in >> skip >> s.side >> skip >> s.start >> skip >> s.end;
            r.sticks.push_back(s);
        }
    }
    return r;
}

Record record(
    const Parameters& p, const State& start, double tau_end, long max_impacts,
    std::vector<Observer*> observers) {
    ImpactRecord impacts;
    StickRecord sticks;
    GrazingRecord grazing;
    observers.insert(observers.end(), {&impacts, &sticks, &grazing});
    const Outcome outcome = simulate(p, start, {tau_end, max_impacts, {}}, observers);
    return {
        outcome, std::move(impacts.entries), std::move(sticks.entries), std::move(grazing.entries)};
}

Parameters table1(double b, Damping damping) {
    Parameters p;
    p.b = b;
    p.damping = damping;
    return p;
}

std::shared_ptr<const RestitutionTable> random_table(std::mt19937_64& engine, double speed) {
    RestitutionTable table;
    for (const double share : {0.3, 1.0, 2.0}) {
        table.speed.push_back(share * speed * uniform(engine, 0.9, 1.1));
        table.R.push_back(uniform(engine, 0.3, 0.9));
    }
    return std::make_shared<const RestitutionTable>(table);
}

System random_system(std::mt19937_64& engine) {
    const auto u = [&](double from, double to) { return uniform(engine, from, to); };
    System s;
    Parameters& p = s.parameters;
    p.epsilon = std::exp(u(std::log(1e-3), std::log(0.5)));
    p.lambda = u(0, 1) < 0.1 ? 0 : std::exp(u(std::log(0.05), std::log(20.0)));
    p.G = u(0, 1) < 0.1 ? 0 : u(0.001, 0.1);
    p.Omega = u(0, 1) < 0.3 ? 1 : std::exp(u(std::log(0.3), std::log(5.0)));
    const double edges[] = {0, 1, 0.999, 1e-3};
    p.R_plus = u(0, 1) < 0.2 ? edges[engine() % 4] : u(0.05, 0.99);
    p.R_minus = u(0, 1) < 0.5 ? p.R_plus : u(0.05, 0.99);
    p.b = std::exp(u(std::log(5e-4), std::log(0.1)));
    p.damping = engine() % 2 ? Damping::closed_form : Damping::equation_of_motion;
    s.start.x = u(-0.01, 0.01);
    s.start.x_dot = u(-0.02, 0.02);
    s.start.y = s.start.x + (u(0, 1) < 0.1 ? (engine() % 2 ? 1 : -1) : u(-1, 1)) * p.b;
    s.start.y_dot = u(0, 1) < 0.2 ? s.start.x_dot : u(-0.03, 0.03);
    return s;
}

CapturedTransient captured_transient() {
    for (int k = 0; k < 20; ++k) {
        Parameters p = table1(0.022 + k * 1e-9, Damping::closed_form);
        p.R_plus = p.R_minus = 0.5;
        AnalysisRequest w{.parameters = p, .start = default_state(p), .tau_end = 20000};
        w.parts.regime = true;
        w.estimators = qr_alone;
        const auto capture = analyse(w).regime->capture;
        if (capture && capture->tau && *capture->tau > 2000 && *capture->tau < 9000)
            return {p, *capture->tau};
    }
    throw std::runtime_error("no capture among twenty runs");
}

Moduli eigenvalue_moduli(const Matrix4& m) {
    Moduli moduli;
    std::ranges::transform(eigenvalues_of(m), moduli.begin(), elementary::modulus);
    return moduli;
}

}  // namespace vines::test
