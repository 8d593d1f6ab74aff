// Measures the core and the generation of answers, as rows of scripts/bench's table: bench
// [--long].
#include <cstdio>
#include <cstring>

#include "parts.hpp"

int main(int count, char** arguments) {
    const bool long_too = count > 1 && std::strcmp(arguments[1], "--long") == 0;
    std::fprintf(stderr, "bench: growth and memory\n");
    vines::bench::bench_growth(long_too);
    std::fprintf(stderr, "bench: time per impact\n");
    vines::bench::bench_kernel();
    std::fprintf(stderr, "bench: sweeps\n");
    vines::bench::bench_sweeps();
    std::fprintf(stderr, "bench: answers\n");
    vines::bench::bench_answers();
}
