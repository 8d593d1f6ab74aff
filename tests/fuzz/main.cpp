// The fuzzer: fuzz --target=NAME [arguments of libFuzzer]. All targets are one program, which
// compiles in a quarter of the time of eight.
#include <cstdint>

#include "fuzz.hpp"

using namespace vines;

namespace {

struct Target {
    std::string_view name;
    void (*run)(std::string_view input);
};

constexpr Target targets[] = {{"json", fuzz::json},         {"query", fuzz::query},
                              {"csv", fuzz::csv},           {"head", fuzz::head},
                              {"simulate", fuzz::simulate}, {"solver", fuzz::solver},
                              {"sweep", fuzz::sweep},       {"identify", fuzz::identify}};

const Target* chosen = nullptr;

}  // namespace

/// Called by libFuzzer first. It ignores arguments that begin with "--", and passes them to the
/// processes that it starts.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    for (int k = 1; k < *argc; ++k)
        for (const Target& target : targets)
            if ((*argv)[k] == "--target=" + std::string(target.name)) chosen = &target;
    if (chosen) return 0;
    std::fputs("fuzz: no --target=NAME of a file of tests/fuzz\n", stderr);
    std::exit(2);
}

/// Runs one input; called by libFuzzer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    chosen->run({reinterpret_cast<const char*>(data), size});
    return 0;
}
