// Who may use the service, where that is not everyone: whoever shows a key.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vines::http {

class ApiKeys {
public:
    /// None: everyone may.
    ApiKeys() = default;
    /// One on each line of a file; empty lines and those that begin with # are left out. Throws
    /// std::runtime_error where the file cannot be read, is no regular one or larger than 1 MiB,
    /// has none, or one that could be guessed or that no header can hold.
    static ApiKeys read(const std::string& path);

    bool are_asked_for() const { return !keys_.empty(); }
    /// Of a header Authorization: whether it is "Bearer" and a key (RFC 6750), in a time that does
    /// not tell how much of a key is right.
    bool open(std::string_view authorization) const;

    static constexpr std::size_t shortest = 16;

private:
    std::vector<std::string> keys_;
};

}  // namespace vines::http
