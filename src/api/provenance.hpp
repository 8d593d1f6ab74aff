// Provenance of an answer: the inputs from which anyone can reproduce it, as a part of the answer.
#pragma once

#include <map>

#include "api/json_text.hpp"

namespace vines::api {

struct Provenance {
    std::string route;                             ///< /v1/simulate
    Json request;                                  ///< canonical(), without the record
    std::optional<std::size_t> answer_limit = {};  ///< bytes, if the answer was cut to fit
    std::optional<std::string> record = {};        ///< sha256() of an identification's body
};

/// {route, commit, answer_limit, request, record_sha256, sha256}. sha256: see ContentHash.
Json describe(const Provenance& provenance, const Json& sha256);

/// The request with names in alphabetical order at every level, and integers without a point.
Json canonical(const Json& request);

/// SHA-256 as 64 hexadecimal digits.
std::string sha256(std::string_view text);

/// SHA-256 of an answer's content, whatever the order of its keys and the spelling of its numbers
/// and strings: of a form of the value that docs/api.md, Provenance, defines.
class ContentHash {
public:
    /// Reads everything but packed lists.
    explicit ContentHash(const Json& answer);
    /// Adds the packed list of a value of the answer.
    void add(const Json& value, const PackedList& list);
    /// Expects all lists.
    std::string end() const;

private:
    void put(const Json& value);

    struct Place {
        std::size_t at;
        const Json* list;
    };
    std::string text_;                          ///< the form without packed lists
    std::vector<Place> places_;                 ///< of these
    std::map<const Json*, std::string> lists_;  ///< their forms
};

/// The same for an answer whose lists are all in memory.
std::string content_sha256(const Json& answer);

/// Writes an answer as one line, with its provenance, if any, as the last member. Returns the
/// provenance's sha256, the ContentHash of the answer without it.
std::string write_sealed(
    Json& answer, const std::optional<Provenance>& provenance, const JsonText::Take& take,
    JsonText::ListOf list_of = list_in_memory);

/// An answer's JSON split into answer and provenance.
struct Unsealed {
    Json answer;                 ///< without provenance
    Json provenance = {};        ///< see describe()
    std::string sha256 = {};     ///< content_sha256() of the answer
    bool is_unmodified = false;  ///< its provenance has this sha256
};
/// nullopt if the answer has no provenance. Throws the Problems of parse_object().
std::optional<Unsealed> unsealed(std::string_view sealed);

}  // namespace vines::api
