#include "exact_product.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace vines::hunt {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Events of the window: those after the first impact, up to the last.
std::span<const PreciseEvent> window_of(const Retraced& run) {
    const auto is_impact = [](const PreciseEvent& e) { return e.kind == Event::impact; };
    const auto& all = run.events;
    const auto first = std::find_if(all.begin(), all.end(), is_impact);
    const auto last = std::find_if(all.rbegin(), all.rend(), is_impact).base();
    return first == all.end() ? std::span<const PreciseEvent>{} : std::span(first + 1, last);
}

template <class Real>
Square<Real> product_of(const Parameters& p, std::span<const PreciseEvent> window) {
    const auto free = Oscillator<Real>::free(p), stuck = Oscillator<Real>::stuck(p);
    const Real epsilon = p.epsilon;
    auto P = Square<Real>::identity(4);
    for (const PreciseEvent& e : window) {
        const Real s(e.since);
        if (e.kind == Event::impact)
            P = strike(e.collision.as<Real>(), epsilon) * (flight(free, s) * P);
        else P = together(stuck, epsilon, s) * P;
    }
    return P;
}

/// Lengths of the columns after Gram-Schmidt: the diagonal of the triangular factor.
template <class Real>
std::array<Real, 4> lengths_of_columns(Square<Real> P) {
    std::array<Real, 4> lengths;
    for (int k = 0; k < 4; ++k) {
        for (int j = 0; j < k; ++j) {
            Real along = 0;
            for (int i = 0; i < 4; ++i) along += P(i, j) * P(i, k);
            for (int i = 0; i < 4; ++i) P(i, k) -= along * P(i, j);
        }
        Real square = 0;
        for (int i = 0; i < 4; ++i) square += P(i, k) * P(i, k);
        lengths[k] = sqrt(square);
        if (square > 0)
            for (int i = 0; i < 4; ++i) P(i, k) /= lengths[k];
    }
    return lengths;
}

/// Matrix of all minors with k rows and k columns.
template <class Real>
Square<Real> minors(const Square<Real>& P, int k) {
    std::vector<std::vector<int>> choices;
    for (unsigned bits = 0; bits < 16; ++bits) {
        std::vector<int> chosen;
        for (int i = 0; i < 4; ++i)
            if (bits >> i & 1) chosen.push_back(i);
        if (static_cast<int>(chosen.size()) == k) choices.push_back(chosen);
    }
    const auto determinant = [&](auto&& self, std::vector<int> rows,
                                 const std::vector<int>& columns) -> Real {
        if (rows.empty()) return 1;
        const int row = rows.back();
        rows.pop_back();
        Real sum = 0;
        for (std::size_t j = 0; j < columns.size(); ++j) {
            auto others = columns;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(j));
            const Real term = P(row, columns[j]) * self(self, rows, others);
            if ((columns.size() - 1 - j) % 2 == 0) sum += term;
            else sum -= term;
        }
        return sum;
    };
    Square<Real> m(static_cast<int>(choices.size()));
    for (int i = 0; i < m.n; ++i)
        for (int j = 0; j < m.n; ++j) m(i, j) = determinant(determinant, choices[i], choices[j]);
    return m;
}

/// ln of the spectral radius by Gelfand's formula, ln||C^n||/n with n = 2^60 by repeated squaring.
template <class Real>
double log_radius(const Square<Real>& C) {
    Square<Precise> power(C.n);
    const Real size = C.largest();
    for (std::size_t i = 0; i < C.entries.size(); ++i)
        power.entries[i] = Precise(C.entries[i] / size);
    Precise log_radius = log(Precise(size)), share = 1;
    for (int k = 0; k < 60; ++k) {
        power = power * power;
        share /= 2;
        const Precise scale = power.largest();
        log_radius += share * log(scale);
        for (Precise& e : power.entries) e /= scale;
    }
    return static_cast<double>(log_radius);
}

template <class Real>
ExactExponents exponents_in(const Parameters& p, const Retraced& run, double lost) {
    const auto window = window_of(run);
    ExactExponents result{1, 0, 0, {}, {}};
    for (const PreciseEvent& e : window) {
        result.T += static_cast<double>(e.since);
        result.impacts += e.kind == Event::impact;
    }
    const Square<Real> P = product_of<Real>(p, window);
    const auto lengths = lengths_of_columns(P);
    const Real nothing = P.largest() * pow(Real(10), -static_cast<int>(lost) - 20);
    double log_before = 0;
    for (int k = 0; k < 4; ++k) {
        result.qr[k] = result.eigenvalues[k] = -infinity;
        if (lengths[k] < nothing) continue;
        result.rank = k + 1;
        result.qr[k] = static_cast<double>(log(lengths[k])) / result.T;
        const double log_radius_k = log_radius(minors(P, k + 1));
        result.eigenvalues[k] = (log_radius_k - log_before) / result.T;
        log_before = log_radius_k;
    }
    return result;
}

constexpr unsigned few_digits = 250, many_digits = 1000;

/// Digits sufficient for a product that loses `lost` digits, and to distinguish a zero length from
/// a small one.
double digits_for(double lost) { return lost + 60; }

}  // namespace

double digits_lost(const Parameters& p, const Retraced& run) {
    // Condition number of each factor: of J from det J = e^(-2 zeta s), of M from its determinant
    // R^2.
    double digits = 0;
    const double zeta = p.zeta();
    for (const PreciseEvent& e : window_of(run)) {
        const double s = static_cast<double>(e.since);
        digits += 2 * std::log10(2 + s) + 2 * zeta * s / std::log(10.0);
        if (e.kind != Event::impact) continue;
        const Collision<Precise>& c = e.collision;
        const double kappa =
            static_cast<double>(abs(c.x_ddot_before / (c.x_dot_before - c.y_dot_before))) +
            2 * zeta;
        digits += 2 * std::log10(2 + kappa) - (c.R > 0 ? std::log10(static_cast<double>(c.R)) : 0);
    }
    return digits;
}

bool exact_exponents_possible(double lost) { return digits_for(lost) <= many_digits; }

ExactExponents exact_exponents(const Parameters& p, const Retraced& run) {
    const double lost = digits_lost(p, run);
    return digits_for(lost) <= few_digits ? exponents_in<Decimal<few_digits>>(p, run, lost)
                                          : exponents_in<Decimal<many_digits>>(p, run, lost);
}

}  // namespace vines::hunt
