#include "cli/stop_signals.hpp"

#include <atomic>
#include <cstdlib>
#include <thread>

#include "program/end_signals.hpp"

namespace vines::cli {

namespace {

std::atomic<bool> asked = false;

}  // namespace

void stop_on_signals() {
    block_end_signals();
    std::thread([] {
        wait_for_end_signal();
        asked = true;
        std::_Exit(128 + wait_for_end_signal());
    }).detach();
}

bool stopped() { return asked; }

}  // namespace vines::cli
