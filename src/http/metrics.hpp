// The service's metrics, in Prometheus' text format.
#pragma once

#include "http/admission_control.hpp"
#include "http/log.hpp"

namespace vines::http {

struct ConnectionLoad {
    std::size_t open = 0;
    std::size_t in_flight = 0;   ///< complete requests that are not yet answered
    std::size_t held_bytes = 0;  ///< bytes of requests and answers
};

/// Outcome of a started sweep.
enum class SweepEnd { complete, client_left, deadline, stopping, failed };

/// Thread-safe.
class Metrics {
public:
    /// The admission control must outlive the metrics.
    explicit Metrics(const AdmissionControl& admission);
    ~Metrics();

    void count_answer(const std::string& method, const Outcome& outcome);
    void count_sweep(SweepEnd end);  ///< of one request
    /// Adds the runs of one sweep, and the impacts of a simulation or of its measured parts.
    void count_runs(std::size_t runs_of_sweep, std::size_t impacts);

    /// Sets the function that text() calls for the state of the connections.
    void watch_connections(std::function<ConnectionLoad()> connections);
    /// All metrics, in the exposition format, version 0.0.4.
    std::string text() const;

    static constexpr const char* content_type = "text/plain; version=0.0.4; charset=utf-8";

private:
    struct Implementation;
    const std::unique_ptr<Implementation> implementation_;
};

}  // namespace vines::http
