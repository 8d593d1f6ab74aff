// Files that a server is told to read. What is no regular file might keep it waiting, as a pipe
// does until somebody writes, or have no end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace vines::http {

/// What a regular file holds, which links may lead to. Throws std::runtime_error, which names it,
/// where it cannot be read, is none, or has more than so many bytes.
std::string read_plain_file(const std::filesystem::path& path, std::size_t most_bytes);

/// The same of one that no link leads to, neither the last name of its path nor one before it: a
/// link might lead out of the folder that a path begins with. The path is absolute.
std::string read_without_links(const std::filesystem::path& path, std::size_t most_bytes);

}  // namespace vines::http
