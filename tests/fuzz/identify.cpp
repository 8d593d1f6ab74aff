// Fuzz target: identification. An input that begins with { is a request as JSON; any other is a
// query, followed by a line with the numbers of a synthetic record.
#include "api/identify.hpp"

#include <fmt/format.h>

#include <iterator>

#include "../laboratory/sensors.hpp"
#include "api/json_text.hpp"
#include "api/parse.hpp"
#include "api/schema/tables.hpp"
#include "fuzz.hpp"

using namespace vines;

namespace {

// About a second under the sanitizers.
constexpr long max_identify_calls = 3000;

/// A record of Table 4's oscillator as CSV. The numbers of its motion and its sensors are followed
/// by pairs of a sample's index and its new value.
std::string record(fuzz::Numbers numbers) {
    const SiParameters si{.m1 = 4.168, .c1 = 3.02, .k1 = 11.47e3, .m2 = 0.032};
    Parameters p{.epsilon = si.epsilon(), .lambda = si.lambda(), .G = 0.01};
    p.b = numbers.next(0.015, 1e-3, 0.1);
    p.R_plus = numbers.next(0.85, 0, 1);
    p.R_minus = numbers.next(p.R_plus, 0, 1);
    const double omega0 = si.omega0(), seconds = numbers.next(1, 0.1, 2),
                 settling = numbers.next(1, 0, 20);
    const test::Sensors sensors{
        .rate = numbers.next(1024, 50, 2048),
        .pulse = numbers.next(0.8e-3, 1e-5, 0.1),
        .noise_x = numbers.next(2e-6, 0, 1),
        .noise_a = numbers.next(0.05, 0, 1e3),
        .offset = numbers.next(0, -1, 1),
        .drift = numbers.next(0, -1, 1),
        .delay = numbers.next(0, -0.1, 0.1),
        .clip_x = numbers.next(0, 0, 1),
        .clip_a = numbers.next(0, 0, 1),
        .dropouts = static_cast<int>(numbers.next(0, 0, 5)),
        .outliers = static_cast<int>(numbers.next(0, 0, 20)),
        .lost_samples = numbers.next(0, 0, 0.9),
        .gap_from = numbers.next(0, 0, 2),
        .gap = numbers.next(0, 0, 2)};
    MeasuredRecord r = test::measured_record(true_motion(p, omega0, settling, seconds), sensors);
    const std::size_t n = r.tau.size();
    for (auto at = static_cast<std::size_t>(numbers.next(0, 0, 1e6)); at > 0 && at <= 2 * n;
         at = static_cast<std::size_t>(numbers.next(0, 0, 1e6)))
        (at > n ? r.x_ddot[at - n - 1] : r.x[at - 1]) = numbers.next(0);
    std::string csv = "time_s,displacement_m,acceleration_m_s2\n";
    for (std::size_t k = 0; k < n; ++k)
        fmt::format_to(
            std::back_inserter(csv), "{},{},{}\n", r.tau[k] / omega0, r.x[k],
            r.x_ddot[k] * omega0 * omega0);
    return csv;
}

api::IdentifyRequest request_of(std::string_view text) {
    if (text.starts_with('{')) return api::read_identify_request(api::parse_object(text));
    const std::string_view query = fuzz::take_part(text, '\n');
    const api::Json fields = api::from_query(api::identify_fields(), api::parse_query(query));
    return api::read_identify_request(fields, record(fuzz::Numbers(text)));
}

}  // namespace

void fuzz::identify(std::string_view text) {
    fuzz::or_problem([text] {
        fuzz::CallLimit call_limit(max_identify_calls);
        const api::Json answer =
            api::identify_answer(request_of(text), {.stop = [&] { return call_limit.is_over(); }});
        const std::string written = api::json_text(answer);
        fuzz::require(api::Json::accept(written), "an answer is JSON: its numbers are finite");
        fuzz::require(
            answer["verdict"].is_string() ||
                answer["verdict_reason"].get<std::string>().starts_with("the motion dies out"),
            "an answer has a verdict, or the motion dies out");
    });
}
