// Vectorised search for contacts, compiled once per instruction set: the build sets the number of
// doubles per vector (vines_vector_width) and the name of the function (vines_named_search).
// Nothing else depends on the processor: sums, products, roots and comparisons of vectors come from
// the compiler, each rounded as IEEE 754 requires and none fused. The steps are those of
// fast_contact.cpp, which explains them.
#if vines_vector_width > 2
#include <immintrin.h>
#endif

#include <cstddef>

#include "core/motion/flight_batch.hpp"

namespace vines {

namespace {

// Vectors of `vines_vector_width` doubles: arithmetic, comparison, selection and table look-up.

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

Real halley(Real f, Real first, Real half_second) {
    return -f * first / (first * first - f * half_second);
}

/// States of the oscillator, one per vector element.
struct Oscillations {
    Real x, x_dot, sin_theta, cos_theta;
};

/// The columns of FlowTables::rows.
constexpr int row_x = 0, row_x_dot = 4, row_cos = 8, row_sin = 9, row_length = 10;

class VectorSearch {
public:
    VectorSearch(FlightBatch& flights, int from)
        : flights_(flights),
          from_(from),
          tables_(*flights.tables),
          leaves_wall_(~equal(column(flights.side), Real{})),
          mirror_(select(leaves_wall_, column(flights.side), all(1))),
          b_(column(flights.b)),
          limit_(column(flights.limit)),
          w_(-mirror_ * column(flights.relative_speed)),
          y_(mirror_ * column(flights.y)),
          y_dot_(mirror_ * column(flights.y_dot)),
          lo_{mirror_ * column(flights.x), mirror_ * column(flights.x_dot),
              mirror_ * column(flights.sin_theta), mirror_ * column(flights.cos_theta)},
          h_(all(tables_.h)),
          stiffness_(all(tables_.stiffness)),
          damping_(all(tables_.damping)),
          forcing_(all(tables_.forcing)),
          Omega_(all(tables_.Omega)) {
        const Real force = absolute(forcing_), reach = all(tables_.reach);
        const Real speed = root(stiffness_ * lo_.x * lo_.x + lo_.x_dot * lo_.x_dot) + force * reach;
        const Real x = speed * all(tables_.inverse_root_stiffness);
        M2_ = stiffness_ * x + damping_ * speed + force;
        M3_ = stiffness_ * speed + damping_ * M2_ + force * Omega_;
        eta_ = grid_rounding * (x + b_ + absolute(y_));
    }

    void run() {
        // Advance block by block to the first one not proven empty, then test its cells; where all
        // are empty, continue with the next block.
        Mask flying = ~Mask{};
        do {
            const Mask stopped = skip_empty_blocks(flying);
            flying = any(stopped) ? search_block(stopped) : Mask{};
        } while (any(flying));
        if (any(crosses_)) find_crossing();
        if (flights_.transfers && any(crosses_)) transfer();
        report();
    }

private:
    using Column = FlightBatch::Column;
    Real column(const Column& c) const { return load(c + from_); }

    Real inside(Real wide) const { return b_ - M2_ * (wide * wide / 8) - eta_; }

    Mask leaves(Real right, Real wide, Real inside) const {
        const Real least = M3_ * (wide * wide / 24) + eta_ / wide;
        return less(least, w_) & less(least * wide, b_ - right) & less(-inside, right);
    }

    template <class Part>
    Real relative_position(Part part, Real time) const {
        return state_part(part) - (y_ + time * y_dot_);
    }
    /// A component of the state from the responses to its four parts.
    template <class Part>
    Real state_part(Part part) const {
        return part(0) * lo_.x + part(1) * lo_.x_dot + part(2) * lo_.sin_theta +
               part(3) * lo_.cos_theta;
    }
    /// Table rows, at a separate grid point per vector element.
    struct Rows {
        const double* of[width];
        Real operator()(int column, int rows_ahead = 0) const {
            return gather(of, column + rows_ahead * row_length);
        }
    };
    Rows rows_at(Real k) const {
        Rows rows;
        for (int i = 0; i < width; ++i)
            rows.of[i] = tables_.rows + std::ptrdiff_t{row_length} * static_cast<int>(k[i]);
        return rows;
    }

    /// Advances to the first block after block_ not proven empty; returns the elements that found
    /// one.
    Mask skip_empty_blocks(Mask flying) {
        const Real wide = flow_block * h_, least = inside(wide), reach = all(tables_.reach);
        const Real last = select(less(limit_, reach), limit_ / wide, all(flow_blocks - 1));
        Real left = select(leaves_wall_, b_, lo_.x - y_), at{};
        Mask left_inside = less(absolute(left), least), stopped{};
        for (int block = 0; any(flying); ++block, at += 1) {
            const Real right = relative_position(
                [this, block](int part) { return all(tables_.apart[part][block]); },
                all(tables_.time_apart[block]));
            const Mask right_inside = less(absolute(right), least);
            Mask empty = left_inside & right_inside;
            if (block == 0)
                empty = (leaves_wall_ & leaves(right, wide, least)) | (~leaves_wall_ & empty);
            const Mask here = flying & ~empty & less(block_, at);
            stopped |= here;
            block_ = select(here, at, block_);
            block_left_ = select(here, left, block_left_);
            flying &= ~here & at_most(at + 1, last);
            left = right;
            left_inside = right_inside;
        }
        return stopped;
    }

    /// Tests the cells of each element's block. Returns the elements whose cells are all empty.
    Mask search_block(Mask active) {
        const Real least = inside(h_), beyond = b_ - eta_;
        const auto give_up = [&](Mask where) {
            undecided_ |= active & where;
            active &= ~where;
        };
        Real left = block_left_, k = select(active, flow_block * block_, Real{});
        const Rows rows = rows_at(k);
        give_up(equal(k, Real{}) & ~leaves_wall_ & at_most(beyond, absolute(left)));
        for (int i = 0; i < flow_block; ++i, k += 1) {
            const Real right = relative_position(
                [&rows, i](int part) { return rows(row_x + part, i + 1); }, (k + 1) * h_);
            const Mask at_wall = leaves_wall_ & equal(k, Real{});
            if (i == 0 && any(at_wall)) give_up(at_wall & ~leaves(right, h_, least));
            const Mask seen = active & ~at_wall, crossing = seen & at_most(beyond, absolute(right));
            crosses_ |= crossing;
            cell_ = select(crossing, k, cell_);
            left_ = select(crossing, left, left_);
            right_ = select(crossing, right, right_);
            active &= ~crossing;
            const Mask empty = less(absolute(left), least) & less(absolute(right), least),
                       unclear = seen & ~crossing & ~empty;
            if (any(unclear)) {
                const Real x_dot =
                    state_part([&rows, i](int part) { return rows(row_x_dot + part, i); });
                give_up(unclear & ~less(M2_ * h_, absolute(x_dot - y_dot_)));
            }
            left = right;
        }
        return active;
    }

    /// State at the left end of the crossing cell.
    Oscillations at_crossing() const {
        const Rows rows = rows_at(select(crosses_, cell_, Real{}));
        const Real cos = rows(row_cos), sin = rows(row_sin);
        return {
            state_part([&rows](int part) { return rows(row_x + part); }),
            state_part([&rows](int part) { return rows(row_x_dot + part); }),
            lo_.sin_theta * cos + lo_.cos_theta * sin, lo_.cos_theta * cos - lo_.sin_theta * sin};
    }

    Real acceleration(const Oscillations& o) const {
        return -stiffness_ * o.x - damping_ * o.x_dot + forcing_ * o.sin_theta;
    }
    Real jerk(const Oscillations& o) const {
        return -stiffness_ * o.x_dot - damping_ * acceleration(o) + forcing_ * Omega_ * o.cos_theta;
    }
    Real snap(const Oscillations& o) const {
        return -stiffness_ * acceleration(o) - damping_ * jerk(o) -
               forcing_ * Omega_ * Omega_ * o.sin_theta;
    }

    /// Taylor series of x and x' about the left end of the crossing cell.
    struct ShortSeries {
        Real x[short_terms], x_dot[short_terms];
        static Real value(const Real* c, Real d) {
            static_assert(short_terms == 12);
            const Real q = d * d, q_squared = q * q, q_fourth = q_squared * q_squared;
            const auto half = [=](int odd) {
                return c[odd] + c[2 + odd] * q + (c[4 + odd] + c[6 + odd] * q) * q_squared +
                       (c[8 + odd] + c[10 + odd] * q) * q_fourth;
            };
            return half(0) + d * half(1);
        }
    };
    /// Response to one part of the state with size 1.
    ShortSeries short_series(int part) const {
        ShortSeries n;
        for (int k = 0; k < short_terms; ++k) {
            n.x[k] = all(tables_.short_x[part][k]);
            n.x_dot[k] = all(tables_.short_x_dot[part][k]);
        }
        return n;
    }
    ShortSeries short_series(const Oscillations& o) const {
        ShortSeries n;
        for (int k = 0; k < short_terms; ++k) {
            const auto sum = [&o, k](const double* const(&columns)[4]) {
                return all(columns[0][k]) * o.x + all(columns[1][k]) * o.x_dot +
                       all(columns[2][k]) * o.sin_theta + all(columns[3][k]) * o.cos_theta;
            };
            n.x[k] = sum(tables_.short_x);
            n.x_dot[k] = sum(tables_.short_x_dot);
        }
        return n;
    }

    Oscillations rotated(const Oscillations& o, Real d) const {
        const Real a = Omega_ * d, q = a * a;
        const Real cos =
            1 + q * (-1.0 / 2 +
                     q * (1.0 / 24 + q * (-1.0 / 720 + q * (1.0 / 40320 + q * (-1.0 / 3628800)))));
        const Real sin =
            a * (1 + q * (-1.0 / 6 +
                          q * (1.0 / 120 +
                               q * (-1.0 / 5040 + q * (1.0 / 362880 + q * (-1.0 / 39916800))))));
        const Real new_sin = o.sin_theta * cos + o.cos_theta * sin,
                   new_cos = o.cos_theta * cos - o.sin_theta * sin;
        const Real shrink = 1.5 - 0.5 * (new_sin * new_sin + new_cos * new_cos);
        return {o.x, o.x_dot, new_sin * shrink, new_cos * shrink};
    }
    Oscillations rotated_little(const Oscillations& o, Real d) const {
        const Real a = Omega_ * d, cos = 1 - 0.5 * a * a;
        return {
            o.x, o.x_dot, o.sin_theta * cos + o.cos_theta * a, o.cos_theta * cos - o.sin_theta * a};
    }

    /// The contact of every element whose x - y is monotone in its crossing cell.
    void find_crossing() {
        const Real wall = select(less(Real{}, right_), all(1), all(-1)), f0 = wall * left_ - b_,
                   fh = wall * right_ - b_;
        const Oscillations o = at_crossing();
        const Real x_ddot = acceleration(o), third = jerk(o), fourth = snap(o);
        const Real f1 = wall * (o.x_dot - y_dot_), f2 = 0.5 * wall * x_ddot,
                   f3 = (1.0 / 6) * wall * third, f4 = (1.0 / 24) * wall * fourth;
        Mask going = crosses_ & less(M2_ * h_, f1) & less(f0, Real{});

        const Real per_h = 1 / h_, slope = (fh - f0) * per_h, inverse_slope = 1 / slope;
        const Real f5 = ((((slope - f1) * per_h - f2) * per_h - f3) * per_h - f4) * per_h;
        Real d = -f0 * inverse_slope;
        d += f2 * d * (h_ - d) * inverse_slope;
        d += halley(
            f0 + d * (f1 + d * (f2 + d * (f3 + d * (f4 + d * f5)))),
            f1 + d * (2 * f2 + d * (3 * f3 + d * (4 * f4 + d * (5 * f5)))),
            f2 + d * (3 * f3 + d * (6 * f4 + d * (10 * f5))));
        const ShortSeries series = short_series(o);
        const Real y_left = y_ + y_dot_ * (cell_ * h_);
        Mask found{};
        Real x{}, x_dot{}, step{};
        for (int i = 0; i < most_crossing_steps; ++i) {
            going &= less(Real{}, d) & at_most(d, h_ + little_step * h_);
            if (!any(going)) break;
            const Real new_x = ShortSeries::value(series.x, d),
                       new_x_dot = ShortSeries::value(series.x_dot, d);
            const Real new_step = halley(
                wall * (new_x - (y_left + y_dot_ * d)) - b_, wall * (new_x_dot - y_dot_),
                f2 + 0.5 * wall * d * (third + 0.5 * d * fourth));
            const Mask little = going & at_most(absolute(new_step), little_step * h_);
            x = select(little, new_x, x);
            x_dot = select(little, new_x_dot, x_dot);
            step = select(little, new_step, step);
            found |= little;
            going &= ~little;
            d = select(going, d + new_step, d);
        }
        const Real s = cell_ * h_ + (d + step);
        crosses_ = found & at_most(s, limit_);
        keep(s, wall, state_after(o, d, x, x_dot, step));
    }

    /// Transfer matrix of the flight, computed as in Flow::transfer().
    void transfer() {
        const Real s = select(crosses_, column(flights_.s), Real{});
        Real k = s / h_;
        for (int i = 0; i < width; ++i) k[i] = static_cast<int>(k[i]);
        const Real over = s - k * h_, d = select(less(Real{}, over), over, Real{});
        const Rows rows = rows_at(k);
        const Real a11 = rows(row_x_dot + 1), a12 = rows(row_x_dot), a21 = rows(row_x + 1),
                   a22 = rows(row_x);
        const ShortSeries unforced = short_series(1);
        const Real u = ShortSeries::value(unforced.x, d),
                   u_dot = ShortSeries::value(unforced.x_dot, d);
        const Real t12 = -stiffness_ * u, t22 = u_dot + damping_ * u;
        store(flights_.a11 + from_, u_dot * a11 + t12 * a21);
        store(flights_.a12 + from_, u_dot * a12 + t12 * a22);
        store(flights_.a21 + from_, u * a11 + t22 * a21);
        store(flights_.a22 + from_, u * a12 + t22 * a22);
    }

    /// x and x' of the series at d, carried over the last step by the Taylor polynomial.
    Oscillations state_after(const Oscillations& o, Real d, Real x, Real x_dot, Real step) const {
        Oscillations at = rotated(o, d);
        at.x = x, at.x_dot = x_dot;
        const Real a = acceleration(at), rate = jerk(at);
        at = rotated_little(at, step);
        at.x = x + step * (x_dot + 0.5 * step * a);
        at.x_dot = x_dot + step * (a + 0.5 * step * rate);
        return at;
    }

    void keep(Real s, Real wall, const Oscillations& at) {
        store(flights_.s + from_, s);
        store(flights_.wall + from_, wall * mirror_);
        store(flights_.contact_x + from_, mirror_ * at.x);
        store(flights_.contact_x_dot + from_, mirror_ * at.x_dot);
        store(flights_.contact_sin + from_, mirror_ * at.sin_theta);
        store(flights_.contact_cos + from_, mirror_ * at.cos_theta);
        store(flights_.contact_speed + from_, mirror_ * (at.x_dot - y_dot_));
    }

    void report() {
        // A crossing that was begun but not found is undecided.
        for (int i = 0; i < width; ++i)
            flights_.result[from_ + i] = crosses_[i]                      ? FlightBatch::contact
                                         : undecided_[i] || cell_[i] >= 0 ? FlightBatch::undecided
                                                                          : FlightBatch::none;
    }

    FlightBatch& flights_;
    const int from_;
    const FlowTables& tables_;
    // Mirrored as in fast_contact.cpp: the wall being left is at x - y = b.
    const Mask leaves_wall_;
    const Real mirror_;
    const Real b_, limit_, w_, y_, y_dot_;
    const Oscillations lo_;
    const Real h_, stiffness_, damping_, forcing_, Omega_;
    Real M2_, M3_, eta_;
    Mask undecided_{}, crosses_{};
    // Current block and x - y at its left end.
    Real block_ = all(-1), block_left_{};
    // Crossing cell and x - y at its ends.
    Real cell_ = all(-1), left_{}, right_{};
};

void search_batch(FlightBatch& flights) {
    for (int from = 0; from < flights.count; from += width) VectorSearch(flights, from).run();
}

}  // namespace

NamedBatchSearch vines_named_search() {
    constexpr const char* name = width == 8 ? "AVX-512" : width == 4 ? "AVX2" : "baseline";
    return {name, search_batch};
}

}  // namespace vines
