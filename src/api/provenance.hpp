// What an answer was made of, told in it, so that anyone can make it once more.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "api/schema/json.hpp"

namespace vines::api {

struct Provenance {
    std::string route;                             ///< /v1/simulate
    Json request;                                  ///< canonical(); without a record
    std::optional<std::size_t> answer_limit = {};  ///< bytes, of an answer that was fitted to them
    std::optional<std::string> record = {};        ///< its sha256(), of an identification
};

/// {route, commit, answer_limit, request, record_sha256, sha256}; sha256: of the answer.
Json describe(const Provenance& provenance, const Json& sha256);

/// The same request with its names in order, at every level, and whole numbers without a point.
Json canonical(const Json& request);

/// 64 hexadecimal digits.
std::string sha256(std::string_view text);

/// Hands an answer's text on, an object that comes in pieces, with its provenance as its last
/// member: sha256 is that of the text without it.
class Seal {
public:
    using Take = std::function<void(std::string_view)>;
    /// Nothing: the text as it is. The provenance outlives it.
    Seal(const std::optional<Provenance>& provenance, Take take);
    ~Seal();
    void add(std::string_view piece);
    /// That was all.
    void end();

private:
    struct Hash;
    const std::optional<Provenance>& provenance_;
    const Take take_;
    const std::unique_ptr<Hash> hash_;
    bool holds_brace_ = false;  // the last one, it may be
};

/// The text of a whole answer, sealed, a line.
std::string sealed_text(Json answer, const std::optional<Provenance>& provenance);

/// An answer's text taken apart.
struct Unsealed {
    std::string text;  ///< without provenance
    Json provenance;   ///< as describe() has it
};
/// Nothing where there is no provenance at its end.
std::optional<Unsealed> unsealed(std::string_view sealed);

}  // namespace vines::api
