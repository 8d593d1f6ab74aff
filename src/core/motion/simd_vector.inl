// Vectors of `vines_vector_width` doubles for flight_search.inl: arithmetic, comparison, selection
// and table look-up. Sums, products, quotients and roots are rounded as IEEE 754 requires and none
// is fused, so that every instruction set gives the same numbers.
#if vines_vector_width > 2
#include <immintrin.h>
#endif

namespace vines {

namespace {

constexpr int width = vines_vector_width;

using Real = double __attribute__((vector_size(8 * width), may_alias));
using Whole = long long __attribute__((vector_size(8 * width), may_alias));

Real load(const double* column) { return *reinterpret_cast<const Real*>(column); }
void store(double* column, Real value) { *reinterpret_cast<Real*>(column) = value; }
Real all(double value) {
#if vines_vector_width == 8
    return _mm512_set1_pd(value);
#elif vines_vector_width == 4
    return _mm256_set1_pd(value);
#else
    return Real{value, value};
#endif
}

Real absolute(Real v) { return (Real)((Whole)v & 0x7fff'ffff'ffff'ffff); }
Real root(Real v) {
    for (int i = 0; i < width; ++i) v[i] = __builtin_sqrt(v[i]);
    return v;
}

// A truth value per vector element: one bit each in mask registers, otherwise all bits of a number.
#if vines_vector_width == 8

struct Mask {
    __mmask8 bits = 0;
    Mask operator&(Mask m) const { return {static_cast<__mmask8>(bits & m.bits)}; }
    Mask operator|(Mask m) const { return {static_cast<__mmask8>(bits | m.bits)}; }
    Mask operator~() const { return {static_cast<__mmask8>(~bits)}; }
    Mask& operator&=(Mask m) { return *this = *this & m; }
    Mask& operator|=(Mask m) { return *this = *this | m; }
    bool operator[](int i) const { return (bits >> i & 1) != 0; }
};
Mask less(Real a, Real b) { return {_mm512_cmp_pd_mask(a, b, _CMP_LT_OQ)}; }
Mask at_most(Real a, Real b) { return {_mm512_cmp_pd_mask(a, b, _CMP_LE_OQ)}; }
Mask equal(Real a, Real b) { return {_mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ)}; }
Real select(Mask where, Real one, Real other) {
    return _mm512_mask_blend_pd(where.bits, other, one);
}
bool any(Mask mask) { return mask.bits != 0; }

#else

using Mask = Whole;
Mask less(Real a, Real b) { return a < b; }
Mask at_most(Real a, Real b) { return a <= b; }
Mask equal(Real a, Real b) { return a == b; }
Real select(Mask where, Real one, Real other) {
    return (Real)((where & (Whole)one) | (~where & (Whole)other));
}
bool any(Mask mask) {
#if vines_vector_width == 4
    return _mm256_movemask_pd((__m256d)mask) != 0;
#else
    return (mask[0] | mask[1]) != 0;
#endif
}

#endif

/// One table value per vector element. The processors' gather instructions are slower.
Real gather(const double* const (&from)[width], int at) {
#if vines_vector_width == 8
    return Real{from[0][at], from[1][at], from[2][at], from[3][at],
                from[4][at], from[5][at], from[6][at], from[7][at]};
#elif vines_vector_width == 4
    return Real{from[0][at], from[1][at], from[2][at], from[3][at]};
#else
    return Real{from[0][at], from[1][at]};
#endif
}

}  // namespace

}  // namespace vines
