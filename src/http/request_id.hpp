// The name of a request, by which its client finds it in the log.
#pragma once

#include <string>

#include "http/head.hpp"

namespace vines::http {

/// What the request says itself: the header X-Request-ID, up to 64 letters, digits, ".", "_" or
/// "-", or the trace-id of a traceparent (W3C Trace Context). Else 16 digits of its own.
std::string request_id(const Head& head);

}  // namespace vines::http
