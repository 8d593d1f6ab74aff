#include "cli/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace vines::cli {

namespace {

/// The reason is errno's: call it next after what failed.
[[noreturn]] void fail(const char* what, const std::string& path) {
    throw std::runtime_error(fmt::format("cannot {} {}: {}", what, path, std::strerror(errno)));
}

}  // namespace

void add_files(CLI::App& command, Files& files) {
    command.add_option("request", files.input, "file with the request; - or nothing: stdin");
    command.add_option("--output,-o", files.output, "file for the answer; - or nothing: stdout");
}

bool is_standard(const std::string& path) { return path.empty() || path == "-"; }

bool is_json(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string::npos && text[first] == '{';
}

std::string read_all(const std::string& path) {
    if (!is_standard(path)) return read_file(path);
    std::ostringstream text;
    text << std::cin.rdbuf();
    return text.str();
}

std::string read_file(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) fail("read", path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

Output::Output(const std::string& path)
    : path_(is_standard(path) ? "" : path),
      next_(path_.empty() ? "" : path_ + ".part"),
      file_(
          path_.empty() ? STDOUT_FILENO
                        : ::open(next_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
    if (file_ < 0) fail();
}

Output::~Output() {
    if (!path_.empty() && file_ >= 0) ::close(file_);
}

void Output::fail() { cli::fail("write", path_.empty() ? "to stdout" : path_); }

void Output::write(std::string_view text) {
    while (!text.empty()) {
        const ssize_t n = ::write(file_, text.data(), text.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) fail();
        text.remove_prefix(static_cast<std::size_t>(n));
    }
}

void Output::end() {
    if (path_.empty()) return;
    const bool ok = ::fsync(file_) == 0 && ::close(std::exchange(file_, -1)) == 0;
    if (!ok || ::rename(next_.c_str(), path_.c_str()) != 0) fail();
}

void write_all(const std::string& path, const std::string& text) {
    Output out(path);
    out.write(text);
    out.end();
}

Appending::Appending(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "ab")) {
    if (!file_) fail("write", path_);
}

void Appending::line(const std::string& text) {
    const std::string whole = text + "\n";
    if (std::fwrite(whole.data(), 1, whole.size(), file_) != whole.size() ||
        std::fflush(file_) != 0)
        fail("write", path_);
}

}  // namespace vines::cli
