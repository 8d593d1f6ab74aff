#include "http/process_load.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <system_error>

namespace vines::http {

namespace {

/// The seconds since 1970 at which the system started.
double boot_time() {
    std::ifstream in("/proc/stat");
    for (std::string word; in >> word;) {
        double seconds = 0;
        if (word == "btime" && in >> seconds) return seconds;
    }
    return 0;
}

/// proc(5): the fields behind the name, which may hold anything, in brackets.
void read_stat(ProcessLoad& load) {
    std::ifstream in("/proc/self/stat");
    const std::string text(std::istreambuf_iterator<char>(in), {});
    const std::size_t name_ends = text.rfind(')');
    if (name_ends == std::string::npos) return;
    std::istringstream fields(text.substr(name_ends + 1));
    std::string skipped;
    double user = 0, system = 0, since_boot = 0, pages = 0;
    for (int field = 3; field < 14; ++field) fields >> skipped;
    fields >> user >> system;  // 14, 15
    for (int field = 16; field < 20; ++field) fields >> skipped;
    fields >> load.threads >> skipped >> since_boot;  // 20, 22
    fields >> load.virtual_memory_bytes >> pages;     // 23, 24
    const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
    load.cpu_seconds = (user + system) / ticks;
    load.start_time_seconds = boot_time() + since_boot / ticks;
    load.resident_memory_bytes = pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

ProcessLoad process_load() {
    ProcessLoad load;
    read_stat(load);
    std::error_code ignored;
    for (std::filesystem::directory_iterator entry("/proc/self/fd", ignored), end; entry != end;
         entry.increment(ignored))
        ++load.open_fds;
    --load.open_fds;  // that which looks
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) == 0) load.max_fds = static_cast<double>(limit.rlim_cur);
    return load;
}

}  // namespace vines::http
