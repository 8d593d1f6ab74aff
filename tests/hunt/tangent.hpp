// Propagation of deviations [x' x y' y] over flights, sticking phases and impacts, in any
// arithmetic. Derived independently from the equations of motion, to check the product's matrices.
#pragma once

#include <vector>

#include "oscillator.hpp"

namespace vines::hunt {

/// Square matrix of any size and arithmetic.
template <class Real>
struct Square {
    explicit Square(int size) : n(size), entries(static_cast<std::size_t>(size) * size, Real(0)) {}
    static Square identity(int size) {
        Square m(size);
        for (int i = 0; i < size; ++i) m(i, i) = 1;
        return m;
    }
    Real& operator()(int i, int j) { return entries[static_cast<std::size_t>(i) * n + j]; }
    const Real& operator()(int i, int j) const {
        return entries[static_cast<std::size_t>(i) * n + j];
    }
    Square operator*(const Square& right) const {
        Square product(n);
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k) {
                if ((*this)(i, k) == 0) continue;
                for (int j = 0; j < n; ++j) product(i, j) += (*this)(i, k) * right(k, j);
            }
        return product;
    }
    Real largest() const {
        Real most = 0;
        for (const Real& e : entries) {
            const Real size = e < 0 ? Real(-e) : e;
            if (size > most) most = size;
        }
        return most;
    }
    int n;
    std::vector<Real> entries;
};

/// J of a flight, eq. (19): [x' x] by the oscillator's block, y' is constant, y grows by y' s.
template <class Real>
Square<Real> flight(const Oscillator<Real>& law, const Real& s) {
    const auto a = law.transfer(s);
    auto J = Square<Real>::identity(4);
    J(0, 0) = a.a11, J(0, 1) = a.a12, J(1, 0) = a.a21, J(1, 1) = a.a22;
    J(3, 2) = s;
    return J;
}

/// Transfer matrix of a sticking phase: both masses follow the deviation of the centre of mass.
template <class Real>
Square<Real> together(const Oscillator<Real>& law, const Real& epsilon, const Real& s) {
    const auto a = law.transfer(s);
    const Real weight[2] = {1 / (1 + epsilon), epsilon / (1 + epsilon)},
               block[2][2] = {{a.a11, a.a12}, {a.a21, a.a22}};
    Square<Real> K(4);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) K(i, j) = block[i % 2][j % 2] * weight[j / 2];
    return K;
}

/// Velocities of an impact, and the oscillator's accelerations before and after it.
template <class Real>
struct Collision {
    Real R, x_dot_before, x_dot_after, y_dot_before, y_dot_after, x_ddot_before, x_ddot_after;

    template <class Other>
    Collision<Other> as() const {
        return {Other(R),           Other(x_dot_before),  Other(x_dot_after), Other(y_dot_before),
                Other(y_dot_after), Other(x_ddot_before), Other(x_ddot_after)};
    }
};

/// M of an impact: a deviation d meets the wall later by -(g d)/(g f-), g = [0 1 0 -1]; until then
/// it moves by f-, afterwards by f+: M = S + (f+ - S f-) g/(g f-), f = [x'' x' 0 y'].
template <class Real>
Square<Real> strike(const Collision<Real>& c, const Real& epsilon) {
    const Real gain = (1 + c.R) / (1 + epsilon);
    auto M = Square<Real>::identity(4);
    M(0, 0) = 1 - epsilon * gain, M(0, 2) = epsilon * gain;
    M(2, 0) = gain, M(2, 2) = 1 - gain;
    const Real before[4] = {c.x_ddot_before, c.x_dot_before, 0, c.y_dot_before};
    const Real after[4] = {c.x_ddot_after, c.x_dot_after, 0, c.y_dot_after};
    const Real approach = before[1] - before[3];
    Real jump[4];
    for (int i = 0; i < 4; ++i) {
        jump[i] = after[i];
        for (int j = 0; j < 4; ++j) jump[i] -= M(i, j) * before[j];
    }
    for (int i = 0; i < 4; ++i) {
        M(i, 1) += jump[i] / approach;
        M(i, 3) -= jump[i] / approach;
    }
    return M;
}

}  // namespace vines::hunt
