#include "api/provenance.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "api/answer_json.hpp"
#include "api/parse.hpp"
#include "api/problem.hpp"
#include "api/version.hpp"

namespace vines::api {

namespace {

constexpr std::string_view before_provenance = ",\"provenance\":";

// Up to 2^53 every integer is a double.
constexpr double largest_whole = 9007199254740992;

}  // namespace

/// SHA-256 of a text in pieces.
class Sha256 {
public:
    Sha256() {
        if (!context_ || EVP_DigestInit_ex(context_.get(), method(), nullptr) != 1)
            throw std::runtime_error("libcrypto: SHA-256");
    }
    void add(std::string_view text) {
        if (EVP_DigestUpdate(context_.get(), text.data(), text.size()) != 1)
            throw std::runtime_error("libcrypto: SHA-256");
    }
    std::string end() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> bytes;
        unsigned int size = 0;
        if (EVP_DigestFinal_ex(context_.get(), bytes.data(), &size) != 1)
            throw std::runtime_error("libcrypto: SHA-256");
        return fmt::format("{:02x}", fmt::join(bytes.data(), bytes.data() + size, ""));
    }

private:
    /// Fetched once, which takes longer than hashing a small answer.
    static const EVP_MD* method() {
        static const EVP_MD* const fetched = EVP_MD_fetch(nullptr, "SHA256", nullptr);
        return fetched;
    }

    std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

Seal::Seal(const std::optional<Provenance>& provenance, JsonText::Take take)
    : provenance_(provenance),
      take_(std::move(take)),
      hash_(provenance ? std::make_unique<Sha256>() : nullptr) {}

Seal::~Seal() = default;

void Seal::add(std::string_view piece) {
    if (piece.empty()) return;
    if (!hash_) return take_(piece);
    hash_->add(piece);
    if (holds_brace_) take_("}");
    holds_brace_ = piece.back() == '}';
    if (holds_brace_) piece.remove_suffix(1);
    take_(piece);
}

void Seal::end() {
    if (hash_) {
        if (!holds_brace_) throw std::logic_error("no object is sealed");
        take_(before_provenance);
        take_(json_text(describe(*provenance_, hash_->end())));
        take_("}");
    }
    take_("\n");
}

Json describe(const Provenance& p, const Json& sha256) {
    Json described = {
        {"route", p.route},
        {"commit", commit()},
        {"answer_limit", or_null(p.answer_limit)},
        {"request", p.request}};
    if (p.record) described["record_sha256"] = *p.record;
    described["sha256"] = sha256;
    return described;
}

Json canonical(const Json& request) {
    if (request.is_array()) {
        Json array = Json::array();
        for (const Json& entry : request) array.push_back(canonical(entry));
        return array;
    }
    // 100.0 from a query equals 100 from a body.
    if (request.is_number_float() && std::abs(request.get<double>()) < largest_whole &&
        request == std::trunc(request.get<double>()))
        return static_cast<std::int64_t>(request.get<double>());
    if (!request.is_object()) return request;
    std::map<std::string, Json> ordered;
    for (const auto& [name, value] : request.items()) ordered[name] = canonical(value);
    Json object = Json::object();
    for (auto& [name, value] : ordered) object[name] = std::move(value);
    return object;
}

std::string sha256(std::string_view text) {
    Sha256 hash;
    hash.add(text);
    return hash.end();
}

void write_sealed(
    Json& answer, const std::optional<Provenance>& provenance, const JsonText::Take& take,
    JsonText::ListOf list_of) {
    Seal seal(provenance, take);
    JsonText text([&seal](std::string_view piece) { seal.add(piece); }, std::move(list_of));
    text.write(answer);
    text.end();
    seal.end();
}

std::optional<Unsealed> unsealed(std::string_view sealed) {
    const std::size_t at = sealed.rfind(before_provenance);
    const std::size_t end = sealed.find_last_not_of(" \t\r\n");
    if (at == std::string_view::npos || sealed[end] != '}') return std::nullopt;
    const std::size_t from = at + before_provenance.size();
    Json provenance;
    try {
        provenance = parse_object(sealed.substr(from, end - from));
    } catch (const Problem&) {
        return std::nullopt;
    }
    const bool is_one = provenance.contains("route") && provenance["route"].is_string() &&
                        provenance.contains("request") && provenance["request"].is_object() &&
                        provenance.contains("sha256");
    if (!is_one) return std::nullopt;
    return Unsealed{std::string(sealed.substr(0, at)) + "}", std::move(provenance)};
}

}  // namespace vines::api
