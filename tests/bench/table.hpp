// Measurements taken in turn, and the rows of scripts/bench's table.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace vines::bench {

/// Seconds that a piece of work takes.
double seconds_of(const std::function<void()>& work);

/// What each of some measurements gave in so many rounds; in each round all are taken in turn, so
/// that what else the machine does meets all of them.
std::vector<std::vector<double>> in_turn(
    int rounds, const std::vector<std::function<double()>>& measurements);

/// Quotients round by round.
std::vector<double> ratios(const std::vector<double>& of, const std::vector<double>& to);

double median(std::vector<double> values);
/// With three significant digits, or all before the point.
std::string digits(double value);

/// Prints a row: what was measured, the median, and the range of all rounds; behind the median what
/// follows from it.
void row(
    const std::string& what, const std::vector<double>& values, const std::string& unit,
    const std::string& remark = "");

/// Of work done in a process of its own: its time, and the most memory that it held beyond what it
/// began with. Call it before anything else has taken memory, or threads were started.
struct Cost {
    double seconds, megabytes;
};
Cost cost_of(const std::function<void()>& work);

}  // namespace vines::bench
