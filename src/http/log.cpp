#include "http/log.hpp"

#include <fmt/chrono.h>
#include <poll.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <ctime>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

#include "api/problem.hpp"

namespace vines::http {

namespace {

using Json = nlohmann::ordered_json;

LogFormat format = LogFormat::json;
std::atomic<std::size_t> all_dropped = 0;

/// In the order in which a reader wants them. Whatever bytes a path has in it.
std::string line_of(const char* level, Json fields) {
    const std::string time = fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)));
    const auto text = [](const Json& value) {
        return value.dump(-1, ' ', false, Json::error_handler_t::replace);
    };
    if (format == LogFormat::json) {
        Json line = {{"time", time}, {"level", level}};
        line.update(fields);
        return text(line) + "\n";
    }
    std::string line = fmt::format("{} {:7}", time, level);
    for (const auto& [name, value] : fields.items())
        line += fmt::format(" {}={}", name, text(value));
    return line + "\n";
}

double rounded(double ms) { return std::round(ms * 1000) / 1000; }

const char* level_of(int status) {
    if (status < 400) return "info";
    return status < 500 || status == 503 ? "warning" : "error";
}

/// Throws nothing: a line that cannot be written is no reason to fail.
void log(const char* level, Json fields) {
    try {
        spdlog::info(line_of(level, std::move(fields)));
    } catch (...) {}
}

/// Standard error, as far as somebody reads it: a full pipe would hold every thread that writes to
/// it. What finds no room is dropped, and counted in a line once there is some.
class Unhindered : public spdlog::sinks::base_sink<std::mutex> {
protected:
    void sink_it_(const spdlog::details::log_msg& message) override {
        if (!has_room()) {
            ++dropped_;
            ++all_dropped;
            return;
        }
        if (dropped_ > 0)
            write(line_of("warning", {{"what", "lines were dropped"}, {"lines", dropped_}}));
        dropped_ = 0;
        write({message.payload.data(), message.payload.size()});
    }
    void flush_() override {}

private:
    /// For two lines: a pipe is writable as long as there is room for a page, and lines are shorter
    /// than half of one, as long as what they echo is.
    static bool has_room() {
        pollfd state{STDERR_FILENO, POLLOUT, 0};
        return ::poll(&state, 1, 0) > 0 && (state.revents & POLLOUT);
    }
    static void write(std::string_view text) {
        static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
    }

    std::size_t dropped_ = 0;  // since the last one that was not
};

}  // namespace

std::size_t log_lines_dropped() { return all_dropped; }

void start_log(LogFormat chosen) {
    format = chosen;
    auto log = std::make_shared<spdlog::logger>("vines", std::make_shared<Unhindered>());
    spdlog::set_default_logger(log);
}

void log_served(const Served& served) {
    const bool probe = served.path == "/livez" || served.path == "/readyz" ||
                       served.path == "/healthz" || served.path == "/metrics";
    if (probe && served.status == 200) return;
    Json line = {
        {"method", api::shortened(served.method)},
        {"path", api::shortened(served.path)},
        {"status", served.status},
        {"ms", rounded(served.ms)},
        {"bytes", served.bytes},
        {"client", served.client},
        {"request_id", served.id}};
    for (const auto& [name, ms] : served.timing) line[name + "_ms"] = rounded(ms);
    if (served.left) line["client_left"] = true;
    log(level_of(served.status), std::move(line));
}

void log_failure(
    const std::string& path, const std::string& request_id, const std::exception_ptr& thrown) {
    std::string what = "no std::exception";
    try {
        std::rethrow_exception(thrown);
    } catch (const std::exception& e) {
        what = e.what();
    } catch (...) {}
    log("error", {{"path", api::shortened(path)},
                  {"request_id", request_id},
                  {"what", api::shortened(what)}});
}

void log_event(const std::string& what) { log("info", {{"what", what}}); }

}  // namespace vines::http
