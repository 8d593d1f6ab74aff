#include "cli/sweep_run.hpp"

#include <fmt/format.h>

#include <atomic>
#include <exception>

#include "api/sweep.hpp"
#include "cli/progress_bar.hpp"
#include "cli/signal_pace.hpp"
#include "program/tell.hpp"

namespace vines::cli {

namespace {

/// Of a sweep that a signal stops, or a line that finds no place.
class SweepPace : public SignalPace {
public:
    bool stop_or_yield() override { return given_up_ || SignalPace::stop_or_yield(); }
    void give_up() { given_up_ = true; }

private:
    std::atomic<bool> given_up_ = false;
};

}  // namespace

std::string compute(const SweepRun& run, const TakeLine& take) {
    ProgressBar bar(run.of - run.request.plan.lines.size(), run.of);
    SweepPace pace;
    // Kept until all threads are back: one that is stopped meanwhile would be taken for the reason.
    std::exception_ptr failure;
    std::string warning = api::run_sweep(
        run.request, run.threads, pace, [&](std::size_t index, const std::string& line) {
            if (failure) return;
            try {
                take(index, line);
                bar.step();
            } catch (...) {
                failure = std::current_exception();
                pace.give_up();
            }
        });
    if (failure) std::rethrow_exception(failure);
    return warning;
}

void tell_stopped(std::size_t done, std::size_t of, const std::string& what_to_do) {
    tell(fmt::format("stopped after {} of {} points{}", done, of, what_to_do));
}

}  // namespace vines::cli
