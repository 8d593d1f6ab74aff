// `vines serve`: options, start, and the end by a signal.
// Shutdown: on SIGTERM or SIGINT sweeps end at once and /readyz answers 503. Requests are still
// accepted for --drain seconds. Then the server stops: requests in progress have 10 s to finish;
// after that computations end with the results they have, and 5 s later the process ends, with code
// 3 if requests are left unanswered. A second signal ends it immediately.
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
#include "http/admission_control.hpp"
#include "http/commands.hpp"
#include "http/log.hpp"
#include "http/routes.hpp"
#include "http/server.hpp"
#include "program/end_signals.hpp"
#include "program/standard_streams.hpp"
#include "program/subcommand.hpp"

namespace vines::http {

namespace {

struct ServeOptions {
    ServerOptions server;
    RouteOptions routes;
    AdmissionLimits compute;
    double drain = 0;  ///< s
    std::string log = "json";
    std::string key_file = {};
};

/// Empty if the text is an origin, else an error message.
std::string origin_error(const std::string& text) {
    return is_origin(text) ? "" : text + " is not an origin such as https://example.org:8443";
}

/// An option takes its value from the flag, else from the environment variable, else the default.
template <class Value>
CLI::Option* add_flag(
    CLI::App& command, const char* name, const char* variable, Value& value, const char* help) {
    return command.add_option(name, value, help)->envname(variable)->capture_default_str();
}

void add_server_flags(CLI::App& c, ServerOptions& o) {
    add_flag(c, "--host", "VINES_HOST", o.host, "address to listen on");
    add_flag(c, "--port", "VINES_PORT", o.port, "port to listen on, 0 for any free one")
        ->check(number_between(0, 65535));
    add_flag(
        c, "--threads", "VINES_THREADS", o.threads, "worker threads: requests answered at once")
        ->check(number_between(1, 4096));
    add_flag(
        c, "--connections", "VINES_CONNECTIONS", o.connections,
        "connections open at once; beyond that the connection that has been idle longest is closed")
        ->check(number_between(1, 1000000));
}

void add_access_flags(CLI::App& c, AccessOptions& o, std::string& key_file) {
    c.add_option(
         "--allow-host", o.hosts,
         "host name with a dot that requests can use, in addition to this machine's; *: any "
         "(repeatable)")
        ->envname("VINES_ALLOW_HOST");
    c.add_option(
         "--cors-origin", o.origins,
         "origin of a page that may use this service; *: any (repeatable)")
        ->envname("VINES_CORS_ORIGIN")
        ->check([](const std::string& text) {
            return text == "*" ? std::string() : origin_error(text);
        });
    c.add_option(
         "--api-key-file", key_file,
         "file with one API key per line; requests then need a key, except for health and the page")
        ->envname("VINES_API_KEY_FILE")
        ->type_name("FILE");
}

void add_compute_flags(CLI::App& c, ServeOptions& o) {
    add_flag(
        c, "--compute-threads", "VINES_COMPUTE_THREADS", o.compute.running, "computations at once")
        ->default_str("the cores")
        ->check(number_between(1, 1024));
    add_flag(
        c, "--compute-queue", "VINES_COMPUTE_QUEUE", o.compute.waiting,
        "computations that wait; beyond that: 503")
        ->check(number_between(0, 100000));
    add_flag(
        c, "--sweeps", "VINES_SWEEPS", o.compute.sweeps,
        "sweeps at once, which share the free computing slots; beyond that: 503")
        ->check(number_between(0, 1000));
    add_flag(
        c, "--sweep-points", "VINES_SWEEP_POINTS", o.routes.sweep_points,
        "maximum number of points of one sweep")
        ->check(number_between(1, 10000000));
    add_flag(
        c, "--drain", "VINES_DRAIN", o.drain,
        "seconds after SIGTERM during which /readyz answers 503 and requests are still accepted, "
        "so that a proxy notices")
        ->check(number_between(0.0, 3600.0));
    add_flag(
        c, "--sweep-deadline", "VINES_SWEEP_DEADLINE", o.routes.sweep_deadline,
        "seconds of one sweep; then its stream ends, and the missing points can be requested")
        ->check(number_between(0.001, 31536000.0));
    add_flag(
        c, "--deadline", "VINES_DEADLINE", o.routes.deadline,
        "seconds of computing for one request; then it ends with the results so far")
        ->check(number_between(0.001, 86400.0));
}

void add_size_flags(CLI::App& c, ServeOptions& o) {
    add_flag(
        c, "--payload-limit", "VINES_PAYLOAD_LIMIT", o.server.payload_limit,
        "largest request body, bytes")
        ->check(number_between(1, 1 << 30));
    add_flag(
        c, "--memory-limit", "VINES_MEMORY_LIMIT", o.server.memory_limit,
        "requests and answers held at once, bytes; beyond that: 503")
        ->check(number_between(std::size_t{1}, std::size_t{1} << 50));
    add_flag(
        c, "--record-limit", "VINES_RECORD_LIMIT", o.routes.record_limit,
        "largest record sent to /v1/identify, bytes")
        ->check(number_between(1, 1 << 30));
    add_flag(
        c, "--answer-limit", "VINES_ANSWER_LIMIT", o.routes.answer_limit,
        "largest JSON answer, bytes; a larger one is thinned, or refused if that is impossible")
        ->check(number_between(std::size_t{1}, std::size_t{1} << 40));
}

void add_log_flags(CLI::App& c, std::string& format) {
    add_flag(
        c, "--log-format", "VINES_LOG_FORMAT", format, "format of the log on stderr: json or text")
        ->check(CLI::IsMember({"json", "text"}));
}

void add_page_flags(CLI::App& c, PageOptions& o) {
    c.add_option(
         "--embed-origin", o.embed_origins,
         "origin of a page that may show this one in a frame (repeatable)")
        ->envname("VINES_EMBED_ORIGIN")
        ->check(origin_error);
    c.add_option(
         "--web-dir", o.web_dir,
         "serve the page from this folder instead of the program, for development")
        ->envname("VINES_WEB_DIR")
        ->check(CLI::ExistingDirectory);
}

/// Time for requests in progress after the drain; then time for computations to end early.
constexpr auto finish_time = std::chrono::seconds(10);
constexpr auto final_time = std::chrono::seconds(5);

// Exit code if requests were left unanswered.
constexpr int exit_unanswered = 3;

/// Ends the process whatever other threads do: all output is already written.
[[noreturn]] void end(int code) { std::_Exit(code); }

/// Logs the unanswered requests; returns their number.
std::size_t report_unanswered(Server& server) {
    const std::size_t number = server.log_unanswered();
    if (number == 0) log_event("stopped");
    else log_warning(fmt::format("stopped; unanswered requests: {}", number));
    return number;
}

/// Waits for a signal, then shuts down as described above.
[[noreturn]] void stop_on_signal(double drain, AdmissionControl& admission, Server& server) {
    wait_for_end_signal();
    std::thread([&server] {
        const int signal = wait_for_end_signal();
        report_unanswered(server);
        end(128 + signal);
    }).detach();
    log_event("stopping");
    admission.stop_sweeps();
    server.close_connections();
    std::this_thread::sleep_for(std::chrono::duration<double>(drain));
    server.stop();
    std::this_thread::sleep_for(finish_time);
    admission.stop_all();
    std::this_thread::sleep_for(final_time);
    end(report_unanswered(server) == 0 ? 0 : exit_unanswered);
}

#ifdef __GLIBC__
/// Limits the memory that malloc keeps. Blocks of 4 MiB and more are mapped one by one: glibc's own
/// threshold grows up to 32 MiB with what is freed. Below it each arena keeps enough for one answer
/// of tens of thousands of numbers, because each page requested anew costs a microsecond. There are
/// no more arenas than computing threads.
void configure_malloc(int computing) {
    mallopt(M_MMAP_THRESHOLD, 4 << 20);
    mallopt(M_TRIM_THRESHOLD, 8 << 20);
    mallopt(M_ARENA_MAX, computing);
}
#endif

/// Prints the address to stdout, where a script can wait for it.
void print_greeting(const std::string& greeting) {
    try {
        print(greeting);
    } catch (const BrokenPipe&) {
    } catch (const std::runtime_error& e) {
        print_message(e.what());
        end(1);
    }
}

ServerOptions server_options(const ServeOptions& options) {
    ServerOptions server = options.server;
    server.access.listens_on = server.host;
    if (!options.key_file.empty()) server.access.keys = ApiKeys::read(options.key_file);
    return server;
}

int serve(const ServeOptions& options) {
#ifdef __GLIBC__
    configure_malloc(options.compute.running);
#endif
    AdmissionControl admission(options.compute);
    Metrics metrics(admission);
    ServerOptions chosen;
    std::vector<Route> routes;
    try {  // before signals are blocked: a disk can be slow and a folder large
        chosen = server_options(options);
        routes = make_routes(options.routes, admission, metrics);
    } catch (const std::runtime_error& e) {
        print_message(e.what());
        end(2);
    }
    block_end_signals();
    start_log(options.log == "text" ? LogFormat::text : LogFormat::json);
    Server server(chosen, std::move(routes), metrics);
    int port = 0;
    try {
        port = server.bind();
    } catch (const std::runtime_error& e) {
        print_message(e.what());
        end(2);
    }
    const std::string greeting = fmt::format(
        "vines {} listens on http://{}:{}\n", api::version(), in_url(options.server.host), port);
    print_greeting(greeting);
    log_event(fmt::format(
        "vines {} listens on {}:{}", api::version(), in_url(options.server.host), port));

    std::thread([&] { stop_on_signal(options.drain, admission, server); }).detach();
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
