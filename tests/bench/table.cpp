#include "table.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace vines::bench {

namespace {

double megabytes(const rusage& usage) { return static_cast<double>(usage.ru_maxrss) / 1024; }

}  // namespace

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<std::vector<double>> in_turn(
    int rounds, const std::vector<std::function<double()>>& measurements) {
    std::vector<std::vector<double>> values(measurements.size());
    for (int k = 0; k < rounds; ++k)
        for (std::size_t i = 0; i < measurements.size(); ++i)
            values[i].push_back(measurements[i]());
    return values;
}

std::vector<double> ratios(const std::vector<double>& of, const std::vector<double>& to) {
    std::vector<double> r;
    for (std::size_t k = 0; k < of.size(); ++k) r.push_back(of[k] / to[k]);
    return r;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

std::string digits(double value) {
    char text[40];
    std::snprintf(
        text, sizeof text, "%.*f",
        value < 1     ? 3
        : value < 10  ? 2
        : value < 100 ? 1
                      : 0,
        value);
    return text;
}

void row(
    const std::string& what, const std::vector<double>& values, const std::string& unit,
    const std::string& remark) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const std::string range = values.size() == 1 ? "" : digits(*least) + " to " + digits(*most);
    std::printf(
        "| %s | %s %s%s | %s |\n", what.c_str(), digits(median(values)).c_str(), unit.c_str(),
        remark.c_str(), range.c_str());
    std::fflush(stdout);
}

Cost cost_of(const std::function<void()>& work) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no process");
    if (child == 0) {
        rusage before;
        getrusage(RUSAGE_SELF, &before);
        Cost cost{seconds_of(work), 0};
        rusage after;
        getrusage(RUSAGE_SELF, &after);
        cost.megabytes = megabytes(after) - megabytes(before);
        const bool written = write(ends[1], &cost, sizeof cost) == sizeof cost;
        _exit(written ? 0 : 1);
    }
    Cost cost;
    close(ends[1]);
    const bool whole = read(ends[0], &cost, sizeof cost) == sizeof cost;
    close(ends[0]);
    waitpid(child, nullptr, 0);
    if (!whole) throw std::runtime_error("the work failed");
    return cost;
}

}  // namespace vines::bench
