#include "api/format/answer_list.hpp"

#include <algorithm>
#include <limits>

namespace vines::api {

namespace {

/// True if each entry is null or of that type.
bool all_are(const Json& array, bool (Json::*is)() const noexcept) {
    return std::all_of(array.begin(), array.end(), [is](const Json& entry) {
        return entry.is_null() || (entry.*is)();
    });
}

std::vector<std::uint8_t> doubles_of(const Json& array) {
    std::vector<std::uint8_t> bytes(array.size() * sizeof(double));
    for (std::size_t k = 0; k < array.size(); ++k) {
        const double number =
            array[k].is_null() ? std::numeric_limits<double>::quiet_NaN() : array[k].get<double>();
        std::memcpy(bytes.data() + k * sizeof number, &number, sizeof number);
    }
    return bytes;
}

}  // namespace

std::optional<AnswerList> AnswerList::of(const Json& value) {
    AnswerList list;
    list.packing_ = packing_of(value);
    if (list.packing_ != Packed::no) {
        list.bytes_ = value.get_binary();
        return list;
    }
    if (!value.is_array()) return std::nullopt;
    if (all_are(value, &Json::is_number)) {
        list.packing_ = Packed::numbers;
        list.own_ = doubles_of(value);
    } else if (std::all_of(
                   value.begin(), value.end(), [](const Json& e) { return e.is_boolean(); })) {
        list.packing_ = Packed::flags;
        for (const Json& entry : value) list.own_.push_back(entry.get<bool>());
    } else if (all_are(value, &Json::is_string)) {
        for (const Json& entry : value)
            list.words_.push_back(entry.is_null() ? std::string() : entry.get<std::string>());
    } else {
        return std::nullopt;
    }
    return list;
}

std::size_t AnswerList::size() const {
    return packing_ == Packed::no ? words_.size() : bytes().size() / entry_size(packing_);
}

std::size_t AnswerList::width() const {
    switch (packing_) {
        case Packed::quadruples: return 4;
        case Packed::matrices: return 16;
        default: return 1;
    }
}

void nan_for_null(std::span<std::uint8_t> doubles) {
    change_numbers(doubles, [](double number) {
        return std::isfinite(number) ? number : std::numeric_limits<double>::quiet_NaN();
    });
}

}  // namespace vines::api
