// Cancellation of reading a request or writing an answer, and limits on the size of a request.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

namespace vines::api {

/// Thrown when reading a request or writing an answer is cancelled.
struct Cancelled {};

/// Polls for cancellation while a request is read or an answer written.
class CancelCheck {
public:
    /// gives_up() returns true once the result is no longer wanted; an empty function never
    /// cancels. The first `first` steps are not polled, so that small inputs cost nothing.
    explicit CancelCheck(std::function<bool()> gives_up, std::size_t first = 0)
        : gives_up_(std::move(gives_up)),
          left_(first) {}
    /// Calls gives_up() now. Throws Cancelled if it returns true.
    void poll() const {
        if (gives_up_ && gives_up_()) throw Cancelled();
    }
    /// Counts small steps (a row of a table, an entry of a list, a line of text) and polls about
    /// every `steps_between_polls` of them, at most once per call.
    void step(std::size_t steps = 1) {
        if (left_ >= steps) {
            left_ -= steps;
        } else {
            left_ = steps_between_polls - 1;
            poll();
        }
    }
    static constexpr std::size_t steps_between_polls = 4096;  // 0.4 to 4 ms

private:
    std::function<bool()> gives_up_;
    std::size_t left_;  // steps before the next poll
};

/// Cancellation of reading, and limits on size. A text that exceeds a limit is rejected with
/// problem 413. The command line sets no limits on size: its files are the user's own.
struct ReadLimits {
    static constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();

    /// Polled by check(); reading throws Cancelled once it returns true. Empty: never cancelled.
    std::function<bool()> gives_up = {};
    /// Numbers of a CSV record, or scalar values of a JSON text; 8 to 24 bytes each.
    std::size_t most_numbers = any_number;
    /// Numbers and strings outside records and lists of impacts.
    std::size_t most_other_values = any_number;
    /// Arrays, objects and names in them; about 100 bytes each.
    std::size_t most_containers = any_number;
    /// Impacts of a list; they take 400 bytes each until the exponents are known.
    std::size_t most_impacts = any_number;

    /// Returns a check for one pass through a text.
    CancelCheck check() const { return CancelCheck(gives_up, CancelCheck::steps_between_polls); }
};

}  // namespace vines::api
