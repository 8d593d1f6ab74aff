// A request: its file, and its fields as options, which override those of the file.
#pragma once

#include <string>
#include <vector>

#include "api/schema/tables.hpp"
#include "cli/files.hpp"
#include "program/process.hpp"
#include "program/subcommand.hpp"

namespace vines::cli {

struct RequestOptions : Files {
    std::string query;                ///< URL query syntax
    std::vector<std::string> fields;  ///< NAME=VALUE each
    std::vector<std::string> axes;    ///< of a sweep: NAME=FROM:TO:COUNT[:log] or NAME=A,B,C
    std::string format;               ///< of the answer; empty: the request's format
    bool plot = false;                ///< draw instead of writing the answer
    int threads = 0;                  ///< 0: one per core

    int thread_count() const { return threads > 0 ? threads : cores(); }
};

/// Adds the files and the options for fields; the second function without the files.
void add_request(CLI::App& command, RequestOptions& options);
void add_request_fields(CLI::App& command, RequestOptions& options);
/// --format; `table` has the field `format`, `about` ends the help.
void add_format(
    CLI::App& command, RequestOptions& options, const api::FieldTable& table = api::form_fields(),
    const std::string& about = "");
/// --plot, which excludes --format. Call add_format() before.
void add_plot_flag(CLI::App& command, RequestOptions& options);
void add_threads(CLI::App& command, RequestOptions& options);

/// The options as a request's JSON, typed by the route's table. If that has a base, fields that are
/// not in the table are set in the base. Throws Problem 400 for an argument that is not NAME=VALUE
/// or for a duplicate.
api::Json given_fields(const RequestOptions& options, const api::FieldTable& table);

/// The request of a file or stdin, overridden by the options. If options are given and no file is
/// named, the options are the request.
api::Json read_request(const RequestOptions& options, const api::FieldTable& table);

/// Sets the format that the extension of the output file names (csv, cbor, npz), unless the request
/// has one.
void add_format_of(const std::string& output, api::Json& request);

}  // namespace vines::cli
