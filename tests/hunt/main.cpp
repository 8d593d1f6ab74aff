// Searches for results of the product that are wrong with confidence. Built and run by
// scripts/hunt.
#include <CLI/CLI.hpp>
#include <cstdint>

#include "coverage.hpp"
#include "damping.hpp"
#include "flights.hpp"
#include "verdicts.hpp"

int main(int count, char** arguments) {
    CLI::App app(
        "Searches for results that are wrong with confidence. Every reported system is a request "
        "that "
        "reproduces it.");
    app.option_defaults()->always_capture_default();
    int systems = 2000, damped = 200, flights = 1000000, first = 0, threads = 2, windows = 0,
        cycles = 300;
    std::uint64_t seed = 1;
    app.add_option(
        "--systems", systems,
        "random systems whose verdicts and periods are checked by runs twenty times as long");
    app.add_option(
        "--damped", damped,
        "strongly damped systems whose exponents are compared with multi-precision results");
    app.add_option(
        "--flights", flights,
        "random flights whose contacts are checked by dense sampling in extended precision");
    app.add_option(
        "--first", first,
        "number of the first system and flight: --damped 0 --flights 0 --systems 1 --first 61 "
        "repeats "
        "one");
    app.add_option(
        "--windows", windows,
        "prints how often this many windows of chaotic motions differ from their mean by more than "
        "their standard errors allow");
    app.add_option("--cycles", cycles, "length of these windows, in forcing cycles");
    app.add_option("--seed", seed, "random seed");
    app.add_option("--threads", threads);
    try {
        app.parse(count, arguments);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }

    const bool exponents = damped == 0 || vines::hunt::hunt_exponents(damped, seed, threads);
    const bool verdicts = systems == 0 || vines::hunt::hunt_verdicts(systems, seed, first, threads);
    const bool contacts = flights == 0 || vines::hunt::hunt_contacts(flights, seed, first, threads);
    if (windows > 0) vines::hunt::print_coverage(windows, cycles, threads);
    return exponents && verdicts && contacts ? 0 : 1;
}
