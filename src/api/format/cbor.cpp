// CBOR (RFC 8949), lists of numbers as typed arrays (RFC 8746).
#include <bit>

#include "api/cancellation.hpp"
#include "api/format/answer_list.hpp"
#include "api/format/encode.hpp"

namespace vines::api {

namespace {

static_assert(std::endian::native == std::endian::little);  // required by the tags below

// RFC 8949, 3.1: the item's major type.
enum class Major : unsigned { bytes = 2, array = 4, object = 5 };

// RFC 8746, 2.1.
constexpr std::uint8_t float64_tag = 86, int32_tag = 78;
constexpr char tag_of_one_byte = '\xd8';

// Approximate size of an answer without its lists, in bytes.
constexpr std::size_t room_beside_lists = 8192;

/// Encodes values and frees each list once it is encoded.
class CborBytes {
public:
    CborBytes(const std::function<bool()>& gives_up, std::size_t room) : cancel_(gives_up) {
        bytes_.reserve(room);
    }

    void put(Json& value) {
        if (value.is_object()) {
            put_head(Major::object, value.size());
            for (auto& [name, part] : value.items()) {
                Json::to_cbor(name, bytes_);
                put(part);
            }
        } else if (value.is_binary()) {
            cancel_.poll();
            put_list(*AnswerList::of(value));
            value = nullptr;
        } else if (value.is_array() && !value.empty() && value[0].is_object()) {
            put_head(Major::array, value.size());
            for (Json& part : value) put(part);
        } else {
            Json::to_cbor(value, bytes_);
        }
    }
    std::string end() { return std::move(bytes_); }

private:
    /// The shortest encoding of a count (RFC 8949, 3.1, 4.2.1).
    void put_head(Major major, std::uint64_t count) {
        const unsigned kind = static_cast<unsigned>(major) << 5;
        if (count < 24) {
            bytes_ += static_cast<char>(kind | count);
            return;
        }
        const int length = count <= 0xff ? 1 : count <= 0xffff ? 2 : count <= 0xffffffff ? 4 : 8;
        bytes_ += static_cast<char>(kind | (24 + std::countr_zero(static_cast<unsigned>(length))));
        for (int shift = 8 * length; shift > 0;)
            bytes_ += static_cast<char>(count >> (shift -= 8) & 0xff);
    }
    void put_typed(std::span<const std::uint8_t> numbers, std::uint8_t tag) {
        bytes_ += tag_of_one_byte;
        bytes_ += static_cast<char>(tag);
        put_head(Major::bytes, numbers.size());
        bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size());
    }
    void put_doubles(std::span<const std::uint8_t> numbers) {
        put_typed(numbers, float64_tag);
        std::uint8_t* const end = reinterpret_cast<std::uint8_t*>(bytes_.data()) + bytes_.size();
        nan_for_null({end - numbers.size(), numbers.size()});
    }
    /// An array of `bytes.size() / size` items.
    template <class PutItem>
    void put_items(std::span<const std::uint8_t> bytes, std::size_t size, PutItem put_item) {
        put_head(Major::array, bytes.size() / size);
        for (std::size_t at = 0; at < bytes.size(); at += size) {
            cancel_.step();
            put_item(bytes.subspan(at, size));
        }
    }
    void put_rows(std::span<const std::uint8_t> rows) {
        put_items(rows, sizeof(Quadruple), [this](auto row) { put_doubles(row); });
    }
    void put_list(const AnswerList& list) {
        switch (list.packing()) {
            case Packed::numbers: return put_doubles(list.bytes());
            case Packed::quadruples: return put_rows(list.bytes());
            case Packed::matrices:
                return put_items(
                    list.bytes(), sizeof(MatrixByRows), [this](auto rows) { put_rows(rows); });
            case Packed::integers: return put_typed(list.bytes(), int32_tag);
            default:
                return put_items(list.bytes(), sizeof(bool), [this](auto flag) {
                    Json::to_cbor(flag[0] != 0, bytes_);
                });
        }
    }

    CancelCheck cancel_;
    std::string bytes_;
};

}  // namespace

std::string cbor_bytes(Json answer, const std::function<bool()>& gives_up) {
    // Each 32-byte row of a list has a head of 4 bytes.
    std::size_t room = room_beside_lists;
    visit_lists(answer, [&room](const std::string&, const AnswerList& list) {
        room += list.bytes().size() / 8 * 9;
    });
    CborBytes bytes(gives_up, room);
    bytes.put(answer);
    return bytes.end();
}

}  // namespace vines::api
