#include "http/end_of_work.hpp"

#include <chrono>
#include <functional>
#include <memory>

namespace vines::http {

namespace {

// A run that its deadline ends is analysed and made up into an answer in this share of it more, the
// first half of that for the analysis.
constexpr double time_to_write = 0.2;

/// Whether nobody waits for an answer any more, or the server is about to end.
class NotNeeded {
public:
    NotNeeded(const Request& request, const ComputeGate& gate) : left_(request.left), gate_(gate) {}
    /// Looks at the clock, and at the connection now and then.
    bool operator()(std::chrono::steady_clock::time_point now) {
        if (now - looked_ > presence_look) {
            looked_ = now;
            is_ = is_ || left_() || gate_.ends_all();
        }
        return is_;
    }

private:
    const std::function<bool()> left_;
    const ComputeGate& gate_;
    std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
    bool is_ = false;
};

}  // namespace

api::Stop end_of_work(double seconds, const Request& request, const ComputeGate& gate, Turn& turn) {
    using Clock = std::chrono::steady_clock;
    const auto now = Clock::now();
    const auto gone = std::make_shared<NotNeeded>(request, gate);
    const auto beyond = [now, gone, seconds, &turn](double share) {
        const std::chrono::duration<double> time(share * seconds);
        return [deadline = now + time, gone, &turn] {
            if (!turn.goes_on()) return true;
            const auto at = Clock::now();
            return at - turn.waited() > deadline || (*gone)(at);
        };
    };
    return {
        .asked = beyond(1),
        .analysis_late = beyond(1 + time_to_write / 2),
        .late = beyond(1 + time_to_write)};
}

}  // namespace vines::http
