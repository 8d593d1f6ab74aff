// httplib's view of a connection whose request is there already: it reads a head that we write, and
// writes the answer.
#pragma once

#include <httplib.h>

#include <chrono>
#include <string>

#include "http/connection.hpp"
#include "http/patience.hpp"

namespace vines::http {

class SocketStream : public httplib::Stream {
public:
    /// head: what is read from it.
    SocketStream(Connection& connection, std::string head, Patience patience)
        : connection_(connection),
          head_(std::move(head)),
          patience_(std::move(patience)) {}

    bool is_readable() const override { return read_ < head_.size(); }
    bool is_writable() const override {
        return !broken_ && connection_.presence() != Connection::Presence::left;
    }
    /// Whether the client has left. One that has closed its own side, and may still read, is sent
    /// the first byte of its answer, which one that has left answers by a reset; later the next
    /// one, of those that every answer begins with.
    bool has_left();
    ssize_t read(char* data, std::size_t size) override;
    /// What comes first, the answer's head, waits for what follows it.
    ssize_t write(const char* data, std::size_t size) override;
    using httplib::Stream::write;
    /// False where not all of the answer could be sent.
    bool finish();
    std::size_t written() const { return written_; }

    void get_remote_ip_and_port(std::string&, int&) const override {}
    void get_local_ip_and_port(std::string&, int&) const override {}
    // Only compared with the largest one that select() takes, which nobody calls.
    socket_t socket() const override { return -1; }

private:
    void ask();
    bool send(std::string_view first, std::string_view second);
    std::chrono::milliseconds patience_left() const;
    bool wait_for_room();

    Connection& connection_;
    const std::string head_;
    const Patience patience_;
    std::size_t read_ = 0, written_ = 0;
    std::string kept_;  // of the answer, not yet sent
    bool began_ = false, broken_ = false;
    std::chrono::nanoseconds waited_{};                // for the client
    std::chrono::steady_clock::time_point asks_at_{};  // whether it is there
    std::chrono::steady_clock::duration until_next_ = std::chrono::seconds(1);
};

}  // namespace vines::http
