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

namespace vines::http {

namespace {

LogFormat format = LogFormat::json;
std::atomic<std::size_t> all_dropped = 0;

// Characters, about.
constexpr std::size_t usual_line = 256;

/// A line as it is written, its fields in the order in which a reader wants them.
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
        // Whatever bytes a path has in it.
        using Json = nlohmann::json;
        put(name, Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
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

/// Throws nothing: a line that cannot be written is no reason to fail.
template <class Add>
void log(std::string_view level, Add add) {
    try {
        Line line(level);
        add(line);
        spdlog::info(std::move(line).end());
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
    log(level_of(served.status), [&](Line& line) {
        line.add("method", api::shortened(served.method));
        line.add("path", api::shortened(served.path));
        line.add("status", static_cast<std::size_t>(served.status));
        line.add("ms", served.ms);
        line.add("bytes", served.bytes);
        line.add("client", served.client);
        line.add("request_id", served.id);
        for (const auto& [name, ms] : served.timing) line.add(name + "_ms", ms);
        if (served.left) line.add_true("client_left");
    });
}

void log_cut_off(const Served& unanswered) {
    log("warning", [&](Line& line) {
        line.add("method", api::shortened(unanswered.method));
        line.add("path", api::shortened(unanswered.path));
        line.add("ms", unanswered.ms);
        line.add("client", unanswered.client);
        line.add("request_id", unanswered.id);
        line.add("what", "the end of the service cut it off");
    });
}

void log_failure(
    const std::string& path, const std::string& request_id, const std::exception_ptr& thrown) {
    std::string what = "no std::exception";
    try {
        std::rethrow_exception(thrown);
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
