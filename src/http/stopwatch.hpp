// Where the time of a request goes.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vines::http {

/// Names of parts of the work, and how long each took, in ms.
using Timing = std::vector<std::pair<std::string, double>>;

class Stopwatch {
public:
    using Clock = std::chrono::steady_clock;

    /// The part that is over, from the end of the one before.
    void lap(const char* name) {
        const auto now = Clock::now();
        laps_.emplace_back(
            name,
            std::chrono::duration<double, std::milli>(now - std::exchange(last_, now)).count());
    }
    /// A part of a lap that belongs to another.
    void move(std::string_view from, std::string_view to, Clock::duration time) {
        const double ms = std::chrono::duration<double, std::milli>(time).count();
        for (auto& [name, lap] : laps_) lap += name == to ? ms : name == from ? -ms : 0;
    }
    Timing take() { return std::move(laps_); }

private:
    Clock::time_point last_ = Clock::now();
    Timing laps_;
};

}  // namespace vines::http
