// `vines serve`: flags and environment, start, end by a signal.
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "api/version.hpp"
#include "http/commands.hpp"
#include "http/compute_gate.hpp"
#include "http/log.hpp"
#include "http/routes.hpp"
#include "http/server.hpp"
#include "program/end_signals.hpp"
#include "program/examples.hpp"
#include "program/print.hpp"
#include "program/tell.hpp"
#include "program/within.hpp"

namespace vines::http {

namespace {

struct ServeOptions {
    ServerOptions server;
    RouteOptions routes;
    ComputeLimits compute;
    double drain = 0;  ///< s
    std::string log = "json";
    std::string key_file = {};
};

/// Empty: it is one.
std::string refusal_of_origin(const std::string& text) {
    return is_origin(text) ? "" : text + " is no origin such as https://example.org:8443";
}

/// A flag beats the environment, which beats the default.
template <class Value>
CLI::Option* add_flag(
    CLI::App& command, const char* name, const char* variable, Value& value, const char* help) {
    return command.add_option(name, value, help)->envname(variable)->capture_default_str();
}

void add_server_flags(CLI::App& c, ServerOptions& o) {
    add_flag(c, "--host", "VINES_HOST", o.host, "address to listen on");
    add_flag(c, "--port", "VINES_PORT", o.port, "port to listen on, 0 for any free one")
        ->check(within(0, 65535));
    add_flag(c, "--threads", "VINES_THREADS", o.threads, "requests in work at once")
        ->check(within(1, 4096));
    add_flag(
        c, "--connections", "VINES_CONNECTIONS", o.connections,
        "connections open at once; beyond that the one that has been idle longest is closed")
        ->check(within(1, 1000000));
}

void add_access_flags(CLI::App& c, AccessOptions& o, std::string& key_file) {
    c.add_option(
         "--allow-host", o.hosts,
         "name with a dot that requests may be meant for, beside this machine's own; *: "
         "any (may come several times)")
        ->envname("VINES_ALLOW_HOST");
    c.add_option(
         "--cors-origin", o.origins,
         "origin of a page that may use this service; *: any (may come several times)")
        ->envname("VINES_CORS_ORIGIN")
        ->check([](const std::string& text) {
            return text == "*" ? std::string() : refusal_of_origin(text);
        });
    c.add_option(
         "--api-key-file", key_file,
         "file with a key on each line, one of which a request has to show, but for health and "
         "the page")
        ->envname("VINES_API_KEY_FILE")
        ->type_name("FILE");
}

void add_compute_flags(CLI::App& c, ServeOptions& o) {
    add_flag(
        c, "--compute-threads", "VINES_COMPUTE_THREADS", o.compute.running, "computations at once")
        ->default_str("the cores")
        ->check(within(1, 1024));
    add_flag(
        c, "--compute-queue", "VINES_COMPUTE_QUEUE", o.compute.waiting,
        "computations that wait; beyond that: 503")
        ->check(within(0, 100000));
    add_flag(
        c, "--sweeps", "VINES_SWEEPS", o.compute.sweeps,
        "sweeps at once, which share the computing that is left; beyond that: 503")
        ->check(within(0, 1000));
    add_flag(
        c, "--sweep-points", "VINES_SWEEP_POINTS", o.routes.sweep_points, "points of one sweep")
        ->check(within(1, 10000000));
    add_flag(
        c, "--drain", "VINES_DRAIN", o.drain,
        "seconds from SIGTERM on during which /readyz says 503 and requests are still taken, so "
        "that a proxy notices")
        ->check(within(0.0, 3600.0));
    add_flag(
        c, "--sweep-deadline", "VINES_SWEEP_DEADLINE", o.routes.sweep_deadline,
        "seconds of one sweep; then its stream ends, and the points that are missing can be asked "
        "for")
        ->check(within(0.001, 31536000.0));
    add_flag(
        c, "--deadline", "VINES_DEADLINE", o.routes.deadline,
        "seconds of computing for one request; then it ends with what it has")
        ->check(within(0.001, 86400.0));
}

void add_size_flags(CLI::App& c, ServeOptions& o) {
    add_flag(
        c, "--payload-limit", "VINES_PAYLOAD_LIMIT", o.server.payload_limit,
        "bytes of a request's body")
        ->check(within(1, 1 << 30));
    add_flag(
        c, "--memory-limit", "VINES_MEMORY_LIMIT", o.server.memory_limit,
        "bytes of requests and answers held at once; beyond that: 503")
        ->check(within(std::size_t{1}, std::size_t{1} << 50));
    add_flag(
        c, "--record-limit", "VINES_RECORD_LIMIT", o.routes.record_limit,
        "bytes of a measurement sent to /v1/identify")
        ->check(within(1, 1 << 30));
    add_flag(
        c, "--answer-limit", "VINES_ANSWER_LIMIT", o.routes.answer_limit,
        "bytes of an answer's JSON; one that would be larger is thinned, or refused where that "
        "cannot be")
        ->check(within(std::size_t{1}, std::size_t{1} << 40));
}

void add_log_flags(CLI::App& c, std::string& format) {
    add_flag(c, "--log-format", "VINES_LOG_FORMAT", format, "of the lines on stderr: json or text")
        ->check(CLI::IsMember({"json", "text"}));
}

void add_page_flags(CLI::App& c, PageOptions& o) {
    c.add_option(
         "--embed-origin", o.embed_origins,
         "origin of a page that may show this one in a frame (may come several times)")
        ->envname("VINES_EMBED_ORIGIN")
        ->check(refusal_of_origin);
    c.add_option(
         "--web-dir", o.web_dir,
         "serve the page from this folder instead of the program (while developing it)")
        ->envname("VINES_WEB_DIR")
        ->check(CLI::ExistingDirectory);
}

/// What is in work when the drain is over has so long to come to its end; then it ends with what it
/// has, for which there is so long.
constexpr auto work_time = std::chrono::seconds(10);
constexpr auto last_time = std::chrono::seconds(5);

// The exit code where requests were cut off.
constexpr int not_all = 3;

/// Whatever the other threads do: none of them has anything that is not yet written.
[[noreturn]] void end(int code) { std::_Exit(code); }

/// Without the answers that are still to come, which the log tells; returns how many they are.
std::size_t give_up_the_rest(Server& server) {
    const std::size_t number = server.log_cut_off();
    if (number == 0) log_event("stopped");
    else log_warning(fmt::format("stopped; requests that were cut off: {}", number));
    return number;
}

/// Stops the service once it is asked to: sweeps end at once, other requests are taken until the
/// drain is over, and those in work are finished. Asked a second time it ends at once.
[[noreturn]] void stop_when_asked(double drain, ComputeGate& gate, Server& server) {
    wait_for_end_signal();
    std::thread([&server] {
        const int signal = wait_for_end_signal();
        give_up_the_rest(server);
        end(128 + signal);
    }).detach();
    log_event("stopping");
    gate.close_to_sweeps();
    server.close_connections();
    std::this_thread::sleep_for(std::chrono::duration<double>(drain));
    server.stop();
    std::this_thread::sleep_for(work_time);
    gate.end_all();
    std::this_thread::sleep_for(last_time);
    end(give_up_the_rest(server) == 0 ? 0 : not_all);
}

#ifdef __GLIBC__
/// Records and answers beyond a size are mapped and unmapped one by one: the library's own
/// threshold grows up to 32 MiB with what is freed. Below it each arena keeps as much as one answer
/// of tens of thousands of numbers needs, for each page that is asked for anew costs a microsecond;
/// there are no more arenas than threads that compute.
void keep_memory_small(int computing) {
    mallopt(M_MMAP_THRESHOLD, 4 << 20);
    mallopt(M_TRIM_THRESHOLD, 8 << 20);
    mallopt(M_ARENA_MAX, computing);
}
#endif

/// On stdout, where somebody may wait for it; who has left needs none.
void greet(const std::string& greeting) {
    try {
        print(greeting);
    } catch (const ReaderLeft&) {
    } catch (const std::runtime_error& e) {
        tell(e.what());
        end(1);
    }
}

/// What it is told, with what the flags name.
ServerOptions server_options(const ServeOptions& options) {
    ServerOptions server = options.server;
    server.access.listens_on = server.host;
    if (!options.key_file.empty()) server.access.keys = ApiKeys::read(options.key_file);
    return server;
}

int serve(const ServeOptions& options) {
#ifdef __GLIBC__
    keep_memory_small(options.compute.running);
#endif
    ComputeGate gate(options.compute);
    Metrics metrics(gate);
    ServerOptions chosen;
    std::vector<Route> routes;
    try {  // while a signal ends the program at once: a disk may be slow, and a folder large
        chosen = server_options(options);
        routes = make_routes(options.routes, gate, metrics);
    } catch (const std::runtime_error& e) {
        tell(e.what());
        end(2);
    }
    block_end_signals();
    start_log(options.log == "text" ? LogFormat::text : LogFormat::json);
    Server server(chosen, std::move(routes), metrics);
    int port = 0;
    try {
        port = server.bind();
    } catch (const std::runtime_error& e) {
        tell(e.what());
        end(2);
    }
    const std::string greeting = fmt::format(
        "vines {} listens on http://{}:{}\n", api::version(), in_url(options.server.host), port);
    greet(greeting);
    log_event(fmt::format(
        "vines {} listens on {}:{}", api::version(), in_url(options.server.host), port));

    std::thread([&] { stop_when_asked(options.drain, gate, server); }).detach();
    server.run();
    log_event("stopped");
    end(0);
}

}  // namespace

Command add_serve(CLI::App& app) {
    const auto options = std::make_shared<ServeOptions>();
    CLI::App* command = app.add_subcommand("serve", "the HTTP service and its page");
    add_server_flags(*command, options->server);
    add_access_flags(*command, options->server.access, options->key_file);
    add_compute_flags(*command, *options);
    add_size_flags(*command, *options);
    add_log_flags(*command, options->log);
    add_page_flags(*command, options->routes.page);
    add_examples(
        *command,
        "vines serve\n"
        "vines serve --host 0.0.0.0 --allow-host vines.example.org --api-key-file keys\n"
        "VINES_PORT=9000 vines serve --deadline 60 --log-format text");
    return {command, [options] { return serve(*options); }};
}

}  // namespace vines::http
