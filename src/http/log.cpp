#include "http/log.hpp"

#include <fmt/chrono.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>

namespace vines::http {

namespace {

using Json = nlohmann::ordered_json;

/// Whatever bytes a path has in it.
std::string text_of(const Json& line) {
    return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

void start_log() {
    auto log = std::make_shared<spdlog::logger>(
        "vines", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    log->set_pattern("%v");  // the lines are JSON already
    log->flush_on(spdlog::level::info);
    spdlog::set_default_logger(log);
}

void end_log() { spdlog::shutdown(); }

void log_served(const Served& served) {
    spdlog::info(text_of(
        {{"time", fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)))},
         {"level", "info"},
         {"method", served.method},
         {"path", served.path},
         {"status", served.status},
         {"ms", std::round(served.ms * 1000) / 1000},
         {"bytes", served.bytes}}));
}

void log_failure(const std::string& path, const std::exception_ptr& thrown) {
    try {
        std::rethrow_exception(thrown);
    } catch (const std::exception& e) {
        spdlog::error(text_of({{"level", "error"}, {"path", path}, {"what", e.what()}}));
    } catch (...) {
        spdlog::error(text_of({{"level", "error"}, {"path", path}, {"what", "no std::exception"}}));
    }
}

}  // namespace vines::http
