#include "core/sweep/parallel.hpp"

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

namespace vines {

void parallel(
    std::size_t count, int threads, RunControl* control,
    const std::function<void(std::size_t)>& task) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failure;
    std::mutex failing;
    const auto work = [&] {
        std::optional<ComputePermit> permit;
        try {
            for (std::size_t i; (i = next++) < count;) {
                if (control && !permit) permit.emplace(*control);
                task(i);
            }
        } catch (...) {
            next = count;
            const std::lock_guard lock(failing);
            if (!failure) failure = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    const std::size_t wanted = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
    others.reserve(wanted);
    try {
        for (std::size_t t = 1; t < wanted; ++t) others.emplace_back(work);
    } catch (const std::system_error&) {}  // no more threads: those already started continue
    work();
    for (std::thread& t : others) t.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace vines
