// Flags, wiring, signals.
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <malloc.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include "api/openapi.hpp"
#include "api/simulate.hpp"
#include "cli/commands.hpp"
#include "http/routes.hpp"
#include "http/server.hpp"
#include "report/markdown.hpp"
#include "report/reproduce.hpp"

namespace {

struct ServeOptions {
    vines::http::ServerOptions server;
    vines::http::RouteOptions routes{30, 100000, 64u << 20, 128u << 20, ""};
    int compute_threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    int compute_queue = 64;
    int sweeps = 4;
    double drain = 0;
};

void add_serve_options(CLI::App& serve, ServeOptions& o) {
    // A flag beats the environment, which beats the default.
    serve.add_option("--host", o.server.host, "address to listen on")
        ->envname("VINES_HOST")
        ->capture_default_str();
    serve.add_option("--port", o.server.port, "port to listen on, 0 for any free one")
        ->envname("VINES_PORT")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    serve.add_option("--threads", o.server.threads, "connections served at once")
        ->envname("VINES_THREADS")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    serve.add_option("--compute-threads", o.compute_threads, "computations at once")
        ->envname("VINES_COMPUTE_THREADS")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    serve
        .add_option("--compute-queue", o.compute_queue, "computations that wait; beyond that: 503")
        ->envname("VINES_COMPUTE_QUEUE")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    serve
        .add_option(
            "--sweeps", o.sweeps,
            "sweeps at once, which share the computing that is left; beyond that: 503")
        ->envname("VINES_SWEEPS")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    serve.add_option("--sweep-points", o.routes.sweep_points, "points of one sweep")
        ->envname("VINES_SWEEP_POINTS")
        ->check(CLI::Range(1, 10000000))
        ->capture_default_str();
    serve
        .add_option(
            "--drain", o.drain,
            "seconds from SIGTERM on during which /readyz says 503 and requests are still taken, "
            "so that a proxy notices")
        ->envname("VINES_DRAIN")
        ->check(CLI::Range(0.0, 3600.0))
        ->capture_default_str();
    serve
        .add_option(
            "--deadline", o.routes.deadline,
            "seconds of computing for one request; then it ends with what it has")
        ->envname("VINES_DEADLINE")
        ->check(CLI::Range(0.001, 86400.0))
        ->capture_default_str();
    serve.add_option("--payload-limit", o.server.payload_limit, "bytes of a request's body")
        ->envname("VINES_PAYLOAD_LIMIT")
        ->check(CLI::Range(1, 1 << 30))
        ->capture_default_str();
    serve
        .add_option(
            "--record-limit", o.routes.record_limit, "bytes of a measurement sent to /v1/identify")
        ->envname("VINES_RECORD_LIMIT")
        ->check(CLI::Range(1, 1 << 30))
        ->capture_default_str();
    serve
        .add_option(
            "--answer-limit", o.routes.answer_limit,
            "bytes of an answer's JSON; one that would be larger is thinned, or refused where that "
            "cannot be")
        ->envname("VINES_ANSWER_LIMIT")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 40))
        ->capture_default_str();
    serve
        .add_option(
            "--web-dir", o.routes.web_dir,
            "serve the page from this folder instead of the program (while developing it)")
        ->envname("VINES_WEB_DIR")
        ->check(CLI::ExistingDirectory);
}

const char* const exit_codes =
    "Exit codes: 0 complete; 1 a file could not be read or written, or files do not fit together; "
    "2 the request is at fault, a problem document on stderr says where; "
    "3 stopped by a signal or points are missing, what is there is usable.";

int serve(const ServeOptions& options, const sigset_t& signals) {
#ifdef __GLIBC__
    // Records and answers of this size on are mapped and unmapped one by one. The library's own
    // threshold grows up to 32 MiB with what is freed, and each of its many arenas would keep that
    // much for good.
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
    auto log = std::make_shared<spdlog::logger>(
        "vines", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    log->set_pattern("%v");  // the lines are JSON already
    log->flush_on(spdlog::level::info);
    spdlog::set_default_logger(log);

    vines::http::ComputeGate gate(options.compute_threads, options.compute_queue, options.sweeps);
    vines::http::Server server(options.server, vines::http::make_routes(options.routes, gate));
    const int port = server.bind();
    std::printf(
        "vines %s listens on http://%s:%d\n", vines::api::version().c_str(),
        options.server.host.c_str(), port);
    std::fflush(stdout);

    std::thread([&] {
        int signal;
        sigwait(&signals, &signal);
        gate.close();
        std::this_thread::sleep_for(std::chrono::duration<double>(options.drain));
        server.stop();
        // run() would return only after every idle connection's keep-alive timeout; no answer is in
        // work any more.
        spdlog::shutdown();
        std::_Exit(0);
    }).detach();
    server.run();
    for (;;) pause();  // stop() was called: the other thread ends the process
}

int reproduce(const std::string& folder) {
    const vines::report::Report result = vines::report::reproduce(folder);
    std::fputs(vines::report::markdown_table(result.findings).c_str(), stdout);
    if (!folder.empty())
        std::fprintf(stderr, "vines: wrote %s/report.md and its plots\n", folder.c_str());
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

    CLI::App app(
        "Exact simulation of a linear oscillator coupled with a vibro-impact nonlinear energy "
        "sink.",
        "vines");
    app.set_version_flag("--version", vines::api::version());
    app.require_subcommand(1);

    ServeOptions options;
    CLI::App* serve_command = app.add_subcommand("serve", "run the HTTP service and its page");
    add_serve_options(*serve_command, options);

    std::string url_host = "127.0.0.1";
    int url_port = 8080;
    CLI::App* health_command = app.add_subcommand(
        "healthcheck", "ask a running service whether it is well: exit code 0 or 1");
    health_command->add_option("--host", url_host, "its address")->capture_default_str();
    health_command->add_option("--port", url_port, "its port")
        ->envname("VINES_PORT")
        ->capture_default_str();

    vines::cli::Files files;
    CLI::App* simulate_command =
        app.add_subcommand("simulate", "one run: the JSON of POST /v1/simulate in, its answer out");
    vines::cli::Files identify_files;
    std::string identify_query;
    CLI::App* identify_command = app.add_subcommand(
        "identify",
        "exponents from a measurement: a CSV file with --query, or the JSON of POST /v1/identify");
    identify_command->add_option(
        "--query,-q", identify_query, "fields for a CSV file, as in a URL: preset=fig20&b=0.015");
    vines::cli::SweepOptions sweep_options;
    CLI::App* sweep_command = app.add_subcommand(
        "sweep", "a sweep: the JSON of POST /v1/sweep in, its points as lines of JSON out");
    for (auto& [command, f] :
         {std::pair(simulate_command, &files), std::pair(identify_command, &identify_files),
          std::pair(sweep_command, &sweep_options.files)}) {
        command->add_option("request", f->input, "file with the request; - or nothing: stdin");
        command->add_option("--output,-o", f->output, "file for the answer; - or nothing: stdout");
        command->footer(exit_codes);
    }
    sweep_command->add_flag(
        "--resume", sweep_options.resume,
        "complete the output file of a run that was stopped or killed");
    sweep_command->add_option(
        "--shard", sweep_options.shard,
        "compute a part only: i/N with i from 0, or auto: from SLURM_ARRAY_TASK_ID and _COUNT, or "
        "JOB_COMPLETION_INDEX and --shards");
    sweep_command->add_option("--shards", sweep_options.shards, "N for --shard auto")
        ->envname("VINES_SHARDS")
        ->check(CLI::Range(1, 1000000));
    sweep_command->add_option("--threads", sweep_options.threads, "threads; 0: one for each core")
        ->envname("VINES_COMPUTE_THREADS")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    std::vector<std::string> parts;
    std::string merged;
    CLI::App* merge_command = app.add_subcommand(
        "merge",
        "put the files of a sweep's shards together: byte for byte the file of the whole sweep");
    merge_command->add_option("files", parts, "the shards' files")->required();
    merge_command->add_option("--output,-o", merged, "file for the whole; - or nothing: stdout");
    merge_command->footer(exit_codes);

    CLI::App* openapi_command =
        app.add_subcommand("openapi", "write the OpenAPI document to stdout");

    std::string report_folder;
    CLI::App* reproduce_command = app.add_subcommand(
        "reproduce",
        "recompute the paper's Figs. 3 to 14 and Tables 1 to 3 and compare: exit code 0 if every "
        "number lies in its band, else 1");
    reproduce_command->add_option(
        "--output", report_folder,
        "folder for report.md and its SVG plots; without it only the table is printed");

    CLI11_PARSE(app, argc, argv);
    try {
        if (*openapi_command) return std::puts(vines::api::openapi().dump(2).c_str()) < 0;
        if (*reproduce_command) return reproduce(report_folder);
        if (*simulate_command || *identify_command || *sweep_command || *merge_command) {
            vines::cli::stop_on_signals();
            if (*identify_command) return vines::cli::identify(identify_files, identify_query);
            return *simulate_command ? vines::cli::simulate(files)
                   : *sweep_command  ? vines::cli::sweep(sweep_options)
                                     : vines::cli::merge(parts, merged);
        }
        if (*health_command)
            return vines::http::get_status(url_host, url_port, "/healthz") == 200 ? 0 : 1;
        return serve(options, signals);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "vines: %s\n", e.what());
        return 1;
    }
}
