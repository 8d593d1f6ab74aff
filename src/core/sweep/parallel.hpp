// Work on all cores.
#pragma once

#include <cstddef>
#include <functional>

namespace vines {

/// Calls task(0), ..., task(count - 1), each once, from so many threads, or as many as
/// the system has, and returns when all are done. A task that throws ends the work: the exception
/// comes out of here once the other threads are back.
void parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& task);

}  // namespace vines
