#include "http/log.hpp"

#include <fmt/chrono.h>
#include <poll.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <ctime>
#include <iterator>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "api/json_text.hpp"
#include "api/problem.hpp"
#include "program/process.hpp"

namespace vines::http {

namespace {

LogFormat format = LogFormat::json;
std::atomic<std::size_t> dropped_total = 0;

// Typical length of a line, characters.
constexpr std::size_t usual_line = 256;

class Line {
public:
    explicit Line(std::string_view level) {
        text_.reserve(usual_line);
        const std::string time = fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)));
        if (format == LogFormat::text)
            fmt::format_to(std::back_inserter(text_), "{} {:7}", time, level);
        else
            fmt::format_to(std::back_inserter(text_), R"({{"time":"{}","level":"{}")", time, level);
    }
    void add(std::string_view name, std::string_view text) {
        if (api::needs_no_escape(text)) return put(name, text, "\"");
        // A path can contain any bytes: invalid UTF-8 is replaced.
        using Json = nlohmann::json;
        put(name, printable(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)));
    }
    void add(std::string_view name, double ms) { put(name, fmt::format("{:.3f}", ms)); }
    void add(std::string_view name, std::size_t number) { put(name, std::to_string(number)); }
    void add_true(std::string_view name) { put(name, "true"); }
    std::string end() && {
        text_ += format == LogFormat::text ? "\n" : "}\n";
        return std::move(text_);
    }

private:
    void put(std::string_view name, std::string_view value, std::string_view quote = "") {
        const bool is_text = format == LogFormat::text;
        const std::string_view before = is_text ? " " : ",\"", between = is_text ? "=" : "\":";
        for (const std::string_view part : {before, name, between, quote, value, quote})
            text_ += part;
    }

    std::string text_;
};

const char* level_of(int status) {
    if (status < 400) return "info";
    return status < 500 || status == 503 ? "warning" : "error";
}

/// Never throws: a line that cannot be written must not make a request fail.
template <class Add>
void log(std::string_view level, Add add) {
    try {
        Line line(level);
        add(line);
        spdlog::info(std::move(line).end());
    } catch (...) {}
}

/// Writes to stderr without blocking: a full pipe would stop every thread that logs. Lines that do
/// not fit are dropped; the next line that fits is preceded by their count.
class NonBlockingSink : public spdlog::sinks::base_sink<std::mutex> {
protected:
    void sink_it_(const spdlog::details::log_msg& message) override {
        if (!is_writable()) {
            ++dropped_;
            ++dropped_total;
            return;
        }
        if (dropped_ > 0) {
            Line line("warning");
            line.add("what", "lines were dropped");
            line.add("lines", dropped_);
            write(std::move(line).end());
        }
        dropped_ = 0;
        write({message.payload.data(), message.payload.size()});
    }
    void flush_() override {}

private:
    /// True if two lines fit: a pipe is writable while it has space for a page, and lines are
    /// shorter than half a page because the texts they quote are shortened.
    static bool is_writable() {
        pollfd state{STDERR_FILENO, POLLOUT, 0};
        return ::poll(&state, 1, 0) > 0 && (state.revents & POLLOUT);
    }
    static void write(std::string_view text) {
        static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
    }

    std::size_t dropped_ = 0;  // since the last written line
};

}  // namespace

std::size_t log_lines_dropped() { return dropped_total; }

void start_log(LogFormat chosen) {
    format = chosen;
    auto log = std::make_shared<spdlog::logger>("vines", std::make_shared<NonBlockingSink>());
    spdlog::set_default_logger(log);
}

void log_request(const Request& request, const Outcome& outcome) {
    const std::string_view path = request.head.path();
    const bool probe =
        path == "/livez" || path == "/readyz" || path == "/healthz" || path == "/metrics";
    if (probe && outcome.status == 200) return;
    log(level_of(outcome.status), [&](Line& line) {
        line.add("method", api::shortened(request.head.method));
        line.add("path", api::shortened(path));
        line.add("status", static_cast<std::size_t>(outcome.status));
        line.add("ms", outcome.ms);
        line.add("bytes", outcome.bytes);
        line.add("client", request.sender.address);
        if (!request.sender.key.empty()) line.add("key", request.sender.key);
        line.add("request_id", request.id);
        for (const auto& [name, ms] : outcome.timing) line.add(name + "_ms", ms);
        if (outcome.left) line.add_true("client_left");
    });
}

void log_unanswered(const Request& request, double ms) {
    log("warning", [&](Line& line) {
        line.add("method", api::shortened(request.head.method));
        line.add("path", api::shortened(request.head.path()));
        line.add("ms", ms);
        line.add("client", request.sender.address);
        line.add("request_id", request.id);
        line.add("what", "the service ended before the answer was sent");
    });
}

void log_failure(std::string_view path, const std::string& request_id) {
    std::string what = "no std::exception";
    try {
        throw;
    } catch (const std::exception& e) {
        what = e.what();
    } catch (...) {}
    log("error", [&](Line& line) {
        line.add("path", api::shortened(path));
        line.add("request_id", request_id);
        line.add("what", api::shortened(what));
    });
}

void log_event(const std::string& what) {
    log("info", [&](Line& line) { line.add("what", what); });
}

void log_warning(const std::string& what) {
    log("warning", [&](Line& line) { line.add("what", what); });
}

}  // namespace vines::http
