#include "core/measures/torus.hpp"

#include <algorithm>
#include <cmath>

#include "core/measures/golden_section.hpp"
#include "core/motion/elementary.hpp"
#include "core/motion/fourier.hpp"
#include "core/stability/orbit.hpp"

namespace vines {

namespace {

constexpr std::size_t most_points_of_torus = 2048, fewest_points_of_torus = 128;
constexpr int most_curves = 6, lines_tried = 4;
// Largest deviations from 1 of length and curvature, by neighbours over by every fourth point: on a
// curve both ratios are 1, in a set with a thickness 4 and 16.
constexpr double length_tolerance = 0.1, curvature_tolerance = 0.4;
constexpr std::size_t coarse_neighbours = 4;
// Largest gap between phases, in turns.
constexpr double most_phase_gap = 0.05;

// Largest ratio of the curvature at the points of the second half, from neighbours in the first, to
// that of all points: a motion that still approaches a curve or an orbit has a larger one.
constexpr double most_drift = 3;
// Largest error of the rotation number, in turns over all points.
constexpr double most_error = 0.01;
// Error of a refined frequency, in turns: rounding hides the top of a maximum.
constexpr double refinement_error = 3e-10;
// Largest relative difference of the line's amplitude between both halves: constant on a torus.
constexpr double most_decay = 0.01;

// Largest relative strength at half the frequency of a line: leakage of the window stays below it.
constexpr double most_half = 1e-6;

// Closer points are equal (a period): the closest of 65,536 on a curve are 1e-5 apart.
constexpr double return_distance = 1e-8;
// Smallest median gap between the phases over the mean gap: periodic points coincide.
constexpr double least_median_gap = 0.01;

std::complex<double> turned(double turns) {
    return elementary::phasor(2 * std::numbers::pi * turns);
}

/// x + i x' of the points without their mean, weighted by the square of a Hann window.
Signal windowed(std::span<const State> points) {
    Signal signal;
    std::complex<double> mean = 0;
    for (const State& s : points) mean += std::complex(s.x, s.x_dot);
    mean /= static_cast<double>(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        const double place = static_cast<double>(k + 1) / static_cast<double>(points.size() + 1);
        const double hann = 1 - turned(place).real();
        signal.push_back((std::complex(points[k].x, points[k].x_dot) - mean) * (hann * hann));
    }
    return signal;
}

/// Modulus of the spectrum at a frequency, in turns per point.
double line_at(const Signal& signal, double frequency) {
    const std::complex<double> step = turned(-frequency);
    std::complex<double> sum = 0;
    for (std::size_t k = signal.size(); k > 0; --k) sum = sum * step + signal[k - 1];
    return elementary::modulus(sum);
}

/// Frequency of the maximum of line_at() within `width` of a frequency, by golden sections.
double refined(const Signal& signal, double frequency, double width) {
    return golden_maximum(
        [&signal](double at) { return line_at(signal, at); }, frequency - width, frequency + width,
        1e-9 * width);
}

/// Frequencies of the strongest lines, in turns per point, the strongest first.
std::vector<double> strongest_lines(const Signal& signal) {
    std::size_t n = 1;
    while (n < 2 * signal.size()) n *= 2;
    Signal spectrum = signal;
    spectrum.resize(n);
    spectrum = fourier_sums(std::move(spectrum), -1);
    std::vector<std::pair<double, std::size_t>> maxima;
    for (std::size_t k = 0; k < n; ++k) {
        const double here = elementary::modulus(spectrum[k]);
        if (here > elementary::modulus(spectrum[(k + 1) % n]) &&
            here >= elementary::modulus(spectrum[(k + n - 1) % n]))
            maxima.emplace_back(-here, k);
    }
    std::ranges::sort(maxima);
    maxima.resize(std::min<std::size_t>(maxima.size(), lines_tried));
    std::vector<double> lines;
    const double width = 1.0 / static_cast<double>(n);
    for (const auto& maximum : maxima)
        lines.push_back(refined(signal, static_cast<double>(maximum.second) * width, width));
    return lines;
}

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// The points in the order of their phases; length and median curvature of the curve through them.
class SortedPoints {
public:
    SortedPoints(std::span<const State> points, const State& scale, double frequency)
        : points_(points),
          scale_(scale) {
        for (std::size_t k = 0; k < points.size(); ++k) {
            const double turns = frequency * static_cast<double>(k);
            phases_.emplace_back(turns - std::floor(turns), k);
        }
        std::ranges::sort(phases_);
    }

    /// Between the phases of neighbours.
    std::vector<double> gaps() const {
        std::vector<double> gaps;
        for (std::size_t i = 0; i < phases_.size(); ++i) gaps.push_back(apart(i, 1));
        return gaps;
    }
    double largest_gap() const { return std::ranges::max(gaps()); }
    double median_gap() const { return median_of(gaps()); }

    struct Shape {
        double length, curvature;
    };
    /// From neighbours that are `step` places apart.
    Shape shape(std::size_t step) const {
        double length = 0;
        std::vector<double> curvatures;
        const std::size_t n = phases_.size();
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t middle = (i + step) % n;
            const double before = apart(i, step), after = apart(middle, step);
            const State &left = at(i), &here = at(middle), &right = at(middle + step);
            const Eigen::Vector4d line =
                (after * vector_of(left) + before * vector_of(right)) / (before + after);
            length += distance(left, here, scale_) / static_cast<double>(step);
            curvatures.push_back(distance(here, state_of(line), scale_) / (before * after));
        }
        return {length, median_of(std::move(curvatures))};
    }

    /// Median curvature of the points that follow these, from the lines between their neighbours.
    double curvature_at(std::span<const State> further, double frequency) const {
        std::vector<double> curvatures;
        for (std::size_t k = 0; k < further.size(); ++k) {
            const double turns = frequency * static_cast<double>(points_.size() + k),
                         phase = turns - std::floor(turns);
            const auto right = static_cast<std::size_t>(
                std::ranges::lower_bound(phases_, std::pair<double, std::size_t>(phase, 0)) -
                phases_.begin());
            const std::size_t left = right + phases_.size() - 1;
            const double whole = apart(left, 1), before = turned_from(left, phase),
                         after = whole - before;
            const Eigen::Vector4d line =
                (after * vector_of(at(left)) + before * vector_of(at(right))) / whole;
            curvatures.push_back(distance(further[k], state_of(line), scale_) / (before * after));
        }
        return median_of(std::move(curvatures));
    }

private:
    double turned_from(std::size_t i, double phase) const {
        const double turns = phase - phases_[i % phases_.size()].first;
        return turns < 0 ? turns + 1 : turns;
    }
    const State& at(std::size_t i) const { return points_[phases_[i % phases_.size()].second]; }
    double apart(std::size_t i, std::size_t step) const {
        return turned_from(i, phases_[(i + step) % phases_.size()].first);
    }

    const std::span<const State> points_;
    const State scale_;
    std::vector<std::pair<double, std::size_t>> phases_;
};

/// True if other points are farther from these than neighbours on a curve are from each other.
bool lie_apart(std::span<const State> points, std::span<const State> others, const State& scale) {
    std::vector<double> nearest, neighbours;
    const std::size_t examined = std::min<std::size_t>(others.size(), 64);
    const auto to_nearest = [&](const State& from, std::size_t without) {
        double distance_to = infinity;
        for (std::size_t k = 0; k < points.size(); ++k)
            if (k != without) distance_to = std::min(distance_to, distance(from, points[k], scale));
        return distance_to;
    };
    for (std::size_t k = 0; k < examined; ++k) {
        nearest.push_back(to_nearest(others[k], points.size()));
        neighbours.push_back(to_nearest(points[k], k));
    }
    return median_of(std::move(nearest)) > 4 * median_of(std::move(neighbours));
}

/// True if all points lie on one curve, rather than on `apart` separate ones. One of the candidates
/// is the rotation number from point to point; its sign only reverses the order.
bool is_one_curve(
    std::span<const State> states, const State& scale, const QuasiPeriodic& found, int apart) {
    for (int k = 0; k < apart; ++k) {
        const SortedPoints sorted(states, scale, (found.rotation_number + k) / apart);
        if (std::abs(sorted.shape(1).length / sorted.shape(coarse_neighbours).length - 1) <
            length_tolerance)
            return true;
    }
    return false;
}

/// Evidence that points at equal intervals, of which one lies on each curve, rotate on it.
std::optional<QuasiPeriodic> on_one_curve(std::span<const State> points, const State& scale) {
    const Signal signal = windowed(points);
    const auto first = points.first(points.size() / 2), last = points.last(points.size() / 2);
    for (const double line : strongest_lines(signal)) {
        // At half the frequency the curve closes after two turns, whose strands can be very close.
        const double strength = line_at(signal, line);
        if (line_at(signal, 0.5 * line) > most_half * strength ||
            line_at(signal, 0.5 * line + 0.5) > most_half * strength)
            continue;
        const SortedPoints sorted(points, scale, line);
        const double largest_gap = sorted.largest_gap();
        const auto count = static_cast<double>(points.size());
        if (largest_gap > most_phase_gap || sorted.median_gap() * count < least_median_gap)
            continue;
        const auto fine = sorted.shape(1), coarse = sorted.shape(coarse_neighbours);
        const double length_ratio = fine.length / coarse.length,
                     curvature_ratio = fine.curvature / coarse.curvature;
        if (!(std::abs(length_ratio - 1) < length_tolerance &&
              std::abs(curvature_ratio - 1) < curvature_tolerance))
            continue;
        const SortedPoints of_first(first, scale, line);
        if (of_first.largest_gap() > most_phase_gap ||
            !(of_first.curvature_at(points.subspan(first.size()), line) <
              most_drift * fine.curvature))
            continue;
        const double width = 1 / count;
        const double early = line_at(windowed(first), line), late = line_at(windowed(last), line);
        if (!(std::abs(late - early) < most_decay * early)) continue;
        double error = refinement_error;
        for (const auto& part : {first, last})
            error = std::max(error, std::abs(refined(windowed(part), line, width) - line));
        if (error > most_error * width) continue;
        const double turns = line - std::round(line);
        return QuasiPeriodic{std::abs(turns), error,          1, points.size(), largest_gap,
                             length_ratio,    curvature_ratio};
    }
    return std::nullopt;
}

}  // namespace

std::optional<QuasiPeriodic> quasi_periodic(std::span<const State> states, const State& scale) {
    const auto returns = [&](const State& s) {
        return distance(s, states.back(), scale) < return_distance;
    };
    if (states.empty() || std::ranges::any_of(states.first(states.size() - 1), returns))
        return std::nullopt;
    // The first half can be a transient.
    states = states.last(std::min(states.size() / 2, most_points_of_torus));
    for (int curves = 1; curves <= most_curves; ++curves) {
        const auto apart = static_cast<std::size_t>(curves);
        if (states.size() / apart < fewest_points_of_torus) break;
        std::vector<State> points;
        for (std::size_t k = states.size() % apart; k < states.size(); k += apart)
            points.push_back(states[k]);
        auto found = on_one_curve(points, scale);
        if (!found) continue;
        // With fewer curves than assumed, points of one of them were taken for several.
        for (std::size_t later = 1; later < apart; ++later) {
            if (apart % later != 0) continue;
            std::vector<State> others;
            for (std::size_t k = states.size() % apart + later; k < states.size(); k += apart)
                others.push_back(states[k]);
            if (!lie_apart(points, others, scale)) return std::nullopt;
        }
        if (curves > 1 && is_one_curve(states, scale, *found, curves)) return std::nullopt;
        found->curves = curves;
        found->rotation_number /= curves;
        found->error /= curves;
        return found;
    }
    return std::nullopt;
}

}  // namespace vines
