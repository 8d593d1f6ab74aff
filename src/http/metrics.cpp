#include "http/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "api/version.hpp"
#include "http/process_load.hpp"

namespace vines::http {

namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

// Seconds: from an answer that was there already to a sweep of an hour.
const prometheus::Histogram::BucketBoundaries durations = {
    .0005, .001, .0025, .005, .01, .025, .05, .1, .25, .5, 1, 2.5, 5, 10, 30, 60, 300, 3600};

/// Of all methods that there are those that the service takes: a client's own words would each be a
/// series of their own.
std::string method_label(const std::string& method) {
    constexpr std::array known{"GET", "HEAD", "POST"};
    return std::find(known.begin(), known.end(), method) != known.end() ? method : "other";
}

// In the order of SweepEnd.
constexpr std::array sweep_ends{"complete", "client_left", "deadline", "stopping", "failed"};

/// A number that is known when it is asked for.
MetricFamily sampled(
    std::string name, std::string help, double value, MetricType type = MetricType::Gauge) {
    ClientMetric metric;
    (type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
    return {std::move(name), std::move(help), type, {std::move(metric)}};
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
    all.push_back(sampled(
        "process_cpu_seconds_total", "User and system time.", load.cpu_seconds,
        MetricType::Counter));
    all.push_back(sampled(
        "process_start_time_seconds", "Start of the process, since 1970.",
        load.start_time_seconds));
    all.push_back(
        sampled("process_resident_memory_bytes", "Memory in use.", load.resident_memory_bytes));
    all.push_back(sampled(
        "process_virtual_memory_bytes", "Memory that is mapped.", load.virtual_memory_bytes));
    all.push_back(sampled("process_open_fds", "Open file descriptors.", load.open_fds));
    all.push_back(sampled("process_max_fds", "File descriptors that may be open.", load.max_fds));
    all.push_back(sampled("process_threads", "Threads.", load.threads));
}

/// Members of a family by one word: to find them by their labels takes as long as to answer a small
/// request.
template <class Member>
class Members {
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
    explicit Implementation(const ComputeGate& gate_) : gate(gate_) {
        // From the start on: a rate needs a value before the first one.
        for (const char* lacking : {"computing", "memory", "stopping", "sweeps", "threads"})
            unavailable.Add({{"reason", lacking}});
        for (const char* end : sweep_ends) sweeps.Add({{"end", end}});
    }

    const ComputeGate& gate;
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
    Members<prometheus::Counter> of_requests;
    prometheus::Family<prometheus::Histogram>& taken = histograms(
        "vines_http_request_duration_seconds",
        "From a request's last byte to its answer's, by route.");
    Members<prometheus::Histogram> of_taken;
    prometheus::Counter& bytes = counter("vines_http_sent_bytes_total", "Bytes of answers.");
    prometheus::Counter& left =
        counter("vines_http_clients_left_total", "Answers whose client left before their end.");
    prometheus::Family<prometheus::Counter>& unavailable = counters(
        "vines_http_unavailable_total",
        "Requests answered with 503, by what the server had no more of.");
    prometheus::Histogram& queued =
        histograms("vines_compute_queue_seconds", "Wait of a request for a place to compute in.")
            .Add({}, durations);
    prometheus::Family<prometheus::Counter>& sweeps =
        counters("vines_sweeps_total", "Sweeps that had begun, by how they ended.");
    prometheus::Counter& runs =
        counter("vines_sweep_runs_total", "Runs of sweeps that have ended.");
    prometheus::Counter& impacts = counter(
        "vines_impacts_total",
        "Impacts computed: of simulations, and of the measured parts of ended sweeps.");

    void add_load(std::vector<MetricFamily>& all) const {
        const ComputeLoad load = gate.load();
        all.push_back(sampled(
            "vines_compute_running", "Computations in work.", static_cast<double>(load.running)));
        all.push_back(sampled(
            "vines_compute_queue_depth", "Requests that wait for a place to compute in.",
            static_cast<double>(load.waiting)));
        all.push_back(
            sampled("vines_sweeps_running", "Sweeps in work.", static_cast<double>(load.sweeps)));
        if (!connections) return;
        const ConnectionLoad now = connections();
        all.push_back(
            sampled("vines_http_connections", "Open connections.", static_cast<double>(now.open)));
        all.push_back(sampled(
            "vines_http_requests_in_flight", "Requests that have come and are not yet answered.",
            static_cast<double>(now.in_flight)));
        all.push_back(sampled(
            "vines_http_held_bytes", "Bytes of requests and answers in memory.",
            static_cast<double>(now.held_bytes)));
    }
};

Metrics::Metrics(const ComputeGate& gate)
    : implementation_(std::make_unique<Implementation>(gate)) {}

Metrics::~Metrics() = default;

void Metrics::count_served(const Served& served) {
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

void Metrics::watch(std::function<ConnectionLoad()> connections) {
    implementation_->connections = std::move(connections);
}

std::string Metrics::text() const {
    std::vector<MetricFamily> all = implementation_->registry.Collect();
    implementation_->add_load(all);
    all.push_back(sampled(
        "vines_log_lines_dropped_total", "Lines of the log that nobody read in time.",
        static_cast<double>(log_lines_dropped()), MetricType::Counter));
    add_process(all);
    all.push_back(build_info());
    return prometheus::TextSerializer().Serialize(all);
}

}  // namespace vines::http
