#include "cli/output.hpp"

#include <fcntl.h>

#include <utility>

#include "cli/file_error.hpp"
#include "cli/lock.hpp"

namespace vines::cli {

Output::Output(Destination to) : to_(std::move(to)) {
    if (to_.is_stream()) return;
    old_ = open_locked(to_, O_WRONLY);
    file_.emplace(to_.file, to_.name);
}

void Output::write(std::string_view text) {
    if (file_) return file_->write(text);
    if (const int failed = write_fully(to_.stream.number(), text))
        fail_at("write", to_.name, failed);
}

void Output::end() {
    if (file_) file_->take_place();
}

void write_all(const std::string& path, const std::string& text) {
    Output out(path);
    out.write(text);
    out.end();
}

}  // namespace vines::cli
