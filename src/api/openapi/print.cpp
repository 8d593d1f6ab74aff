// print_openapi FILE: writes the OpenAPI document, from which the build makes the page /docs
// (web/docs/page.mjs).
#include <fstream>

#include "api/openapi/openapi.hpp"

int main(int, char** argv) {
    std::ofstream file(argv[1]);
    file << vines::api::openapi() << '\n';
    return file.flush() ? 0 : 1;
}
