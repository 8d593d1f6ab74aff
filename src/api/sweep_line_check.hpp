// Whether a line is one that a sweep's request leads to, as far as shows without computing it.
#pragma once

#include <string>
#include <vector>

#include "api/sweep_request.hpp"

namespace vines::api {

class SweepLineCheck {
public:
    /// The request has to outlive it.
    explicit SweepLineCheck(const SweepRequest& request);

    /// What is wrong with the line of a point, given as text and parsed: its index is none of the
    /// sweep's; its place is not that of its index, bit for bit; a field is missing, is none of a
    /// line's, or of another kind; or the text is not as this program writes it. Empty: nothing.
    std::string fault_of(const std::string& line, const Json& parsed) const;

    /// Of its index alone.
    std::string fault_of_index(const Json& parsed) const;

private:
    std::string fault_of_place(const std::string& line, const Json& parsed) const;

    const SweepRequest& request_;
    // Lines with every set of fields that one may have: where a second start is tried, and where
    // not; where the values make no system.
    std::vector<Json> tried_, single_, without_system_;
};

}  // namespace vines::api
