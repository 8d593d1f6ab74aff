// One client's connection: the bytes that have come, as one request after the other.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "http/head.hpp"
#include "http/held_memory.hpp"
#include "http/message.hpp"
#include "http/route.hpp"

namespace vines::http {

/// A request that is there as a whole, or what is wrong with it: then nothing that comes behind it
/// is read.
struct Exchange {
    Head head;
    std::string body;
    const Route* route = nullptr;  ///< of one that is not refused
    std::optional<Response> refused = {};
    std::chrono::steady_clock::time_point since = {};  ///< it was complete
};

/// What is said of a request by its head alone, before its body is read: what is wrong with it, or
/// the route that takes it, and a body as long as the head says.
struct Admitted {
    const Route* route = nullptr;
    std::optional<Response> refused = {};
};
using Admission = std::function<Admitted(const Head&)>;

// From one request to the next.
inline constexpr std::chrono::seconds idle_time(60);

/// Used by one thread at a time.
class Connection {
public:
    using Clock = std::chrono::steady_clock;

    /// Takes over a socket that does not block. The others outlive it.
    /// client: its address, for the log.
    Connection(int socket, std::string client, const Admission& admission, HeldMemory& memory);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    enum class Progress {
        waits,     ///< for more bytes
        complete,  ///< a request can be taken
        ended      ///< by the client, with no request that is whole
    };
    /// Reads what is there, some of it at most, and waits for nothing.
    Progress advance();
    /// Whether the complete request is answered however busy the server is.
    bool is_light() const { return refused_ || route_->light; }
    /// The complete request; its bytes are forgotten.
    Exchange take();
    /// Makes what has come of a request one that is refused, which can be taken.
    void refuse(Response refusal);

    /// When it is given up unless something comes to its end before: a head, a body, or the
    /// client's last bytes.
    Clock::time_point deadline() const { return deadline_; }
    /// Whether nothing of a request has come.
    bool is_idle() const { return bytes_.empty() && !head_ && !is_ending(); }
    /// Whether it has had its answers, and nothing has come since.
    bool is_spare() const { return is_idle() && served_; }
    /// Since it waits for what it waits for.
    Clock::time_point since() const { return since_; }
    /// Its answer is sent: now it may wait for another request.
    void begin_waiting();

    /// Its answer could not be sent as a whole: it will end with a reset, so that nobody takes a
    /// part for the whole.
    void break_off() { broken_ = true; }
    /// No answer follows. What its client still sends is read and dropped for a while: closed on
    /// bytes that nobody read, a connection is reset, and the client may never see its answer.
    void begin_ending();
    bool is_ending() const { return ending_; }
    /// Reads and drops; true once the client is done, too, or has sent too much.
    bool has_ended();

    enum class Presence {
        there,
        in_doubt,  ///< the client has closed its own side: it may still read, or have left
        left       ///< it has reset the connection
    };
    Presence presence() const;

    int socket() const { return socket_; }
    const std::string& client() const { return client_; }

    /// So many bytes of an answer are held for it, beside those that it has received.
    void hold(std::size_t bytes) { held_.set(bytes + bytes_.capacity()); }

private:
    Progress read_on();
    Progress read_request();
    bool has_no_room() const;
    void begin_request();
    void begin_body();
    void expect_more();

    const int socket_;
    const std::string client_;
    const Admission& admission_;
    HeldBytes held_;
    std::string bytes_;  // received, and not yet taken
    HeadReader reader_;
    std::optional<Head> head_;  // complete; what follows is its body
    const Route* route_ = nullptr;
    Clock::time_point complete_since_;
    std::size_t expected_ = 0;  // bytes of it, before the deadline
    std::optional<Response> refused_;
    bool half_closed_ = false;  // the client sends no more
    bool ending_ = false, broken_ = false, served_ = false;
    std::size_t dropped_ = 0;
    Clock::time_point since_, deadline_;
};

}  // namespace vines::http
