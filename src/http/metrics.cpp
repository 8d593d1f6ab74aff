#include "http/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <sys/resource.h>

#include <chrono>
#include <ctime>
#include <filesystem>

#include "api/version.hpp"

namespace vines::http {

namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

// Seconds: from cached answers to a sweep of an hour.
const prometheus::Histogram::BucketBoundaries durations = {
    .0005, .001, .0025, .005, .01, .025, .05, .1, .25, .5, 1, 2.5, 5, 10, 30, 60, 300, 3600};

// In the order of SweepEnd.
constexpr std::array sweep_ends{"complete", "client_left", "deadline", "stopping", "failed"};

const std::chrono::system_clock::time_point start_of_process = std::chrono::system_clock::now();

/// Entries of a folder of /proc/self; 0 where the system does not tell.
auto entries_in(const char* folder) {
    std::error_code ignored;
    return std::distance(std::filesystem::directory_iterator(folder, ignored), {});
}

}  // namespace

struct Metrics::Implementation {
    explicit Implementation(const AdmissionControl& admission_) : admission(admission_) {
        // All series exist from the start: a rate needs an earlier value.
        for (const char* lacking : {"computing", "memory", "stopping", "sweeps", "threads"})
            unavailable.Add({{"reason", lacking}});
        for (const char* end : sweep_ends) sweeps.Add({{"end", end}});
    }

    const AdmissionControl& admission;
    std::function<ConnectionLoad()> connections = [] { return ConnectionLoad{}; };
    prometheus::Registry registry;

    prometheus::Family<prometheus::Counter>& counters(const char* name, const char* help) {
        return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
    }
    prometheus::Counter& counter(const char* name, const char* help) {
        return counters(name, help).Add({});
    }
    prometheus::Family<prometheus::Histogram>& histograms(const char* name, const char* help) {
        return prometheus::BuildHistogram().Name(name).Help(help).Register(registry);
    }

    prometheus::Family<prometheus::Counter>& requests =
        counters("vines_http_requests_total", "Requests answered, by route, method and status.");
    prometheus::Family<prometheus::Histogram>& taken = histograms(
        "vines_http_request_duration_seconds",
        "Time from a request's last byte to its answer's, by route.");
    prometheus::Counter& bytes = counter("vines_http_sent_bytes_total", "Bytes of answers.");
    prometheus::Counter& left =
        counter("vines_http_clients_left_total", "Answers whose client left before their end.");
    prometheus::Family<prometheus::Counter>& unavailable = counters(
        "vines_http_unavailable_total", "Requests answered with 503, by exhausted resource.");
    prometheus::Histogram& queued =
        histograms("vines_compute_queue_seconds", "Time that a request waited for a compute slot.")
            .Add({}, durations);
    prometheus::Family<prometheus::Counter>& sweeps =
        counters("vines_sweeps_total", "Started sweeps, by outcome.");
    prometheus::Counter& runs = counter("vines_sweep_runs_total", "Runs of ended sweeps.");
    prometheus::Counter& impacts = counter(
        "vines_impacts_total",
        "Impacts computed by simulations and in the measured part of ended sweeps.");
};

Metrics::Metrics(const AdmissionControl& admission)
    : implementation_(std::make_unique<Implementation>(admission)) {}

Metrics::~Metrics() = default;

void Metrics::count_answer(const std::string& method, const Outcome& outcome) {
    Implementation& all = *implementation_;
    // Unsupported methods share one label, so that clients cannot create new series.
    const bool is_known = method == "GET" || method == "HEAD" || method == "POST";
    const std::string label = is_known ? method : "other", code = std::to_string(outcome.status);
    all.requests.Add({{"route", outcome.route}, {"method", label}, {"code", code}}).Increment();
    all.taken.Add({{"route", outcome.route}}, durations).Observe(outcome.ms / 1000);
    all.bytes.Increment(static_cast<double>(outcome.bytes));
    if (outcome.left) all.left.Increment();
    if (!outcome.lacking.empty()) all.unavailable.Add({{"reason", outcome.lacking}}).Increment();
    for (const auto& [name, ms] : outcome.timing)
        if (name == "queue") all.queued.Observe(ms / 1000);
}

void Metrics::count_sweep(SweepEnd end) {
    implementation_->sweeps.Add({{"end", sweep_ends[static_cast<std::size_t>(end)]}}).Increment();
}

void Metrics::count_runs(std::size_t runs_of_sweep, std::size_t impacts) {
    implementation_->runs.Increment(static_cast<double>(runs_of_sweep));
    implementation_->impacts.Increment(static_cast<double>(impacts));
}

void Metrics::watch_connections(std::function<ConnectionLoad()> connections) {
    implementation_->connections = std::move(connections);
}

std::string Metrics::text() const {
    std::vector<MetricFamily> all = implementation_->registry.Collect();
    // Adds a metric without labels, at its present value.
    const auto add = [&all](
                         const char* name, const char* help, auto value,
                         MetricType type = MetricType::Gauge) {
        ClientMetric metric;
        (type == MetricType::Counter ? metric.counter.value : metric.gauge.value) =
            static_cast<double>(value);
        all.push_back({name, help, type, {std::move(metric)}});
    };
    const AdmissionLoad load = implementation_->admission.load();
    add("vines_compute_running", "Computations running.", load.running);
    add("vines_compute_queue_depth", "Requests that wait for a compute slot.", load.waiting);
    add("vines_sweeps_running", "Sweeps running.", load.sweeps);
    const ConnectionLoad now = implementation_->connections();
    add("vines_http_connections", "Open connections.", now.open);
    add("vines_http_requests_in_flight", "Requests received and not yet answered.", now.in_flight);
    add("vines_http_held_bytes",
        "Bytes of requests and answers in memory, and reserved for answers.", now.held_bytes);
    add("vines_log_lines_dropped_total", "Log lines dropped because stderr was full.",
        log_lines_dropped(), MetricType::Counter);
    // The resource use of this process, by the names of Prometheus' client libraries.
    add("process_cpu_seconds_total", "User and system time.",
        static_cast<double>(std::clock()) / CLOCKS_PER_SEC, MetricType::Counter);
    const std::chrono::duration<double> start = start_of_process.time_since_epoch();
    add("process_start_time_seconds", "Start of the process, since 1970.", start.count());
    const ProcessMemory memory = process_memory();
    add("process_resident_memory_bytes", "Memory in use.", memory.resident);
    add("process_virtual_memory_bytes", "Memory that is mapped.", memory.mapped);
    // Without the descriptor of this folder.
    add("process_open_fds", "Open file descriptors.", entries_in("/proc/self/fd") - 1);
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    add("process_max_fds", "File descriptors that may be open.", limit.rlim_cur);
    add("process_threads", "Threads.", entries_in("/proc/self/task"));
    add("vines_build_info", "The build that serves, by its labels; always 1.", 1);
    all.back().metric[0].label = {
        {"version", api::version()}, {"commit", api::commit()}, {"compiler", api::compiler()}};
    return prometheus::TextSerializer().Serialize(all);
}

}  // namespace vines::http
