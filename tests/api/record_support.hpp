// Records of simulated motions for tests of identifications.
#pragma once

#include <cstdio>
#include <string>

#include "core/measurement/synthetic_record.hpp"
#include "support.hpp"

namespace vines::test {

/// A record of the preset's oscillator from quiet sensors, `settling` s after the start from rest.
inline std::string measured(
    const char* preset, double seconds, double settling = 0, char separator = ',') {
    const SimulateRequest r = read_simulate_request({{"preset", preset}});
    const double omega0 = r.system.si->omega0();
    const MeasuredRecord record = synthetic_record(
        true_motion(r.wanted.parameters, omega0, settling, seconds),
        {.noise_x = 1e-6, .noise_a = 0.025});
    std::string csv =
        std::string("time_s") + separator + "displacement_m" + separator + "acceleration_m_s2\n";
    for (std::size_t k = 0; k < record.tau.size(); ++k) {
        char line[96];
        std::snprintf(
            line, sizeof line, "%.7f%c%.8e%c%.5e\n", record.tau[k] / omega0, separator, record.x[k],
            separator, record.x_ddot[k] * omega0 * omega0);
        csv += line;
    }
    return csv;
}

inline Problem refused(const Json& fields, const std::string& csv) {
    CAPTURE(csv.substr(0, 100));
    return problem_of([&] { identified(read_identify_request(fields, csv)); });
}

inline const std::string header = "time_s,displacement_m,acceleration_m_s2\n";

inline std::string replaced_line(const std::string& csv, int line, const std::string& by) {
    std::size_t from = 0;
    for (int k = 1; k < line; ++k) from = csv.find('\n', from) + 1;
    return csv.substr(0, from) + by + csv.substr(csv.find('\n', from));
}

}  // namespace vines::test
