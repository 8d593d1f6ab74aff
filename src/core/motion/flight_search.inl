// The search of flight_lanes.hpp, compiled once for each instruction set: the file that includes
// this one says how many lanes a vector has (vines_lanes). It knows nothing of the processor beside
// that: sums, products, roots and comparisons of vectors are the compiler's, each rounded as IEEE
// has it, none fused. Comments on why it is done so stand in fast_contact.cpp, whose steps these
// are.
#include <cstddef>

#include "core/motion/flight_lanes.hpp"
#include "core/motion/search_limits.hpp"
#include "core/motion/vector_lanes.inl"

namespace vines {

namespace {

Real halley(Real f, Real first, Real half_second) {
    return -f * first / (first * first - f * half_second);
}

/// The state of the oscillator in each lane.
struct Oscillations {
    Real x, x_dot, sin_theta, cos_theta;
};

/// The columns of FlowTables::rows.
constexpr int row_x = 0, row_x_dot = 4, row_cos = 8, row_sin = 9, row_length = 10;

class Search {
public:
    Search(FlightLanes& flights, int from)
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
        // From block to block to the first that is not empty as a whole, then from cell to cell of
        // it; where those are, on to the blocks behind it.
        Mask flying = ~Mask{};
        do {
            const Mask stopped = march(flying);
            flying = any(stopped) ? look(stopped) : Mask{};
        } while (any(flying));
        if (any(crosses_)) cross();
        if (flights_.transfers && any(crosses_)) transfer();
        report();
    }

private:
    using Column = FlightLanes::Column;
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
    /// What a state has become, from its parts.
    template <class Part>
    Real state_part(Part part) const {
        return part(0) * lo_.x + part(1) * lo_.x_dot + part(2) * lo_.sin_theta +
               part(3) * lo_.cos_theta;
    }
    /// Rows of the lanes' tables, each at a grid point of its own.
    struct Rows {
        const double* of[width];
        Real operator()(int column, int behind = 0) const {
            return gather(of, column + behind * row_length);
        }
    };
    Rows rows_at(Real k) const {
        Rows rows;
        for (int i = 0; i < width; ++i)
            rows.of[i] = tables_.rows + std::ptrdiff_t{row_length} * static_cast<int>(k[i]);
        return rows;
    }

    /// On to the first block behind block_ that is not proven empty. Gives the lanes that have one.
    Mask march(Mask flying) {
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

    /// The cells of each lane's block. Gives the lanes in which all of them are empty.
    Mask look(Mask lanes) {
        const Real least = inside(h_), beyond = b_ - eta_;
        const auto give_up = [&](Mask where) {
            open_ |= lanes & where;
            lanes &= ~where;
        };
        Real left = block_left_, k = select(lanes, flow_block * block_, Real{});
        const Rows rows = rows_at(k);
        give_up(equal(k, Real{}) & ~leaves_wall_ & at_most(beyond, absolute(left)));
        for (int i = 0; i < flow_block; ++i, k += 1) {
            const Real right = relative_position(
                [&rows, i](int part) { return rows(row_x + part, i + 1); }, (k + 1) * h_);
            const Mask behind_wall = leaves_wall_ & equal(k, Real{});
            if (i == 0 && any(behind_wall)) give_up(behind_wall & ~leaves(right, h_, least));
            const Mask seen = lanes & ~behind_wall,
                       crossing = seen & at_most(beyond, absolute(right));
            crosses_ |= crossing;
            cell_ = select(crossing, k, cell_);
            left_ = select(crossing, left, left_);
            right_ = select(crossing, right, right_);
            lanes &= ~crossing;
            const Mask empty = less(absolute(left), least) & less(absolute(right), least),
                       unclear = seen & ~crossing & ~empty;
            if (any(unclear)) {
                const Real x_dot =
                    state_part([&rows, i](int part) { return rows(row_x_dot + part, i); });
                give_up(unclear & ~less(M2_ * h_, absolute(x_dot - y_dot_)));
            }
            left = right;
        }
        return lanes;
    }

    /// At the left end of each lane's crossing cell.
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

    /// The Taylor series of x and x' about the crossing cell's left end.
    struct Near {
        Real x[near_terms], x_dot[near_terms];
        static Real value(const Real* c, Real d) {
            static_assert(near_terms == 12);
            const Real q = d * d, q_squared = q * q, q_fourth = q_squared * q_squared;
            const auto half = [=](int odd) {
                return c[odd] + c[2 + odd] * q + (c[4 + odd] + c[6 + odd] * q) * q_squared +
                       (c[8 + odd] + c[10 + odd] * q) * q_fourth;
            };
            return half(0) + d * half(1);
        }
    };
    /// Of a motion that begins as one part of the state, of size 1 and alone.
    Near near_series(int part) const {
        Near n;
        for (int k = 0; k < near_terms; ++k) {
            n.x[k] = all(tables_.near_x[part][k]);
            n.x_dot[k] = all(tables_.near_x_dot[part][k]);
        }
        return n;
    }
    Near near_series(const Oscillations& o) const {
        Near n;
        for (int k = 0; k < near_terms; ++k) {
            const auto sum = [&o, k](const double* const(&columns)[4]) {
                return all(columns[0][k]) * o.x + all(columns[1][k]) * o.x_dot +
                       all(columns[2][k]) * o.sin_theta + all(columns[3][k]) * o.cos_theta;
            };
            n.x[k] = sum(tables_.near_x);
            n.x_dot[k] = sum(tables_.near_x_dot);
        }
        return n;
    }

    Oscillations turned(const Oscillations& o, Real d) const {
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
    Oscillations turned_little(const Oscillations& o, Real d) const {
        const Real a = Omega_ * d, cos = 1 - 0.5 * a * a;
        return {
            o.x, o.x_dot, o.sin_theta * cos + o.cos_theta * a, o.cos_theta * cos - o.sin_theta * a};
    }

    /// The contact of every lane whose x - y is monotone in its crossing cell.
    void cross() {
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
        const Near series = near_series(o);
        const Real y_left = y_ + y_dot_ * (cell_ * h_);
        Mask found{};
        Real x{}, x_dot{}, step{};
        for (int i = 0; i < most_crossing_steps; ++i) {
            going &= less(Real{}, d) & at_most(d, h_ + little_step * h_);
            if (!any(going)) break;
            const Real new_x = Near::value(series.x, d), new_x_dot = Near::value(series.x_dot, d);
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

    /// The transfer matrix of the flight, as Flow::transfer() has it.
    void transfer() {
        const Real s = select(crosses_, column(flights_.s), Real{});
        Real k = s / h_;
        for (int i = 0; i < width; ++i) k[i] = static_cast<int>(k[i]);
        const Real over = s - k * h_, d = select(less(Real{}, over), over, Real{});
        const Rows rows = rows_at(k);
        const Real a11 = rows(row_x_dot + 1), a12 = rows(row_x_dot), a21 = rows(row_x + 1),
                   a22 = rows(row_x);
        const Near unforced = near_series(1);
        const Real u = Near::value(unforced.x, d), u_dot = Near::value(unforced.x_dot, d);
        const Real t12 = -stiffness_ * u, t22 = u_dot + damping_ * u;
        store(flights_.a11 + from_, u_dot * a11 + t12 * a21);
        store(flights_.a12 + from_, u_dot * a12 + t12 * a22);
        store(flights_.a21 + from_, u * a11 + t22 * a21);
        store(flights_.a22 + from_, u * a12 + t22 * a22);
    }

    /// By the series' x and x' at d, and over the last step by its Taylor polynomial.
    Oscillations state_after(const Oscillations& o, Real d, Real x, Real x_dot, Real step) const {
        Oscillations at = turned(o, d);
        at.x = x, at.x_dot = x_dot;
        const Real a = acceleration(at), rate = jerk(at);
        at = turned_little(at, step);
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
        // What began to cross and is not found is open.
        for (int i = 0; i < width; ++i)
            flights_.found[from_ + i] = crosses_[i]                 ? FlightLanes::contact
                                        : open_[i] || cell_[i] >= 0 ? FlightLanes::open
                                                                    : FlightLanes::none;
    }

    FlightLanes& flights_;
    const int from_;
    const FlowTables& tables_;
    // As in Flight of fast_contact.cpp: mirrored so that the wall that is left is at x - y = b.
    const Mask leaves_wall_;
    const Real mirror_;
    const Real b_, limit_, w_, y_, y_dot_;
    const Oscillations lo_;
    const Real h_, stiffness_, damping_, forcing_, Omega_;
    Real M2_, M3_, eta_;
    Mask open_{}, crosses_{};
    // The block at hand and x - y at its left end.
    Real block_ = all(-1), block_left_{};
    // The crossing cell and x - y at its ends.
    Real cell_ = all(-1), left_{}, right_{};
};

void search_lanes(FlightLanes& flights) {
    for (int from = 0; from < flights.count; from += width) Search(flights, from).run();
}

}  // namespace

}  // namespace vines
