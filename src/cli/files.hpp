// Input and output files of a command, and the JSON in them. An output path leads to a Destination:
// a stream, or a regular file, which Output replaces by a complete new one and AppendFile extends.
// While a run has a file open, it is locked against other runs of this program.
#pragma once

#include <CLI/CLI.hpp>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "api/parse.hpp"
#include "api/problem.hpp"
#include "program/descriptor.hpp"

namespace vines::cli {

/// Paths; "-" or "" stands for stdin or stdout.
struct Files {
    std::string input, output;
};

/// Adds an option or a positional for a path or several ones, which shells complete.
template <class Paths>
CLI::Option* add_file(
    CLI::App& command, const std::string& names, Paths& paths, const std::string& about) {
    return command.add_option(names, paths, about)->type_name("FILE");
}
inline void add_output(
    CLI::App& command, std::string& path,
    const std::string& about = "file for the answer; - or nothing: stdout") {
    add_file(command, "--output,-o", path, about);
}

/// Returns whether a path stands for stdin or stdout.
bool is_standard(const std::string& path);

/// Return the whole content. Throw std::runtime_error with the reason if it cannot be read. Only
/// read_all() reads stdin for "" and "-".
std::string read_all(const std::string& path);
std::string read_file(const std::string& path);

/// Reads an open file from its current position to the end; `name` is used in messages.
std::string read_open(int descriptor, const std::string& name);

/// Returns whether a text is JSON rather than a file of columns.
bool is_json(const std::string& text);

/// Either a stream (stdout, a pipe, a device), which is written directly, or a regular file,
/// existing or not, which is replaced or extended.
struct Destination {
    std::string name;  ///< for messages
    Descriptor stream;
    std::string file;  ///< path with symbolic links resolved; empty for a stream

    bool is_stream() const { return static_cast<bool>(stream); }
};

/// "" and "-" stand for stdout. /dev/stdout, /dev/stderr and /dev/fd/N stand for descriptors that
/// the process has open. Opening a named pipe blocks until it has a reader. Throws
/// std::runtime_error with the reason if the path is a directory or cannot be resolved.
Destination destination_of(const std::string& path);

/// Removes all temporary files and blocks the creation and renaming of others for good. Called by
/// the thread that ends the program after a signal.
void remove_temporary_files();

/// A stream is written at once. A file is replaced atomically by end(), from a temporary file in
/// its folder, with its mode: other processes see the old or the new content. All members throw
/// std::runtime_error with the reason, or BrokenPipe.
class Output {
public:
    explicit Output(const std::string& path) : Output(destination_of(path)) {}
    /// `lock`: the existing file, if it is already locked.
    explicit Output(Destination to, Descriptor lock = Descriptor());
    /// Removes the temporary file, if it has not replaced the target.
    ~Output();
    void write(std::string_view text);
    void end();

private:
    const Destination to_;
    /// The existing file, opened and locked: fails if it is not writable or another run writes it.
    Descriptor lock_;
    std::string temporary_;  ///< path of the temporary file; empty after it has replaced the target
    Descriptor file_;
};

/// Writes a whole text.
void write_all(const std::string& path, const std::string& text);

/// File to which lines are appended. Created by the constructor and locked against other runs. All
/// members throw std::runtime_error with the reason.
class AppendFile {
public:
    explicit AppendFile(const Destination& file);

    /// Returns the content.
    std::string read() const;
    /// Truncates the file to its first `length` bytes.
    void truncate(std::size_t length);
    /// Appends all lines in one write, so that a killed run keeps them. On an error nothing is
    /// appended.
    void append(std::string_view lines);
    /// Waits until the content is on the disk.
    void sync();
    /// Replaces the file as Output does. Ends the use of this object.
    void replace(std::string_view content);

private:
    const std::string path_, name_;
    Descriptor file_;
    std::size_t length_ = 0;
};

// The JSON of answers.

/// Value at a JSON pointer such as "/exponents/qr/final/0"; null if missing.
inline const api::Json& part(const api::Json& answer, const std::string& path) {
    static const api::Json none;
    const api::Json::json_pointer at(path);
    return answer.contains(at) ? answer[at] : none;
}

/// NaN if it is no number.
inline double number_of(const api::Json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

inline std::vector<double> numbers_of(const api::Json& list, double unit = 1) {
    std::vector<double> numbers;
    for (const api::Json& entry : list) numbers.push_back(number_of(entry) / unit);
    return numbers;
}

/// Empty if it is no string.
inline std::string word_of(const api::Json& value) {
    return value.is_string() ? value.get<std::string>() : "";
}

/// An answer or a line of a sweep; a discarded value (is_discarded()) for a text that is no object.
inline api::Json parse_answer(std::string_view text) {
    try {
        return api::parse_object(text);
    } catch (const api::Problem&) {
        return api::Json::value_t::discarded;
    }
}

}  // namespace vines::cli
