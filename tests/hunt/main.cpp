// Hunts for statements of the product that are wrong with confidence. scripts/hunt builds and runs
// it.
#include <CLI/CLI.hpp>
#include <cstdint>

#include "damping.hpp"
#include "flights.hpp"
#include "verdicts.hpp"

int main(int count, char** arguments) {
    CLI::App app(
        "Hunts for statements that are wrong with confidence. Every system it reports is a request "
        "that repeats "
        "it.");
    app.option_defaults()->always_capture_default();
    int systems = 2000, damped = 200, flights = 1000000, first = 0, threads = 2;
    std::uint64_t seed = 1;
    app.add_option(
        "--systems", systems,
        "random systems whose verdicts and periods are judged by runs twenty times as long");
    app.add_option(
        "--damped", damped,
        "strongly damped systems whose exponents are compared with multi-precision ones");
    app.add_option(
        "--flights", flights,
        "random flights whose contacts are judged by dense sampling in extended precision");
    app.add_option(
        "--first", first,
        "the first system and flight of the seed to be judged: --damped 0 --flights 0 --systems 1 "
        "--first 61 repeats one");
    app.add_option("--seed", seed, "of all");
    app.add_option("--threads", threads);
    try {
        app.parse(count, arguments);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }

    const bool exponents = damped == 0 || vines::hunt::hunt_exponents(damped, seed, threads);
    const bool verdicts = systems == 0 || vines::hunt::hunt_verdicts(systems, seed, first, threads);
    const bool contacts = flights == 0 || vines::hunt::hunt_contacts(flights, seed, first, threads);
    return exponents && verdicts && contacts ? 0 : 1;
}
