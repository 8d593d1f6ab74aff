// Helpers for the fuzz targets.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "api/problem.hpp"
#include "api/schema/field.hpp"

namespace vines::fuzz {

/// The targets, each in the file of its name. They run one input.
void json(std::string_view text);
void query(std::string_view text);
void csv(std::string_view text);
void head(std::string_view bytes);
void simulate(std::string_view text);
void solver(std::string_view text);
void sweep(std::string_view text);
void identify(std::string_view text);

/// Aborts if a condition does not hold; the fuzzer then keeps the input.
inline void require(bool holds, const char* sentence) {
    if (holds) return;
    std::fprintf(stderr, "violated: %s\n", sentence);
    std::abort();
}

/// Runs `work`, which can throw a Problem with a JSON document and a status of 400 to 499. Any
/// other exception is a finding.
template <class Work>
void or_problem(Work work) {
    try {
        work();
    } catch (const api::Problem& problem) {
        require(problem.status >= 400 && problem.status < 500, "a problem has a status of 4xx");
        require(api::Json::accept(problem.body()), "a problem's document is JSON");
    }
}

/// Removes the part before the first separator, and the separator, from the text; returns the part.
inline std::string_view take_part(std::string_view& text, char separator) {
    const std::string_view part = text.substr(0, text.find(separator));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    return part;
}

/// Numbers in a text, so that inputs are readable. A word gives the number with which it begins; a
/// word without one, a missing word and NaN give the default.
class Numbers {
public:
    explicit Numbers(std::string_view text) : rest_(text) {}
    double next(double otherwise) {
        const std::string_view word = take_part(rest_, ' ');
        double number = otherwise;
        std::from_chars(word.data(), word.data() + word.size(), number);
        return std::isnan(number) ? otherwise : number;
    }
    double next(double otherwise, double from, double to) {
        return std::clamp(next(otherwise), from, to);
    }

private:
    std::string_view rest_;
};

/// Counts calls of a stop function: each is_over() counts one, and those after the first max_calls
/// return true.
class CallLimit {
public:
    explicit CallLimit(long max_calls) : left_(max_calls) {}
    bool is_over() { return --left_ < 0; }

private:
    long left_;
};

}  // namespace vines::fuzz
