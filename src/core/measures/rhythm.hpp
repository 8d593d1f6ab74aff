// Rhythm of the contacts: contacts per cycle, and stretches synchronised with the forcing, counted
// during the run without a list of contacts. A stretch is synchronised if its contacts alternate
// sides at intervals within 15 % of half a forcing period; stretches that are too short to be more
// than chance do not count.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/motion/record.hpp"
#include "core/stability/mean_error.hpp"

namespace vines {

/// A synchronised stretch (the paper's "area2" in Fig. 9), or the interval between two of them.
struct SynchronyStretch {
    double tau_start, tau_end;
    bool synchronised;
    long contacts;
};

// Half cycles of the shortest stretch, two cycles: shorter alternations happen by chance.
inline constexpr long shortest_stretch = 4;

/// Divides a sequence of contacts into stretches.
class Synchrony {
public:
    Synchrony(double half_cycle, std::size_t most_stretches)
        : stretches(most_stretches),
          half_cycle_(half_cycle) {}
    void add(const ContactEvent& contact);
    /// Call after the last contact.
    void finish() {
        if (contacts == 0) return;
        end_alternation();
        desynchronised({last_.tau, contacts - 1});
    }

    LastOf<SynchronyStretch> stretches;
    long contacts = 0;
    long in_stretches = 0;  ///< contacts in synchronised stretches
    long longest = 0;       ///< half cycles of the longest synchronised stretch

private:
    /// A contact with its number.
    struct Mark {
        double tau = 0;
        long number = 0;
    };
    void end_alternation();
    void desynchronised(const Mark& to) {
        if (to.number > free_from_.number)
            stretches.add({free_from_.tau, to.tau, false, to.number - free_from_.number + 1});
    }

    const double half_cycle_;
    Mark alternating_from_;
    Mark free_from_;  // first contact not yet in a stretch
    ContactEvent last_{};
};

/// Positions of the contacts in 1/128 cycle, as differences of one byte, two after a pause of a
/// cycle.
class CyclePositions {
public:
    static constexpr int parts = 128;

    /// Adds a contact at tau/cycle, not before the previous one.
    void add(double cycles);
    /// Passes each position, in parts since tau = 0, to `take`.
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
    // Seven bits per byte, the lowest first; all but the last byte have the eighth bit set.
    static constexpr int bits = 7, low_bits = 127;
    std::vector<std::uint8_t> bytes_;
    std::int64_t last_ = 0;
};

/// Contacts of a window. The lists are as long as Rhythm keeps them.
struct ContactCounts {
    long contacts = 0;
    double z_overall = 0;  ///< contacts per cycle, from the first to the last contact
    /// Standard error (mean_error.hpp); NaN for windows of fewer than 32 cycles.
    double z_error = nan;
    std::vector<double> moving_tau, moving_z;  ///< contacts per cycle, over 10 cycles around tau
    std::vector<double> cycles_with;           ///< fraction of cycles with 0, 1, 2, ... contacts
    std::vector<SynchronyStretch> stretches;   ///< the last ones
    long stretch_count = 0;                    ///< including stretches not listed
    double synchronised = 0;                   ///< fraction of contacts in synchronised stretches
    long longest_synchronised = 0;             ///< half cycles of the longest synchronised stretch
};

/// Observer of the rhythm of the contacts in a window.
class Rhythm : public ContactStream {
public:
    /// `most_listed`: maximum length of the lists that grow with the run; 0: no lists.
    Rhythm(const Parameters& p, const Interval& window, std::size_t most_listed)
        : ContactStream(p),
          cycle_(p.cycle()),
          window_(window),
          most_listed_(most_listed) {}

    /// The counts in the part of the window that the run reached; call once, after the run. Cycles
    /// are counted from one before the first contact.
    ContactCounts finish(const Interval& reached);

private:
    void on_contact(const ContactEvent& contact) override {
        if (contact.tau < window_.from) before_ = contact;
        else if (contact.tau <= window_.to) count(contact);
    }
    void count(const ContactEvent& contact);
    double z(const Interval& reached) const;
    double z_error(const Interval& reached) const;
    void count_cycles(const Interval& reached, ContactCounts& counts) const;

    const double cycle_;
    const Interval window_;
    const std::size_t most_listed_;
    Synchrony synchrony_{0.5 * cycle_, most_listed_};
    double first_ = 0, last_ = 0;
    std::optional<ContactEvent> before_;  // the last contact before the window
    const WindowSteps steps_{window_, cycle_};
    const double steps_per_tau_ = 1 / steps_.duration();
    std::vector<double> in_steps_ = std::vector<double>(steps_.count());  // contacts in each step
    CyclePositions positions_;
};

}  // namespace vines
