// Fuzz target: the head of a request, arriving in pieces.
#include "http/head.hpp"

#include <algorithm>
#include <optional>
#include <random>

#include "fuzz.hpp"

using namespace vines;
using http::Head;
using http::HeadReader;

namespace {

/// Result of reading the bytes so far.
struct Reading {
    std::optional<Head> head;  ///< complete
    std::size_t size = 0;      ///< of the head
    int status = 0;            ///< of a refusal
    std::string refusal = {};
    bool is_over() const { return head || status != 0; }
};

/// Reads prefixes of the bytes up to each of the ends, the last being the whole. Each prefix is
/// copied to its own buffer, so that sanitizers detect reads beyond it.
Reading read_up_to(std::string_view bytes, const std::vector<std::size_t>& ends) {
    HeadReader reader;
    Reading result;
    try {
        for (const std::size_t end : ends) {
            const std::vector<char> so_far(bytes.begin(), bytes.begin() + static_cast<long>(end));
            if (!reader.read({so_far.data(), so_far.size()})) continue;
            result.size = reader.size();
            result.head = reader.take();
            break;
        }
    } catch (const api::Problem& problem) {
        result.status = problem.status;
        result.refusal = problem.what();
    }
    return result;
}

bool same(const Reading& a, const Reading& b) {
    if (a.status != b.status || a.refusal != b.refusal || a.size != b.size ||
        a.head.has_value() != b.head.has_value())
        return false;
    if (!a.head) return true;
    const Head &h = *a.head, &k = *b.head;
    return h.method == k.method && h.target == k.target && h.host == k.host &&
           h.headers == k.headers && h.content_length == k.content_length &&
           h.keep_alive == k.keep_alive && h.takes_chunks == k.takes_chunks &&
           h.expects_continue == k.expects_continue;
}

/// Random ends of pieces, always the same for the same bytes; short pieces are more frequent.
std::vector<std::size_t> some_ends(std::string_view bytes) {
    std::minstd_rand random(static_cast<unsigned>(std::hash<std::string_view>()(bytes)));
    std::vector<std::size_t> ends;
    for (std::size_t end = 0; end < bytes.size() && ends.size() < 50;) {
        end = std::min(bytes.size(), end + 1 + random() % (std::size_t{1} << random() % 12));
        ends.push_back(end);
    }
    ends.push_back(bytes.size());
    return ends;
}

/// Returns whether the head has this header, alone or in a list with others of its name.
bool has_header(const Head& head, std::string_view name, std::string_view value) {
    return std::any_of(head.headers.begin(), head.headers.end(), [&](const auto& header) {
        return header.first == http::lower_case(name) &&
               header.second.find(http::trimmed(value)) != std::string::npos;
    });
}

/// Checks the lines of an accepted head: it must not allow two HTTP parsers to see different
/// requests.
void check_strictness(std::string_view bytes, const Head& head) {
    using fuzz::require;
    require(bytes.ends_with("\r\n\r\n"), "a head ends with an empty line");
    bytes.remove_suffix(2);
    if (bytes.starts_with("\r\n")) bytes.remove_prefix(2);
    std::size_t hosts = 0, lengths = 0;
    const std::string_view first = bytes.substr(0, bytes.find('\n') + 1);
    const bool is_old = first.ends_with(" HTTP/1.0\r\n");
    require(is_old || first.ends_with(" HTTP/1.1\r\n"), "the version is 1.0 or 1.1");
    bytes.remove_prefix(first.size());
    while (!bytes.empty()) {
        std::string_view line = fuzz::take_part(bytes, '\n');
        require(line.ends_with('\r'), "a line ends with CR LF");
        line.remove_suffix(1);
        require(line.find_first_of(std::string_view("\r\0", 2)) == line.npos, "no CR, no NUL");
        const std::string_view name = line.substr(0, line.find(':'));
        require(name.size() < line.size() && !name.empty(), "a header has a name");
        require(name.find_first_of(" \t") == name.npos, "no blank before the colon");
        require(has_header(head, name, line.substr(name.size() + 1)), "each header is reported");
        hosts += http::lower_case(name) == "host";
        lengths += http::lower_case(name) == "content-length";
        require(http::lower_case(name) != "transfer-encoding", "no chunks");
    }
    require(hosts == 1 || (hosts == 0 && is_old), "one Host");
    require(lengths == 1 || (lengths == 0 && head.content_length == 0), "one Content-Length");
    require(head.target.starts_with('/'), "a target begins with /");
    require(head.target.find_first_of(" \t\r\n") == head.target.npos, "no blank in a target");
    require(head.path().starts_with('/'), "a path begins with /");
}

}  // namespace

void fuzz::head(std::string_view bytes) {
    const Reading whole = read_up_to(bytes, {bytes.size()});
    fuzz::require(
        same(whole, read_up_to(bytes, some_ends(bytes))),
        "reading in pieces gives the same result");
    if (whole.head) {
        fuzz::require(
            whole.size <= bytes.size() && whole.size <= HeadReader::max_bytes,
            "a head is limited in size");
        check_strictness(bytes.substr(0, whole.size), *whole.head);
        fuzz::require(
            same(whole, read_up_to(bytes, {whole.size})), "following bytes do not matter");
    }
    if (!whole.is_over())
        fuzz::require(
            bytes.size() <= HeadReader::max_bytes, "a head that is too long is refused at once");
}
