#include "bench/peers/job.hpp"

#include <cmath>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>

namespace peers {

namespace {

using Json = nlohmann::json;

Job job_of(const Json& j) {
    const auto at = [&](const char* name) { return j.at(name).get<double>(); };
    return {at("epsilon"), at("lambda"), at("G"),       at("Omega"),        at("R"),
            at("b"),       at("x_dot"),  at("x"),       at("y_dot"),        at("y"),
            j.at("side"),  at("tau"),    at("tau_end"), at("longest_step"), at("tolerance")};
}

Json text(const Answer& answer) {
    Json tau = Json::array(), side = Json::array();
    for (const Contact& c : answer.contacts) tau.push_back(c.tau), side.push_back(c.side);
    return {
        {"tau", tau},
        {"side", side},
        {"end", answer.end},
        {"states", answer.states},
        {"sticks", answer.sticks}};
}

double processor_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Nanoseconds of CPU time per contact, from runs that take this long in total.
Json timed(Method method, const Job& job, double seconds, void (*forget)()) {
    double contacts = 0, spent = 0;
    do {
        forget();
        const double start = processor_seconds();
        contacts += static_cast<double>(method(job).contacts.size());
        spent += processor_seconds() - start;
    } while (spent < seconds);
    return {{"nanoseconds", 1e9 * spent / contacts}};
}

}  // namespace

bool stalled(const std::vector<Contact>& contacts) {
    constexpr std::size_t many = 200;
    return contacts.size() >= many &&
           contacts.back().tau - contacts[contacts.size() - many].tau < 1e-3;
}

int serve(
    const std::string& versions, const std::map<std::string, Method>& methods, void (*forget)()) {
    std::ios::sync_with_stdio(false);
    for (std::string line; std::getline(std::cin, line);) {
        const Json asked = Json::parse(line);
        Json answer = {{"versions", versions}};
        if (asked.contains("method")) {
            const Method method = methods.at(asked.at("method"));
            const Job job = job_of(asked);
            const bool keep = !asked.value("forget", false);
            answer = asked.contains("seconds")
                         ? timed(method, job, asked.at("seconds"), keep ? [] {} : forget)
                         : text(method(job));
        }
        std::cout << answer << std::endl;
    }
    return 0;
}

}  // namespace peers
