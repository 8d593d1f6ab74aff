// The event loop: one thread waits with epoll for all clients, reads requests and answers those
// that need no worker (health, refusals). A complete request goes with its connection to a worker
// thread, which computes the answer and returns the connection; the loop sends what its socket has
// not taken.
#pragma once

#include <set>

#include "http/connection.hpp"
#include "http/fair_queue.hpp"
#include "http/metrics.hpp"
#include "http/worker_pool.hpp"

namespace vines::http {

struct ConnectionLimits {
    std::size_t connections = 4096;  ///< open ones, including idle ones
    std::size_t per_client = 1024;   ///< connections of one client that is no proxy
    /// Threads, of which a stream that is read slowly occupies one; as many requests wait for one.
    int workers = 128;
    std::size_t held_bytes = 384 << 20;  ///< bytes of requests and answers, see MemoryBudget
};

class EventLoop {
public:
    /// listening: a listening socket, which becomes non-blocking. The handler must outlive the
    /// loop. Throws std::system_error if no worker thread can be started.
    EventLoop(
        Descriptor listening, const ConnectionLimits& limits, Networks proxies,
        RequestHandler& handler);

    /// Runs until stop() has been called and all connections are closed.
    void run();
    MemoryBudget& memory() { return memory_; }
    ConnectionLoad load() const {
        return {
            .open = count_ + with_workers_,
            .in_flight = with_workers_ + delivering_,
            .held_bytes = memory_.bytes()};
    }
    /// To be called when a request is refused because streams hold what it needs: for a while
    /// those that are read slowly are broken off sooner.
    void note_scarcity_of_streams() { streams_scarce_ = Clock::now(); }
    /// See WorkerPool.
    bool others_need_threads(const std::string& client, bool even_last) {
        return workers_.others_need(client, even_last);
    }
    /// From any thread, once: accepts no new connections, answers requests that arrive on open ones
    /// within 300 ms, waits for the answers in progress, and lets run() return.
    void stop();

private:
    using Owned = std::unique_ptr<Connection>;
    using Clock = Connection::Clock;

    void wait();
    void queue(int socket);
    void accept(int most);
    Connection* eviction_candidate() const;
    Connection* eviction_candidate(const std::string& owner) const;
    void change_events(int operation, int socket, std::uint32_t events) const;
    void await(int operation, const Connection& connection) const;
    void listen(bool on);
    void watch(Owned connection);
    Owned release(int socket);
    void close(int socket);
    void handle(int socket, bool failed = false);
    void read(Connection& connection);
    void hand_over(Owned connection);
    bool answer_here(Connection& connection);
    void deliver(Connection& connection);
    bool was_scarce(Clock::time_point last) const;
    bool memory_is_scarce() const { return memory_.is_full() || was_scarce(memory_.last_full()); }
    void expire_deliveries();
    void collect_returned();
    void expire();
    void time_out(Connection& connection);
    // The others are called by the thread in run(), these by workers.
    void work(Owned connection);
    void finish_stream(Owned connection, Task rest);
    void hand_back(int socket, Owned connection);
    void wake() const;

    RequestHandler& handler_;
    const std::size_t max_connections_, max_per_client_;
    const Networks proxies_;
    const Descriptor listening_, poll_, wake_;
    MemoryBudget memory_;
    std::vector<Owned> connections_;           // indexed by socket; used by run() only
    std::map<std::string, std::size_t> open_;  // connections by client, also those with workers
    FairQueue<int> ready_;                     // sockets with more to read or to send, by owner
    std::set<int> queued_;                     // those in ready_
    std::atomic<std::size_t> count_ = 0;       // number of connections_
    std::atomic<std::size_t> delivering_ = 0;  // those of them that take an answer
    bool is_memory_to_return_ = false;
    std::size_t most_at_work_ = 0;               // with_workers_, since the last look
    std::atomic<std::size_t> with_workers_ = 0;  // or returned and not yet collected
    std::atomic<Clock::time_point> streams_scarce_{};
    Clock::time_point connections_scarce_{};
    std::atomic<bool> stopping_ = false;
    std::atomic<bool> listens_ = false;
    bool closing_ = false;
    Clock::time_point checked_ = Clock::now();
    // Connections without a complete request end then.
    Clock::time_point idle_until_ = Clock::time_point::max();
    std::mutex mutex_;
    /// From workers: connections by their sockets; null once the stream of one has ended.
    std::vector<std::pair<int, Owned>> returned_;
    WorkerPool<Owned> workers_;  // destroyed first
};

}  // namespace vines::http
