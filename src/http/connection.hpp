// One client's connection. It reads the bytes that arrive, without blocking, and turns them into
// one complete request after another.
// Its time limits: 10 s for a head, 10 s for each further 64 KiB of a body, 60 s idle between
// requests.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "http/head.hpp"
#include "http/memory.hpp"
#include "http/message.hpp"

namespace vines::http {

struct WriteTimeout {
    std::chrono::milliseconds time;   ///< total time to wait for the client to read
    std::function<bool()> contended;  ///< whether other requests wait for this thread
};

/// A complete request, or the refusal of one; nothing is read after a refused request.
struct Exchange {
    Head head;
    std::string body;
    const Route* route = nullptr;  ///< can be null if refused
    std::optional<Response> refused = {};
    std::chrono::steady_clock::time_point since = {};  ///< time at which the request was complete
};

/// Decision by a request's head, before its body is read: its route, or a refusal.
struct CheckedHead {
    const Route* route = nullptr;
    std::optional<Response> refused = {};
};
using HeadCheck = std::function<CheckedHead(const Head&)>;

// Longest time between an answer and the next request.
inline constexpr std::chrono::seconds idle_time(60);

/// Used by one thread at a time.
class Connection {
public:
    using Clock = std::chrono::steady_clock;

    /// Takes ownership of a non-blocking socket; check_head and the budget must outlive the
    /// connection. client: its address, for the log.
    Connection(int socket, std::string client, const HeadCheck& check_head, MemoryBudget& memory);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    enum class Progress {
        waits,     ///< more bytes are needed
        complete,  ///< a request can be taken
        ended      ///< closed by the client without a complete request
    };
    /// Reads the bytes that have arrived, up to 256 KiB, without blocking.
    Progress advance();
    /// True if the event loop itself answers the complete request, however busy the workers are.
    bool is_answered_on_loop() const { return refused_ || route_->on_event_loop; }
    /// Returns the complete request and removes its bytes from the buffer.
    Exchange take();
    /// Turns the incomplete request into a refused one, to be returned by take().
    void refuse(Response refusal);

    /// Time at which the connection times out unless further bytes arrive.
    Clock::time_point deadline() const { return deadline_; }
    /// True if no byte of a next request has arrived.
    bool is_idle() const { return bytes_.empty() && !head_ && !is_closing(); }
    /// True if idle after at least one answer.
    bool is_idle_keep_alive() const { return is_idle() && served_; }
    /// Start of the current wait for the client.
    Clock::time_point waiting_since() const { return waiting_since_; }
    /// To be called after an answer: waits for the next request.
    void begin_waiting();

    /// To be called if an answer could not be sent completely: the connection will end with a
    /// reset, so that the client does not take the part for the whole.
    void abort() { aborted_ = true; }
    /// Starts a lingering close: closes the sending side, and discards what the client still sends
    /// for up to 3 s or 64 MiB. Closing with unread bytes would reset the connection, and the
    /// client could lose its last answer.
    void begin_closing();
    bool is_closing() const { return closing_; }
    /// Discards received bytes; true once the client has closed too, or sent too much.
    bool finish_closing();

    enum class PeerState {
        connected,
        half_closed,  ///< the client has closed its sending side; it can still be reading, or gone
        reset         ///< the client has reset the connection
    };
    PeerState peer_state() const;

    int socket() const { return socket_; }
    const std::string& client() const { return client_; }

    /// Sets the bytes of answers held for the client; received bytes are added.
    void hold(std::size_t bytes) { held_.set(bytes + bytes_.capacity()); }

private:
    Progress read_on();
    Progress read_request();
    bool exceeds_memory() const;
    void begin_request();
    void begin_body();
    void expect_more();

    const int socket_;
    const std::string client_;
    const HeadCheck& check_head_;
    MemoryShare held_;
    std::string bytes_;  // received, not yet taken
    HeadReader reader_;
    std::optional<Head> head_;  // once complete; bytes_ then holds its body
    const Route* route_ = nullptr;
    Clock::time_point complete_since_;
    std::size_t expected_ = 0;  // size of the body that must be reached before the deadline
    std::optional<Response> refused_;
    bool half_closed_ = false;  // the client has closed its sending side
    bool closing_ = false, aborted_ = false, served_ = false;
    std::size_t dropped_ = 0;
    Clock::time_point waiting_since_, deadline_;
};

}  // namespace vines::http
