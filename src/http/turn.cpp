#include "http/turn.hpp"

#include <utility>

namespace vines::http {

namespace {

// Many times what a small answer takes, and little beside a turn of the system's scheduler.
constexpr auto moment = std::chrono::milliseconds(1);

}  // namespace

Turn::Turn(ComputeGate& gate, std::function<bool()> gives_up, bool may_begin)
    : gate_(gate),
      gives_up_(std::move(gives_up)) {
    if (may_begin) {
        ComputeGate::Begin begin = gate_.begin();
        place_ = std::move(begin.place);
        moment_ = std::move(begin.moment);
    }
    if (!*this) place_ = gate_.enter(gives_up_);
}

bool Turn::goes_on() {
    if (!moment_) return place_ != nullptr;
    const Clock::time_point now = Clock::now();
    if (now - began_ < moment) return true;
    place_ = gate_.enter(gives_up_, std::move(moment_));
    waited_ = Clock::now() - now;
    return place_ != nullptr;
}

}  // namespace vines::http
