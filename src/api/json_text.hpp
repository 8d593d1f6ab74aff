// An answer as JSON text: its words and single numbers value by value, its packed lists straight
// from their numbers (column.hpp).
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>

#include "api/schema/json.hpp"

namespace vines::api {

/// Writes text in pieces.
class JsonText {
public:
    /// Takes one piece after the other.
    using Take = std::function<void(std::string_view)>;

    explicit JsonText(Take take) : take_(std::move(take)) {}
    JsonText(const JsonText&) = delete;
    JsonText& operator=(const JsonText&) = delete;

    /// What is written is freed: lists at once, members with their object.
    void write(Json& json);
    /// Hands out what is left.
    void end();

private:
    void put(char c);
    void put(std::string_view text);
    void put_quoted(const std::string& text);
    void put_number(double number);
    /// An entry of a list, and the bracket or comma before it.
    void put_entry(char before, double entry);
    void put_entry(char before, int entry);
    void put_entry(char before, bool entry);
    template <class Entry>
    void put_entry(char before, const std::array<Entry, 4>& entry);
    template <class Entry>
    void put_list(const Json::binary_t& list);
    void put_list(const Json& list);
    /// Where so many more characters fit.
    char* room(std::size_t length);

    const Take take_;
    std::array<char, 16384> piece_;
    std::size_t used_ = 0;
};

/// The whole text.
std::string json_text(Json json);

}  // namespace vines::api
