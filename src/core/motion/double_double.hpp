// Double-double arithmetic: unevaluated sums of two doubles, about 106 bits. It uses only + - * /,
// so that results are the same on every machine and can be computed at compile time.
#pragma once

namespace vines {

/// high + low, |low| at most half an ulp of high.
struct DoubleDouble {
    double high = 0, low = 0;
};

/// a + b exactly, for a = 0 or |a| >= |b|.
constexpr DoubleDouble ordered_sum(double a, double b) {
    const double high = a + b;
    return {high, b - (high - a)};
}

/// a + b exactly (Knuth's two-sum).
constexpr DoubleDouble exact_sum(double a, double b) {
    const double high = a + b, of_b = high - a;
    return {high, (a - (high - of_b)) + (b - of_b)};
}

/// The leading 26 bits of a number (Veltkamp's split); the remainder has at most 26 bits. Products
/// of such parts are exact.
constexpr double head_of(double a) {
    const double shifted = a * 0x8000001p0;
    return shifted - (shifted - a);
}

/// a b exactly (Dekker's product), for 0 and for factors and products between 1e-290 and 1e290.
constexpr DoubleDouble exact_product(double a, double b) {
    const double a_head = head_of(a), a_tail = a - a_head, b_head = head_of(b), b_tail = b - b_head;
    const double high = a * b;
    return {high, ((a_head * b_head - high) + a_head * b_tail + a_tail * b_head) + a_tail * b_tail};
}

/// Sum, product and quotient with a relative error of about 2^-102.
constexpr DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble sum = exact_sum(a.high, b.high);
    return ordered_sum(sum.high, sum.low + (a.low + b.low));
}
constexpr DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble product = exact_product(a.high, b.high);
    return ordered_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}
constexpr DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double quotient = a.high / b.high;
    const DoubleDouble back = exact_product(quotient, b.high);
    const double rest = ((a.high - back.high) - back.low) + (a.low - quotient * b.low);
    return ordered_sum(quotient, rest / b.high);
}

}  // namespace vines
