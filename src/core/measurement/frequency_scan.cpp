// Search for the forcing's frequency: the joint fit converges only if the phase slips by less than
// a cycle over the record, and in a long record a small frequency error slips by many.
#include "core/measurement/joint_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/measurement/interval_motion.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

constexpr double widest = 0.05;  // search range on either side of the given frequency, relative
// Step of the search: the phase slip between the record's middle and its ends, rad.
constexpr double slip = 0.4;
// Longest piece, in cycles: within a piece the phase slip is neglected.
constexpr double longest_piece_cycles = 1.5;
// Another frequency must explain more than the given one by this fraction.
constexpr double least_gain = 0.02;

/// Equations S f = h for the forcing from one piece of the record, without its initial state.
struct PieceEquations {
    double tau;  ///< middle of the piece
    Eigen::Matrix2d S;
    Eigen::Vector2d h;
};

/// Normal equations of one piece in its initial state and the forcing.
struct StartAndForce {
    Eigen::Matrix4d N = Eigen::Matrix4d::Zero();
    Eigen::Vector4d g = Eigen::Vector4d::Zero();
    long samples = 0;

    void add(const Eigen::Vector4d& row, double value, double noise) {
        N.noalias() += row * row.transpose() / (noise * noise);
        g.noalias() += row * (value / (noise * noise));
        ++samples;
    }
    PieceEquations without_start(double tau) const {
        // Far below the contribution of one sample, about one over its variance, and above zero.
        constexpr double ridge = 1e-9;
        const Eigen::Matrix2d start =
            (N.topLeftCorner<2, 2>() + ridge * Eigen::Matrix2d::Identity()).inverse();
        const Eigen::Matrix2d mixed = N.bottomLeftCorner<2, 2>() * start;
        return {
            tau, N.bottomRightCorner<2, 2>() - mixed * N.topRightCorner<2, 2>(),
            g.tail<2>() - mixed * g.head<2>()};
    }
};

/// Starts of the pieces: the borders, and further ones where impacts are far apart.
std::vector<double> pieces_of(const MeasuredRecord& r, const Candidates& borders, double longest) {
    std::vector<double> starts = {r.tau.front()};
    const auto reach = [&](double to) {
        while (to - starts.back() > longest) starts.push_back(starts.back() + longest);
    };
    for (const Candidate& c : borders) {
        reach(c.tau);
        if (c.tau > starts.back()) starts.push_back(c.tau);
    }
    reach(r.tau.back());
    return starts;
}

std::vector<PieceEquations> equations_of(
    const JointFitInput& in, const std::vector<double>& starts) {
    const MeasuredRecord& r = in.record;
    const Parameters& p = in.parameters;
    const Flow flow(1, 2 * p.zeta(), 1, p.Omega);
    const double middle = 0.5 * (r.tau.front() + r.tau.back());
    // The median removes the sensor's offset.
    const double x_offset = median(r.x), a_offset = median(r.x_ddot);
    std::vector<PieceEquations> all;
    std::size_t k = 0;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        in.progress.look();
        const double end = i + 1 < starts.size() ? starts[i + 1] : infinity;
        FollowedFlow<4> parts(flow, unit_motions(p.Omega * (starts[i] - middle)));
        StartAndForce equations;
        for (; k < r.tau.size() && r.tau[k] < end; ++k) {
            const auto m = parts.at(std::max(0.0, r.tau[k] - starts[i]), r.x.empty());
            if (!r.x.empty() && !in.statistics.x.bad[k])
                equations.add(
                    {m[0].x, m[1].x, m[2].x, m[3].x}, r.x[k] - x_offset, in.statistics.x.noise);
            // Next to a displacement it adds almost nothing. Its pulses act as noise.
            if (r.x.empty() && !in.statistics.a.bad[k])
                equations.add(
                    {m[0].x_ddot, m[1].x_ddot, m[2].x_ddot, m[3].x_ddot}, r.x_ddot[k] - a_offset,
                    in.statistics.a.noise);
        }
        if (equations.samples > 4)
            all.push_back(equations.without_start(
                starts[i] + 0.5 * (std::min(end, r.tau.back()) - starts[i])));
    }
    return all;
}

/// Part of the sum of squares explained by a forcing whose phase advances by `faster` per tau.
double explained(const std::vector<PieceEquations>& pieces, double faster, double middle) {
    Eigen::Matrix2d S = Eigen::Matrix2d::Zero();
    Eigen::Vector2d h = Eigen::Vector2d::Zero();
    for (const PieceEquations& piece : pieces) {
        const double a = faster * (piece.tau - middle);
        // Rotates from the nominal phase to the faster one.
        Eigen::Matrix2d turn;
        turn << elementary::cos(a), -elementary::sin(a), elementary::sin(a), elementary::cos(a);
        S += turn.transpose() * piece.S * turn;
        h += turn.transpose() * piece.h;
    }
    const double value = h.dot(S.inverse() * h);
    return std::isfinite(value) ? value : 0;
}

}  // namespace

double scanned_frequency(const JointFitInput& in, const Candidates& borders) {
    const MeasuredRecord& r = in.record;
    const Parameters& p = in.parameters;
    const double middle = 0.5 * (r.tau.front() + r.tau.back()),
                 length = r.tau.back() - r.tau.front();
    const std::vector<PieceEquations> pieces =
        equations_of(in, pieces_of(r, borders, longest_piece_cycles * p.cycle()));
    const double step = slip / (0.5 * length);
    const int steps = static_cast<int>(widest * p.Omega / step) + 1;
    const double given = explained(pieces, 0, middle);
    double best = given, faster = 0;
    for (int k = -steps; k <= steps; ++k) {
        in.progress.tick();
        const double value = explained(pieces, k * step, middle);
        if (value > best && value > (1 + least_gain) * given) best = value, faster = k * step;
    }
    return p.Omega + faster;
}

}  // namespace vines
