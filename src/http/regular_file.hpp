// Reads regular files only: a pipe could block forever, and a device might never end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace vines::http {

/// Contents of a regular file; links are followed. Throws std::runtime_error, which names the file,
/// if it cannot be read, is not a regular file or has more than max_bytes bytes.
std::string read_regular_file(const std::filesystem::path& path, std::size_t max_bytes);

/// The same without following links, in any part of the path: a link could lead out of the folder
/// that the path starts with. The path must be absolute.
std::string read_regular_file_no_links(const std::filesystem::path& path, std::size_t max_bytes);

}  // namespace vines::http
