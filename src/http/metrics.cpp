#include "http/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <sstream>
#include <string>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include "api/version.hpp"

namespace vines::http {

namespace {

/// Resource use of this process, by the names of Prometheus' client libraries; 0 if unknown.
struct ProcessLoad {
    double cpu_seconds = 0;
    double start_time_seconds = 0;  ///< since 1970
    double resident_memory_bytes = 0, virtual_memory_bytes = 0;
    double open_fds = 0, max_fds = 0;
    double threads = 0;
};

/// Boot time of the system, seconds since 1970.
double boot_time() {
    std::ifstream in("/proc/stat");
    for (std::string word; in >> word;) {
        double seconds = 0;
        if (word == "btime" && in >> seconds) return seconds;
    }
    return 0;
}

/// Reads /proc/self/stat (proc(5)); the name in parentheses can contain any character.
void read_stat(ProcessLoad& load) {
    std::ifstream in("/proc/self/stat");
    const std::string text(std::istreambuf_iterator<char>(in), {});
    const std::size_t name_ends = text.rfind(')');
    if (name_ends == std::string::npos) return;
    std::istringstream fields(text.substr(name_ends + 1));
    std::string skipped;
    double user = 0, system = 0, since_boot = 0, pages = 0;
    for (int field = 3; field < 14; ++field) fields >> skipped;
    fields >> user >> system;  // 14, 15
    for (int field = 16; field < 20; ++field) fields >> skipped;
    fields >> load.threads >> skipped >> since_boot;  // 20, 22
    fields >> load.virtual_memory_bytes >> pages;     // 23, 24
    const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
    load.cpu_seconds = (user + system) / ticks;
    load.start_time_seconds = boot_time() + since_boot / ticks;
    load.resident_memory_bytes = pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

ProcessLoad process_load() {
    ProcessLoad load;
    read_stat(load);
    std::error_code ignored;
    for (std::filesystem::directory_iterator entry("/proc/self/fd", ignored), end; entry != end;
         entry.increment(ignored))
        ++load.open_fds;
    --load.open_fds;  // without the descriptor of this directory
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) == 0) load.max_fds = static_cast<double>(limit.rlim_cur);
    return load;
}

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

// Seconds: from cached answers to a sweep of an hour.
const prometheus::Histogram::BucketBoundaries durations = {
    .0005, .001, .0025, .005, .01, .025, .05, .1, .25, .5, 1, 2.5, 5, 10, 30, 60, 300, 3600};

/// Unsupported methods share one label, so that clients cannot create new series.
std::string method_label(const std::string& method) {
    constexpr std::array known{"GET", "HEAD", "POST"};
    return std::find(known.begin(), known.end(), method) != known.end() ? method : "other";
}

// In the order of SweepEnd.
constexpr std::array sweep_ends{"complete", "client_left", "deadline", "stopping", "failed"};

/// A metric without labels, at its present value.
MetricFamily sampled(
    const char* name, const char* help, auto value, MetricType type = MetricType::Gauge) {
    ClientMetric metric;
    (type == MetricType::Counter ? metric.counter.value : metric.gauge.value) =
        static_cast<double>(value);
    return {name, help, type, {std::move(metric)}};
}

MetricFamily build_info() {
    MetricFamily family =
        sampled("vines_build_info", "The build that serves, by its labels; always 1.", 1);
    family.metric[0].label = {
        {"version", api::version()}, {"commit", api::commit()}, {"compiler", api::compiler()}};
    return family;
}

void add_process(std::vector<MetricFamily>& all) {
    const ProcessLoad load = process_load();
    const MetricFamily families[] = {
        sampled(
            "process_cpu_seconds_total", "User and system time.", load.cpu_seconds,
            MetricType::Counter),
        sampled(
            "process_start_time_seconds", "Start of the process, since 1970.",
            load.start_time_seconds),
        sampled("process_resident_memory_bytes", "Memory in use.", load.resident_memory_bytes),
        sampled(
            "process_virtual_memory_bytes", "Memory that is mapped.", load.virtual_memory_bytes),
        sampled("process_open_fds", "Open file descriptors.", load.open_fds),
        sampled("process_max_fds", "File descriptors that may be open.", load.max_fds),
        sampled("process_threads", "Threads.", load.threads)};
    all.insert(all.end(), std::begin(families), std::end(families));
}

/// Members of a metric family by one key: a look-up by labels takes as long as a small request.
template <class Member>
class LabelCache {
public:
    template <class Make>
    Member& at(const std::string& word, Make make) {
        const std::lock_guard lock(mutex_);
        Member*& member = known_[word];
        if (!member) member = &make();
        return *member;
    }

private:
    std::mutex mutex_;
    std::unordered_map<std::string, Member*> known_;
};

}  // namespace

struct Metrics::Implementation {
    explicit Implementation(const AdmissionControl& admission_) : admission(admission_) {
        // All series exist from the start: a rate needs an earlier value.
        for (const char* lacking : {"computing", "memory", "stopping", "sweeps", "threads"})
            unavailable.Add({{"reason", lacking}});
        for (const char* end : sweep_ends) sweeps.Add({{"end", end}});
    }

    const AdmissionControl& admission;
    std::function<ConnectionLoad()> connections;
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
    LabelCache<prometheus::Counter> of_requests;
    prometheus::Family<prometheus::Histogram>& taken = histograms(
        "vines_http_request_duration_seconds",
        "Time from a request's last byte to its answer's, by route.");
    LabelCache<prometheus::Histogram> of_taken;
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

    void add_load(std::vector<MetricFamily>& all) const {
        const AdmissionLoad load = admission.load();
        all.push_back(sampled("vines_compute_running", "Computations running.", load.running));
        all.push_back(sampled(
            "vines_compute_queue_depth", "Requests that wait for a compute slot.", load.waiting));
        all.push_back(sampled("vines_sweeps_running", "Sweeps running.", load.sweeps));
        if (!connections) return;
        const ConnectionLoad now = connections();
        all.push_back(sampled("vines_http_connections", "Open connections.", now.open));
        all.push_back(sampled(
            "vines_http_requests_in_flight", "Requests received and not yet answered.",
            now.in_flight));
        all.push_back(sampled(
            "vines_http_held_bytes", "Bytes of requests and answers in memory.", now.held_bytes));
    }
};

Metrics::Metrics(const AdmissionControl& admission)
    : implementation_(std::make_unique<Implementation>(admission)) {}

Metrics::~Metrics() = default;

void Metrics::count_served(const ServedRequest& served) {
    Implementation& all = *implementation_;
    const std::string method = method_label(served.method), code = std::to_string(served.status);
    all.of_requests
        .at(served.route + ' ' + method + ' ' + code,
            [&]() -> auto& {
                return all.requests.Add(
                    {{"route", served.route}, {"method", method}, {"code", code}});
            })
        .Increment();
    all.of_taken
        .at(served.route,
            [&]() -> auto& { return all.taken.Add({{"route", served.route}}, durations); })
        .Observe(served.ms / 1000);
    all.bytes.Increment(static_cast<double>(served.bytes));
    if (served.left) all.left.Increment();
    if (!served.lacking.empty()) all.unavailable.Add({{"reason", served.lacking}}).Increment();
    for (const auto& [name, ms] : served.timing)
        if (name == "queue") all.queued.Observe(ms / 1000);
}

void Metrics::count_impacts(long impacts) {
    implementation_->impacts.Increment(static_cast<double>(impacts));
}

void Metrics::count_sweep(SweepEnd end, std::size_t runs, std::size_t impacts) {
    implementation_->sweeps.Add({{"end", sweep_ends[static_cast<std::size_t>(end)]}}).Increment();
    implementation_->runs.Increment(static_cast<double>(runs));
    implementation_->impacts.Increment(static_cast<double>(impacts));
}

void Metrics::watch_connections(std::function<ConnectionLoad()> connections) {
    implementation_->connections = std::move(connections);
}

std::string Metrics::text() const {
    std::vector<MetricFamily> all = implementation_->registry.Collect();
    implementation_->add_load(all);
    all.push_back(sampled(
        "vines_log_lines_dropped_total", "Log lines dropped because stderr was full.",
        log_lines_dropped(), MetricType::Counter));
    add_process(all);
    all.push_back(build_info());
    return prometheus::TextSerializer().Serialize(all);
}

}  // namespace vines::http
