#include "api/sweep.hpp"

#include <mutex>

#include "api/json_text.hpp"
#include "api/sweep_line.hpp"

namespace vines::api {

namespace {

using TakeLine = std::function<void(std::size_t, const std::string&)>;

/// Writes lines on the threads that computed them, and hands them out one by one.
class Lines : public SweepSink {
public:
    Lines(const SweepRequest& r, const TakeLine& take) : r_(r), take_(take) {}

    void point(std::size_t index, const SweepPoint& point) override {
        hand_out(index, json_text(describe_point(r_, index, point)));
    }
    void row(std::size_t index, const RowSummary& row) override {
        hand_out(index, json_text(describe_row(r_, index, row)));
    }

private:
    void hand_out(std::size_t index, const std::string& line) {
        const std::lock_guard lock(mutex_);
        take_(index, line);
    }

    const SweepRequest& r_;
    const TakeLine& take_;
    std::mutex mutex_;
};

}  // namespace

std::string run_sweep(const SweepRequest& r, int threads, Pace& pace, const TakeLine& take) {
    Lines lines(r, take);
    return start_warning(vines::run_sweep(r.plan, threads, pace, lines));
}

}  // namespace vines::api
