// The service's log: one line of JSON for each request, on stderr.
#pragma once

#include <exception>
#include <string>

namespace vines::http {

/// Makes the lines below go to stderr, each at once.
void start_log();
/// Writes what is left; nothing may be logged any more.
void end_log();

/// One request, and its answer.
struct Served {
    std::string method, path;
    int status;
    double ms;          ///< from its head to its answer's end
    std::size_t bytes;  ///< of the answer's body; 0 where it was streamed
};
void log_served(const Served& served);

/// Why a request failed. Throws nothing, whatever was thrown: an exception here would end the
/// process.
void log_failure(const std::string& path, const std::exception_ptr& thrown);

}  // namespace vines::http
