#include "core/measures/rhythm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace vines {

namespace {

// Tolerance of the interval, relative to half a cycle: reproduces Fig. 9's synchronised parts and
// the border of Types I and II, which does not move between 10 and 20 %.
constexpr double synchrony_tolerance = 0.15;
constexpr int moving_cycles = 10;

/// Phase of the forcing cycle, in parts of it, that contacts avoid: cycles are cut there.
int quiet_position(const CyclePositions& positions) {
    constexpr int bins = CyclePositions::parts / 2;
    std::array<long, bins> count{};
    positions.each([&](std::int64_t at) { ++count[at % CyclePositions::parts / 2]; });
    // Middle of the longest run of bins with the fewest contacts (cyclic).
    const long fewest = *std::ranges::min_element(count);
    int best = 0, best_length = 0;
    for (int from = 0; from < bins; ++from) {
        int length = 0;
        while (length < bins && count[(from + length) % bins] == fewest) ++length;
        if (length > best_length) best = from, best_length = length;
    }
    return 2 * best + best_length;
}

/// Whole cycles, rounded down.
long whole_cycles(std::int64_t positions) {
    const std::int64_t parts = CyclePositions::parts, before = positions < 0 ? parts - 1 : 0;
    return static_cast<long>((positions - before) / parts);
}

/// Counts contacts cycle by cycle.
class CycleCounter {
public:
    /// Keeps one of `every` entries of the moving z.
    CycleCounter(ContactCounts& counts, std::size_t every) : counts_(counts), every_(every) {}

    /// `middle` of the cycles of the moving z that end with this one.
    void add(int contacts, double middle) {
        auto& with = counts_.cycles_with;
        if (with.size() <= static_cast<std::size_t>(contacts)) with.resize(contacts + 1, 0);
        ++with[contacts];
        int& oldest = latest_[cycles_ % moving_cycles];
        sum_ += contacts - oldest;
        oldest = contacts;
        ++cycles_;
        if (cycles_ < moving_cycles || (cycles_ - moving_cycles) % every_ != 0) return;
        counts_.moving_tau.push_back(middle);
        counts_.moving_z.push_back(static_cast<double>(sum_) / moving_cycles);
    }
    void finish() {
        for (double& share : counts_.cycles_with) share /= static_cast<double>(cycles_);
    }

private:
    ContactCounts& counts_;
    const std::size_t every_;
    std::size_t cycles_ = 0;
    long sum_ = 0;
    std::array<int, moving_cycles> latest_{};
};

}  // namespace

void Synchrony::add(const ContactEvent& contact) {
    const bool is_synchronised =
        contact.side != last_.side &&
        std::abs(contact.tau - last_.tau - half_cycle_) < synchrony_tolerance * half_cycle_;
    if (contacts == 0) {
        alternating_from_ = free_from_ = {contact.tau, 0};
    } else if (!is_synchronised) {
        end_alternation();
        alternating_from_ = {contact.tau, contacts};
    }
    last_ = contact;
    ++contacts;
}

void Synchrony::end_alternation() {
    const Mark last{last_.tau, contacts - 1};
    const long half_cycles = last.number - alternating_from_.number;
    longest = std::max(longest, half_cycles);
    if (half_cycles < shortest_stretch) return;
    desynchronised(alternating_from_);
    stretches.add({alternating_from_.tau, last.tau, true, half_cycles + 1});
    in_stretches += half_cycles + 1;
    free_from_ = last;
}

void CyclePositions::add(double cycles) {
    const auto position = static_cast<std::int64_t>(std::floor(cycles * parts));
    std::int64_t step = position - last_;
    last_ = position;
    for (; step > low_bits; step >>= bits)
        bytes_.push_back(static_cast<std::uint8_t>((step & low_bits) | (low_bits + 1)));
    bytes_.push_back(static_cast<std::uint8_t>(step));
}

void Rhythm::count(const ContactEvent& contact) {
    if (synchrony_.contacts == 0) first_ = contact.tau;
    last_ = contact.tau;
    synchrony_.add(contact);
    if (most_listed_ > 0) positions_.add(contact.tau / cycle_);
    const double step = (contact.tau - window_.from) * steps_per_tau_;
    if (step >= 0 && step < static_cast<double>(in_steps_.size()))
        ++in_steps_[static_cast<std::size_t>(step)];
}

ContactCounts Rhythm::finish(const Interval& reached) {
    flush_contacts();
    // A window that the run does not reach has shrunk to one instant at the run's end.
    if (before_ && before_->tau >= reached.from) count(*before_);
    synchrony_.finish();
    ContactCounts counts;
    counts.contacts = synchrony_.contacts;
    counts.z_overall = z(reached);
    counts.z_error = z_error(reached);
    if (most_listed_ > 0) count_cycles(reached, counts);
    trim_to_last(synchrony_.stretches.entries, most_listed_);
    counts.stretches = std::move(synchrony_.stretches.entries);
    counts.stretch_count = synchrony_.stretches.seen;
    if (counts.contacts > 0)
        counts.synchronised =
            static_cast<double>(synchrony_.in_stretches) / static_cast<double>(counts.contacts);
    counts.longest_synchronised = synchrony_.longest;
    return counts;
}

double Rhythm::z(const Interval& reached) const {
    const long contacts = synchrony_.contacts;
    if (contacts > 1) return static_cast<double>(contacts - 1) * cycle_ / (last_ - first_);
    const double duration = reached.to - reached.from;
    return duration > 0 ? static_cast<double>(contacts) * cycle_ / duration : 0;
}

double Rhythm::z_error(const Interval& reached) const {
    const double passed = (reached.to - window_.from) / steps_.duration();
    // A run that ends within the window has only counted whole steps.
    const auto steps = std::span(in_steps_).first(
        std::min(in_steps_.size(), static_cast<std::size_t>(std::max(0.0, passed + 1e-9))));
    return error_of_modulated_sum(steps) * cycle_ /
           (static_cast<double>(steps.size()) * steps_.duration());
}

void Rhythm::count_cycles(const Interval& reached, ContactCounts& counts) const {
    const int cut_position = counts.contacts > 0 ? quiet_position(positions_) : 0;
    const double cut = static_cast<double>(cut_position) / CyclePositions::parts,
                 from = counts.contacts > 0 ? first_ - cycle_ : reached.from;
    const long first = static_cast<long>(std::ceil(from / cycle_ - cut)),
               cycles = static_cast<long>(std::floor(reached.to / cycle_ - cut)) - first;
    if (cycles <= 0) return;
    const auto moving = static_cast<std::size_t>(std::max(0L, cycles + 1 - moving_cycles));
    CycleCounter counter(counts, moving / most_listed_ + 1);
    long cycle = 0;
    int in_cycle = 0;
    auto count_up_to = [&](long to) {
        for (; cycle < std::min(to, cycles); ++cycle, in_cycle = 0)
            counter.add(in_cycle, (first + cycle + 1 + cut - 0.5 * moving_cycles) * cycle_);
    };
    positions_.each([&](std::int64_t position) {
        const long at = whole_cycles(position - cut_position) - first;
        count_up_to(at);
        if (at == cycle) ++in_cycle;
    });
    count_up_to(cycles);
    counter.finish();
}

}  // namespace vines
