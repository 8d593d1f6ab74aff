#include "http/compress.hpp"

#include <optional>
#include <string>
#include <utility>

#include "http/encoding.hpp"

namespace vines::http {

bool compress(Response& response, const Request& request, const std::function<bool()>& gives_up) {
    if (response.body.size() < compress_from || !accepts_gzip(request.accept_encoding)) return true;
    // It is told of the body as it was.
    if (response.tag.empty() && request.method != "POST") response.tag = entity_tag(response.body);
    std::optional<std::string> gzipped = gzip(response.body, gives_up);
    if (!gzipped) return false;
    response.gzipped_from = response.body.size();
    response.body = std::move(*gzipped);
    return true;
}

}  // namespace vines::http
