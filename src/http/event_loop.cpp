#include "http/event_loop.hpp"

#include <netdb.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>

namespace vines::http {

namespace {

using namespace std::chrono_literals;

constexpr auto expiry_interval = 250ms;

// Time for which a worker waits for a client's next request, in ms: cheaper than to return the
// connection to the event loop and get it back.
constexpr int next_request_wait = 1;

// Answers to one client in a row, and the time for them; then the others get their turn. Turns of
// all clients take 200 ms, or one answer each.
constexpr int max_answers_in_row = 16;
constexpr auto longest_turn = 1ms, all_turns = 200ms;

// Time for turns before new connections and other clients are looked for.
constexpr auto round_time = 5ms;

// Time for which a resource counts as scarce after a refusal for lack of it: longer than the pause
// that a slow reader may then make, and than Retry-After (1 s).
constexpr auto scarce_time = 4s;

// Connections accepted before the open ones get their turn: at the limit a search for another one
// to close goes before each.
constexpr int max_accepted = 32;

// Time in which a new connection is not closed for others whose client has more, all at work.
constexpr auto time_of_new = 1s;

// Bytes of requests and answers, or requests at work, from which on free memory is returned to the
// system once nothing is left to do.
constexpr std::size_t much_held = 16 << 20, many_at_work = 8;

// Bytes sent to one client before the others get their turn.
constexpr std::size_t max_sent = 1 << 20;

// Unsent bytes of one client in the kernel, in addition to those on their way.
constexpr int unsent_in_kernel = 1 << 17;

// Time after stop() in which requests on idle connections are still answered.
constexpr auto drain_time = 300ms;

/// Raises the limit of open files as far as possible and returns it, less some for other files.
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

}  // namespace

EventLoop::EventLoop(
    Descriptor listening, const ConnectionLimits& limits, Networks proxies, RequestHandler& handler)
    : handler_(handler),
      max_connections_(std::min(limits.connections, files_for_connections())),
      max_per_client_(limits.per_client),
      proxies_(std::move(proxies)),
      listening_(std::move(listening)),
      poll_(::epoll_create1(EPOLL_CLOEXEC)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      memory_(limits.held_bytes),
      workers_(limits.workers, [this](Owned connection) { work(std::move(connection)); }) {
    ::fcntl(listening_.number(), F_SETFL, ::fcntl(listening_.number(), F_GETFL) | O_NONBLOCK);
    change_events(EPOLL_CTL_ADD, wake_.number(), EPOLLIN);
    listen(true);
}

void EventLoop::run() {
    while (!closing_ || count_ > 0 || with_workers_ > 0) {
        wait();
        collect_returned();
        if (Clock::now() - checked_ >= expiry_interval || stopping_) expire();
    }
}

void EventLoop::stop() {
    stopping_ = true;
    wake();
}

void EventLoop::wake() const {
    const std::uint64_t one = 1;
    static_cast<void>(!::write(wake_.number(), &one, sizeof one));
}

void EventLoop::wait() {
    std::array<epoll_event, 256> events;
    const int n = ::epoll_wait(
        poll_.number(), events.data(), events.size(),
        ready_.empty() ? static_cast<int>((stopping_ ? 20ms : expiry_interval).count()) : 0);
    bool is_new_one = false;
    for (int i = 0; i < n; ++i) {
        const epoll_event& event = events[static_cast<std::size_t>(i)];
        const int socket = event.data.fd;
        if (socket == listening_.number()) is_new_one = true;
        else if (socket == wake_.number()) {
            std::uint64_t count = 0;
            static_cast<void>(!::read(wake_.number(), &count, sizeof count));
        } else if (event.events & (EPOLLERR | EPOLLHUP)) handle(socket, true);
        else queue(socket);
    }
    // Last, since it can close one of these sockets and give its number to the new one.
    if (is_new_one) accept(max_accepted);
    const Clock::time_point until = Clock::now() + round_time;
    while (const std::optional<int> socket = ready_.pop()) {
        queued_.erase(*socket);
        handle(*socket);
        if (Clock::now() > until) break;
    }
}

/// Lets a connection take its turn among those of its owner; the owners take turns.
void EventLoop::queue(int socket) {
    const Owned& connection = connections_[static_cast<std::size_t>(socket)];
    if (connection && queued_.insert(socket).second) ready_.push(connection->owner(), socket);
}

void EventLoop::change_events(int operation, int socket, std::uint32_t events) const {
    epoll_event event{.events = events, .data = {.fd = socket}};
    ::epoll_ctl(poll_.number(), operation, socket, &event);
}

/// Sets what is awaited of a connection: a request, or that the socket takes more of the answer;
/// the latter edge-triggered, since a stream can have nothing to send.
void EventLoop::await(int operation, const Connection& connection) const {
    change_events(
        operation, connection.socket(), connection.is_delivering() ? EPOLLOUT | EPOLLET : EPOLLIN);
}

void EventLoop::listen(bool on) {
    if (on == listens_) return;
    change_events(on ? EPOLL_CTL_ADD : EPOLL_CTL_DEL, listening_.number(), EPOLLIN);
    listens_ = on;
}

/// Accepts pending connections. Beyond the limit, or without a free file descriptor, another
/// connection is closed for each new one.
void EventLoop::accept(int most) {
    for (int n = 0; n < most; ++n) {
        const bool full = load().open >= max_connections_;
        Connection* other = full ? eviction_candidate() : nullptr;
        if (full && !other) {
            connections_scarce_ = Clock::now();
            return listen(false);
        }
        sockaddr_storage address{};
        socklen_t size = sizeof address;
        auto* const peer = reinterpret_cast<sockaddr*>(&address);
        const int socket =
            ::accept4(listening_.number(), peer, &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (socket < 0 && (errno == EINTR || errno == ECONNABORTED)) continue;
        if (socket < 0 && (errno == EMFILE || errno == ENFILE)) {
            pollfd pending{listening_.number(), POLLIN, 0};  // also without a pending one
            if (::poll(&pending, 1, 0) == 0) return;
            if ((other = eviction_candidate())) {
                close(other->socket());
                continue;
            }
            connections_scarce_ = Clock::now();
            return listen(false);
        }
        if (socket < 0 && errno != EAGAIN) return listen(false);  // out of memory
        if (socket < 0) return;
        auto connection =
            std::make_unique<Connection>(socket, numeric(peer, size), handler_, memory_);
        // Behind a proxy are many clients.
        if (open_[connection->owner()] >= max_per_client_ &&
            !contain(proxies_, connection->peer()) &&
            !(other = eviction_candidate(connection->owner())))
            continue;  // closes the new one
        if (other) close(other->socket());
        const int yes = 1;
        ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        ::setsockopt(
            socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &unsent_in_kernel, sizeof unsent_in_kernel);
        ++open_[connection->owner()];
        watch(std::move(connection));
    }
}

/// The connection that is closed first: of the client with most of them, unless it has only one or
/// all are at work; an idle keep-alive one, else the one that has waited longest for its client.
Connection* EventLoop::eviction_candidate() const {
    const auto most =
        std::ranges::max_element(open_, {}, [](const auto& client) { return client.second; });
    if (most != open_.end() && most->second > 1)
        if (Connection* const chosen = eviction_candidate(most->first)) return chosen;
    Connection* const any = eviction_candidate({});
    const bool is_new =
        any && !any->is_idle_keep_alive() && Clock::now() - any->waiting_since() < time_of_new;
    return is_new ? nullptr : any;
}

/// The same of one client; empty: of any.
Connection* EventLoop::eviction_candidate(const std::string& owner) const {
    Connection* chosen = nullptr;
    const auto before = [](const Connection& a, const Connection& b) {
        if (a.is_idle_keep_alive() != b.is_idle_keep_alive()) return a.is_idle_keep_alive();
        return a.waiting_since() < b.waiting_since();
    };
    for (const Owned& c : connections_)
        if (c && !c->is_delivering() && (owner.empty() || c->owner() == owner) &&
            (!chosen || before(*c, *chosen)))
            chosen = c.get();
    return chosen;
}

void EventLoop::watch(Owned connection) {
    const auto socket = static_cast<std::size_t>(connection->socket());
    if (connections_.size() <= socket) connections_.resize(socket + 1);
    Connection& watched = *(connections_[socket] = std::move(connection));
    ++count_;
    if (watched.is_delivering()) ++delivering_;
    await(EPOLL_CTL_ADD, watched);
}

EventLoop::Owned EventLoop::release(int socket) {
    change_events(EPOLL_CTL_DEL, socket, 0);
    --count_;
    return std::move(connections_[static_cast<std::size_t>(socket)]);
}

void EventLoop::close(int socket) {
    const Owned connection = release(socket);
    const auto open = open_.find(connection->owner());
    if (--open->second == 0) open_.erase(open);
}

void EventLoop::handle(int socket, bool failed) {
    const Owned& connection = connections_[static_cast<std::size_t>(socket)];
    if (!connection) return;  // closed after the event
    if (connection->is_delivering()) {
        if (failed) connection->outbox().cancel();
        deliver(*connection);
    } else if (failed && !connection->is_closing()) close(socket);
    else if (!connection->is_closing()) read(*connection);
    else if (connection->finish_closing()) close(socket);
}

void EventLoop::read(Connection& connection) {
    const Clock::time_point began = Clock::now();
    const auto turn = std::min<Clock::duration>(longest_turn, all_turns / (open_.size() + 1));
    for (int n = 0;; ++n) {
        switch (connection.advance()) {
            case Connection::Progress::waits:
                if (connection.awaits_memory())  // until expire()
                    change_events(EPOLL_CTL_MOD, connection.socket(), 0);
                return;
            case Connection::Progress::ended: close(connection.socket()); return;
            case Connection::Progress::complete: break;
        }
        if (!connection.is_answered_on_loop()) return hand_over(release(connection.socket()));
        if (n >= max_answers_in_row || Clock::now() - began > turn) {
            queue(connection.socket());
            return;
        }
        if (!answer_here(connection)) return;
    }
}

void EventLoop::hand_over(Owned connection) {
    most_at_work_ = std::max<std::size_t>(most_at_work_, ++with_workers_);
    const std::string client = connection->client();
    std::optional<Owned> refused = workers_.add(client, std::move(connection));
    if (!refused) return;
    --with_workers_;
    Connection& one = **refused;
    one.refuse(problem_response(api::Problem::unavailable(
        "threads", "all worker threads are busy and their queue is full")));
    watch(*std::move(refused));
    answer_here(one);
}

/// True if the connection waits for a next request.
bool EventLoop::answer_here(Connection& connection) {
    handler_.answer(connection, connection.take());
    ++delivering_;
    connection.deliver();
    if (connection.is_delivering()) await(EPOLL_CTL_MOD, connection);
    else --delivering_;
    return !connection.is_delivering() && !connection.is_closing();
}

void EventLoop::deliver(Connection& connection) {
    connection.deliver(max_sent);
    if (connection.is_delivering()) {
        if (connection.outbox().can_send_more()) queue(connection.socket());
        return;
    }
    --delivering_;
    await(EPOLL_CTL_MOD, connection);
    if (!connection.is_closing()) read(connection);
}

void EventLoop::collect_returned() {
    std::vector<std::pair<int, Owned>> returned;
    {
        const std::lock_guard lock(mutex_);
        returned.swap(returned_);
    }
    for (auto& [socket, connection] : returned)
        if (connection) {
            watch(std::move(connection));
            --with_workers_;
            queue(socket);
        } else handle(socket);  // its stream has ended
    if (!closing_ && !returned.empty()) listen(true);
}

void EventLoop::expire() {
    const Clock::time_point now = checked_ = Clock::now();
    if (stopping_ && !closing_) {
        closing_ = true;
        accept(std::numeric_limits<int>::max());  // those already in the listen queue
        listen(false);
        ::shutdown(listening_.number(), SHUT_RDWR);
        idle_until_ = now + drain_time;
    }
    expire_deliveries();
    const bool scarce = memory_is_scarce();
    for (const Owned& c : connections_) {
        if (c && c->awaits_memory()) {
            await(EPOLL_CTL_MOD, *c);
            queue(c->socket());
        }
        if (c && !c->is_delivering() &&
            now > (c->is_closing() ? c->deadline() : std::min(c->deadline(scarce), idle_until_)))
            time_out(*c);
    }
    is_memory_to_return_ |=
        memory_.take_most() >= much_held || std::exchange(most_at_work_, 0) >= many_at_work;
    if (is_memory_to_return_ && memory_.bytes() < much_held && with_workers_ == 0) {
        is_memory_to_return_ = false;
        trim_memory();
    }
    if (!stopping_) listen(true);
}

void EventLoop::time_out(Connection& connection) {
    if (connection.is_idle() || connection.is_closing()) {
        close(connection.socket());
        return;
    }
    connection.refuse(
        stopping_ ? stopping_refusal()
        : connection.awaits_memory()
            ? memory_refusal()
            : problem_response(408, "the request did not arrive completely in time"));
    answer_here(connection);
}

bool EventLoop::was_scarce(Clock::time_point last) const { return checked_ - last < scarce_time; }

/// Breaks off answers that are read too slowly. A finished answer holds memory and a connection; a
/// stream also a thread, and a sweep's place.
void EventLoop::expire_deliveries() {
    const bool scarce = memory_is_scarce() || was_scarce(connections_scarce_);
    const bool streams = scarce || workers_.jobs_wait() || was_scarce(streams_scarce_);
    for (const Owned& c : connections_)
        if (c && c->is_delivering() &&
            c->outbox().client_is_slow(Clock::now(), c->is_streaming() ? streams : scarce)) {
            c->outbox().cancel();
            deliver(*c);
        }
}

void EventLoop::work(Owned connection) {
    const std::string client = connection->client();
    for (;;) {
        Task rest = handler_.answer(*connection, connection->take());
        if (rest) return finish_stream(std::move(connection), std::move(rest));
        connection->deliver();
        if (connection->is_delivering() || connection->is_closing()) break;
        Connection::Progress progress = connection->advance();
        pollfd next_one{connection->socket(), POLLIN, 0};
        if (progress == Connection::Progress::waits && !workers_.jobs_wait() &&
            ::poll(&next_one, 1, next_request_wait) > 0)
            progress = connection->advance();
        if (progress == Connection::Progress::ended) connection->begin_closing();
        // At the limit of connections it goes back to the loop, which can close it for a new one.
        if (progress != Connection::Progress::complete || !listens_) break;
        // Others wait, or the next request is that of another client behind the same proxy.
        const std::string next = connection->client();
        if (workers_.jobs_wait() || next != client)
            return workers_.put_back(next, std::move(connection));
    }
    const int socket = connection->socket();
    hand_back(socket, std::move(connection));
}

void EventLoop::finish_stream(Owned connection, Task rest) {
    const int socket = connection->socket();
    hand_back(socket, std::move(connection));
    rest();
    rest = {};  // with a sweep's place, before the client learns of the end
    hand_back(socket, nullptr);
}

void EventLoop::hand_back(int socket, Owned connection) {
    {
        const std::lock_guard lock(mutex_);
        returned_.emplace_back(socket, std::move(connection));
    }
    wake();
}

}  // namespace vines::http
