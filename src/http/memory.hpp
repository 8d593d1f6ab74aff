// Memory that large answers have taken.
#pragma once

#include <cstdlib>  // __GLIBC__
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace vines::http {

/// To the system, as far as nothing uses it.
inline void give_memory_back() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace vines::http
