#include "core/stability/exterior.hpp"

#include <algorithm>
#include <cmath>

#include "core/stability/linear.hpp"

namespace vines {

namespace {

// A spectral radius below this fraction of the norm is dominated by rounding.
constexpr double least_radius = 1e-8;

}  // namespace

Leg leg_of(const Flow& flow, double duration, bool sticking, bool resting) {
    const double contraction = flow.fastest_decay() * duration,
                 parts =
                     contraction > most_contraction ? std::ceil(contraction / most_contraction) : 1,
                 part = duration / parts;
    return {flow.transfer(part),      part,     -flow.damping() * part,
            static_cast<long>(parts), sticking, resting};
}

Leg leg_of(const Stretch& s) {
    return leg_of(s.flow, s.duration, s.sticking_side != 0, s.rests_inside());
}

Saltation slip_of(const Leg& leg, double epsilon) { return saltation(epsilon, Slip{0, leg.slip}); }

template <class Deviations>
void carry(Deviations& d, const Leg& leg, double epsilon) {
    const auto& [a11, a12, a21, a22] = leg.oscillator;
    using Row = Eigen::Matrix<double, 1, Deviations::ColsAtCompileTime>;
    Row x_dot = d.row(0), x = d.row(1);
    const Row gap = leg.resting ? Row(d.row(3) - x) : Row(Row::Zero());
    const double nu = 1 / (1 + epsilon), mu = epsilon * nu;
    if (leg.sticking || leg.resting) x_dot = nu * x_dot + mu * d.row(2);
    if (leg.sticking) x = nu * x + mu * d.row(3);
    d.row(0) = a11 * x_dot + a12 * x;
    d.row(1) = a21 * x_dot + a22 * x;
    if (leg.sticking || leg.resting) d.row(2) = d.row(0), d.row(3) = d.row(1) + gap;
    else d.row(3) += leg.duration * d.row(2);
}

template void carry(Frame&, const Leg&, double);
template void carry(Eigen::Vector4d&, const Leg&, double);

Matrix4 transfer_of(const Leg& leg, double epsilon) {
    Frame J = Frame::Identity();
    for (long k = 0; k < leg.parts; ++k) carry(J, leg, epsilon);
    if (leg.slip != 1) J = slip_of(leg, epsilon).times(J);
    return J;
}

Matrix4 transfer_of(std::span<const Leg> legs, double epsilon) {
    Matrix4 J = Matrix4::Identity();
    for (const Leg& leg : legs) J = transfer_of(leg, epsilon) * J;
    return J;
}

namespace {

/// Determinant over one part; the contraction is too small for the difference to lose digits.
double determinant_of(const Transfer& a) { return a.a11 * a.a22 - a.a12 * a.a21; }

/// With z = x - y: c = x' - mu z' and x move as one body, z' vanishes and z stays.
[[gnu::noinline]] Area carried_at_rest(const Area& w, const Leg& leg, double epsilon) {
    const auto& [a11, a12, a21, a22] = leg.oscillator;
    // The areas of c and x, c and z, x and z.
    const double mu = epsilon / (1 + epsilon), cx = w(0) - mu * (w(0) + w(3)),
                 cz = w(0) - w(2) - mu * (w(0) - w(2) + w(3) + w(5)), xz = -w(4);
    const double x_dot_x = determinant_of(leg.oscillator) * cx, x_dot_z = a11 * cz + a12 * xz;
    Area out;
    out << x_dot_x, 0, x_dot_x - x_dot_z, -x_dot_x, -(a21 * cz + a22 * xz), x_dot_x - x_dot_z;
    return out;
}

[[gnu::noinline]] Volume carried_at_rest(const Volume& n, const Leg& leg, double epsilon) {
    const double nu = 1 / (1 + epsilon),
                 size = determinant_of(leg.oscillator) * (epsilon * nu * n(0) - nu * n(2));
    return {size, 0, -size, 0};
}

}  // namespace

Area carried(const Area& w, const Leg& leg, double epsilon) {
    const auto& [a11, a12, a21, a22] = leg.oscillator;
    const double det = determinant_of(leg.oscillator);
    Area out;
    if (leg.sticking) {
        // Area of the deviations of the centre of mass: x' = y', x = y.
        const double nu = 1 / (1 + epsilon), mu = epsilon * nu;
        const double area = det * (nu * nu * w(0) + nu * mu * (w(2) - w(3)) + mu * mu * w(5));
        out << area, 0, area, -area, 0, area;
        return out;
    }
    if (leg.resting) return carried_at_rest(w, leg, epsilon);
    // J consists of the oscillator's block and the ball's block [1 0; s 1].
    const double s = leg.duration, w03 = w(2) + s * w(1), w13 = w(4) + s * w(3);
    out << det * w(0), a11 * w(1) + a12 * w(3), a11 * w03 + a12 * w13, a21 * w(1) + a22 * w(3),
        a21 * w03 + a22 * w13, w(5);
    return out;
}

Volume carried(const Volume& n, const Leg& leg, double epsilon) {
    if (leg.sticking) return Volume::Zero();
    if (leg.resting) return carried_at_rest(n, leg, epsilon);
    // det(J) J^-T n
    const auto& [a11, a12, a21, a22] = leg.oscillator;
    const double det = determinant_of(leg.oscillator);
    return {
        a22 * n(0) - a21 * n(1), a11 * n(1) - a12 * n(0), det * (n(2) - leg.duration * n(3)),
        det * n(3)};
}

namespace {

/// M in the coordinates (x', x, z', z) with z = x - y: z' becomes -R_speed z' + r_z z and z becomes
/// -R z, x' gains -jump_x_dot z' + r_x z and x gains -jump_x z.
struct Relative {
    double R, R_speed, jump_x, jump_x_dot, r_x, r_z;
    /// R_speed r_x - jump_x_dot r_z, without products of x'': it enters linearly everywhere.
    double mixed;
};
Relative relative(const Saltation& M) {
    const double r_z = M.r_x - M.r_y;
    return {
        M.R, M.R_speed, M.jump_x, M.jump_x_dot, M.r_x, r_z, M.R_speed * M.r_x - M.jump_x_dot * r_z};
}

}  // namespace

Area carried(const Area& w, const Saltation& M) {
    const auto [R, R_speed, jump_x, jump_x_dot, r_x, r_z, mixed] = relative(M);
    // Components in the coordinates of x and z: 12 is x, z'; 23 is z', z.
    const double u02 = -w(1), u03 = w(0) - w(2), u12 = -w(0) - w(3), u13 = -w(4),
                 u23 = u03 + w(3) + w(5);
    const double v01 = w(0) - jump_x * u03 + jump_x_dot * (u12 + jump_x * u23) - r_x * u13,
                 v02 = r_z * u03 - R_speed * u02 + mixed * u23, v03 = R * (jump_x_dot * u23 - u03),
                 v12 = r_z * u13 - R_speed * (u12 + jump_x * u23), v13 = -R * u13,
                 v23 = M.determinant() * u23;
    Area out;
    out << v01, -v02, v01 - v03, -v01 - v12, -v13, v01 - v03 + v12 + v23;
    return out;
}

Volume carried(const Volume& n, const Saltation& M) {
    // det(M) M^-T n.
    const auto [R, R_speed, jump_x, jump_x_dot, r_x, r_z, mixed] = relative(M);
    const double along_x_dot = n(0) + n(2), along_x = n(1) + n(3), det = M.determinant();
    const double along_z_dot = R * (n(2) - jump_x_dot * along_x_dot),
                 along_z = mixed * along_x_dot + r_z * n(2) + R_speed * (n(3) - jump_x * along_x);
    return {det * along_x_dot + along_z_dot, det * along_x + along_z, -along_z_dot, -along_z};
}

void Flag::pass(const Leg& leg, double epsilon) {
    carry(deviation, leg, epsilon);
    area = carried(area, leg, epsilon);
    volume = carried(volume, leg, epsilon);
    determinant *= leg.sticking || leg.resting ? 0 : determinant_of(leg.oscillator);
}

void Flag::strike(const Saltation& M) {
    deviation = M.times(deviation);
    area = carried(area, M);
    volume = carried(volume, M);
}

std::array<double, 3> Flag::squares() const {
    return {deviation.squaredNorm(), area.squaredNorm(), volume.squaredNorm()};
}

std::array<double, 2> Flag::separations() const {
    const Eigen::Vector4d &d = deviation, &n = volume;
    const Area& w = area;
    const Eigen::Vector4d spanned(
        d(0) * w(3) - d(1) * w(1) + d(2) * w(0), d(0) * w(4) - d(1) * w(2) + d(3) * w(0),
        d(0) * w(5) - d(2) * w(2) + d(3) * w(1), d(1) * w(5) - d(2) * w(4) + d(3) * w(3));
    const Eigen::Vector4d seen(
        w(0) * n(1) + w(1) * n(2) + w(2) * n(3), -w(0) * n(0) + w(3) * n(2) + w(4) * n(3),
        -w(1) * n(0) - w(3) * n(1) + w(5) * n(3), -w(2) * n(0) - w(4) * n(1) - w(5) * n(2));
    return {spanned.norm() / (d.norm() * w.norm()), seen.norm() / (w.norm() * n.norm())};
}

template <int n>
void PowerProduct::Scaled<n>::rescale() {
    const double norm = matrix.norm();
    if (norm == 0) return;
    matrix /= norm;
    log_scale += elementary::log(norm);
}

/// ln of the largest modulus of an eigenvalue.
template <int n>
double PowerProduct::Scaled<n>::log_radius() const {
    if (!matrix.allFinite()) return nan;
    const double radius = spectral_radius(matrix);
    return radius > least_radius ? log_scale + elementary::log(radius) : nan;
}

template <class... By>
void PowerProduct::transport(const By&... by) {
    first_.rescale();
    for (int k = 0; k < 6; ++k) second_.matrix.col(k) = carried(Area(second_.matrix.col(k)), by...);
    second_.rescale();
    if (rank_ < 3) return;
    for (int k = 0; k < 4; ++k) third_.matrix.col(k) = carried(Volume(third_.matrix.col(k)), by...);
    third_.rescale();
}

void PowerProduct::pass(const Leg& leg) {
    if (leg.sticking) rank_ = 2;
    if (leg.resting) rank_ = std::min(rank_, 3);
    for (long count = 0; count < leg.parts; ++count) {
        Frame first = first_.matrix;
        carry(first, leg, epsilon_);
        first_.matrix = first;
        transport(leg, epsilon_);
        log_det_ += leg.log_det;
    }
    if (leg.slip != 1) strike(slip_of(leg, epsilon_));
}

void PowerProduct::strike(const Saltation& M) {
    if (M.is_singular()) rank_ = std::min(rank_, 3);
    first_.matrix = M.times(first_.matrix);
    transport(M);
    log_det_ += elementary::log(std::abs(M.R)) + elementary::log(std::abs(M.R_speed));
}

Moduli PowerProduct::log_moduli() const {
    const double one = first_.log_radius(), two = second_.log_radius(),
                 three = rank_ >= 3 ? third_.log_radius() : 0;
    Moduli logs = {one, two - one, three - two, log_det_ - three};
    for (int k = rank_; k < 4; ++k) logs[k] = -infinity;
    return logs;
}

Moduli ImpactTransfer::moduli(bool with_impact) const {
    PowerProduct product(epsilon);
    for (const Leg& leg : legs) product.pass(leg);
    if (with_impact) product.strike(M);
    Moduli moduli = product.log_moduli();
    for (double& m : moduli) m = elementary::exp(m);
    return moduli;
}

Moduli ImpactTransfer::J_moduli() const {
    if (std::ranges::any_of(legs, [](const Leg& leg) { return leg.sticking || leg.slip != 1; }))
        return moduli(false);
    // Two blocks, eq. (19). The ball's, [1 0; s 1], is a Jordan block, which a solver would split.
    Moduli moduli = {1, 1, 1, 1};
    for (const Leg& leg : legs) {
        const auto& [a11, a12, a21, a22] = leg.oscillator;
        const double n = static_cast<double>(leg.parts), half_trace = 0.5 * std::abs(a11 + a22);
        // half_trace^2 minus the determinant, without the ones that cancel in a short flight.
        const double d = 0.25 * (a11 - a22) * (a11 - a22) + a12 * a21;
        const double large = d > 0 ? elementary::log(half_trace + std::sqrt(d)) : 0.5 * leg.log_det;
        moduli[2] = elementary::exp(n * large);
        moduli[3] = elementary::exp(n * (leg.log_det - large));
    }
    return moduli;
}

Moduli ImpactTransfer::M_moduli() const {
    Moduli moduli = {1, 1, std::abs(M.R), std::abs(M.R_speed)};
    std::ranges::sort(moduli, std::greater<>());
    return moduli;
}

void TransferObserver::on_stretch(const Stretch& stretch) {
    if (!begun_) return;
    const bool sticking = stretch.sticking_side != 0;
    const bool continues = !legs_.empty() && legs_.back().sticking == sticking &&
                           legs_.back().resting == stretch.rests_inside() && legs_.back().slip == 1;
    double duration = stretch.duration;
    if (continues) {
        duration += legs_.back().duration * static_cast<double>(legs_.back().parts);
        legs_.pop_back();
    }
    legs_.push_back(leg_of(stretch.flow, duration, sticking, stretch.rests_inside()));
}

void TransferObserver::on_slip(const Slip& slip) {
    if (!begun_) return;
    if (legs_.empty()) legs_.push_back({{}, 0, 0, 1, false});
    legs_.back().slip *= slip.ratio;
}

void TransferObserver::on_impact(const Impact& impact) {
    if (!window_.contains(impact.tau)) return;
    if (begun_) on_transfer(impact, saltation(parameters_, impact), legs_);
    else on_first_impact(impact);
    begun_ = true;
    legs_.clear();
}

}  // namespace vines
