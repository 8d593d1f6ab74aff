// What the service counts, in the text that Prometheus reads.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "http/compute_gate.hpp"
#include "http/log.hpp"

namespace vines::http {

/// The connections at a moment.
struct ConnectionLoad {
    std::size_t open = 0;
    std::size_t in_flight = 0;   ///< requests that have come as a whole and are not yet answered
    std::size_t held_bytes = 0;  ///< of requests and answers
};

/// How a sweep that had begun ended.
enum class SweepEnd { complete, client_left, deadline, stopping, failed };

/// Used by any thread.
class Metrics {
public:
    /// The gate outlives it.
    explicit Metrics(const ComputeGate& gate);
    ~Metrics();

    void count_served(const Served& served);
    /// The impacts of a simulation.
    void count_impacts(long impacts);
    /// The runs of a sweep, and their measured impacts.
    void count_sweep(SweepEnd end, std::size_t runs, std::size_t impacts);

    /// Asked whenever text() is.
    void watch(std::function<ConnectionLoad()> connections);
    /// The exposition format, version 0.0.4.
    std::string text() const;

    static constexpr const char* content_type = "text/plain; version=0.0.4; charset=utf-8";

private:
    struct Implementation;
    const std::unique_ptr<Implementation> implementation_;
};

}  // namespace vines::http
