// Provenance of an answer: the inputs from which anyone can reproduce it, as a part of the answer.
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
    Json request;                                  ///< canonical(), without the record
    std::optional<std::size_t> answer_limit = {};  ///< bytes, if the answer was cut to fit
    std::optional<std::string> record = {};        ///< sha256() of an identification's body
};

/// {route, commit, answer_limit, request, record_sha256, sha256}. sha256 is that of the answer.
Json describe(const Provenance& provenance, const Json& sha256);

/// The request with names in alphabetical order at every level, and integers without a point.
Json canonical(const Json& request);

/// SHA-256 as 64 hexadecimal digits.
std::string sha256(std::string_view text);

class Sha256;

/// Passes on an answer's text, a JSON object in pieces, and appends its provenance as the last
/// member. The provenance's sha256 is that of the text without it.
class Seal {
public:
    /// Without a provenance the text stays unchanged. The provenance must outlive the Seal.
    Seal(const std::optional<Provenance>& provenance, JsonText::Take take);
    ~Seal();
    void add(std::string_view piece);
    /// Ends the text.
    void end();

private:
    const std::optional<Provenance>& provenance_;
    const JsonText::Take take_;
    const std::unique_ptr<Sha256> hash_;
    bool holds_brace_ = false;  // the last '}' so far is withheld
};

/// Writes an answer as one line, with its provenance if any.
void write_sealed(
    Json& answer, const std::optional<Provenance>& provenance, const JsonText::Take& take,
    JsonText::ListOf list_of = list_in_memory);

/// An answer's text split into answer and provenance.
struct Unsealed {
    std::string text;  ///< without provenance
    Json provenance;   ///< see describe()
};
/// nullopt if the text does not end with a provenance.
std::optional<Unsealed> unsealed(std::string_view sealed);

}  // namespace vines::api
