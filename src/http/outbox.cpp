#include "http/outbox.hpp"

#include <linux/sockios.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <utility>

namespace vines::http {

namespace {

using namespace std::chrono_literals;

// Unsent bytes of a stream beyond which its computation waits.
constexpr std::size_t capacity = 1 << 18;

// Smaller parts are joined.
constexpr std::size_t usual_part = 65536;

// Parts sent with one system call.
constexpr std::size_t max_parts = 16;

// Every answer begins with these bytes.
constexpr std::string_view status_line_begin = "HTTP/1.1 ";

}  // namespace

// A client slower than this would hold memory, a thread or a sweep's place for nothing.
Outbox::Outbox(int socket)
    : socket_(socket),
      usual_{.allowed = 30s, .rate = 8192},
      while_scarce_{.allowed = 2s, .rate = 65536} {
    before_ = queued();
}

bool Outbox::client_has_left() {
    pollfd state{socket_, POLLRDHUP, 0};
    if (::poll(&state, 1, 0) <= 0) return false;
    if (state.revents & (POLLERR | POLLHUP | POLLNVAL)) return true;
    if (state.revents & POLLRDHUP) probe();
    return false;
}

/// Sends the next byte of the answer's beginning; the interval doubles each time. At most half of
/// the work for a client that has left is then wasted, and the nine bytes last for minutes.
void Outbox::probe() {
    const auto now = Clock::now();
    if (probed_ == status_line_begin.size() || now < probe_at_) return;
    const char* const byte = status_line_begin.data() + probed_;
    if (::send(socket_, byte, 1, MSG_DONTWAIT | MSG_NOSIGNAL) == 1) ++probed_;
    probe_at_ = now + probe_interval_;
    probe_interval_ *= 2;
}

void Outbox::add(std::string bytes) {
    const std::lock_guard lock(mutex_);
    if (sent_ < probed_) {  // the start of the first part
        bytes.erase(0, probed_);
        sent_ = probed_;
    }
    if (bytes.empty()) return;
    unsent_ += bytes.size();
    expect(unsent_);
    if (!parts_.empty() && parts_.back().size() + bytes.size() <= usual_part)
        parts_.back() += bytes;
    else parts_.push_back(std::move(bytes));
}

void Outbox::expect(std::size_t bytes) {
    while_scarce_.rate = std::max(while_scarce_.rate, static_cast<double>(bytes) / 30);  // 30 s
}

void Outbox::end(bool whole) {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    broken_ = broken_ || !whole;
}

bool Outbox::wait_for_space() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return broken_ || unsent_ <= capacity; });
    return !broken_;
}

Outbox::State Outbox::send(std::size_t max_bytes) {
    const std::lock_guard lock(mutex_);
    const std::size_t sent_before = sent_;
    while (unsent_ > 0 && !broken_ && sent_ - sent_before < max_bytes) {
        std::array<iovec, max_parts> pieces;
        std::size_t n = 0;
        for (auto part = parts_.begin(); part != parts_.end() && n < pieces.size(); ++part, ++n)
            pieces[n] = {part->data(), part->size()};
        pieces[0] = {parts_.front().data() + begin_, parts_.front().size() - begin_};
        msghdr message{};
        message.msg_iov = pieces.data();
        message.msg_iovlen = n;
        const ssize_t taken = ::sendmsg(socket_, &message, MSG_DONTWAIT | MSG_NOSIGNAL);
        const auto now = Clock::now();
        if (std::exchange(blocked_, false)) waited_ += now - blocked_since_;
        if (taken >= 0) drop_sent(static_cast<std::size_t>(taken));
        else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            blocked_ = true;
            blocked_since_ = now;
            break;
        } else if (errno != EINTR) broken_ = true;
    }
    if (broken_ || unsent_ <= capacity) changed_.notify_all();
    if (broken_) return State::broken;
    return ended_ && unsent_ == 0 ? State::sent : State::open;
}

void Outbox::cancel() {
    const std::lock_guard lock(mutex_);
    broken_ = true;
    changed_.notify_all();
}

bool Outbox::client_is_slow(Clock::time_point now, bool scarce) {
    const std::lock_guard lock(mutex_);
    const auto wait = waited_ + (blocked_ ? now - blocked_since_ : Clock::duration(0));
    // Bytes that the client's system has received: those in the socket's buffer are not read yet.
    const std::size_t all = before_ + sent_;
    const auto bytes = static_cast<double>(all - std::min(all, queued()));
    const std::chrono::duration<double> waited = wait - std::exchange(counted_wait_, wait);
    const double read = bytes - std::exchange(counted_bytes_, bytes);
    for (Lag* lag : {&usual_, &while_scarce_}) {
        // Bytes read in advance give no credit: they can lie unread in the client's system.
        lag->time += waited - std::chrono::duration<double>(read / lag->rate);
        lag->time = std::max(lag->time, std::chrono::duration<double>(0));
    }
    if (!scarce) while_scarce_.time = {};
    const Lag& lag = scarce ? while_scarce_ : usual_;
    return lag.time > lag.allowed;
}

/// Bytes in the socket's buffer that the client has not acknowledged.
std::size_t Outbox::queued() const {
    int bytes = 0;
    return ::ioctl(socket_, SIOCOUTQ, &bytes) == 0 ? static_cast<std::size_t>(bytes) : 0;
}

bool Outbox::can_send_more() const {
    const std::lock_guard lock(mutex_);
    return unsent_ > 0 && !blocked_ && !broken_;
}

bool Outbox::is_lost(bool by_closing) const {
    const std::lock_guard lock(mutex_);
    pollfd state{socket_, POLLRDHUP, 0};
    return broken_ || (by_closing && ::poll(&state, 1, 0) > 0);
}

std::size_t Outbox::sent() const {
    const std::lock_guard lock(mutex_);
    return sent_;
}

void Outbox::drop_sent(std::size_t bytes) {
    sent_ += bytes;
    unsent_ -= bytes;
    begin_ += bytes;
    while (!parts_.empty() && begin_ >= parts_.front().size()) {
        begin_ -= parts_.front().size();
        parts_.pop_front();
    }
}

}  // namespace vines::http
