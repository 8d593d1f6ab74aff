#include "http/connection.hpp"

#include <sys/socket.h>

namespace vines::http {

namespace {

using namespace std::chrono_literals;

// Time from the first byte of a head to its last.
constexpr auto head_time = 10s;
// Time for each further step of a body, and of a large one while memory is scarce.
constexpr auto body_time = 10s, scarce_body_time = 2s;
constexpr std::size_t body_step = 65536;

// Bodies up to this size, in bytes, are accepted even when the memory budget is used up; as much is
// read of a larger one before it is known whether there is memory.
constexpr std::size_t small_body = 4096;
// Larger ones wait for memory only before they are read: parts of many could wait for each other.
constexpr std::size_t usual_body = 4 << 20;

// Lingering close: longest time, and most bytes discarded.
constexpr auto lingering_time = 3s;
constexpr std::size_t max_dropped = 64 << 20;

// Bytes read from one client before the others get their turn.
constexpr std::size_t max_read = 1 << 18;

constexpr std::string_view continue_line = "HTTP/1.1 100 Continue\r\n\r\n";

/// Returns the number of bytes, 0 at the end or on an error, nothing if none have arrived.
std::optional<std::size_t> receive(int socket, char* data, std::size_t size) {
    const ssize_t n = ::recv(socket, data, size, MSG_DONTWAIT);
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return std::nullopt;
    return 0;
}

}  // namespace

Connection::Connection(int socket, std::string peer, RequestHandler& handler, MemoryBudget& memory)
    : socket_(socket),
      peer_(std::move(peer)),
      owner_(owner_of(peer_)),
      handler_(handler),
      memory_(memory) {
    wait_for_head(head_time);
}

Connection::~Connection() {
    if (delivery_) delivery_->outbox.cancel();
    memory_.count(held_, held_.client, {});
}

Connection::Progress Connection::advance() try {
    std::array<char, 65536> piece;
    for (std::size_t taken = 0;;) {
        const Progress progress = read_request();
        if (progress == Progress::complete) request_->since = Clock::now();
        if (progress != Progress::waits || taken >= max_read || awaits_memory_) return progress;
        if (half_closed_) return Progress::ended;
        const std::size_t most = request_ ? piece.size() : small_body;
        const std::optional<std::size_t> size = receive(socket(), piece.data(), most);
        if (!size) return Progress::waits;
        half_closed_ = *size == 0;
        if (bytes_.empty() && !half_closed_ && !request_) wait_for_head(head_time);
        if (request_ && bytes_.size() + *size > bytes_.capacity()) {
            std::string larger;  // reserve() of a text that has bytes doubles its capacity
            larger.reserve(std::min(body_size(), 2 * (bytes_.size() + *size)));
            bytes_.swap(larger.append(bytes_));
        }
        bytes_.append(piece.data(), *size);
        hold_received();
        if (request_ && bytes_.size() >= expected_) expect_more();
        taken += *size;
    }
} catch (const std::bad_alloc&) {  // only this connection fails
    bytes_ = {};
    return Progress::ended;
}

Connection::Progress Connection::read_request() {
    try {
        if (!request_ && !bytes_.empty() && reader_.read(bytes_)) begin_body();
    } catch (const api::Problem& problem) {
        refuse(problem_response(problem));
    }
    if (!request_) return Progress::waits;
    const auto is_whole = [this] { return request_->refused || bytes_.size() >= body_size(); };
    // The number of connections bounds the small ones.
    if (!is_whole() && body_size() > small_body) {
        const std::size_t held = bytes_.capacity();
        const bool lacks = memory_.is_full_for(client(), {std::max(body_size(), held) - held});
        const bool may_wait = bytes_.size() <= small_body || body_size() <= usual_body;
        const bool waited = std::exchange(awaits_memory_, lacks && may_wait);
        if (lacks && !awaits_memory_) request_->refused = memory_refusal();
        if (awaits_memory_ && !waited) deadline_ = Clock::now() + longest_wait_for_memory;
        if (waited && !lacks) expect_more();
    }
    return is_whole() ? Progress::complete : Progress::waits;
}

Connection::Clock::time_point Connection::deadline(bool memory_is_scarce) const {
    const bool is_large = request_ && !delivery_ && body_size() > small_body;
    return memory_is_scarce && is_large ? deadline_ - (body_time - scarce_body_time) : deadline_;
}

void Connection::wait_for_head(Clock::duration time) {
    waiting_since_ = Clock::now();
    deadline_ = waiting_since_ + time;
}

void Connection::begin_request() {
    request_.emplace();
    request_->head = reader_.take();
    request_->sender.address = peer_;
}

void Connection::begin_body() {
    begin_request();
    bytes_.erase(0, reader_.size());
    handler_.check_head(*request_, peer_);
    if (request_->refused || bytes_.size() >= body_size()) return;
    expect_more();
    // A client that waits for this has read the answers before: it fits into the socket's buffer.
    if (request_->head.expects_continue)
        static_cast<void>(::send(
            socket(), continue_line.data(), continue_line.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
}

void Connection::expect_more() {
    expected_ = bytes_.size() + body_step;
    deadline_ = Clock::now() + body_time;
}

void Connection::refuse(Response refusal) {
    if (!request_) begin_request();
    request_->refused = std::move(refusal);
    request_->since = Clock::now();
}

Request Connection::take() {
    const std::size_t length = request_->refused ? 0 : body_size();
    if (request_->refused) bytes_.clear();
    // Moves the large buffer out with the body.
    std::string rest = bytes_.substr(length);
    bytes_.resize(length);
    request_->body = std::exchange(bytes_, std::move(rest));
    reader_ = HeadReader();
    served_ = true;
    awaits_memory_ = false;
    return *std::exchange(request_, {});
}

void Connection::deliver(std::size_t max_bytes) {
    const Outbox::State state = outbox().send(max_bytes);
    if (state == Outbox::State::open) return;
    const std::shared_ptr<Delivery> delivery = std::exchange(delivery_, {});
    handler_.finish(delivery, state);
    aborted_ = state == Outbox::State::broken;
    if (!delivery->keep_alive || aborted_) return begin_closing();
    wait_for_head(bytes_.empty() ? Clock::duration(idle_time) : head_time);
    hold_received();
}

void Connection::begin_closing() {
    closing_ = true;
    bytes_ = {};
    hold_received();
    if (aborted_) {
        const linger reset{1, 0};
        ::setsockopt(socket(), SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
    } else {
        ::shutdown(socket(), SHUT_WR);
    }
    deadline_ = Clock::now() + (aborted_ ? Clock::duration(0) : lingering_time);
}

bool Connection::finish_closing() {
    if (aborted_) return true;
    std::array<char, 65536> piece;
    for (std::size_t taken = 0; taken < max_read;) {
        const std::optional<std::size_t> size = receive(socket(), piece.data(), piece.size());
        if (!size) return false;
        taken += *size;
        dropped_ += *size;
        if (*size == 0 || dropped_ > max_dropped) return true;
    }
    return false;
}

}  // namespace vines::http
