// Cancellation and limits of reading a request or writing an answer.
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
    /// gives_up() returns true once the result is no longer wanted; empty: never cancelled. The
    /// first `first` steps are not polled, so that small inputs cost nothing.
    explicit CancelCheck(std::function<bool()> gives_up, std::size_t first = 0)
        : gives_up_(std::move(gives_up)),
          left_(first) {}
    /// Polls now. Throws Cancelled if so.
    void poll() const {
        if (gives_up_ && gives_up_()) throw Cancelled();
    }
    /// Polls once per `steps_between_polls` small steps: a row of a table, an entry of a list, a
    /// line of text.
    void step(std::size_t steps = 1) {
        if (left_ >= steps) {
            left_ -= steps;
        } else {
            left_ = steps_between_polls - 1;
            poll();
        }
    }
    static constexpr std::size_t steps_between_polls = 4096;  // steps of .1 to 1 us

private:
    std::function<bool()> gives_up_;
    std::size_t left_;  // steps before the next poll
};

/// Limits on size, and cancellation. The command line sets none: its files are the user's own.
struct ReadLimits {
    static constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();

    /// Polled every few thousand steps; throws Cancelled once it returns true.
    std::function<bool()> gives_up = {};
    /// Numbers of a CSV record, or scalar values of a JSON text; 8 to 24 bytes each. Problem 413
    /// beyond.
    std::size_t most_numbers = any_number;
    /// Numbers and strings in the fields other than a record or a list of impacts. Problem 413
    /// beyond.
    std::size_t most_other_values = any_number;
    /// Arrays, objects and names in them; about 100 bytes each. Problem 413 beyond.
    std::size_t most_containers = any_number;

    /// A check for one pass through a text.
    CancelCheck check() const { return CancelCheck(gives_up, CancelCheck::steps_between_polls); }
};

}  // namespace vines::api
