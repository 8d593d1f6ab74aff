// What a measurement does not show of the contacts between two impacts that it shows: impacts too
// weak to be seen, the chatter that comes to rest, the time for which the mass then sticks to the
// wall, or an impact that a list misses. The identified system is run from the first of the two; if
// that leads to the second, what came between is what was hidden.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/measurement/identified_impact.hpp"
#include "core/measurement/identified_system.hpp"
#include "core/measurement/measured_record.hpp"

namespace vines {

/// An impact of a run, in the measurement's tau.
struct RunImpact {
    Impact impact;
    std::optional<Release> release = {};    ///< where the mass sticks after it
    std::optional<std::size_t> shown = {};  ///< the impact that shows it; none: it is hidden
    bool comes_to_rest = false;             ///< as in IdentifiedImpact
};

/// What lies between the impacts with these indices, some of it hidden.
struct HiddenContacts {
    std::size_t from, to;
    double y_dot_after, y_dot_before;     ///< of the mass, after `from` and before `to`
    std::optional<Release> release = {};  ///< where the mass sticks after `from`
    std::vector<RunImpact> impacts = {};
};

struct HidingPlaces {
    /// By what the oscillator may miss an impact to which it leads: x and x'.
    double tolerance = 0;
    double longest = 0;  ///< time that a run may take from one to the next
    /// So many in a row may be hidden that would be seen: a list misses some, or a search does.
    int most_seen = 6;
    std::vector<TimeGap> gaps = {};  ///< over which no run leads, in order
};
/// In order. The velocity with which the mass leaves an impact is that of the flight before, eq.
/// (43), or of the impact's own jump, eqs. (4), (36). `doubtful`: of each impact, that it may be
/// none, but stand for what is hidden beside it; empty: of none. look(): called for each impact;
/// what it throws ends this.
std::vector<HiddenContacts> hidden_contacts(
    const IdentifiedSystem& system, const HidingPlaces& places,
    const std::vector<IdentifiedImpact>& impacts, const std::vector<char>& doubtful = {},
    const std::function<void()>& look = {});

/// Puts them in, where none was doubtful, and has all velocities of the mass there from the
/// run. Returns how many were hidden.
long put_in(const std::vector<HiddenContacts>& hidden, std::vector<IdentifiedImpact>& impacts);

}  // namespace vines
