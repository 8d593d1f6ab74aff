#pragma once

#include <cstddef>
#include <functional>
#include <utility>

namespace vines::api {

/// Thrown where a request is not read, or an answer not written, to its end.
struct BrokenOff {};

/// While a request is read, or an answer written: whether somebody still wants it.
class StillWanted {
public:
    /// gives_up(): true where nobody does; none: it always is wanted.
    /// The first of its steps are not asked for at all: what is small is done before.
    explicit StillWanted(std::function<bool()> gives_up, std::size_t first = 0)
        : gives_up_(std::move(gives_up)),
          left_(first) {}
    /// Asks. BrokenOff if it is not.
    void look() const {
        if (gives_up_ && gives_up_()) throw BrokenOff();
    }
    /// Asks at each of so many small steps: a row of a table, an entry of a list, a
    /// line of a text.
    void step(std::size_t steps = 1) {
        if (left_ >= steps) {
            left_ -= steps;
        } else {
            left_ = between_looks - 1;
            look();
        }
    }
    static constexpr std::size_t between_looks = 4096;  // steps of .1 to 1 us

private:
    std::function<bool()> gives_up_;
    std::size_t left_;  // of the steps before the next look
};

}  // namespace vines::api
