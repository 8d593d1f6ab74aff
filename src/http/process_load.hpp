// What the system says of this process.
#pragma once

namespace vines::http {

/// As Prometheus' client libraries name them; 0 where the system does not tell.
struct ProcessLoad {
    double cpu_seconds = 0;
    double start_time_seconds = 0;  ///< since 1970
    double resident_memory_bytes = 0, virtual_memory_bytes = 0;
    double open_fds = 0, max_fds = 0;
    double threads = 0;
};

ProcessLoad process_load();

}  // namespace vines::http
