// Checks that the installed core gives the reference exponent of the paper's system.
#include <cmath>
#include <cstdio>
#include <vines/core/analysis/analysis.hpp>

int main() {
    vines::Parameters table1;
    table1.b = 0.008;
    table1.damping = vines::Damping::closed_form;
    const vines::Analysis run = vines::analyse(
        {.parameters = table1,
         .start = vines::default_state(table1),
         .tau_end = 1709,
         .parts = {.exponents = true}});
    const double lambda1 = run.exponents->growth.lambda1;
    std::printf("lambda1 = %.12f\n", lambda1);
    // From tests/core/reference/closed_b0.008.txt, in 250-digit arithmetic.
    const double reference = -0.0116853206289877;
    return std::abs(lambda1 - reference) < 1e-9 ? 0 : 1;
}
