// What an answer was made of, told in it, so that anyone can make it once more.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "api/json_text.hpp"
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

class Sha256;

/// Hands an answer's text on, an object that comes in pieces, with its provenance as its last
/// member: sha256 is that of the text without it.
class Seal {
public:
    /// Nothing: the text as it is. The provenance outlives it.
    Seal(const std::optional<Provenance>& provenance, JsonText::Take take);
    ~Seal();
    void add(std::string_view piece);
    /// That was all.
    void end();

private:
    const std::optional<Provenance>& provenance_;
    const JsonText::Take take_;
    const std::unique_ptr<Sha256> hash_;
    bool holds_brace_ = false;  // the last one, it may be
};

/// Writes an answer's text, a line, sealed where there is a provenance. `lists`: of those to come.
void write_sealed(
    Json& answer, const std::optional<Provenance>& provenance, const JsonText::Take& take,
    ListSource* lists = nullptr);

/// An answer's text taken apart.
struct Unsealed {
    std::string text;  ///< without provenance
    Json provenance;   ///< as describe() has it
};
/// Nothing where there is no provenance at its end.
std::optional<Unsealed> unsealed(std::string_view sealed);

}  // namespace vines::api
