// One client's connection. It turns the bytes that arrive into one complete request after another,
// and sends the answers, without blocking.
// Its time limits: 10 s for a head, 10 s for each further 64 KiB of a body, 60 s idle between
// requests.
#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "http/client.hpp"
#include "http/head.hpp"
#include "http/memory.hpp"
#include "http/message.hpp"
#include "http/outbox.hpp"

namespace vines::http {

/// A complete request, or the refusal of one; nothing is read after a refused request.
struct Exchange {
    Head head;
    std::string body;
    const Route* route = nullptr;  ///< can be null if refused
    std::optional<Response> refused = {};
    Sender sender = {};
    std::chrono::steady_clock::time_point since = {};  ///< time at which the request was complete
};

/// An answer on its way to its client.
struct Delivery {
    std::shared_ptr<Outbox> outbox;
    bool keep_alive = false;                        ///< the connection can be reused after it
    bool is_streaming = false;                      ///< computed while it is sent
    std::function<void(Outbox::State)> ended = {};  ///< called once: sent or broken
};

/// Decision by a request's head, before its body is read: its route, or a refusal.
struct CheckedHead {
    const Route* route = nullptr;
    std::optional<Response> refused = {};
    Sender sender = {};
};
/// peer: the other end's address.
using HeadCheck = std::function<CheckedHead(const Head&, const std::string& peer)>;

// Longest time between an answer and the next request.
inline constexpr std::chrono::seconds idle_time(60);

/// Used by one thread at a time.
class Connection {
public:
    using Clock = std::chrono::steady_clock;

    /// Takes ownership of a non-blocking socket; check_head and the budget must outlive the
    /// connection. peer: the other end's address.
    Connection(int socket, std::string peer, const HeadCheck& check_head, MemoryBudget& memory);
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

    /// Time at which the connection times out unless further bytes arrive; earlier for a large body
    /// while memory is scarce.
    Clock::time_point deadline(bool memory_is_scarce = false) const;
    /// True if no byte of a next request has arrived.
    bool is_idle() const { return bytes_.empty() && !head_ && !delivery_ && !is_closing(); }
    /// True if idle after at least one answer.
    bool is_idle_keep_alive() const { return is_idle() && served_; }
    /// Start of the current wait for the client.
    Clock::time_point waiting_since() const { return waiting_since_; }

    /// To be called with an answer; deliver() then sends it.
    void begin_delivery(Delivery delivery) { delivery_ = std::move(delivery); }
    bool is_delivering() const { return delivery_.has_value(); }
    bool is_streaming() const { return delivery_ && delivery_->is_streaming; }
    /// Sends what the socket takes of the answer. At its end the connection waits for the next
    /// request, or closes: with a reset if the answer is broken off, so that the client does not
    /// take the part for the whole.
    void deliver(std::size_t max_bytes = std::numeric_limits<std::size_t>::max());
    bool can_send_more() const { return delivery_->outbox->can_send_more(); }
    void break_off() { delivery_->outbox->cancel(); }  ///< deliver() then ends the delivery
    bool client_is_slow(bool scarce) {
        return delivery_->outbox->client_is_slow(Clock::now(), scarce);
    }

    /// Starts a lingering close: closes the sending side, and discards what the client still sends
    /// for up to 3 s or 64 MiB. Closing with unread bytes would reset the connection, and the
    /// client could lose its last answer.
    void begin_closing();
    bool is_closing() const { return closing_; }
    /// Discards received bytes; true once the client has closed too, or sent too much.
    bool finish_closing();

    int socket() const { return socket_; }
    const std::string& peer() const { return peer_; }
    const std::string& owner() const { return owner_; }  ///< owner_of(peer())
    /// The request's sender, valid once its head is complete.
    const Sender& sender() const { return sender_; }

    /// Sets the bytes of answers held for the client; received bytes are added.
    void hold(std::size_t bytes) { held_.set(bytes + bytes_.capacity()); }

private:
    Progress read_on();
    Progress read_request();
    bool exceeds_memory() const;
    void begin_request();
    void begin_body();
    void expect_more();
    void begin_waiting();

    const int socket_;
    const std::string peer_, owner_;
    const HeadCheck& check_head_;
    MemoryShare held_;
    std::string bytes_;  // received, not yet taken
    HeadReader reader_;
    std::optional<Head> head_;  // once complete; bytes_ then holds its body
    const Route* route_ = nullptr;
    Sender sender_;
    Clock::time_point complete_since_;
    std::size_t expected_ = 0;  // size of the body that must be reached before the deadline
    std::optional<Response> refused_;
    std::optional<Delivery> delivery_;
    bool half_closed_ = false;  // the client has closed its sending side
    bool closing_ = false, aborted_ = false, served_ = false;
    std::size_t dropped_ = 0;
    Clock::time_point waiting_since_, deadline_;
};

}  // namespace vines::http
