// The fields of a request as flags.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "api/schema/json.hpp"
#include "api/schema/tables.hpp"
#include "cli/files.hpp"

namespace vines::cli {

struct RequestFields {
    std::string query;                ///< as in a URL
    std::vector<std::string> fields;  ///< NAME=VALUE each
    std::vector<std::string> axes;    ///< of a sweep: NAME=FROM:TO:COUNT[:log] or NAME=A,B,C
    std::string format;               ///< of the answer; empty: as the request says

    /// Whether there is a request without a file.
    bool is_given() const { return !query.empty() || !fields.empty() || !axes.empty(); }
};

void add_request_fields(CLI::App& command, RequestFields& fields);
void add_format(CLI::App& command, RequestFields& fields);
void add_axes(CLI::App& command, RequestFields& fields);

/// As a request's JSON, by the types of the route's table. Problem 400 for what is no NAME=VALUE,
/// or comes twice.
api::Json given_fields(const RequestFields& fields, const api::FieldTable& table);

/// The request in a file, or on stdin, with the fields over its own. Where there are fields and no
/// file is named they are the request.
api::Json read_request(
    const Files& files, const RequestFields& fields, const api::FieldTable& table);

/// The same of a sweep: fields that are none of its own are those of its base.
api::Json read_sweep(const Files& files, const RequestFields& fields);

}  // namespace vines::cli
