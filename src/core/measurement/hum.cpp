// The record times exp(-i Omega tau) is averaged over overlapping blocks with a Hann window, which
// suppress the motion; the spectrum of the averages shows the line and its neighbourhood.
#include "core/measurement/hum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

using Complex = std::complex<double>;

// Half of a block in periods of the mains, and the range searched, relative to the frequency.
constexpr double half_block_periods = 25, searched = 0.003;
// A line exceeds the median of its neighbourhood and the noise by these factors; the neighbourhood
// reaches this many resolutions, the line itself some.
constexpr double stands_above = 6, above_noise = 2;
constexpr int neighbourhood = 40, line_width = 3, trials_per_resolution = 8;

double hann(double place) {
    const double sine = elementary::sin(std::numbers::pi * place);
    return sine * sine;
}

/// The channel near one frequency.
class NearLine {
public:
    NearLine(const std::vector<double>& tau, const std::vector<double>& v, double Omega)
        : length_(tau.back() - tau.front()),
          hop_(half_block_periods * 2 * std::numbers::pi / Omega) {
        const auto blocks = static_cast<std::size_t>(std::max(0.0, length_ / hop_ - 1));
        std::vector<Complex> sums(blocks, 0);
        std::vector<double> weights(blocks, 0);
        for (std::size_t k = 0; k < tau.size(); ++k) {
            const double place = (tau[k] - tau.front()) / hop_;
            const Complex value = v[k] * elementary::phasor(-Omega * (tau[k] - tau.front()));
            const auto last = static_cast<std::size_t>(place);
            for (std::size_t j = last > 0 ? last - 1 : 0; j <= last && j < blocks; ++j) {
                const double weight = hann(0.5 * (place - static_cast<double>(j)));
                sums[j] += weight * value, weights[j] += weight;
            }
        }
        for (std::size_t j = 0; j < blocks; ++j)
            if (weights[j] > 0) {
                const double at = static_cast<double>(j + 1) * hop_;
                const double weight = hann(at / length_);
                averages_.push_back({at, weight, 2.0 * sums[j] / weights[j]});
                total_ += weight;
            }
    }

    double resolution() const { return 2 * std::numbers::pi / length_; }
    /// Amplitude and phase at Omega + faster, cos and -sin of the time since the start.
    Complex at(double faster) const {
        Complex sum = 0;
        for (const Average& a : averages_)
            sum += a.weight * a.value * elementary::phasor(-faster * a.tau);
        return sum / total_;
    }
    bool is_empty() const { return averages_.size() < 3; }

private:
    struct Average {
        double tau, weight;
        Complex value;
    };
    double length_, hop_, total_ = 0;
    std::vector<Average> averages_;
};

/// Removes the line near Omega; returns its frequency and amplitude, 0 if there is none.
Hum remove_line(const std::vector<double>& tau, std::vector<double>& v, double Omega) {
    const NearLine near(tau, v, Omega);
    if (near.is_empty()) return {Omega, 0, false};
    double best = 0, highest = 0;
    const double step = near.resolution() / trials_per_resolution;
    const int trials = static_cast<int>(searched * Omega / step) + 1;
    for (int k = -trials; k <= trials; ++k)
        if (const double height = elementary::modulus(near.at(k * step)); height > highest)
            highest = height, best = k * step;
    std::vector<double> around;
    for (int k = line_width; k <= neighbourhood; ++k)
        for (const int sign : {1, -1})
            around.push_back(elementary::modulus(near.at(best + sign * k * near.resolution())));
    const double noise = third_difference_noise(tau, v);
    if (!(highest > stands_above * median(std::move(around)) && highest > above_noise * noise))
        return {Omega, 0, false};
    const Complex line = near.at(best);
    for (std::size_t k = 0; k < tau.size(); ++k)
        v[k] -= (line * elementary::phasor((Omega + best) * (tau[k] - tau.front()))).real();
    return {Omega + best, highest, false};
}

}  // namespace

std::vector<Hum> remove_hum(MeasuredRecord& r, const std::vector<double>& mains) {
    std::vector<Hum> found;
    for (const double Omega : mains)
        for (std::vector<double>* channel : {&r.x, &r.x_ddot}) {
            if (channel->empty()) continue;
            Hum hum = remove_line(r.tau, *channel, Omega);
            hum.in_displacement = channel == &r.x;
            if (hum.amplitude > 0) found.push_back(hum);
        }
    return found;
}

}  // namespace vines
