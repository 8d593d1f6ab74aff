#include "cli/sweep_file.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "api/sweep_frame.hpp"
#include "cli/files.hpp"

namespace vines::cli {

namespace {

std::string type_of(const api::Json& line) {
    const bool typed = line.is_object() && line.contains("type") && line["type"].is_string();
    return typed ? line["type"].get<std::string>() : "";
}

/// Of a line that tells nothing of a point.
bool is_between_points(const std::string& type) {
    return type == "done" || type == "progress" || type == "warning" || type == "error";
}

}  // namespace

std::string SweepFile::lines() const {
    std::string all = start + "\n";
    for (const auto& [index, line] : points) all += line + "\n";
    return all;
}

std::string SweepFile::text() const { return lines() + api::done_line(points.size()); }

SweepFile read_sweep_file(const std::string& path) {
    return parse_sweep_file(read_file(path), path);
}

SweepFile parse_sweep_file(const std::string& text, const std::string& name) {
    SweepFile file;
    long number = 0;
    for (std::size_t from = 0, end; (end = text.find('\n', from)) != std::string::npos;
         from = end + 1) {
        ++number;
        const std::string line = text.substr(from, end - from);
        const api::Json json = api::Json::parse(line, nullptr, false);
        const std::string type = type_of(json);
        if (number == 1 && type == "start") file.start = line;
        else if (
            number > 1 && type == "point" && json.contains("index") &&
            json["index"].is_number_unsigned())
            file.points[json["index"].get<std::size_t>()] = line;
        else if (number == 1 || !is_between_points(type))
            throw std::runtime_error(
                fmt::format("{}, line {}: not a line of a sweep", name, number));
    }
    return file;
}

}  // namespace vines::cli
