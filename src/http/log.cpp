#include "http/log.hpp"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include "api/json_text.hpp"
#include "program/process.hpp"

namespace vines::http {

namespace {

LogFormat format = LogFormat::json;
std::atomic<std::size_t> dropped_total = 0;

// A line begins with its time and level.
constexpr const char* json_pattern = R"({"time":"%Y-%m-%dT%H:%M:%SZ","level":"%l"%v})";
constexpr const char* text_pattern = "%Y-%m-%dT%H:%M:%SZ %-7l%v";

/// The fields of a line.
struct Line {
    void add(std::string_view name, std::string_view value) {
        if (api::needs_no_escape(value)) return put(name, value, "\"");
        // A path can contain any bytes: invalid UTF-8 is replaced.
        constexpr auto replace = nlohmann::json::error_handler_t::replace;
        put(name, printable(nlohmann::json(value).dump(-1, ' ', false, replace)));
    }
    void add(std::string_view name, double ms) { put(name, fmt::format("{:.3f}", ms)); }
    void add(std::string_view name, std::size_t number) { put(name, std::to_string(number)); }
    void put(std::string_view name, std::string_view value, std::string_view quote = "") {
        const bool is_text = format == LogFormat::text;
        const std::string_view before = is_text ? " " : ",\"", between = is_text ? "=" : "\":";
        for (const std::string_view part : {before, name, between, quote, value, quote})
            text += part;
    }

    std::string text = {};
};

using Level = spdlog::level::level_enum;

/// Never throws: a line that cannot be written must not make a request fail.
template <class Add>
void log(Level level, Add add) {
    try {
        Line line;
        add(line);
        spdlog::log(level, line.text);
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
        if (const std::size_t lines = std::exchange(dropped_, 0)) {
            Line line;
            line.add("what", "lines were dropped");
            line.add("lines", lines);
            write({message.logger_name, Level::warn, line.text});
        }
        write(message);
    }
    void flush_() override {}

private:
    /// True if two lines fit: a pipe is writable while it has space for a page, and lines are
    /// shorter than half a page because the texts they quote are shortened.
    static bool is_writable() {
        pollfd state{STDERR_FILENO, POLLOUT, 0};
        return ::poll(&state, 1, 0) > 0 && (state.revents & POLLOUT);
    }
    void write(const spdlog::details::log_msg& message) {
        spdlog::memory_buf_t text;
        formatter_->format(message, text);
        static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
    }

    std::size_t dropped_ = 0;  // since the last written line
};

}  // namespace

std::size_t log_lines_dropped() { return dropped_total; }

void start_log(LogFormat chosen) {
    format = chosen;
    auto log = std::make_shared<spdlog::logger>("vines", std::make_shared<NonBlockingSink>());
    const char* const pattern = format == LogFormat::text ? text_pattern : json_pattern;
    log->set_pattern(pattern, spdlog::pattern_time_type::utc);
    spdlog::set_default_logger(log);
}

void log_request(const Request& request, const Outcome& outcome) {
    constexpr std::array probes{"/livez", "/readyz", "/healthz", "/metrics"};
    const std::string_view path = request.head.path();
    if (outcome.status == 200 && std::ranges::count(probes, path) > 0) return;
    const bool failed = outcome.status >= 500 && outcome.status != 503;
    log(failed                 ? Level::err
        : outcome.status < 400 ? Level::info
                               : Level::warn,
        [&](Line& line) {
            line.add("method", api::shortened(request.head.method));
            line.add("path", api::shortened(path));
            line.add("status", static_cast<std::size_t>(outcome.status));
            line.add("ms", outcome.ms);
            line.add("bytes", outcome.bytes);
            line.add("client", request.sender.address);
            if (!request.sender.key.empty()) line.add("key", request.sender.key);
            line.add("request_id", request.id);
            for (const auto& [name, ms] : outcome.timing) line.add(name + "_ms", ms);
            if (outcome.left) line.put("client_left", "true");
        });
}

void log_unanswered(const Request& request, double ms) {
    log(Level::warn, [&](Line& line) {
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
    log(Level::err, [&](Line& line) {
        line.add("path", api::shortened(path));
        line.add("request_id", request_id);
        line.add("what", api::shortened(what));
    });
}

void log_event(const std::string& what, bool is_warning) {
    log(is_warning ? Level::warn : Level::info, [&](Line& line) { line.add("what", what); });
}

}  // namespace vines::http
