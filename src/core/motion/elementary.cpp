#include "core/motion/elementary.hpp"

#include <algorithm>
#include <array>
#include <bit>

// The argument is reduced to a table point, whose function value is known to twice the precision of
// double, and a small remainder. The result is an exact large part plus a small part in ordinary
// doubles, at most 2^-7 of it, whose roundings contribute less than 2^-6 ulp. Each series ends
// where the first omitted term is below 2^-62 of the result. The compiler computes the tables.

namespace vines::elementary {

namespace {

// Double-double arithmetic: unevaluated sums of two doubles, about 106 bits.

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

/// The leading 26 bits of a number (Veltkamp's split); products of head and remainder are exact.
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

/// 2 artanh(numerator/denominator), which is ln((denominator + numerator)/(denominator -
/// numerator)), for a quotient up to 1/3: the 34th term is below 2^-109.
constexpr DoubleDouble logarithm_by_series(double numerator, double denominator) {
    const DoubleDouble u = DoubleDouble{numerator} / DoubleDouble{denominator}, square = u * u;
    DoubleDouble sum;
    for (int n = 67; n > 0; n -= 2) sum = sum * square + DoubleDouble{2} / DoubleDouble{1.0 * n};
    return sum * u;
}

constexpr DoubleDouble ln_2 = logarithm_by_series(1, 3);

/// Rounds the high part to a multiple of 2^-42: eleven bits before the point remain for exact sums.
constexpr DoubleDouble on_grid(const DoubleDouble& a) {
    constexpr double shift = 0x1.8p10;  // its ulp is 2^-42
    const double high = (a.high + shift) - shift;
    return {high, (a.high - high) + a.low};
}

constexpr DoubleDouble ln_2_on_grid = on_grid(ln_2);

constexpr std::uint64_t mantissa_bits = 52, bits_of_1 = std::uint64_t{0x3ff} << mantissa_bits;

// ln x = k ln 2 + ln c + ln(z/c), x = 2^k z. A table cell covers 2^45 doubles; the first cell
// begins at 0.703, 76.5 cells below 1. The cell around 1 has c = 1, so that nothing cancels there.
constexpr int cell_bits = 45, log_cells = 128, cells_below_1 = 76;
constexpr std::uint64_t cell_size = std::uint64_t{1} << cell_bits,
                        least_z = bits_of_1 - cells_below_1 * cell_size - cell_size / 2;

struct LogCell {
    double inverse;  // 1/c in 11 bits: its product with 42 bits is exact
    DoubleDouble logarithm;
};

constexpr auto log_table = [] {
    std::array<LogCell, log_cells> table;
    for (int i = 0; i < log_cells; ++i) {
        const double middle = std::bit_cast<double>(least_z + i * cell_size + cell_size / 2);
        const double parts_of_1024 = static_cast<int>(1024 / middle + 0.5);
        table[i] = {
            parts_of_1024 / 1024,
            on_grid(logarithm_by_series(1024 - parts_of_1024, 1024 + parts_of_1024))};
    }
    return table;
}();

/// ln x as an unevaluated sum, with relative errors of 2^-69 and 2^-62. `bits` are those of a
/// normal number x; k is the power of two by which x was multiplied beforehand.
inline DoubleDouble log_parts(std::uint64_t bits, int k) {
    const std::uint64_t from_least = bits - least_z;
    k = static_cast<int>(static_cast<std::int64_t>(from_least) >> mantissa_bits) - k;
    const LogCell& cell = log_table[(from_least >> cell_bits) % log_cells];
    const std::uint64_t z = bits - (from_least & ~std::uint64_t{0} << mantissa_bits);
    // r = z/c - 1, |r| < 0.0052, exact in two parts because the parts of z have 42 and 11 bits.
    const double z_head = std::bit_cast<double>(z & ~std::uint64_t{0x7ff}),
                 z_tail = std::bit_cast<double>(z) - z_head;
    const auto [r, r_low] = ordered_sum(z_head * cell.inverse - 1, z_tail * cell.inverse);
    // ln(1 + r) - r
    const double square = r * r,
                 rest = square * ((-1. / 2 + r * (1. / 3)) +
                                  square * ((-1. / 4 + r * (1. / 5)) +
                                            square * ((-1. / 6 + r * (1. / 7)) - square / 8)));
    // Zero, or larger than r.
    const double coarse = k * ln_2_on_grid.high + cell.logarithm.high;
    const auto [high, low] = ordered_sum(coarse, r);
    return {high, (low + (r_low + k * ln_2_on_grid.low + cell.logarithm.low)) + rest};
}

/// The same for any positive finite number.
inline DoubleDouble log_parts(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    return bits >> mantissa_bits > 0 ? log_parts(bits, 0)
                                     : log_parts(std::bit_cast<std::uint64_t>(x * 0x1p54), 54);
}

}  // namespace

double log(double x) {
    if (x == 0) return -infinity;
    if (!(x > 0 && x < infinity)) return x > 0 ? x : nan;
    const DoubleDouble parts = log_parts(x);
    return parts.high + parts.low;
}

namespace {

// e^x = 2^(n/128) e^r
constexpr int exp_steps = 128;
// The head has 26 bits: multiplied by n, which is below 2^18, it is exact.
constexpr double exp_step_head = head_of(ln_2.high) / exp_steps,
                 exp_step_rest = ((ln_2.high - head_of(ln_2.high)) + ln_2.low) / exp_steps;

constexpr auto exp_table = [] {
    std::array<DoubleDouble, exp_steps> table;
    for (int i = 0; i < exp_steps; ++i) {
        const DoubleDouble r = ln_2 * DoubleDouble{1.0 * i / exp_steps};
        // The term after the 27th is below 2^-110.
        DoubleDouble sum = {1};
        for (int n = 27; n > 0; --n)
            sum = DoubleDouble{1} + sum * r / DoubleDouble{static_cast<double>(n)};
        table[i] = sum;
    }
    return table;
}();

/// Nearest integer, |x| < 2^51.
double nearest_whole(double x) {
    constexpr double shift = 0x1.8p52;
    return (x + shift) - shift;
}

/// e^(x + low), |low| at most an ulp of x.
double exp_of(double x, double low) {
    // Beyond these limits the result is infinite or 0.
    if (!(x < 710)) return x > 0 ? infinity : x;
    if (x < -746) return 0;
    constexpr double steps_per_unit = exp_steps / ln_2.high;
    const double n = nearest_whole(x * steps_per_unit);
    const int whole = static_cast<int>(n), k = whole >> 7;
    const double r = (x - n * exp_step_head) - (n * exp_step_rest - low);  // |r| < 0.0028
    const double growth =
        r + r * r * (1. / 2 + r * (1. / 6 + r * (1. / 24 + r * (1. / 120 + r * (1. / 720)))));
    const DoubleDouble& start = exp_table[whole & (exp_steps - 1)];
    const double result = start.high + (start.low + start.high * growth);
    // 2^k as two factors, because 2^1024 and 2^-1075 are not doubles.
    const int first = k / 2;
    const auto power_of_2 = [](int power) {
        return std::bit_cast<double>(bits_of_1 + (static_cast<std::uint64_t>(power) << 52));
    };
    return result * power_of_2(first) * power_of_2(k - first);
}

}  // namespace

double exp(double x) { return exp_of(x, 0); }

double pow(double x, double y) {
    if (y == 0 || x == 1) return 1;
    if (!(x >= 0) || std::isnan(y)) return nan;
    if (x == 0 || x == infinity) return (x > 0) == (y > 0) ? infinity : 0;
    const DoubleDouble sum = log_parts(x), logarithm = ordered_sum(sum.high, sum.low);
    const double rough = logarithm.high * y;
    // Beyond the limits of exp, where the parts of the product could overflow.
    if (!(std::abs(rough) < 800)) return rough > 0 ? infinity : 0;
    const DoubleDouble product = exact_product(logarithm.high, y);
    return exp_of(product.high, product.low + logarithm.low * y);
}

namespace {

// pi to 160 bits.
constexpr double pi[3] = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53, -0x1.f1976b7ed8fbcp-109};

// sin(x) = sin(n step + r)
constexpr int turn_steps = 64, right_angle = turn_steps / 4;
constexpr double steps_per_radian = turn_steps / (2 * pi[0]);
constexpr double angle_step[3] = {pi[0] / 32, pi[1] / 32, pi[2] / 32};

/// Series of sin (first = 1) or cos (first = 0) up to pi/4, to 2^-107.
constexpr DoubleDouble sine_series(const DoubleDouble& angle, int first) {
    const DoubleDouble minus_square = DoubleDouble{-1} * angle * angle;
    DoubleDouble sum = {1};
    for (int n = first + 26; n > first; n -= 2)
        sum = DoubleDouble{1} + sum * minus_square / DoubleDouble{1.0 * n * (n - 1)};
    return first == 1 ? sum * angle : sum;
}

/// The high parts have 26 bits.
constexpr auto sine_table = [] {
    std::array<DoubleDouble, turn_steps> table;
    for (int i = 0; i <= right_angle; ++i) {
        const bool near_0 = 2 * i <= right_angle;
        const DoubleDouble angle = DoubleDouble{angle_step[0], angle_step[1]} *
                                   DoubleDouble{1.0 * (near_0 ? i : right_angle - i)};
        const DoubleDouble sine = sine_series(angle, near_0 ? 1 : 0);
        const double head = head_of(sine.high);
        const DoubleDouble entry = {head, (sine.high - head) + sine.low};
        table[i] = table[2 * right_angle - i] = entry;
        for (const int k : {2 * right_angle + i, 4 * right_angle - i})
            table[k % turn_steps] = i == 0 ? DoubleDouble{} : DoubleDouble{-entry.high, -entry.low};
    }
    return table;
}();

struct ReducedAngle {
    std::int64_t steps;
    DoubleDouble rest;  // |rest| <= step/2 = 0.0491
};

/// For fewer than 1024 steps, error 2^-95: products with 26-bit parts are exact.
inline ReducedAngle less_few_steps(double x, double n) {
    constexpr double first = head_of(angle_step[0]), second = angle_step[0] - first;
    const DoubleDouble near = exact_sum(x - n * first, -n * second);
    return {static_cast<std::int64_t>(n), ordered_sum(near.high, near.low - n * angle_step[1])};
}

/// For any number of steps; error 2^-62 of the remainder below 2^35 steps.
ReducedAngle less_many_steps(double x) {
    // Up to this limit the error of truncating pi after three parts is small enough.
    constexpr double furthest = 0x1p47;
    if (!(std::abs(x) < infinity)) return {0, {nan, 0}};
    if (std::abs(x) > furthest) x = std::fmod(x, 2 * pi[0]);
    const double n = nearest_whole(x * steps_per_radian);
    const DoubleDouble first = exact_product(n, angle_step[0]),
                       second = exact_product(n, angle_step[1]);
    const DoubleDouble nearer = exact_sum(x - first.high, -first.low),
                       near = exact_sum(nearer.high, -second.high);
    const double low = (nearer.low + near.low) - second.low - n * angle_step[2];
    return {static_cast<std::int64_t>(n), ordered_sum(near.high, low)};
}

inline ReducedAngle reduced(double x) {
    const double n = nearest_whole(x * steps_per_radian);
    if (n == 0) return {0, {x, 0}};
    if (std::abs(n) < 1024) {
        const ReducedAngle angle = less_few_steps(x, n);
        if (std::abs(angle.rest.high) > 0x1p-30) return angle;
    }
    return less_many_steps(x);
}

/// sin(a + r) = sin a + r cos a + (sin r - r) cos a + (cos r - 1) sin a.
inline double sine_at(std::int64_t steps, const DoubleDouble& r) {
    const auto at = [](std::int64_t k) { return sine_table[k & (turn_steps - 1)]; };
    const DoubleDouble sine = at(steps), cosine = at(steps + right_angle);
    const double r_head = head_of(r.high), r_rest = (r.high - r_head) + r.low,
                 square = r.high * r.high;
    // sin(r)/r - 1, cos(r) - 1
    const double sine_less =
        square * (-1. / 6 + square * (1. / 120 + square * (-1. / 5040 + square / 362880)));
    const double cosine_less =
        square * (-1. / 2 + square * (1. / 24 + square * (-1. / 720 + square / 40320)));
    // sin a is 0 or the larger term.
    const DoubleDouble large = ordered_sum(sine.high, cosine.high * r_head);
    const double small = sine.low + cosine.high * r_rest + cosine.low * r.high +
                         (cosine.high + cosine.low) * (r.high * sine_less) +
                         (sine.high + sine.low) * cosine_less;
    return large.high + (large.low + small);
}

}  // namespace

double sin(double x) {
    // Here x - x^3/6 rounds to x; 0 keeps its sign.
    if (std::abs(x) < 0x1p-28) return x;
    const ReducedAngle angle = reduced(x);
    return sine_at(angle.steps, angle.rest);
}

double cos(double x) {
    const ReducedAngle angle = reduced(x);
    return sine_at(angle.steps + right_angle, angle.rest);
}

namespace {

// atan u = atan t + atan((u - t)/(1 + t u)), t = i/64, u up to 1.
constexpr int atan_steps = 64;

constexpr auto atan_table = [] {
    std::array<DoubleDouble, atan_steps + 1> table;
    for (int i = 1; i <= atan_steps; ++i) {
        const DoubleDouble further =
            DoubleDouble{atan_steps} / DoubleDouble{1.0 * (atan_steps * atan_steps + i * (i - 1))};
        const DoubleDouble minus_square = DoubleDouble{-1} * further * further;
        // Argument up to 1/64: the term after the ninth is below 2^-110.
        DoubleDouble sum;
        for (int n = 17; n > 0; n -= 2)
            sum = sum * minus_square + DoubleDouble{1} / DoubleDouble{1.0 * n};
        table[i] = table[i - 1] + sum * further;
    }
    return table;
}();

// Below this fraction of the other leg, a leg of a right triangle does not change the result.
constexpr double least_side = 0x1p-60;

/// A power of two that scales products of both legs and their low parts into the range of double.
double scale_of(double larger) {
    return larger > 0x1p400 ? 0x1p-600 : larger < 0x1p-400 ? 0x1p600 : 1;
}

/// base + sign atan(opposite/adjacent), 0 < opposite <= adjacent.
double angle_from(const DoubleDouble& base, int sign, double opposite, double adjacent) {
    const double whole = nearest_whole(opposite / adjacent * atan_steps), t = whole / atan_steps;
    // Exact because t has 7 bits: no product with a 26-bit part is rounded.
    const DoubleDouble along = exact_product(t, adjacent), up = exact_product(t, opposite);
    const DoubleDouble q = (DoubleDouble{opposite} + DoubleDouble{-along.high, -along.low}) /
                           (DoubleDouble{adjacent} + up);  // |q| <= 1/128
    const double square = q.high * q.high;
    const double less = square * (-1. / 3 + square * (1. / 5 + square * (-1. / 7 + square / 9)));
    const DoubleDouble& known = atan_table[static_cast<int>(whole)];
    const DoubleDouble first = exact_sum(base.high, sign * known.high),
                       sum = exact_sum(first.high, sign * q.high);
    const double small = base.low + sign * (known.low + (q.low + q.high * less));
    return sum.high + (sum.low + (first.low + small));
}

/// The angle in the first quadrant, or for x < 0 in the second: y >= 0, infinities allowed.
double angle_above(double y, double x) {
    constexpr DoubleDouble half_turn = {pi[0], pi[1]}, quarter = {pi[0] / 2, pi[1] / 2};
    const double width = std::abs(x);
    const bool is_steep = y > width;
    const DoubleDouble base = is_steep ? quarter : std::signbit(x) ? half_turn : DoubleDouble{};
    if (width == infinity && y == infinity) return angle_above(1, std::copysign(1, x));
    const double larger = std::max(width, y), smaller = std::min(width, y);
    if (smaller <= least_side * larger) return base.high == 0 && larger > 0 ? y / width : base.high;
    const double scale = scale_of(larger);
    return angle_from(base, is_steep == std::signbit(x) ? 1 : -1, smaller * scale, larger * scale);
}

}  // namespace

double atan2(double y, double x) {
    if (std::isnan(x) || std::isnan(y)) return nan;
    return std::copysign(angle_above(std::abs(y), x), y);
}

double atan(double x) { return atan2(x, 1); }

double hypot(double x, double y) {
    const double larger = std::max(std::abs(x), std::abs(y)),
                 smaller = std::min(std::abs(x), std::abs(y));
    if (std::isinf(x) || std::isinf(y)) return infinity;
    if (std::isnan(x) || std::isnan(y)) return nan;
    if (!(smaller > least_side * larger)) return larger + smaller;
    const double scale = scale_of(larger), a = larger * scale, b = smaller * scale;
    const DoubleDouble squares = exact_product(a, a) + exact_product(b, b);
    const double root = std::sqrt(squares.high);
    const DoubleDouble back = exact_product(root, root);
    const double rest = ((squares.high - back.high) - back.low) + squares.low;
    return (root + rest / (2 * root)) / scale;
}

}  // namespace vines::elementary
