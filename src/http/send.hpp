// Sending responses through httplib.
// The server has read a request completely before httplib is involved. httplib gets a SocketStream,
// from which it reads a minimal request head and to which it writes the answer; send() fills in the
// response.
#pragma once

#include <httplib.h>

#include <chrono>
#include <string>

#include "http/connection.hpp"
#include "http/head.hpp"
#include "http/message.hpp"

namespace vines::http {

class SocketStream : public httplib::Stream {
public:
    /// head: the request head that httplib reads.
    SocketStream(Connection& connection, std::string head, WriteTimeout timeout)
        : connection_(connection),
          head_(std::move(head)),
          timeout_(std::move(timeout)) {}

    bool is_readable() const override { return read_ < head_.size(); }
    bool is_writable() const override {
        return !failed_ && connection_.peer_state() != Connection::PeerState::reset;
    }
    /// True if the client has left. A client that has closed its sending side can still be reading:
    /// it is sent the first bytes that every answer begins with, one at a time; a client that has
    /// left answers them with a reset.
    bool has_left();
    ssize_t read(char* data, std::size_t size) override;
    /// The first write, the answer's head, is buffered and sent with the next one.
    ssize_t write(const char* data, std::size_t size) override;
    using httplib::Stream::write;
    /// Sends what is buffered; false if not all of the answer could be sent.
    bool finish();
    std::size_t written() const { return written_; }

    void get_remote_ip_and_port(std::string&, int&) const override {}
    void get_local_ip_and_port(std::string&, int&) const override {}
    // httplib only compares it with the largest one for select(), which it never calls.
    socket_t socket() const override { return -1; }

private:
    void probe();
    bool send(std::string_view first, std::string_view second);
    std::chrono::milliseconds time_left() const;
    bool wait_until_writable();

    Connection& connection_;
    const std::string head_;
    const WriteTimeout timeout_;
    std::size_t read_ = 0, written_ = 0;
    std::string buffered_;  // start of the answer, not yet sent
    bool head_written_ = false, failed_ = false;
    std::chrono::nanoseconds waited_{};  // waiting for the client
    std::chrono::steady_clock::time_point probe_at_{};
    std::chrono::steady_clock::duration probe_interval_ = std::chrono::seconds(1);
};

/// Fills in the response: ETag (304 if the client has it), compression if the body is large and the
/// client accepts it, the request's id. A stream has neither length nor ETag.
void send(
    const Head& head, const std::string& request_id, httplib::Response& out, Response response);

}  // namespace vines::http
