#include "http/connection.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <new>
#include <utility>

#include "api/problem.hpp"
#include "http/problem_response.hpp"

namespace vines::http {

namespace {

using namespace std::chrono_literals;

// From the first byte of a head to its last.
constexpr auto head_time = 10s;
// For each so many bytes of a body, and its last ones.
constexpr auto body_time = 10s;
constexpr std::size_t body_step = 65536;

// Is always taken.
constexpr std::size_t small_body = 65536;

// What comes behind a last answer is read for so long and so much of it.
constexpr auto ending_time = 3s;
constexpr std::size_t most_dropped = 64 << 20;

// Of one client in one go, so that the others have their turn.
constexpr std::size_t in_one_go = 1 << 18;

constexpr std::string_view continue_line = "HTTP/1.1 100 Continue\r\n\r\n";

/// Without waiting: the number of bytes, 0 at the end, nothing where there are none.
std::optional<std::size_t> receive(int socket, char* data, std::size_t size) {
    const ssize_t n = ::recv(socket, data, size, MSG_DONTWAIT);
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return std::nullopt;
    return 0;
}

void send_continue(int socket) {
    // As the first bytes of an answer they find room.
    static_cast<void>(
        ::send(socket, continue_line.data(), continue_line.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
}

}  // namespace

Connection::Connection(
    int socket, std::string client, const Admission& admission, HeldMemory& memory)
    : socket_(socket),
      client_(std::move(client)),
      admission_(admission),
      held_(memory),
      since_(Clock::now()),
      deadline_(since_ + head_time) {}

Connection::~Connection() { ::close(socket_); }

Connection::Progress Connection::advance() {
    try {
        const Progress progress = read_on();
        if (progress == Progress::complete) complete_since_ = Clock::now();
        return progress;
    } catch (const std::bad_alloc&) {  // of this one's bytes: the others go on
        bytes_ = {};
        return Progress::ended;
    }
}

Connection::Progress Connection::read_on() {
    std::array<char, 65536> piece;
    std::size_t taken = 0;
    for (;;) {
        const Progress progress = read_request();
        if (progress != Progress::waits || taken >= in_one_go) return progress;
        if (half_closed_) return Progress::ended;
        const std::optional<std::size_t> size = receive(socket_, piece.data(), piece.size());
        if (!size) return Progress::waits;
        half_closed_ = *size == 0;
        if (bytes_.empty() && !half_closed_ && !head_) begin_request();
        bytes_.append(piece.data(), *size);
        held_.set(bytes_.capacity());
        if (head_ && bytes_.size() >= expected_) expect_more();
        taken += *size;
    }
}

/// Of what has come.
Connection::Progress Connection::read_request() {
    if (refused_) return Progress::complete;
    try {
        if (!head_ && !bytes_.empty() && reader_.read(bytes_)) begin_body();
    } catch (const api::Problem& problem) {
        refuse(problem_response(problem));
    }
    if (!refused_ && has_no_room()) refused_ = memory_refusal();
    if (refused_) return Progress::complete;
    const bool whole = head_ && bytes_.size() >= head_->content_length;
    return whole ? Progress::complete : Progress::waits;
}

/// For a large body: small ones are bounded by the number of connections.
bool Connection::has_no_room() const {
    return head_ && head_->content_length > small_body && held_.memory().is_full();
}

void Connection::begin_request() {
    since_ = Clock::now();
    deadline_ = since_ + head_time;
}

void Connection::begin_waiting() {
    since_ = Clock::now();
    deadline_ = since_ + (bytes_.empty() ? Clock::duration(idle_time) : head_time);
    hold(0);
}

void Connection::begin_body() {
    head_ = reader_.take();
    bytes_.erase(0, reader_.size());
    Admitted admitted = admission_(*head_);
    route_ = admitted.route;
    refused_ = std::move(admitted.refused);
    if (refused_ || bytes_.size() >= head_->content_length) return;
    expect_more();
    if (head_->expects_continue) send_continue(socket_);
}

/// Of a body, in time.
void Connection::expect_more() {
    expected_ = bytes_.size() + body_step;
    deadline_ = Clock::now() + body_time;
}

void Connection::refuse(Response refusal) {
    refused_ = std::move(refusal);
    if (!head_) head_ = reader_.take();
    complete_since_ = Clock::now();
}

Exchange Connection::take() {
    Exchange exchange;
    exchange.since = complete_since_;
    if (refused_) {
        exchange.refused = std::exchange(refused_, {});
        bytes_.clear();
    }
    exchange.head = std::move(*std::exchange(head_, {}));
    exchange.route = std::exchange(route_, nullptr);
    const std::size_t length = exchange.refused ? 0 : exchange.head.content_length;
    // The large buffer goes with the body.
    std::string rest = bytes_.substr(length);
    bytes_.resize(length);
    exchange.body = std::exchange(bytes_, std::move(rest));
    reader_ = HeadReader();
    served_ = true;
    return exchange;
}

void Connection::begin_ending() {
    ending_ = true;
    bytes_ = {};
    hold(0);
    if (broken_) {
        const linger reset{1, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
    } else {
        ::shutdown(socket_, SHUT_WR);
    }
    deadline_ = Clock::now() + (broken_ ? Clock::duration(0) : ending_time);
}

bool Connection::has_ended() {
    if (broken_) return true;
    std::array<char, 65536> piece;
    for (std::size_t taken = 0; taken < in_one_go;) {
        const std::optional<std::size_t> size = receive(socket_, piece.data(), piece.size());
        if (!size) return false;
        taken += *size;
        dropped_ += *size;
        if (*size == 0 || dropped_ > most_dropped) return true;
    }
    return false;
}

Connection::Presence Connection::presence() const {
    pollfd state{socket_, POLLIN | POLLRDHUP, 0};
    if (::poll(&state, 1, 0) <= 0) return Presence::there;
    if (state.revents & (POLLERR | POLLHUP | POLLNVAL)) return Presence::left;
    return state.revents & POLLRDHUP ? Presence::in_doubt : Presence::there;
}

}  // namespace vines::http
