#include "http/connections.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "http/problem_response.hpp"

namespace vines::http {

namespace {

using namespace std::chrono_literals;

// How often what takes too long is looked for.
constexpr auto between_looks = 250ms;

// A client that goes on at once is waited for by the worker that answered it, which is cheaper than
// to give its connection back and forth.
constexpr int soon = 1;  // ms

// The same client's turn ends after so many answers.
constexpr int most_in_turn = 16;

// A client that does not read for so long is given up.
constexpr auto write_patience = 30s;

// After stop() what a client has just sent on a connection that was idle is still answered.
constexpr auto last_call = 300ms;

void add(int poll, int socket) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = socket;
    ::epoll_ctl(poll, EPOLL_CTL_ADD, socket, &event);
}

/// As many as this process may have, after asking for the most, less some for everything else.
std::size_t files_for_connections() {
    constexpr std::size_t others = 64;
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &limit);
    ::getrlimit(RLIMIT_NOFILE, &limit);
    return limit.rlim_cur > 2 * others ? limit.rlim_cur - others : others;
}

std::string numeric(const sockaddr* address, socklen_t size) {
    std::array<char, NI_MAXHOST> text{};
    ::getnameinfo(address, size, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST);
    return text.data();
}

void remove(int poll, int socket) { ::epoll_ctl(poll, EPOLL_CTL_DEL, socket, nullptr); }

}  // namespace

Connections::Connections(int listening, const ConnectionLimits& limits, Answering answering)
    : listening_(listening),
      answering_(std::move(answering)),
      most_connections_(std::min(limits.connections, files_for_connections())),
      poll_(::epoll_create1(EPOLL_CLOEXEC)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      memory_(limits.held_bytes),
      workers_(limits.workers, limits.waiting, [this](Owned connection) {
          work(std::move(connection));
      }) {
    ::fcntl(listening_, F_SETFL, ::fcntl(listening_, F_GETFL) | O_NONBLOCK);
    add(poll_, wake_);
    listen(true);
}

Connections::~Connections() {
    ::close(poll_);
    ::close(wake_);
}

void Connections::run() {
    while (!is_done()) {
        wait();
        take_back();
        if (Clock::now() - looked_ >= between_looks || stopping_) expire();
    }
}

void Connections::stop() {
    stopping_ = true;
    wake();
}

void Connections::wake() const {
    const std::uint64_t one = 1;
    static_cast<void>(!::write(wake_, &one, sizeof one));
}

void Connections::wait() {
    std::array<epoll_event, 256> events;
    const int n = ::epoll_wait(
        poll_, events.data(), events.size(),
        again_.empty() ? static_cast<int>((stopping_ ? 20ms : between_looks).count()) : 0);
    for (int i = 0; i < n; ++i) {
        const int socket = events[static_cast<std::size_t>(i)].data.fd;
        if (socket == listening_) accept_all();
        else if (socket == wake_) {
            std::uint64_t count = 0;
            static_cast<void>(!::read(wake_, &count, sizeof count));
        } else look_at(socket);
    }
    for (const int socket : std::exchange(again_, {})) look_at(socket);
}

void Connections::listen(bool on) {
    if (on == listens_) return;
    on ? add(poll_, listening_) : remove(poll_, listening_);
    listens_ = on;
}

/// Those that have connected. Beyond the limit another one makes room.
void Connections::accept_all() {
    for (;;) {
        const bool full = number_ + static_cast<std::size_t>(in_work_) >= most_connections_;
        Connection* const other = full ? dispensable() : nullptr;
        if (full && !other) return listen(false);
        sockaddr_storage address{};
        socklen_t size = sizeof address;
        auto* const peer = reinterpret_cast<sockaddr*>(&address);
        const int socket = ::accept4(listening_, peer, &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (socket < 0 && (errno == EINTR || errno == ECONNABORTED)) continue;
        if (socket < 0 && errno != EAGAIN) return listen(false);  // for lack of files or memory
        if (socket < 0) return;
        if (other) release(other->socket());
        const int yes = 1;
        ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        keep(std::make_unique<Connection>(
            socket, numeric(peer, size), answering_.admission, memory_));
    }
}

/// The one whose end harms least: one that has had its answers and is idle, else the one that waits
/// for its own client for longest. One that is quick is never long among them, so that a flood
/// closes its own.
Connection* Connections::dispensable() const {
    Connection* chosen = nullptr;
    const auto before = [](const Connection& a, const Connection& b) {
        if (a.is_spare() != b.is_spare()) return a.is_spare();
        return a.since() < b.since();
    };
    for (const Owned& c : kept_)
        if (c && (!chosen || before(*c, *chosen))) chosen = c.get();
    return chosen;
}

void Connections::keep(Owned connection) {
    const int socket = connection->socket();
    if (kept_.size() <= static_cast<std::size_t>(socket))
        kept_.resize(static_cast<std::size_t>(socket) + 1);
    kept_[static_cast<std::size_t>(socket)] = std::move(connection);
    ++number_;
    add(poll_, socket);
}

Connections::Owned Connections::release(int socket) {
    remove(poll_, socket);
    --number_;
    return std::move(kept_[static_cast<std::size_t>(socket)]);
}

void Connections::look_at(int socket) {
    const Owned& kept = kept_[static_cast<std::size_t>(socket)];
    if (!kept) return;  // closed since the event
    if (!kept->is_ending()) read(*kept);
    else if (kept->has_ended()) release(socket);
}

void Connections::read(Connection& connection) {
    for (int n = 0;; ++n) {
        switch (connection.advance()) {
            case Connection::Progress::waits: return;
            case Connection::Progress::ended: release(connection.socket()); return;
            case Connection::Progress::complete: break;
        }
        if (!connection.is_light()) return hand_over(release(connection.socket()));
        if (n >= most_in_turn) return again_.push_back(connection.socket());
        answer_here(connection, connection.take());
        if (connection.is_ending()) return;
    }
}

void Connections::hand_over(Owned connection) {
    ++in_work_;
    if (workers_.add(connection)) return;
    --in_work_;
    connection->refuse(answering_.overloaded());
    answer_here(*connection, connection->take());
    keep(std::move(connection));
}

/// It is small, so that the socket takes it at once, or its client has not read those before.
void Connections::answer_here(Connection& connection, Exchange exchange) {
    const auto never = [] { return false; };
    if (answering_.answer(connection, std::move(exchange), {0ms, never}))
        connection.begin_waiting();
    else connection.begin_ending();
}

void Connections::take_back() {
    std::vector<Owned> returned;
    {
        const std::lock_guard lock(mutex_);
        returned.swap(returned_);
    }
    for (Owned& connection : returned) {
        --in_work_;
        keep(std::move(connection));
    }
}

void Connections::expire() {
    const Clock::time_point now = looked_ = Clock::now();
    if (stopping_ && !closing_) {
        closing_ = true;
        accept_all();  // those that the system has accepted already
        listen(false);
        ::shutdown(listening_, SHUT_RDWR);
        idle_until_ = now + last_call;
    }
    for (const Owned& c : kept_)
        if (c && now > (c->is_ending() ? c->deadline() : std::min(c->deadline(), idle_until_)))
            give_up(*c);
    if (!stopping_) listen(true);
}

void Connections::give_up(Connection& connection) {
    if (connection.is_idle() || connection.is_ending()) {
        release(connection.socket());
        return;
    }
    connection.refuse(
        stopping_ ? stopping_refusal()
                  : problem_response(408, "the request did not come to its end in time"));
    answer_here(connection, connection.take());
}

bool Connections::is_done() const { return closing_ && number_ == 0 && in_work_ == 0; }

void Connections::work(Owned connection) {
    for (;;) {
        const Patience patience{write_patience, [this] { return workers_.wanted(); }};
        if (!answering_.answer(*connection, connection->take(), patience)) {
            connection->begin_ending();
            break;
        }
        connection->begin_waiting();
        Connection::Progress progress = connection->advance();
        if (progress == Connection::Progress::waits && is_there_soon(*connection))
            progress = connection->advance();
        if (progress == Connection::Progress::ended) connection->begin_ending();
        if (progress != Connection::Progress::complete) break;
        // Others have waited longer.
        if (workers_.wanted() && workers_.add(connection)) return;
    }
    give_back(std::move(connection));
}

bool Connections::is_there_soon(Connection& connection) {
    pollfd state{connection.socket(), POLLIN, 0};
    return !workers_.wanted() && ::poll(&state, 1, soon) > 0;
}

void Connections::give_back(Owned connection) {
    {
        const std::lock_guard lock(mutex_);
        returned_.push_back(std::move(connection));
    }
    wake();
}

}  // namespace vines::http
