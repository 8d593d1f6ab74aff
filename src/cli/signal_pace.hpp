// A sweep that a signal stops.
#pragma once

#include <algorithm>
#include <thread>

#include "api/sweep.hpp"
#include "cli/stop_signals.hpp"

namespace vines::cli {

class SignalPace : public api::Pace {
public:
    bool stop_or_yield() override { return stopped(); }
};

inline int cores() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

}  // namespace vines::cli
