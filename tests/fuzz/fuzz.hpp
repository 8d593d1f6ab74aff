// What the fuzz targets share.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "api/problem.hpp"
#include "api/schema/json.hpp"

/// One input, as libFuzzer calls it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace vines::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Ends the program where a sentence does not hold: the fuzzer keeps the input.
inline void require(bool holds, const char* sentence) {
    if (holds) return;
    std::fprintf(stderr, "WRONG: not so: %s\n", sentence);
    std::abort();
}

/// Does what may end with a Problem, whose document must be JSON. Whatever else is thrown is a
/// finding.
template <class Work>
void or_problem(Work work) {
    try {
        work();
    } catch (const api::Problem& problem) {
        require(problem.status >= 400 && problem.status < 500, "a request is refused as its own");
        require(api::Json::accept(problem.body()), "a problem's document is JSON");
    }
}

/// The part before the first separator, taken with it from the front of a text.
inline std::string_view take_part(std::string_view& text, char separator) {
    const std::string_view part = text.substr(0, text.find(separator));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    return part;
}

/// Numbers that stand in a text, so that an input can be read: a word that is none, or that is not
/// there, is what it would be otherwise.
class Numbers {
public:
    explicit Numbers(std::string_view text) : rest_(text) {}
    double next(double otherwise) {
        const std::string_view word = take_part(rest_, ' ');
        double number = otherwise;
        std::from_chars(word.data(), word.data() + word.size(), number);
        return number == number ? number : otherwise;
    }
    double next(double otherwise, double from, double to) {
        return std::clamp(next(otherwise), from, to);
    }

private:
    std::string_view rest_;
};

/// Says stop at the so many-th time that it is asked.
class Patience {
public:
    explicit Patience(long looks) : left_(looks) {}
    bool is_over() { return --left_ < 0; }

private:
    long left_;
};

}  // namespace vines::fuzz
