// A response on its way out through httplib.
#pragma once

#include <httplib.h>

#include <string>

#include "http/head.hpp"
#include "http/message.hpp"

namespace vines::http {

/// With its ETag (304 where the client has it) and compressed where that is worth it and the client
/// takes it, and with the request's id. One with `stream` in place of a body has neither a length
/// nor an ETag.
void send(
    const Head& head, const std::string& request_id, httplib::Response& out, Response response);

}  // namespace vines::http
