#include "api/provenance.hpp"

#include <fmt/ranges.h>
#include <openssl/evp.h>

#include <algorithm>
#include <memory>

#include "api/parse.hpp"
#include "api/version.hpp"

namespace vines::api {

namespace {

// A longer form of a list is replaced by its hash, which is as long.
constexpr std::size_t longest_form = 64;

// Up to 2^53 every integer is a double.
constexpr double largest_whole = 9007199254740992;

/// SHA-256 of a text in pieces.
class Sha256 {
public:
    Sha256() { check(context_ && EVP_DigestInit_ex(context_.get(), method(), nullptr)); }
    void add(std::string_view text) {
        check(EVP_DigestUpdate(context_.get(), text.data(), text.size()));
    }
    std::string end() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> bytes;
        unsigned int size = 0;
        check(EVP_DigestFinal_ex(context_.get(), bytes.data(), &size));
        return fmt::format("{:02x}", fmt::join(bytes.data(), bytes.data() + size, ""));
    }

private:
    static void check(bool succeeded) {
        if (!succeeded) throw std::runtime_error("libcrypto: SHA-256");
    }
    /// Fetched once, which takes longer than hashing a small answer.
    static const EVP_MD* method() {
        static const EVP_MD* const fetched = EVP_MD_fetch(nullptr, "SHA256", nullptr);
        return fetched;
    }

    std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

/// True for an object, and for a list that holds one.
bool holds_object(const Json& value) {
    return value.is_object() ||
           (value.is_array() && std::any_of(value.begin(), value.end(), holds_object));
}

void put_form(std::string_view text, std::string& to) {
    if (needs_no_escape(text)) to.append(1, '"').append(text).append(1, '"');
    else to += Json(text).dump();
}
void put_form(double number, std::string& to) {
    if (!std::isfinite(number)) {
        to += 'n';
        return;
    }
    number += 0.0;  // a minus sign of zero does not survive every program
    std::array<char, sizeof number> bytes;
    std::memcpy(bytes.data(), &number, sizeof number);
    to.append(1, 'd').append(bytes.data(), bytes.size());
}
void put_form(int number, std::string& to) { put_form(static_cast<double>(number), to); }
void put_form(bool flag, std::string& to) { to += flag ? 't' : 'f'; }
template <class Entry>
void put_form(const std::array<Entry, 4>& row, std::string& to) {
    to += '[';
    for (const Entry& entry : row) put_form(entry, to);
    to += ']';
}

/// The form of a value without objects and packed lists.
void put_form(const Json& value, std::string& to) {
    switch (value.type()) {
        case Json::value_t::null: to += 'n'; return;
        case Json::value_t::boolean: return put_form(value.get<bool>(), to);
        case Json::value_t::string:
            return put_form(std::string_view(value.get_ref<const std::string&>()), to);
        case Json::value_t::array:
            to += '[';
            for (const Json& entry : value) put_form(entry, to);
            to += ']';
            return;
        case Json::value_t::object:
        case Json::value_t::binary: throw std::logic_error("a packed list in a list");
        default: return put_form(value.get<double>(), to);
    }
}

/// A list's form, or its hash if the form is long.
class ListForm {
public:
    template <class Entry>
    void add(const Entry& entry) {
        put_form(entry, form_);
        if (form_.size() >= large) flush();
    }
    std::string end() {
        form_ += ']';
        if (!hash_ && form_.size() <= longest_form) return std::move(form_);
        flush();
        return hash_->end();
    }

private:
    static constexpr std::size_t large = 16384;

    void flush() {
        if (!hash_) hash_.emplace();
        hash_->add(form_);
        form_.clear();
    }

    std::string form_ = "[";
    std::optional<Sha256> hash_;
};

std::string list_form(const PackedList& list) {
    ListForm form;
    for_each_entry(list, [&form](const auto& entry) { form.add(entry); });
    return form.end();
}

std::string list_form(const Json& list) {
    ListForm form;
    for (const Json& entry : list) form.add(entry);
    return form.end();
}

void add_lists(const Json& value, ContentHash& hash) {
    if (value.is_binary()) hash.add(value, list_in_memory(value));
    if (value.is_structured())
        for (const Json& part : value) add_lists(part, hash);
}

}  // namespace

ContentHash::ContentHash(const Json& answer) { put(answer); }

void ContentHash::put(const Json& value) {
    if (value.is_binary()) return places_.push_back({text_.size(), &value});
    if (value.is_object()) {
        std::map<std::string_view, const Json*> members;  // by name
        for (const auto& [name, member] : value.get_ref<const Json::object_t&>())
            members[name] = &member;
        text_ += '{';
        for (const auto& [name, member] : members) {
            put_form(name, text_);
            put(*member);
        }
        text_ += '}';
    } else if (holds_object(value)) {
        text_ += '[';
        for (const Json& entry : value) put(entry);
        text_ += ']';
    } else if (value.is_array()) {
        text_ += list_form(value);
    } else {
        put_form(value, text_);
    }
}

void ContentHash::add(const Json& value, const PackedList& list) {
    lists_[&value] = list_form(list);
}

std::string ContentHash::end() const {
    Sha256 hash;
    const std::string_view text = text_;
    std::size_t done = 0;
    for (const Place& place : places_) {
        hash.add(text.substr(done, place.at - done));
        hash.add(lists_.at(place.list));
        done = place.at;
    }
    hash.add(text.substr(done));
    return hash.end();
}

Json describe(const Provenance& p, const Json& sha256) {
    Json described = {
        {"route", p.route},
        {"commit", commit()},
        {"answer_limit", p.answer_limit ? Json(*p.answer_limit) : Json(nullptr)},
        {"request", p.request}};
    if (p.record) described["record_sha256"] = *p.record;
    described["sha256"] = sha256;
    return described;
}

Json canonical(const Json& request) {
    // 100.0 from a query equals 100 from a body.
    if (request.is_number_float() && std::abs(request.get<double>()) < largest_whole &&
        request == std::trunc(request.get<double>()))
        return static_cast<std::int64_t>(request.get<double>());
    Json value = request.is_object() ? Json(nlohmann::json(request)) : request;  // sorted by name
    if (value.is_structured())
        for (Json& part : value) part = canonical(part);
    return value;
}

std::string sha256(std::string_view text) {
    Sha256 hash;
    hash.add(text);
    return hash.end();
}

std::string content_sha256(const Json& answer) {
    ContentHash hash(answer);
    add_lists(answer, hash);
    return hash.end();
}

std::string write_sealed(
    Json& answer, const std::optional<Provenance>& provenance, const JsonText::Take& take,
    JsonText::ListOf list_of) {
    std::optional<ContentHash> hash;
    if (provenance) hash.emplace(answer);
    bool holds_brace = false;  // the last '}' so far is withheld
    JsonText text(
        [&](std::string_view piece) {
            if (holds_brace) take("}");
            holds_brace = hash && piece.ends_with('}');
            if (holds_brace) piece.remove_suffix(1);
            take(piece);
        },
        [&](const Json& value) {
            const PackedList list = list_of(value);
            if (hash) hash->add(value, list);
            return list;
        });
    text.write(answer);
    text.end();
    std::string hashed;
    if (hash) {
        hashed = hash->end();
        take(R"(,"provenance":)");
        take(json_text(describe(*provenance, hashed)));
        take("}");
    }
    take("\n");
    return hashed;
}

std::optional<Unsealed> unsealed(std::string_view sealed) {
    Unsealed parts{.answer = parse_object(sealed)};
    const auto found = parts.answer.find("provenance");
    if (found == parts.answer.end() || !found->is_object()) return std::nullopt;
    parts.provenance = std::move(*found);
    parts.answer.erase(found);
    const Json& p = parts.provenance;
    const bool is_one = p.contains("route") && p["route"].is_string() && p.contains("request") &&
                        p["request"].is_object() && p.contains("sha256");
    if (!is_one) return std::nullopt;
    parts.sha256 = content_sha256(parts.answer);
    parts.is_unmodified = p["sha256"] == parts.sha256;
    return parts;
}

}  // namespace vines::api
