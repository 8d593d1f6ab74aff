// Observers that record a run: the sampled motion, stroboscopic states, impacts, sticking phases,
// grazing contacts.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "core/motion/elementary.hpp"
#include "core/motion/flow.hpp"
#include "core/motion/simulate.hpp"

namespace vines {

/// The oscillator at equidistant times of a stretch: eight multiplications per sample. The flow is
/// a linear map of (x, x', sin theta, cos theta); its maps over 1, 2, 3, ... steps are tabulated,
/// each to the last ulp, so that errors do not add up. A sample differs from Flow::after() by at
/// most 16 ulp of Flow::Bounds::x, mostly from rounding of times within the flow's reach.
class SampledFlow {
public:
    /// Time between samples, in tau.
    explicit SampledFlow(double step) : step_(step) {}

    /// Sets the flow, which must exist until the next begin(), and the state at s = 0.
    void begin(const Flow& flow, const Oscillation& start);
    /// The state after s <= reach; s grows from call to call, by one step up to rounding of tau.
    Oscillation at(double s);

private:
    /// The map over j steps: responses to the parts of the state, rotation of the phasor.
    struct Steps {
        double time;  ///< duration of j steps, rounded: the map is exact for it
        Oscillation x, x_dot;
        double cos, sin;
    };
    Steps steps_over(double time) const;

    double step_;
    const Flow* flow_ = nullptr;
    Oscillation start_{};
    std::vector<Steps> table_;  // for j = 1, 2, ..., extended on demand
    std::optional<Flow::Coefficients> of_;

    // Time and state from which the table counts, and the steps that at() has taken since.
    struct Origin {
        double s;
        Oscillation state;
        std::size_t steps;
    };
    std::optional<Origin> origin_;
};

/// Capacity of a record that keeps all entries.
inline constexpr std::size_t everything = std::numeric_limits<std::size_t>::max() / 2;

/// Trims a record to its last `most` entries at the end of the run.
template <class Entries>
void trim_to_last(Entries& entries, std::size_t most) {
    if (entries.size() > most)
        entries.erase(entries.begin(), entries.end() - static_cast<std::ptrdiff_t>(most));
}
/// Trims a growing record whenever it holds half as many more: an entry moves about twice.
template <class Entries>
void keep_last(Entries& entries, std::size_t most) {
    if (entries.size() > most + most / 2) trim_to_last(entries, most);
}

/// The sampled motion: columns of equal length. x and y in m, derivatives with respect to tau.
struct Series {
    std::vector<double> tau, x, x_dot, y, y_dot, x_ddot;
    std::vector<double> x_relative;  ///< to the base; empty unless a load moves it

    /// The columns that every series has.
    auto columns() { return std::array{&tau, &x, &x_dot, &y, &y_dot, &x_ddot}; }
};

/// Samples the motion at tau = 0, step, 2 step, ... and at the end of the run.
class SeriesRecord : public Observer {
public:
    /// `with_base`: records x_relative.
    explicit SeriesRecord(double step, bool with_base = false)
        : step_(step),
          with_base_(with_base) {}
    /// Reserves memory for a complete run, or for the first million samples.
    void expect(double tau_end) {
        const auto samples = static_cast<std::size_t>(std::min(tau_end / step_, 1e6)) + 2;
        for (auto* column : series.columns()) column->reserve(samples);
    }
    void on_stretch(const Stretch&) override;
    void finish(const Outcome& outcome) {
        constexpr double rounding = 1e-6;  // of a long run, in steps
        if (series.tau.empty() || series.tau.back() < outcome.tau - rounding * step_)
            add(outcome.tau, outcome.state, x_ddot_at_end_, base_at_end_);
    }

    Series series;

private:
    void add(double tau, const State& state, double x_ddot, double base);
    double step_, x_ddot_at_end_ = 0, base_at_end_ = 0;
    bool with_base_;
    long next_ = 0;
    SampledFlow free_{step_}, sticking_{step_};
};

/// Times at which a Stroboscope takes the state, up to `until`: tau = (k + phase/(2 pi)) 2 pi/Omega
/// with k = first, first + 1, ...; there theta = phi + phase.
struct StroboscopeTimes {
    long first = 0;
    double phase = 0, until = infinity;
};

/// Takes the state once per forcing cycle.
class Stroboscope : public Observer {
public:
    explicit Stroboscope(const Parameters& p, const StroboscopeTimes& times = {})
        : cycle_(p.cycle()),
          after_(times.phase / p.Omega),
          until_(times.until),
          next_(times.first) {}
    void on_stretch(const Stretch&) override;

    /// Time of sample k.
    double tau_of(long k) const { return static_cast<double>(k) * cycle_ + after_; }

protected:
    virtual void take(long k, const State& state) = 0;
    long next() const { return next_; }

private:
    const double cycle_, after_, until_;
    long next_;
};

/// The last `most` stroboscopic states, and up to half as many more.
class StroboscopicRecord : public Stroboscope {
public:
    explicit StroboscopicRecord(
        const Parameters& parameters, const StroboscopeTimes& times = {},
        std::size_t most = everything)
        : Stroboscope(parameters, times),
          most_(most) {}

    /// Number k of the first state kept.
    long first() const { return next() - static_cast<long>(states.size()); }
    double tau(std::size_t k) const { return tau_of(first() + static_cast<long>(k)); }
    /// The first k with tau(k) in a window, and the first one after it.
    std::pair<std::size_t, std::size_t> range(const Interval& window) const {
        std::size_t first = 0, end = states.size();
        while (first < end && tau(first) < window.from) ++first;
        while (end > first && tau(end - 1) > window.to) --end;
        return {first, end};
    }
    std::vector<State> states;  ///< states[k] is the state at tau(k)

private:
    void take(long, const State& state) override {
        states.push_back(state);
        keep_last(states, most_);
    }
    const std::size_t most_;
};

/// The last `most` entries of a growing list, and up to half as many more. `seen` counts all.
template <class Entry>
class LastOf {
public:
    explicit LastOf(std::size_t most = everything) : most_(most) {}
    void add(const Entry& entry) {
        entries.push_back(entry);
        keep_last(entries, most_);
        ++seen;
    }

    std::vector<Entry> entries;
    long seen = 0;

private:
    const std::size_t most_;
};

class ImpactRecord : public Observer, public LastOf<Impact> {
public:
    using LastOf::LastOf;
    void on_impact(const Impact& impact) override { add(impact); }
};

/// A range of impacts by their numbers, counted from 0.
struct ImpactRange {
    long first = 0, count = 0;
};

/// Observer of the last `most_listed` impacts of a run. If there are more than `most_kept` of them,
/// the list is dropped and only the quantities derived from all impacts are kept.
class ImpactCollector : public Observer {
public:
    ImpactCollector(std::size_t most_listed, std::size_t most_kept);

    void on_impact(const Impact& impact) override;
    void finish();  ///< call once, after the run

    ImpactRange listed() const;  ///< numbers of the listed impacts
    bool kept() const { return kept_; }

    std::vector<Impact> entries;  ///< all listed impacts, or empty if not kept()
    double typical_speed = 1;     ///< median of the relative speeds; 1 without impacts
    struct NearlyTangent {
        long number;
        double tau, speed;  ///< |x' - y'| before the impact
    };
    std::vector<NearlyTangent> nearly_tangent;

private:
    void conclude(long number, const Impact& impact);

    const std::size_t most_listed_, most_kept_;
    bool kept_ = true;
    long seen_ = 0;
    LastOf<double> speeds_;
};

/// Passes the impacts in `range` to `take`, in order, by repeating the run with its limits. Returns
/// false if limits.stop ended the repetition before the last of them.
bool repeat_impacts(
    const Parameters& parameters, const State& start, const Limits& limits,
    const ImpactRange& range, const std::function<void(const Impact&)>& take);

/// An impact and the time since the previous impact.
struct SectionPoint {
    Impact impact;
    double since;  ///< NaN at the first impact of the run
};

/// The impacts in a window, each with the time since the previous impact, even if that is outside.
class SectionRecord : public Observer, public LastOf<SectionPoint> {
public:
    SectionRecord(const Interval& window, std::size_t most) : LastOf(most), window_(window) {}
    void on_impact(const Impact& impact) override {
        if (window_.contains(impact.tau)) add({impact, impact.tau - before_});
        before_ = impact.tau;
    }

private:
    const Interval window_;
    double before_ = nan;
};

/// A phase in which the ball rests on a wall.
struct StickingPhase {
    StickStart start;
    double tau_end;
};

class StickRecord : public Observer, public LastOf<StickingPhase> {
public:
    using LastOf::LastOf;
    void on_stick(const StickStart& start) override { add({start, start.tau}); }
    void on_release(double tau) override { entries.back().tau_end = tau; }
};

/// A contact: its time, and the side of its wall.
struct ContactEvent {
    double tau;
    int side;
};

/// Contacts with zero relative speed, without an impact.
class GrazingRecord : public Observer, public LastOf<ContactEvent> {
public:
    using LastOf::LastOf;
    void on_grazing_contact(double tau, int side) override { add({tau, side}); }
};

/// Keeps only the first impact of a chatter.
inline void fold_chatter(std::vector<ContactEvent>& contacts, const StickStart& start) {
    if (start.impacts > 1)
        contacts.resize(contacts.size() - static_cast<std::size_t>(start.impacts - 1));
}

/// Contacts as regimes count them: an impact, or a complete chatter that ends in sticking.
class ContactRecord : public Observer {
public:
    void on_impact(const Impact& impact) override {
        ++impacts;
        contacts.push_back({impact.tau, impact.side});
    }
    void on_stick(const StickStart& start) override {
        sticks.push_back({start.tau, start.tau});
        fold_chatter(contacts, start);
    }
    void on_release(double tau) override { sticks.back().to = tau; }

    std::vector<ContactEvent> contacts;
    std::vector<Interval> sticks;
    long impacts = 0;
};

/// Reports the same contacts one at a time; stores only impacts that may belong to a chatter.
class ContactStream : public Observer {
public:
    /// Flights of a chatter take less than half a cycle (Run::longest_bounce_), up to rounding.
    explicit ContactStream(const Parameters& p) : longest_bounce_(1.001 * p.faster_half_cycle()) {}

    void on_impact(const Impact& impact) override;
    void on_stick(const StickStart& start) override {
        fold_chatter(held_, start);
        flush_contacts();
    }

protected:
    virtual void on_contact(const ContactEvent& contact) = 0;
    /// Reports the stored contacts; call it after the run.
    void flush_contacts();

private:
    const double longest_bounce_;
    std::vector<ContactEvent> held_;
};

}  // namespace vines
