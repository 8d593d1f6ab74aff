// A text on its way to a file or a stream.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "cli/destination.hpp"
#include "cli/temporary_file.hpp"

namespace vines::cli {

/// A file is replaced at its end, at once: another one sees the old text or the new. A stream is
/// written as the text comes. All throw std::runtime_error with the reason, or ReaderLeft.
class Output {
public:
    explicit Output(const std::string& path) : Output(destination_of(path)) {}
    explicit Output(Destination to);
    void write(std::string_view text);
    void end();

private:
    const Destination to_;
    /// The file that is replaced, if there is one: only by who may write it, and nobody else now.
    Descriptor old_;
    std::optional<TemporaryFile> file_;
};

/// The same of a whole text.
void write_all(const std::string& path, const std::string& text);

}  // namespace vines::cli
