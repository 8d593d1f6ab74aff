// One client's connection. It turns the bytes that arrive into one complete request after another,
// and sends the answers, without blocking.
// Time limits: 10 s for a head, 10 s for each further 64 KiB of a body, 60 s between requests.
#pragma once

#include <memory>

#include "http/log.hpp"
#include "http/memory.hpp"
#include "http/outbox.hpp"
#include "program/descriptor.hpp"

namespace vines::http {

/// A request that is answered, and its answer on the way to the client.
struct Delivery {
    Delivery(Request received, int socket) : request(std::move(received)), outbox(socket) {}

    Request request;
    Outbox outbox;
    Outcome outcome = {};
    bool keep_alive = false;    ///< the connection can be reused after it
    bool is_streaming = false;  ///< computed while it is sent
};

using Task = std::function<void()>;
class Connection;

/// The server's part of an exchange. Its functions are called from several threads.
class RequestHandler {
public:
    virtual ~RequestHandler() = default;
    /// Decides by the head, before the body is read: sets the route and the sender, and refuses an
    /// unacceptable request. peer: the other end's address.
    virtual void check_head(Request& request, const std::string& peer) const = 0;
    /// Computes the answer and begins its delivery. Returns the rest of the work, which adds to the
    /// outbox, if the answer is computed while it is sent.
    virtual Task answer(Connection& connection, Request request) = 0;
    /// Called once for each delivery: sent or broken.
    virtual void finish(const std::shared_ptr<Delivery>& delivery, Outbox::State state) = 0;
};

// Longest time between an answer and the next request.
inline constexpr std::chrono::seconds idle_time(60);

/// Used by one thread at a time.
class Connection {
public:
    using Clock = std::chrono::steady_clock;

    /// Takes ownership of a non-blocking socket; the handler and the budget must outlive the
    /// connection. peer: the other end's address.
    Connection(int socket, std::string peer, RequestHandler& handler, MemoryBudget& memory);
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
    bool is_answered_on_loop() const { return request_->refused || request_->route->on_event_loop; }
    /// True while a large body waits for memory: advance() looks for it, and reads no byte before.
    bool awaits_memory() const { return awaits_memory_; }
    /// Returns the complete request and removes its bytes from the buffer.
    Request take();
    /// Turns the incomplete request into a refused one, to be returned by take().
    void refuse(Response refusal);

    /// Time at which the connection times out unless further bytes arrive; earlier for a large body
    /// while memory is scarce.
    Clock::time_point deadline(bool memory_is_scarce = false) const;
    /// True if no byte of a next request has arrived.
    bool is_idle() const { return bytes_.empty() && !request_ && !delivery_ && !is_closing(); }
    /// True if idle after at least one answer.
    bool is_idle_keep_alive() const { return is_idle() && served_; }
    /// Start of the current wait for the client.
    Clock::time_point waiting_since() const { return waiting_since_; }

    /// To be called with an answer; deliver() then sends it.
    void begin_delivery(std::shared_ptr<Delivery> delivery) { delivery_ = std::move(delivery); }
    bool is_delivering() const { return delivery_ != nullptr; }
    bool is_streaming() const { return delivery_ && delivery_->is_streaming; }
    /// Sends what the socket takes of the answer. At its end the connection waits for the next
    /// request, or closes: with a reset if the answer is broken off, so that the client does not
    /// take the part for the whole.
    void deliver(std::size_t max_bytes = std::numeric_limits<std::size_t>::max());
    /// Outbox of the present answer; deliver() ends the delivery once it is cancelled.
    Outbox& outbox() const { return delivery_->outbox; }

    /// Starts a lingering close: closes the sending side, and discards what the client still sends
    /// for up to 3 s or 64 MiB. Closing with unread bytes would reset the connection, and the
    /// client could lose its last answer.
    void begin_closing();
    bool is_closing() const { return closing_; }
    /// Discards received bytes; true once the client has closed too, or sent too much.
    bool finish_closing();

    int socket() const { return socket_.number(); }
    const std::string& peer() const { return peer_; }
    const std::string& owner() const { return owner_; }  ///< owner_of(peer())
    /// The client of the complete request, see Sender.
    std::string client() const { return request_->sender.client(); }

    /// Sets the bytes of the client's answer; received bytes are added.
    void hold(const std::string& client, MemoryBudget::Bytes bytes) {
        memory_.count(held_, client, {bytes.all + bytes_.capacity(), bytes.for_long});
    }
    /// The same, see MemoryBudget.
    bool reserve(const std::string& client, MemoryBudget::Bytes bytes, Clock::time_point since) {
        bytes.all += bytes_.capacity();
        return memory_.reserve(held_, client, bytes, since);
    }

private:
    Progress read_request();
    void hold_received() { hold(request_ ? client() : owner_, {}); }
    std::size_t body_size() const { return request_->head.content_length; }
    void wait_for_head(Clock::duration time);
    void begin_request();
    void begin_body();
    void expect_more();

    const Descriptor socket_;
    const std::string peer_, owner_;
    RequestHandler& handler_;
    MemoryBudget& memory_;
    MemoryBudget::Counted held_;
    std::string bytes_;  // received, not yet taken
    HeadReader reader_;
    std::optional<Request> request_;  // once the head is complete; bytes_ then holds its body
    std::size_t expected_ = 0;        // size of the body that must be reached before the deadline
    std::shared_ptr<Delivery> delivery_;
    bool half_closed_ = false;  // the client has closed its sending side
    bool awaits_memory_ = false;
    bool closing_ = false, aborted_ = false, served_ = false;
    std::size_t dropped_ = 0;
    Clock::time_point waiting_since_, deadline_;
};

}  // namespace vines::http
