// `vines serve`: options, start, and the end by a signal; `vines healthcheck`, which queries a
// running service, for containers without curl. SIGHUP reloads the API keys; without a key file it
// stops the service. Shutdown: on SIGTERM or SIGINT sweeps end at once and /readyz answers 503.
// Requests are still accepted for --drain seconds. Then the server stops: requests in progress have
// 10 s to finish; after that computations end with the results they have, and 5 s later the process
// ends, with code 3 if requests are left unanswered. A second signal ends it immediately.
#include "api/version.hpp"
#include "http/routes.hpp"
#include "http/server.hpp"
#include "program/subcommand.hpp"

#include <httplib.h>  // after Eigen's headers, which one of its macros breaks

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

/// The environment variable of an option: VINES_LOG_FORMAT of --log-format.
std::string variable_of(std::string option) {
    option.replace(0, 2, "vines_");
    for (char& c : option) c = c == '-' ? '_' : static_cast<char>(std::toupper(c));
    return option;
}

/// Adds an option with a number from `least` to `most`.
template <class Value>
CLI::Option* number(
    CLI::App& command, const std::string& name, Value& value, std::type_identity_t<Value> least,
    std::type_identity_t<Value> most, const char* help) {
    return command.add_option(name, value, help)
        ->check(number_between(least, most))
        ->capture_default_str();
}

void add_connection_options(CLI::App& c, ServerOptions& o) {
    c.add_option("--host", o.access.host, "address to listen on")->capture_default_str();
    number(c, "--port", o.port, 0, 65535, "port to listen on, 0 for any free one");
    number(c, "--threads", o.limits.workers, 1, 4096, "worker threads: requests answered at once");
    number(
        c, "--connections", o.limits.connections, 1, 1000000,
        "connections open at once; beyond that one of the client with most of them is closed");
    number(
        c, "--client-connections", o.limits.per_client, 1, 1000000,
        "connections of an address, except of a trusted proxy; beyond that one of them is closed");
}

void add_access_options(CLI::App& c, AccessOptions& o, std::string& key_file) {
    c.add_option(
        "--allow-host", o.hosts,
        "host name with a dot that requests can use, beside this machine's; *: any (repeatable)");
    c.add_option(
         "--cors-origin", o.origins,
         "origin of a page that may use this service; *: any (repeatable)")
        ->check([](const std::string& text) { return text == "*" ? "" : origin_error(text); });
    c.add_option_function<std::vector<std::string>>(
         "--trust-proxy",
         [&o](const std::vector<std::string>& texts) {
             for (const std::string& text : texts) o.proxies.push_back(*Network::read(text));
         },
         "address or network (10.0.0.0/8) of a proxy that names the client (repeatable)")
        ->type_name("ADDRESS")
        ->check([](const std::string& text) {
            return Network::read(text) ? "" : text + " is not an address or ADDRESS/BITS";
        });
    c.add_option(
         "--api-key-file", key_file,
         "file with one API key per line; requests then need a key, except for health and the "
         "page; SIGHUP reloads it")
        ->type_name("FILE");
}

void add_limits(CLI::App& c, ServeOptions& o) {
    number(c, "--compute-threads", o.compute.running, 1, 1024, "computations at once")
        ->default_str("the cores");
    number(
        c, "--compute-queue", o.compute.waiting, 0, 100000,
        "computations that wait; beyond that: 503");
    number(
        c, "--sweeps", o.compute.sweeps, 0, 1000,
        "sweeps at once, which share the free computing slots; beyond that: 503");
    number(
        c, "--sweep-points", o.routes.sweep_points, 1, 10000000,
        "maximum number of points of one sweep");
    number(
        c, "--drain", o.drain, 0, 3600,
        "seconds after SIGTERM during which /readyz answers 503 and requests are still accepted, "
        "so that a proxy notices");
    number(
        c, "--sweep-deadline", o.routes.sweep_deadline, 0.001, 31536000,
        "seconds of one sweep; then its stream ends, and the missing points can be requested");
    number(
        c, "--deadline", o.routes.deadline, 0.001, 86400,
        "seconds of computing for one request; then it ends with the results so far");
    number(
        c, "--payload-limit", o.server.access.payload_limit, 1, 1 << 30,
        "largest request body, bytes");
    number(
        c, "--memory-limit", o.server.limits.held_bytes, 1, std::size_t{1} << 50,
        "requests and answers held at once, bytes; beyond that: 503");
    number(
        c, "--record-limit", o.routes.record_limit, 1, 1 << 30,
        "largest record sent to /v1/identify, bytes");
    number(
        c, "--answer-limit", o.routes.answer_limit, 1, std::size_t{1} << 40,
        "largest JSON answer, bytes; a larger one is thinned, or refused if that is impossible");
}

void add_log_and_page_options(CLI::App& c, std::string& log_format, PageOptions& page) {
    c.add_option("--log-format", log_format, "format of the log on stderr: json or text")
        ->capture_default_str()
        ->check(CLI::IsMember({"json", "text"}));
    c.add_option(
         "--embed-origin", page.embed_origins,
         "origin of a page that may show this one in a frame (repeatable)")
        ->check(origin_error);
    c.add_option(
         "--web-dir", page.web_dir,
         "serve the page from this folder instead of the program, for development")
        ->check(CLI::ExistingDirectory);
}

// Memory of the service beside requests and answers, with that of runs in work, bytes.
constexpr std::size_t memory_without_requests = 64 << 20;

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
    else log_event(fmt::format("stopped; unanswered requests: {}", number), true);
    return number;
}

/// Waits for a signal to stop; SIGHUP reloads the keys, if there are any.
int wait_for_stop(ApiKeys* keys) {
    for (;;) {
        const int signal = wait_for_end_signal();
        if (!keys || signal != SIGHUP) return signal;
        try {
            log_event(fmt::format("API keys reloaded: {}", keys->reload()));
        } catch (const std::runtime_error& e) {
            log_event(fmt::format("API keys unchanged: {}", e.what()), true);
        }
    }
}

/// Waits for a signal, then shuts down as described above.
[[noreturn]] void stop_on_signal(
    double drain, ApiKeys* keys, AdmissionControl& admission, Server& server) {
    wait_for_stop(keys);
    std::thread([&server, keys] {
        const int signal = wait_for_stop(keys);
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

int serve(ServeOptions options) {
    configure_malloc(options.compute.running);
    options.compute.memory = options.server.limits.held_bytes + memory_without_requests;
    AdmissionControl admission(options.compute);
    Metrics metrics(admission);
    std::optional<Server> server;
    std::shared_ptr<ApiKeys> keys;
    try {
        // Read before signals are blocked: a disk can be slow and a folder large.
        if (!options.key_file.empty()) keys = std::make_shared<ApiKeys>(options.key_file);
        options.server.access.keys = keys;
        options.routes.most_followers =
            static_cast<std::size_t>(std::max(1, options.server.limits.workers / 2));
        std::vector<Route> routes = make_routes(options.routes, admission, metrics);
        if (keys) std::signal(SIGHUP, SIG_DFL);  // it reloads them, also under nohup
        block_end_signals();
        // Others would end the service without a shutdown.
        for (const int other : {SIGUSR1, SIGUSR2, SIGALRM}) std::signal(other, SIG_IGN);
        start_log(options.log == "text" ? LogFormat::text : LogFormat::json);
        server.emplace(options.server, std::move(routes), metrics);
    } catch (const std::runtime_error& e) {
        print_message(e.what());
        end(2);
    }
    const std::string address =
        fmt::format("{}:{}", in_url(options.server.access.host), server->port());
    try {  // a script can wait for the address
        print(fmt::format("vines {} listens on http://{}\n", api::version(), address));
    } catch (const BrokenPipe&) {
    } catch (const std::runtime_error& e) {
        print_message(e.what());
        end(1);
    }
    log_event(fmt::format("vines {} listens on {}", api::version(), address));

    std::thread([&] { stop_on_signal(options.drain, keys.get(), admission, *server); }).detach();
    server->run();
    log_event("stopped");
    end(0);
}

}  // namespace

Command add_serve(CLI::App& app) {
    const auto options = std::make_shared<ServeOptions>();
    CLI::App* command = app.add_subcommand("serve", "the HTTP service and its page");
    add_connection_options(*command, options->server);
    add_access_options(*command, options->server.access, options->key_file);
    add_limits(*command, *options);
    add_log_and_page_options(*command, options->log, options->routes.page);
    // An option takes its value from the flag, else from the environment variable, else its
    // default.
    for (CLI::Option* option : command->get_options())
        if (option != command->get_help_ptr()) option->envname(variable_of(option->get_name()));
    add_examples(
        *command,
        "vines serve\n"
        "vines serve --host 0.0.0.0 --allow-host vines.example.org --api-key-file keys\n"
        "VINES_PORT=9000 vines serve --deadline 60 --log-format text");
    return {command, [options] { return serve(*options); }};
}

Command add_healthcheck(CLI::App& app) {
    const auto target = std::make_shared<ServerOptions>();
    CLI::App* command =
        app.add_subcommand("healthcheck", "check a running service: exit code 0 if healthy");
    command->add_option("--host", target->access.host, "address of the service")
        ->capture_default_str();
    command->add_option("--port", target->port, "port of the service")
        ->envname("VINES_PORT")
        ->capture_default_str();
    add_examples(*command, "vines healthcheck --port 8080 && echo well");
    return {command, [target] {
                httplib::Client client(target->access.host, target->port);
                client.set_connection_timeout(2);  // s
                client.set_read_timeout(2);
                const auto result = client.Get("/healthz");
                return result && result->status == 200 ? 0 : 1;
            }};
}

}  // namespace vines::http
