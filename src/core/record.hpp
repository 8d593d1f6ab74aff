// Observers that write down what a run does: the sampled motion, the impacts, the stuck phases.
#pragma once

#include <numbers>
#include <vector>

#include "core/simulate.hpp"

namespace vines {

/// Cuts a growing record down to its last `most` entries, at half of them more: each entry is moved once at most.
template <class Entries>
void keep_last(Entries& entries, std::size_t most) {
    if (entries.size() >= most + most / 2 + 1) entries.erase(entries.begin(), entries.end() - static_cast<std::ptrdiff_t>(most));
}
/// The same at the end of the run.
template <class Entries>
void trim_to_last(Entries& entries, std::size_t most) {
    if (entries.size() > most) entries.erase(entries.begin(), entries.end() - static_cast<std::ptrdiff_t>(most));
}

/// The motion at tau = 0, step, 2 step, ... and at the end of the run. Units as in State.
class SeriesRecord : public Observer {
public:
    explicit SeriesRecord(double step) : step_(step) {}
    void on_stretch(const Stretch&) override;
    void finish(const Outcome& outcome);

    std::vector<double> tau, x, x_dot, y, y_dot;

private:
    void add(double tau, const State& state);
    double step_;
    long next_ = 0;
};

/// The states at one phase of the forcing: at tau = first, first + 1, ... times 2 pi/Omega (theta = phi).
class StroboscopicRecord : public Observer {
public:
    explicit StroboscopicRecord(const Parameters& parameters, long first = 0) : cycle_(2 * std::numbers::pi / parameters.Omega), first_(first) {}
    void on_stretch(const Stretch&) override;

    double tau(std::size_t k) const { return (first_ + static_cast<long>(k)) * cycle_; }
    std::vector<State> states;  ///< the k-th at tau(k)

private:
    const double cycle_;
    const long first_;
};

class ImpactRecord : public Observer {
public:
    void on_impact(const Impact& impact) override { impacts.push_back(impact); }
    std::vector<Impact> impacts;
};

class StickRecord : public Observer {
public:
    void on_stick(const StickStart& start) override { sticks.push_back({start, start.tau}); }
    void on_release(double tau) override { sticks.back().tau_end = tau; }

    struct Stick {
        StickStart start;
        double tau_end;
    };
    std::vector<Stick> sticks;
};

/// Tangent contacts without an impact.
class TouchRecord : public Observer {
public:
    void on_touch(double tau, int side) override { touches.push_back({tau, side}); }

    struct Touch {
        double tau;
        int side;
    };
    std::vector<Touch> touches;
};

}  // namespace vines
