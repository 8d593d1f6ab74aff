// Elementary functions that are the same on every machine. Those of the C library are not: it
// chooses among variants by what the processor offers, and they differ in the last bit. These are
// made of + - * / and the square root, which IEEE 754 defines to the last bit, and are compiled
// without fused operations.
//
// Errors in ulps of the result, of which rounding alone takes 0.5. What is not said is as in C:
// what becomes of 0, of infinite arguments and of NaN, and the sign of a zero.
#pragma once

#include <complex>

namespace vines::elementary {

/// The natural logarithm, to 0.51 ulp; NaN below 0.
double log(double x);

/// To 0.51 ulp; to 0.76 where the result is subnormal.
double exp(double x);

/// x^y of a base that is not negative, else NaN; to 0.51 + |y|/2^15 ulp.
double pow(double x, double y);

/// Of x in radians, to 0.51 ulp for |x| up to 2^31, and up to 2^47 to 1e-30 more. Beyond, where
/// neighbouring numbers are more than a thousandth of a turn apart, of x modulo the double next to
/// 2 pi.
double sin(double x);
double cos(double x);

/// The angle of the point (x, y), in [-pi, pi], to 0.51 ulp where that is not subnormal.
double atan2(double y, double x);
double atan(double x);

/// sqrt(x^2 + y^2), to 0.51 ulp where that is not subnormal.
double hypot(double x, double y);

/// The modulus of a complex number: std::abs of one calls the C library.
inline double modulus(const std::complex<double>& z) { return hypot(z.real(), z.imag()); }

}  // namespace vines::elementary
