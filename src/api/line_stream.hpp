// A result that is sent in lines of NDJSON, or in parts of a table, while it is computed.
#pragma once

#include <functional>
#include <string>

#include "core/sweep/sweep.hpp"

namespace vines::api {

using vines::RunControl;

class LineStream {
public:
    /// Receives lines with their ends, or parts of a table.
    using Take = std::function<void(const std::string& text)>;

    virtual ~LineStream() = default;
    /// The line {type: start, ...}, or the beginning of a table.
    virtual std::string begin() const = 0;
    /// Passes each line of the result on as it is computed. False if stopped before the end.
    virtual bool compute(int threads, RunControl& control, const Take& take) = 0;
    /// The line {type: progress, ...} after `done` lines; empty for a table. From any thread.
    virtual std::string progress(
        std::size_t done, const RunControl& control, double seconds) const = 0;
    /// The last line, {type: done, ...}, or the end of a table; empty without a result. Called
    /// after compute().
    virtual std::string end() = 0;
    /// Memory that it takes until its end beside a few MB, about.
    virtual std::size_t bytes(int /*threads*/) const { return 0; }
    /// The request to send after an early end, in words; null for a table, which is then cut off.
    virtual const char* remedy() const = 0;
};

}  // namespace vines::api
