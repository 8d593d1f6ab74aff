#include <charconv>
#include <string>
#include <vector>

#include "api/json_text.hpp"
#include "api/simulate.hpp"
#include "core/motion/record.hpp"
#include "http/encoding.hpp"
#include "parts.hpp"
#include "table.hpp"

namespace vines::bench {

namespace {

constexpr int turns = 15;

void bench_sampling() {
    Parameters p;
    p.damping = Damping::closed_form;
    const auto run = [&p](bool sampled) {
        SeriesRecord record(1709.0 / 10000);
        Observer* const observers[] = {&record};
        return 1e3 * seconds_of([&] {
                   const Limits limits{1709, 100000, {}};
                   if (!sampled) {
                       simulate(p, default_state(p), limits, {});
                       return;
                   }
                   record.finish(simulate(p, default_state(p), limits, observers));
               });
    };
    SeriesRecord record(1709.0 / 10000);
    Observer* const observers[] = {&record};
    record.finish(simulate(p, default_state(p), {1709, 100000, {}}, observers));
    std::vector<char> text(64);
    const auto digits_alone = [&] {
        return 1e3 * seconds_of([&] {
                   const Series& s = record.series;
                   for (const auto* column : {&s.tau, &s.x, &s.x_dot, &s.y, &s.y_dot})
                       for (const double number : *column)
                           std::to_chars(text.data(), text.data() + text.size(), number);
               });
    };
    const auto times =
        in_turn(turns, {[&] { return run(true); }, [&] { return run(false); }, digits_alone});
    row("10,000 samples of a run to tau = 1709, b = 22 mm, with the run", times[0], "ms");
    row("the same run without samples", times[1], "ms");
    row("five columns of these samples by std::to_chars alone", times[2], "ms");
}

/// The default request, from its text to each form of its answer.
void bench_forms() {
    api::Json answer;
    std::string text, packed;
    const auto times = in_turn(
        turns, {[&] {
                    return 1e3 * seconds_of([&] {
                               answer = simulate_in_parts(
                                            api::read_simulate_request(api::Json::object()), {})
                                            .json;
                           });
                },
                [&] { return 1e3 * seconds_of([&] { text = api::json_text(std::move(answer)); }); },
                [&] { return 1e3 * seconds_of([&] { packed = http::gzip(text); }); }});
    const auto size = [](const std::string& s) {
        return ", " + std::to_string(s.size()) + " bytes";
    };
    row("the default request, computed and described", times[0], "ms");
    row("the default answer as JSON text", times[1], "ms", size(text));
    row("the default answer gzipped", times[2], "ms", size(packed));
}

}  // namespace

void bench_answers() {
    bench_sampling();
    bench_forms();
}

}  // namespace vines::bench
