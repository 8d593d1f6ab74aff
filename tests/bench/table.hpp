// Measurements taken in turn, and the rows of scripts/bench's table.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace vines::bench {

/// Runs a piece of work and returns its time in s.
double seconds_of(const std::function<void()>& work);

/// Results of several measurements over this number of rounds. Each round takes all in turn, so
/// that other load on the machine affects all of them.
std::vector<std::vector<double>> in_turn(
    int rounds, const std::vector<std::function<double()>>& measurements);

/// Quotients, round by round.
std::vector<double> ratios(const std::vector<double>& of, const std::vector<double>& to);

double median(std::vector<double> values);
/// With three significant digits, or all digits before the decimal point.
std::string digits(double value);

/// Prints a row: the name, the median, the range of all rounds, and after the median a derived
/// value.
void row(
    const std::string& what, const std::vector<double>& values, const std::string& unit,
    const std::string& remark = "");

/// Time of work in a process of its own, and its peak memory beyond the initial one. Call it before
/// anything else uses much memory or starts threads.
struct Cost {
    double seconds, megabytes;
};
Cost cost_of(const std::function<void()>& work);

}  // namespace vines::bench
