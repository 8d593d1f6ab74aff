// Flags, wiring, signals.
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <thread>

#include "api/simulate.hpp"
#include "http/routes.hpp"
#include "http/server.hpp"
#include "report/reproduce.hpp"

namespace {

struct ServeOptions {
    vines::http::ServerOptions server;
    vines::http::RouteOptions routes{static_cast<int>(std::max(1u, std::thread::hardware_concurrency())), 64, 30, ""};
};

void add_serve_options(CLI::App& serve, ServeOptions& o) {
    // A flag beats the environment, which beats the default.
    serve.add_option("--host", o.server.host, "address to listen on")->envname("VINES_HOST")->capture_default_str();
    serve.add_option("--port", o.server.port, "port to listen on, 0 for any free one")->envname("VINES_PORT")->check(CLI::Range(0, 65535))->capture_default_str();
    serve.add_option("--threads", o.server.threads, "connections served at once")->envname("VINES_THREADS")->check(CLI::Range(1, 4096))->capture_default_str();
    serve.add_option("--compute-threads", o.routes.compute_threads, "computations at once")->envname("VINES_COMPUTE_THREADS")->check(CLI::Range(1, 1024))->capture_default_str();
    serve.add_option("--compute-queue", o.routes.compute_queue, "computations that wait; beyond that: 503")->envname("VINES_COMPUTE_QUEUE")->check(CLI::Range(0, 100000))->capture_default_str();
    serve.add_option("--deadline", o.routes.deadline, "seconds of computing for one request; then it ends with what it has")->envname("VINES_DEADLINE")->check(CLI::Range(0.001, 86400.0))->capture_default_str();
    serve.add_option("--payload-limit", o.server.payload_limit, "bytes of a request's body")->envname("VINES_PAYLOAD_LIMIT")->check(CLI::Range(1, 1 << 30))->capture_default_str();
    serve.add_option("--web-dir", o.routes.web_dir, "serve the page from this folder instead of the program (while developing it)")->envname("VINES_WEB_DIR")->check(CLI::ExistingDirectory);
}

int serve(const ServeOptions& options, const sigset_t& signals) {
    auto log = std::make_shared<spdlog::logger>("vines", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    log->set_pattern("%v");  // the lines are JSON already
    log->flush_on(spdlog::level::info);
    spdlog::set_default_logger(log);

    vines::http::ComputeGate gate(options.routes.compute_threads, options.routes.compute_queue);
    vines::http::Server server(options.server, vines::http::make_routes(options.routes, gate));
    const int port = server.bind();
    std::printf("vines %s listens on http://%s:%d\n", vines::api::version().c_str(), options.server.host.c_str(), port);
    std::fflush(stdout);

    std::thread([&server, &signals] {
        int signal;
        sigwait(&signals, &signal);
        server.stop();
        // run() would return only after every idle connection's keep-alive timeout; no answer is in work any more.
        spdlog::shutdown();
        std::_Exit(0);
    }).detach();
    server.run();
    for (;;) pause();  // stop() was called: the other thread ends the process
}

int reproduce(const std::string& folder) {
    const vines::report::Reproduction result = vines::report::reproduce(folder);
    std::fputs(result.table().c_str(), stdout);
    if (!folder.empty()) std::fprintf(stderr, "vines: wrote %s/report.md and its plots\n", folder.c_str());
    if (!result.holds()) std::fprintf(stderr, "vines: a number has left its band\n");
    return result.holds() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    sigset_t signals;  // blocked in every thread, taken by the one that waits for them
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);

    CLI::App app("Exact simulation of a linear oscillator coupled with a vibro-impact nonlinear energy sink.", "vines");
    app.set_version_flag("--version", vines::api::version());
    app.require_subcommand(1);

    ServeOptions options;
    CLI::App* serve_command = app.add_subcommand("serve", "run the HTTP service and its page");
    add_serve_options(*serve_command, options);

    std::string url_host = "127.0.0.1";
    int url_port = 8080;
    CLI::App* health_command = app.add_subcommand("healthcheck", "ask a running service whether it is well: exit code 0 or 1");
    health_command->add_option("--host", url_host, "its address")->capture_default_str();
    health_command->add_option("--port", url_port, "its port")->envname("VINES_PORT")->capture_default_str();

    std::string report_folder;
    CLI::App* reproduce_command = app.add_subcommand("reproduce", "recompute the paper's Figs. 3 to 14 and Tables 1 to 3 and compare: exit code 0 if every number lies in its band, else 1");
    reproduce_command->add_option("--output", report_folder, "folder for report.md and its SVG plots; without it only the table is printed");

    CLI11_PARSE(app, argc, argv);
    try {
        if (*reproduce_command) return reproduce(report_folder);
        if (*health_command) return vines::http::get_status(url_host, url_port, "/healthz") == 200 ? 0 : 1;
        return serve(options, signals);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "vines: %s\n", e.what());
        return 1;
    }
}
