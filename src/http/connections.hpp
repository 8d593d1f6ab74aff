// All connections of the service. One thread keeps those that wait for their client, whatever their
// number; a request that has come as a whole is handed to a worker, with its connection.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "http/connection.hpp"
#include "http/metrics.hpp"
#include "http/patience.hpp"
#include "http/workers.hpp"

namespace vines::http {

/// Who answers. All of it is called from several threads.
struct Answering {
    Admission admission;
    /// Sends the answer. False: the connection cannot be used any more.
    std::function<bool(Connection&, Exchange, Patience)> answer;
    /// What is answered where no worker is free and as many requests wait as may.
    std::function<Response()> overloaded;
};

struct ConnectionLimits {
    std::size_t connections = 4096;
    int workers = 64;
    std::size_t waiting = 64;            ///< requests that wait for a worker
    std::size_t held_bytes = 512 << 20;  ///< of requests and answers
};

class Connections {
public:
    /// listening: a socket that listens, which is made non-blocking. Throws std::system_error where
    /// no worker can be started.
    Connections(int listening, const ConnectionLimits& limits, Answering answering);
    ~Connections();

    /// Keeps the connections until stop() has been called and the last of them has gone.
    void run();
    /// Of requests and answers.
    const HeldMemory& memory() const { return memory_; }
    ConnectionLoad load() const {
        const auto in_work = static_cast<std::size_t>(in_work_);
        return {.open = number_ + in_work, .in_flight = in_work, .held_bytes = memory_.bytes()};
    }
    /// From any thread, once: takes no new connection, answers what comes on the others for a
    /// moment, waits for the answers in work, and makes run() return.
    void stop();

private:
    using Owned = std::unique_ptr<Connection>;
    using Clock = Connection::Clock;

    // Of the thread in run().
    void wait();
    void accept_all();
    Connection* dispensable() const;
    void listen(bool on);
    void keep(Owned connection);
    Owned release(int socket);
    void look_at(int socket);
    void read(Connection& connection);
    void hand_over(Owned connection);
    void answer_here(Connection& connection, Exchange exchange);
    void take_back();
    void expire();
    void give_up(Connection& connection);
    bool is_done() const;
    // Of a worker.
    void work(Owned connection);
    bool is_there_soon(Connection& connection);
    void give_back(Owned connection);
    void wake() const;

    const int listening_;
    const Answering answering_;
    const std::size_t most_connections_;
    const int poll_, wake_;
    HeldMemory memory_;
    std::vector<Owned> kept_;  // by socket; of the thread in run()
    std::vector<int> again_;   // sockets of those whose turn was over before they were done
    std::atomic<std::size_t> number_ = 0;  // of those
    std::atomic<int> in_work_ = 0;         // with a worker, or on their way back
    std::atomic<bool> stopping_ = false;
    bool listens_ = false, closing_ = false;
    Clock::time_point looked_ = Clock::now();
    Clock::time_point idle_until_ =
        Clock::time_point::max();  // who has sent no whole request ends then
    std::mutex mutex_;
    std::vector<Owned> returned_;  // by workers
    Workers<Owned> workers_;       // goes first
};

}  // namespace vines::http
