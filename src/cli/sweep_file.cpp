#include "cli/sweep_file.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "api/problem.hpp"
#include "api/sweep.hpp"
#include "cli/json_values.hpp"

namespace vines::cli {

namespace {

/// Returns whether a line contains no point.
bool is_between_points(const std::string& type) {
    return type == "done" || type == "progress" || type == "warning" || type == "error";
}

/// Parses a file line by line.
class Reader {
public:
    Reader(const std::string& name, LineChecks checks) : name_(name), checks_(checks) {}

    void take(std::string line) {
        ++number_;
        file_.complete_bytes += line.size() + 1;
        const api::Json json = parse_answer(line);
        const std::string type = word_of(part(json, "/type"));
        if (number_ == 1 && type == "start") return take_start(std::move(line));
        if (number_ == 1 || (type != "point" && !is_between_points(type)))
            fail_in_line(name_, number_, "not a line of a sweep");
        if (file_.ended) file_.in_order = false;
        file_.ended = type == "done";
        if (type == "point") take_point(line, json);
        else if (!file_.ended) file_.in_order = false;
    }

    SweepFile taken() { return std::move(file_); }

private:
    void take_start(std::string line) {
        file_.start = std::move(line);
        request_.emplace(request_of(file_, name_));
        check_.emplace(*request_);
    }

    std::string fault_of(const std::string& line, const api::Json& json) const {
        return checks_ == LineChecks::full ? check_->fault_of(line, json)
                                           : check_->fault_of_index(json);
    }

    void take_point(const std::string& line, const api::Json& json) {
        if (const std::string fault = fault_of(line, json); !fault.empty())
            fail_in_line(name_, number_, fault);
        const std::size_t index = json["index"].get<std::size_t>();
        auto& points = file_.points;
        if (!points.empty() && index <= points.rbegin()->first) file_.in_order = false;
        const auto [there, is_new] = points.try_emplace(index, SweepFile::Line{line, number_});
        if (!is_new && there->second.text != line)
            fail_in_line(
                name_, number_,
                fmt::format(
                    "point {} differs from the same point in line {}", index,
                    there->second.number));
    }

    const std::string& name_;
    const LineChecks checks_;
    long number_ = 0;
    SweepFile file_;
    std::optional<api::SweepRequest> request_;
    std::optional<api::SweepLineCheck> check_;
};

}  // namespace

void fail_in_line(const std::string& name, long number, const std::string& fault) {
    throw std::runtime_error(fmt::format("{}, line {}: {}", name, number, fault));
}

std::string SweepFile::text() const {
    std::string all = start + "\n";
    for (const auto& [index, line] : points) all += line.text + "\n";
    return all + api::done_line(points.size());
}

SweepFile parse_sweep_file(const std::string& text, const std::string& name, LineChecks checks) {
    Reader reader(name, checks);
    for (std::size_t from = 0, end; (end = text.find('\n', from)) != std::string::npos;
         from = end + 1)
        reader.take(text.substr(from, end - from));
    return reader.taken();
}

api::SweepRequest request_of(const SweepFile& file, const std::string& name) {
    const api::Json start = parse_answer(file.start);
    const api::Json& request = part(start, "/request");
    if (!request.is_object()) fail_in_line(name, 1, "the request is missing");
    try {
        return api::read_sweep_request(request, max_points);
    } catch (const api::Problem& problem) {
        fail_in_line(name, 1, std::string("its request is invalid: ") + problem.what());
    }
}

}  // namespace vines::cli
