// A response on its way out through httplib.
#pragma once

#include <httplib.h>

#include "http/message.hpp"

namespace vines::http {

/// With its ETag (304 where the client has it) and compressed where that is worth it and the client
/// takes it. With `close` the connection ends after the answer: a body that nobody read must not be
/// taken for the next request.
void send(
    const httplib::Request& request, httplib::Response& out, Response response, bool close = false);

/// A response with `stream` in place of a body: without a length or an ETag, and compressed where
/// it may be and the client takes it.
void send_stream(const httplib::Request& request, httplib::Response& out, Response response);

}  // namespace vines::http
