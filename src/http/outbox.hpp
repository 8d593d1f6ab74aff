// The bytes of one answer on their way to its client.
// A worker adds them and sends those that the socket takes at once; the event loop sends the others
// when the socket takes more. Neither blocks on the socket.
#pragma once

#include <condition_variable>
#include <deque>
#include <limits>
#include <mutex>
#include <string>

namespace vines::http {

/// Thread-safe.
class Outbox {
public:
    using Clock = std::chrono::steady_clock;

    /// The socket is non-blocking and stays open until cancel().
    explicit Outbox(int socket);

    /// Before anything is added: true if the client has left. A client that has closed its sending
    /// side can still be reading: it is sent the first bytes that every answer begins with, one at
    /// a time; a client that has left answers them with a reset.
    bool client_has_left();

    void add(std::string bytes);
    /// To be called after the last add(). whole: false if the answer is broken off.
    void end(bool whole);
    /// Waits while much is unsent. False if the rest of the answer cannot be sent.
    bool wait_for_space();

    enum class State {
        open,   ///< more bytes are to be added or sent
        sent,   ///< the socket has taken the whole answer
        broken  ///< not all of it can be sent
    };
    /// Sends what the socket takes, up to about max_bytes.
    State send(std::size_t max_bytes = std::numeric_limits<std::size_t>::max());
    /// True if the last send() has stopped at its limit.
    bool can_send_more() const;
    /// Nothing more is sent; wait_for_space() returns.
    void cancel();

    /// To be called before the first add() of a stream, with the bytes that it holds or has.
    void expect(std::size_t bytes);
    /// True if the client reads too slowly: for 30 s less than 8 KiB/s, or while a resource is
    /// scarce for 2 s less than 64 KiB/s or a thirtieth of a complete answer, or of what a stream
    /// holds or has, each second. A pause counts only while bytes wait for it. To be called
    /// regularly.
    bool client_is_slow(Clock::time_point now, bool scarce);

    /// True if the rest of the answer cannot be sent; by_closing: also if the client has closed its
    /// sending side.
    bool is_lost(bool by_closing) const;
    std::size_t sent() const;  ///< bytes that the socket has taken

private:
    void drop_sent(std::size_t bytes);
    std::size_t queued() const;
    void probe();

    const int socket_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::string> parts_;  // not yet sent, from begin_ on
    std::size_t begin_ = 0, unsent_ = 0, sent_ = 0, probed_ = 0;
    std::size_t before_ = 0;  // bytes of earlier answers in the socket's buffer
    bool ended_ = false, broken_ = false;
    // Time in which the socket took nothing more.
    bool blocked_ = false;
    Clock::time_point blocked_since_;
    Clock::duration waited_{};
    // At the last call of client_is_slow().
    Clock::duration counted_wait_{};
    double counted_bytes_ = 0;
    /// Waiting time that the client has not made good by reading, at one of the two rates.
    struct Lag {
        std::chrono::duration<double> allowed, time{};
        double rate;  // bytes per second
    };
    Lag usual_, while_scarce_;
    Clock::time_point probe_at_;
    Clock::duration probe_interval_ = std::chrono::seconds(1);
};

}  // namespace vines::http
