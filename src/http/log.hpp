// The service's log: one line of JSON (or text) per request on stderr.
#pragma once

#include <exception>
#include <string>

#include "http/message.hpp"

namespace vines::http {

enum class LogFormat { json, text };

/// Sets the log's format and destination, stderr; must be called before the functions below.
void start_log(LogFormat format);

/// A request and its answer, for the log and the metrics.
struct ServedRequest {
    std::string id;
    std::string client;    ///< its address
    std::string key = {};  ///< name of its API key, if any
    std::string method, path;
    std::string route;         ///< of the answer; "page" for all files, "none" without a route
    std::string lacking = {};  ///< of a 503: the exhausted resource
    int status = 0;
    double ms = 0;          ///< from the request's last byte to the answer's
    Timing timing = {};     ///< of the computation
    std::size_t bytes = 0;  ///< sent
    bool left = false;      ///< the client left before all was sent
};
/// Logs a request, at the level of its status; successful probes are not logged.
void log_request(const ServedRequest& served);

/// Logs a request that the end of the process leaves unanswered.
void log_unanswered(const ServedRequest& request);

/// Logs why a request failed. Never throws: an exception here would end the process.
void log_failure(
    const std::string& path, const std::string& request_id, const std::exception_ptr& thrown);

void log_event(const std::string& what);
void log_warning(const std::string& what);

/// Lines dropped so far because stderr was full.
std::size_t log_lines_dropped();

}  // namespace vines::http
