#include <string>

#include "api/json_text.hpp"
#include "api/request.hpp"
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
    const auto times = in_turn(turns, {[&] { return run(true); }, [&] { return run(false); }});
    row("10,000 samples of a run to tau = 1709, b = 22 mm, with the run", times[0], "ms");
    row("that run without them", times[1], "ms");
}

/// The default request, from its text on: each form of its answer by itself.
void bench_forms() {
    api::Json answer;
    std::string text, packed;
    const auto times = in_turn(
        turns, {[&] {
                    return 1e3 * seconds_of([&] {
                               answer = simulate_answer(
                                   api::read_simulate_request(api::Json::object()), {});
                           });
                },
                [&] { return 1e3 * seconds_of([&] { text = api::json_text(std::move(answer)); }); },
                [&] { return 1e3 * seconds_of([&] { packed = http::gzip(text); }); }});
    const auto size = [](const std::string& s) {
        return ", " + std::to_string(s.size()) + " bytes";
    };
    row("the default request, computed and described", times[0], "ms");
    row("its answer as JSON text", times[1], "ms", size(text));
    row("that text gzipped", times[2], "ms", size(packed));
}

}  // namespace

void bench_answers() {
    bench_sampling();
    bench_forms();
}

}  // namespace vines::bench
