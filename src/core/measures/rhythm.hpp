// The rhythm in which the two masses meet, counted while a run goes on: no list of its contacts is
// kept.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/motion/contacts.hpp"
#include "core/motion/record.hpp"

namespace vines {

/// A stretch of contacts that alternate sides at intervals within 15 % of half a forcing period
/// (synchronised: the paper's "area2" in Fig. 9), or what lies between two of them.
struct SynchronyStretch {
    double tau_start, tau_end;
    bool synchronised;
    long contacts;
};

// Two impacts per cycle over two cycles: a shorter alternation happens by chance.
inline constexpr long shortest_stretch = 4;

/// Contacts one after the other, parted into stretches.
class Synchrony {
public:
    Synchrony(double half_cycle, std::size_t most_stretches)
        : stretches(most_stretches),
          half_cycle_(half_cycle) {}
    void add(const CountedContact& contact);
    /// Behind the last contact.
    void finish();

    LastOf<SynchronyStretch> stretches;
    long contacts = 0;
    long in_stretches = 0;  ///< of the contacts, in synchronised ones
    long longest = 0;       ///< half cycles of the longest synchronised alternation

private:
    /// A contact by its number.
    struct Mark {
        double tau = 0;
        long number = 0;
    };
    bool in_step(const CountedContact& next) const;
    void end_alternation();
    void desynchronised(const Mark& to);

    const double half_cycle_;
    Mark alternating_from_;
    Mark free_from_;  // the first contact that no stretch has yet
    CountedContact last_{};
};

/// The 128th of a forcing cycle in which each contact lies: a byte for each, and one more behind a
/// pause of a cycle.
class CyclePositions {
public:
    static constexpr int parts = 128;

    /// At tau/cycle, no earlier than the one before.
    void add(double cycles);
    /// Gives each as a number of parts since tau = 0.
    template <class Take>
    void each(Take take) const {
        std::int64_t position = 0, step = 0;
        int shift = 0;
        for (const std::uint8_t byte : bytes_) {
            step |= static_cast<std::int64_t>(byte & low_bits) << shift;
            shift += bits;
            if (byte > low_bits) continue;
            take(position += step);
            step = 0;
            shift = 0;
        }
    }

private:
    // Steps are written by seven bits a byte, the lowest first; all but the last have the eighth
    // bit set.
    static constexpr int bits = 7, low_bits = 127;
    std::vector<std::uint8_t> bytes_;
    std::int64_t last_ = 0;
};

/// How the contacts are spread over the forcing cycles.
struct CycleCounts {
    std::vector<double> moving_tau, moving_z;  ///< contacts per cycle, over 10 of them around tau
    std::vector<double> cycles_with;           ///< share of cycles with 0, 1, 2, ... contacts
};

/// Of the contacts in a window.
class Rhythm : public ContactStream {
public:
    /// `most_listed`: of the lists that grow with the run. 0: none of them is made.
    Rhythm(const Parameters& parameters, const Interval& window, std::size_t most_listed);

    /// Once, after the run: what it reached of the window.
    void finish(const Interval& reached);

    /// Contacts per cycle, from the first to the last.
    double z() const;
    /// From a cycle before the first contact on. The moving z is thinned to most_listed entries.
    CycleCounts cycle_counts() const;
    /// No more than most_listed.
    std::vector<SynchronyStretch> last_stretches();

    long contacts() const { return synchrony.contacts; }

    Synchrony synchrony;

private:
    void on_contact(const CountedContact& contact) override;
    void count(const CountedContact& contact);

    const double cycle_;
    const Interval window_;
    const std::size_t most_listed_;
    Interval reached_{};
    double first_ = 0, last_ = 0;
    std::optional<CountedContact> before_;  // the last one before the window
    CyclePositions positions_;
};

}  // namespace vines
