#pragma once

#include <cstddef>
#include <functional>

namespace vines::api {

/// Thrown where an answer is not written to its end.
struct BrokenOff {};

/// While an answer is written: whether somebody still wants it.
class StillWanted {
public:
    /// gives_up(): true where nobody does; none: it always is wanted.
    explicit StillWanted(std::function<bool()> gives_up) : gives_up_(std::move(gives_up)) {}
    /// Asks. BrokenOff if it is not.
    void look() const {
        if (gives_up_ && gives_up_()) throw BrokenOff();
    }
    /// Asks at each of so many small steps: a row of a table, an entry of a list.
    void step() {
        if (steps_++ % between_looks == 0) look();
    }

private:
    static constexpr std::size_t between_looks = 4096;  // steps of .1 to 1 us
    std::function<bool()> gives_up_;
    std::size_t steps_ = 0;
};

}  // namespace vines::api
