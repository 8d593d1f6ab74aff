// Bodies are compressed where they are made: a large one takes longer to compress than to write.
#pragma once

#include <cstddef>
#include <functional>

#include "http/message.hpp"

namespace vines::http {

// Below this the time to compress costs more than the bytes.
inline constexpr std::size_t compress_from = 65536;

/// Where that is worth it and the client takes it. False: it was given up, which is asked before
/// each MB.
bool compress(Response& response, const Request& request, const std::function<bool()>& gives_up);

}  // namespace vines::http
