#include "http/socket_stream.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace vines::http {

namespace {

// A client that reads slower than this, beside its patience, holds a thread for nothing; where
// others wait for the thread, so does a faster one.
constexpr double slowest_reader = 8192, slowest_of_many = 65536;  // bytes per second

// Then the patience is shorter, too. That is looked for so often.
constexpr std::chrono::milliseconds hurried_time(2000), look(500);

// Of every answer, whatever it will be.
constexpr std::string_view begin_of_answer = "HTTP/1.1 ";

}  // namespace

ssize_t SocketStream::read(char* data, std::size_t size) {
    const std::size_t n = std::min(size, head_.size() - read_);
    std::memcpy(data, head_.data() + read_, n);
    read_ += n;
    return static_cast<ssize_t>(n);
}

ssize_t SocketStream::write(const char* data, std::size_t size) {
    if (!began_) {
        began_ = true;
        kept_.assign(data, size);
        kept_.erase(0, written_);  // has been sent to ask
        return static_cast<ssize_t>(size);
    }
    const bool sent = send(kept_, {data, size});
    kept_.clear();
    return sent ? static_cast<ssize_t>(size) : -1;
}

bool SocketStream::finish() {
    const bool sent = send(kept_, {});
    kept_.clear();
    return sent;
}

bool SocketStream::has_left() {
    const Connection::Presence presence = connection_.presence();
    if (presence == Connection::Presence::in_doubt) ask();
    return presence == Connection::Presence::left;
}

/// After twice the time each time: of what is computed for a client that leaves late a half is for
/// nothing at most, and the bytes that there are last for minutes.
void SocketStream::ask() {
    const auto now = std::chrono::steady_clock::now();
    if (began_ || written_ == begin_of_answer.size() || now < asks_at_) return;
    const char* const byte = begin_of_answer.data() + written_;
    if (::send(connection_.socket(), byte, 1, MSG_DONTWAIT | MSG_NOSIGNAL) == 1) ++written_;
    asks_at_ = now + until_next_;
    until_next_ *= 2;
}

bool SocketStream::send(std::string_view first, std::string_view second) {
    while (!broken_ && !(first.empty() && second.empty())) {
        const auto part = [](std::string_view text) {
            return iovec{const_cast<char*>(text.data()), text.size()};
        };
        std::array<iovec, 2> parts{part(first), part(second)};
        msghdr message{};
        message.msg_iov = parts.data();
        message.msg_iovlen = parts.size();
        const ssize_t n = ::sendmsg(connection_.socket(), &message, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (n >= 0) {
            const auto sent = static_cast<std::size_t>(n);
            written_ += sent;
            const std::size_t of_first = std::min(sent, first.size());
            first.remove_prefix(of_first);
            second.remove_prefix(sent - of_first);
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) broken_ = !wait_for_room();
        else broken_ = errno != EINTR;
    }
    return !broken_;
}

/// How long the client may still keep from reading: all in all, so that one that reads a byte now
/// and then gains nothing by it.
std::chrono::milliseconds SocketStream::patience_left() const {
    const bool hurried = patience_.hurried();
    const auto time = hurried ? std::min(patience_.time, hurried_time) : patience_.time;
    const std::chrono::duration<double> earned(
        static_cast<double>(written_) / (hurried ? slowest_of_many : slowest_reader));
    return std::chrono::ceil<std::chrono::milliseconds>(time + earned - waited_);
}

bool SocketStream::wait_for_room() {
    using Clock = std::chrono::steady_clock;
    for (;;) {
        const std::chrono::milliseconds left = patience_left();
        if (left.count() <= 0 || patience_.time.count() == 0) return false;
        const Clock::time_point began = Clock::now();
        pollfd state{connection_.socket(), POLLOUT, 0};
        const int ready = ::poll(&state, 1, static_cast<int>(std::min(left, look).count()));
        waited_ += Clock::now() - began;
        if (ready > 0) return !(state.revents & (POLLERR | POLLHUP));
        if (ready < 0 && errno != EINTR) return false;
    }
}

}  // namespace vines::http
