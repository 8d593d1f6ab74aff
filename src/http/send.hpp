// Responses as the bytes of an answer.
#pragma once

#include <string>

#include "http/head.hpp"
#include "http/message.hpp"
#include "http/outbox.hpp"

namespace vines::http {

/// Completes a response: ETag (304 if the client has it), compression if the body is large and the
/// client accepts it, the request's id. A stream has neither length nor ETag.
void complete(const Head& head, const std::string& request_id, Response& response);

/// Adds a completed response to the outbox; a stream is computed meanwhile, and waits for its
/// client. False if it was broken off. keep_alive: as announced to the client.
bool write(const Head& head, bool keep_alive, Response response, Outbox& outbox);

}  // namespace vines::http
