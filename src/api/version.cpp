#include "api/version.hpp"

#include "api/commit.hpp"  // made by commit.cmake

namespace vines::api {

std::string version() { return VINES_VERSION; }

std::string commit() { return VINES_COMMIT; }

std::string compiler() {
#ifdef __clang__
    return "clang " __clang_version__;
#else
    return "g++ " __VERSION__;
#endif
}

}  // namespace vines::api
