#include "api/example_record.hpp"

#include <fmt/format.h>

#include <iterator>

#include "api/request.hpp"
#include "core/measurement/synthetic_record.hpp"

namespace vines::api {

namespace {

constexpr const char* preset = "fig20";
constexpr double seconds = 20;

}  // namespace

std::string example_record() {
    const SimulateRequest request = read_simulate_request({{"preset", preset}});
    const double omega0 = request.system.si->omega0();
    const MeasuredRecord record =
        synthetic_record(true_motion(request.wanted.parameters, omega0, 0, seconds), {});
    std::string csv = "time_s,displacement_m,acceleration_m_s2\n";
    for (std::size_t k = 0; k < record.tau.size(); ++k)
        fmt::format_to(
            std::back_inserter(csv), "{:.7f},{:.8e},{:.5e}\n", record.tau[k] / omega0, record.x[k],
            record.x_ddot[k] * omega0 * omega0);
    return csv;
}

}  // namespace vines::api
