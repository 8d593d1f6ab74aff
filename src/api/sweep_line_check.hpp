// Checks whether a line can belong to a sweep, without computing it.
//
// Lines are compared with sample lines, described for made-up results with every possible set of
// fields.
#pragma once

#include <string>
#include <vector>

#include "api/sweep_request.hpp"

namespace vines::api {

/// Lines of made-up results that together have every field that a line of the sweep can have.
std::vector<Json> sample_lines(const SweepRequest& request);

class SweepLineCheck {
public:
    /// The request must outlive the object.
    explicit SweepLineCheck(const SweepRequest& request);

    /// The fault of a point's line, given as text and parsed; empty if none. Faults: an index
    /// outside the sweep; a place that differs from that of the index in any bit; a missing or
    /// unknown field, or one of another type; text that this program would write differently.
    std::string fault_of(const std::string& line, const Json& parsed) const;

    /// The fault of the index alone.
    std::string fault_of_index(const Json& parsed) const;

private:
    std::string fault_of_place(const std::string& line, const Json& parsed) const;

    const SweepRequest& request_;
    // Sample lines with every possible set of fields: with a second start, without, and for values
    // that form no valid system.
    std::vector<Json> tried_, single_, without_system_;
};

}  // namespace vines::api
