// `vines identify`: a measurement as CSV or JSON.
#include "api/identify.hpp"

#include <memory>

#include "api/json_text.hpp"
#include "api/query.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"

namespace vines::cli {

namespace {

struct IdentifyOptions {
    Files files;
    std::string query;  ///< fields for a CSV file, as in a URL
};

api::IdentifyRequest read_request(const std::string& text, const std::string& query) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first != std::string::npos && text[first] == '{')
        return api::read_identify_request(api::parse_object(text));
    return api::read_identify_request(
        api::from_query(api::identify_fields(), api::parse_query(query)), text);
}

int identify(const IdentifyOptions& o) {
    const api::IdentifyRequest request = read_request(read_all(o.files.input), o.query);
    write_all(o.files.output, api::json_text(api::identify_answer(request)) + "\n");
    return complete;
}

}  // namespace

Command add_identify(CLI::App& app) {
    const auto options = std::make_shared<IdentifyOptions>();
    CLI::App* command = app.add_subcommand(
        "identify",
        "exponents from a measurement: a CSV file with --query, or the JSON of POST /v1/identify");
    command->add_option(
        "--query,-q", options->query, "fields for a CSV file, as in a URL: preset=fig20&b=0.015");
    add_files(*command, options->files);
    return with_exit_codes(command, [options] { return identify(*options); });
}

}  // namespace vines::cli
