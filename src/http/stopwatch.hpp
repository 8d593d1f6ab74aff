// Measures the phases of a request's work.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vines::http {

/// Duration of each phase by name, ms.
using Timing = std::vector<std::pair<std::string, double>>;

class Stopwatch {
public:
    using Clock = std::chrono::steady_clock;

    /// Ends a phase that began at the previous call.
    void lap(const char* name) {
        const auto now = Clock::now();
        laps_.emplace_back(
            name,
            std::chrono::duration<double, std::milli>(now - std::exchange(last_, now)).count());
    }
    /// Moves time from one phase to another.
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
