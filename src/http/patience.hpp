// With a client that does not read its answer.
#pragma once

#include <chrono>
#include <functional>

namespace vines::http {

struct Patience {
    std::chrono::milliseconds time;  ///< in which it may keep from reading, all in all
    std::function<bool()> hurried;   ///< whether others wait for the thread that it holds
};

}  // namespace vines::http
