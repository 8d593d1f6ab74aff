#include "cli/sweep_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "api/problem.hpp"

namespace vines::cli {

std::string SweepFile::text() const {
    std::string all = start + "\n";
    for (const auto& [index, line] : points) all += line + "\n";
    return all + api::Json{{"type", "done"}, {"points", points.size()}}.dump() + "\n";
}

SweepFile read_sweep_file(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno));
    std::ostringstream content;
    content << in.rdbuf();
    const std::string text = content.str();
    SweepFile file;
    long number = 0;
    for (std::size_t from = 0, end; (end = text.find('\n', from)) != std::string::npos;
         from = end + 1) {
        ++number;
        const std::string line = text.substr(from, end - from);
        const api::Json json = api::Json::parse(line, nullptr, false);
        const std::string type =
            json.is_object() && json.contains("type") && json["type"].is_string()
                ? json["type"].get<std::string>()
                : "";
        if (number == 1 && type == "start") file.start = line;
        else if (
            number > 1 && type == "point" && json.contains("index") &&
            json["index"].is_number_unsigned())
            file.points[json["index"].get<std::size_t>()] = line;
        else if (number > 1 && type == "done") file.done = true;
        else
            throw std::runtime_error(
                path + ", line " + std::to_string(number) + ": not a line of a sweep");
    }
    return file;
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
    if (!ok || ::rename(next.c_str(), path.c_str()) != 0)
        throw std::runtime_error("cannot write " + path + ": " + std::strerror(errno));
}

}  // namespace vines::cli
