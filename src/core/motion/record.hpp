// Observers that write down what a run does: the sampled motion, the impacts, the stuck phases.
#pragma once

#include <limits>
#include <vector>

#include "core/motion/sampled_flow.hpp"
#include "core/motion/simulate.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

/// Of a record that keeps all of its entries.
inline constexpr std::size_t everything = std::numeric_limits<std::size_t>::max() / 2;

/// Cuts a growing record down to its last `most` entries, at half of them more: each entry is moved
/// once at most.
template <class Entries>
void keep_last(Entries& entries, std::size_t most) {
    if (entries.size() >= most + most / 2 + 1)
        entries.erase(entries.begin(), entries.end() - static_cast<std::ptrdiff_t>(most));
}
/// The same at the end of the run.
template <class Entries>
void trim_to_last(Entries& entries, std::size_t most) {
    if (entries.size() > most)
        entries.erase(entries.begin(), entries.end() - static_cast<std::ptrdiff_t>(most));
}

/// The motion at some moments: columns of equal length. x and y in m, derivatives in tau.
struct Series {
    std::vector<double> tau, x, x_dot, y, y_dot, x_ddot;
};

/// The motion at tau = 0, step, 2 step, ... and at the end of the run.
class SeriesRecord : public Observer {
public:
    explicit SeriesRecord(double step) : step_(step), free_(step), stuck_(step) {}
    /// Makes room for all of a run, or for the first million moments.
    void expect(double tau_end);
    void on_stretch(const Stretch&) override;
    void finish(const Outcome& outcome);

    Series series;

private:
    void add(double tau, const State& state, double x_ddot);
    double step_, x_ddot_at_end_ = 0;
    long next_ = 0;
    SampledFlow free_, stuck_;
};

/// Takes the states at one phase of the forcing, once a cycle: at tau = (k + phase/(2 pi)) 2
/// pi/Omega with k = first, first + 1, ... So theta = phi + phase.
class Stroboscope : public Observer {
public:
    explicit Stroboscope(
        const Parameters& parameters, long first = 0, double phase = 0, double until = infinity)
        : cycle_(parameters.cycle()),
          after_(phase / parameters.Omega),
          until_(until),
          next_(first) {}
    void on_stretch(const Stretch&) override;

    /// Moment of the k-th.
    double tau_of(long k) const { return static_cast<double>(k) * cycle_ + after_; }

protected:
    virtual void take(long k, const State& state) = 0;
    long next() const { return next_; }

private:
    const double cycle_, after_, until_;
    long next_;
};

/// Of the states at whole cycles up to a moment the last so many.
struct LastStates {
    std::size_t most;
    double until;
};

/// Keeps them all, or of LastStates up to half more.
class StroboscopicRecord : public Stroboscope {
public:
    explicit StroboscopicRecord(const Parameters& parameters, long first = 0, double phase = 0)
        : Stroboscope(parameters, first, phase) {}
    StroboscopicRecord(const Parameters& parameters, const LastStates& last)
        : Stroboscope(parameters, 0, 0, last.until),
          most_(last.most) {}

    /// Number k of the first that is kept.
    long first() const { return next() - static_cast<long>(states.size()); }
    double tau(std::size_t k) const { return tau_of(first() + static_cast<long>(k)); }
    std::vector<State> states;  ///< the k-th at tau(k)

private:
    void take(long, const State& state) override {
        states.push_back(state);
        keep_last(states, most_);
    }
    const std::size_t most_ = everything;
};

/// The last `most` entries of a list that grows with a run: it keeps up to half more. `seen` counts
/// all of them.
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

/// An impact of a section, and the time since the impact before it.
struct SectionPoint {
    Impact impact;
    double since;  ///< NaN at the first impact of the run
};

/// The impacts in [tau_start, tau_end], each with the time since the impact before it, whether that
/// is in the window or not.
class SectionRecord : public Observer, public LastOf<SectionPoint> {
public:
    SectionRecord(double tau_start, double tau_end, std::size_t most)
        : LastOf(most),
          tau_start_(tau_start),
          tau_end_(tau_end) {}
    void on_impact(const Impact& impact) override {
        if (impact.tau >= tau_start_ && impact.tau <= tau_end_) add({impact, impact.tau - before_});
        before_ = impact.tau;
    }

private:
    const double tau_start_, tau_end_;
    double before_ = nan;
};

/// A phase in which the mass stays on a wall.
struct StuckPhase {
    StickStart start;
    double tau_end;
};

class StickRecord : public Observer, public LastOf<StuckPhase> {
public:
    using LastOf::LastOf;
    void on_stick(const StickStart& start) override { add({start, start.tau}); }
    void on_release(double tau) override { entries.back().tau_end = tau; }
};

/// A tangent contact without an impact.
struct TangentContact {
    double tau;
    int side;
};

class TouchRecord : public Observer, public LastOf<TangentContact> {
public:
    using LastOf::LastOf;
    void on_touch(double tau, int side) override { add({tau, side}); }
};

}  // namespace vines
