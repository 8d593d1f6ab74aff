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

namespace vines::cli {

namespace {

/// The reason is errno's: call it next after what failed.
[[noreturn]] void fail(const char* what, const std::string& path) {
    throw std::runtime_error(fmt::format("cannot {} {}: {}", what, path, std::strerror(errno)));
}

void replace_file(const std::string& path, const std::string& text) {
    const std::string next = path + ".part";
    const int file = ::open(next.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    bool ok = file >= 0;
    for (std::size_t at = 0; ok && at < text.size();) {
        const ssize_t n = ::write(file, text.data() + at, text.size() - at);
        if (n < 0 && errno == EINTR) continue;
        ok = n > 0;
        if (ok) at += static_cast<std::size_t>(n);
    }
    ok = ok && ::fsync(file) == 0;
    if (file >= 0) ok = ::close(file) == 0 && ok;
    if (!ok || ::rename(next.c_str(), path.c_str()) != 0) fail("write", path);
}

}  // namespace

void add_files(CLI::App& command, Files& files) {
    command.add_option("request", files.input, "file with the request; - or nothing: stdin");
    command.add_option("--output,-o", files.output, "file for the answer; - or nothing: stdout");
}

bool is_standard(const std::string& path) { return path.empty() || path == "-"; }

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

void write_all(const std::string& path, const std::string& text) {
    if (!is_standard(path)) return replace_file(path, text);
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        fail("write", "to stdout");
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
