// `vines verify`: checks the hash of an answer, repeats the request in its provenance, and compares
// both value by value, to the last bit, whatever the order of the keys and the spelling of numbers
// and strings. Of a sweep it recomputes the first line, each point that the file has, and the last.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "api/format/answer_request.hpp"
#include "api/json_text.hpp"
#include "api/parse.hpp"
#include "api/sweep.hpp"
#include "api/version.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/sweep_file.hpp"
#include "program/process.hpp"

namespace vines::cli {

namespace {

using api::Json;

struct VerifyOptions {
    std::string answer, record;
};

void print_line(const std::string& line) { print(printable(line) + "\n"); }

void print_early_stop() { print_message("stopped before everything was recomputed"); }

/// A short form of a value, for messages.
std::string in_line(const Json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return fmt::format("a list of {}", value.size());
    return api::shortened(value.dump());
}

/// First difference of two answers, as "/impacts/tau/3: 1.0 became 2.0"; empty if they are equal.
std::string difference(const Json& stored, const Json& computed, const std::string& path = "") {
    if (stored == computed) return {};
    if (!stored.is_structured() || stored.type() != computed.type())
        return fmt::format("{}: {} became {}", path, in_line(stored), in_line(computed));
    for (const auto& [name, value] : stored.items()) {
        const Json::json_pointer at = Json::json_pointer() / name;
        if (!computed.contains(at)) return path + at.to_string() + " is missing";
        const std::string found = difference(value, computed[at], path + at.to_string());
        if (!found.empty()) return found;
    }
    for (const auto& [name, value] : computed.items())
        if (const auto at = Json::json_pointer() / name; !stored.contains(at))
            return path + at.to_string() + " is new";
    return {};
}

/// A recomputed answer.
struct Recomputed {
    std::string text, sha256;
    api::Provenance provenance;
};

/// The request of an answer, with the measured record from its file.
api::AnswerRequest rebuilt_request(const api::Provenance& p, const std::string& record) {
    Json fields = p.request;
    const bool is_columns = !record.empty() && !is_json(record);
    if (!record.empty() && !is_columns) {
        const Json whole = api::parse_object(record);
        for (const char* name : {"record", "impacts"})
            if (whole.contains(name)) fields[name] = whole[name];
    }
    return api::read_answer_request(p.route, std::move(fields), {record, is_columns});
}

/// Recomputes the answer. Empty if a signal stops it. Throws Problem if the request has no answer.
std::optional<Recomputed> recomputed(const api::Provenance& p, const std::string& record) {
    const Stoppable stoppable(print_early_stop);
    Recomputed computed;
    try {
        api::Answer answer = api::compute_answer(
            rebuilt_request(p, record),
            {.stop = {.requested = stopped}, .most_bytes = p.answer_limit.value_or(api::any_size)});
        computed.provenance = *answer.provenance;
        RunControl control;
        computed.sha256 = api::write_answer(
            std::move(answer), control,
            [&computed](std::string_view piece) { computed.text += piece; });
    } catch (const api::Problem&) {  // thrown by a stopped identification
        if (!stopped()) throw;
    }
    return stopped() ? std::nullopt : std::optional(std::move(computed));
}

/// Prints the program versions of an answer and of its recomputation.
void print_builds(const Json& answer, const Json& provenance) {
    const auto build = [](const std::string& version, const std::string& commit) {
        return commit.empty() ? version : version + " (" + commit + ")";
    };
    const std::string version = word_of(part(answer, "/version")),
                      commit = word_of(part(provenance, "/commit"));
    print_line(fmt::format(
        "answered by {}, recomputed by {}", build(api::shortened(version), api::shortened(commit)),
        build(api::version(), api::commit())));
    if (commit != api::commit())
        print_line(
            "commit: not this program's; that such a build computed the answer is not proven");
}

/// The record of an identification; empty for other answers.
std::string record_of(const Json& provenance, const VerifyOptions& o) {
    if (!provenance.contains("record_sha256")) return "";
    if (o.record.empty())
        throw api::Problem(
            422, "the measured record is not in the answer: name its file with --record");
    std::string record = read_file(o.record);
    if (provenance["record_sha256"] != api::sha256(record))
        print_line("record: not the file that was sent");
    return record;
}

api::Provenance read_provenance(const Json& stored) {
    api::Provenance read{.route = stored["route"], .request = stored["request"]};
    const Json limit = api::canonical(part(stored, "/answer_limit"));
    if (limit.is_number_integer() && limit > 0) read.answer_limit = limit.get<std::size_t>();
    return read;
}

int verify_answer(const api::Unsealed& stored, const VerifyOptions& o) {
    print_builds(stored.answer, stored.provenance);
    print_line(stored.is_unmodified ? "sha256: matches" : "sha256: the answer was modified");
    const std::string record = record_of(stored.provenance, o);
    const std::string reason = word_of(part(stored.answer, "/status/reason"));
    if (reason == "deadline" || reason == "interrupted") {
        print_line("not decided: a time limit or a signal ended the run early");
        return stored.is_unmodified ? incomplete : differs;
    }
    const std::optional<Recomputed> computed =
        recomputed(read_provenance(stored.provenance), record);
    if (!computed) {
        print_early_stop();
        return stopped_code();
    }
    std::string in_answer;
    if (stored.sha256 != computed->sha256)
        in_answer = difference(stored.answer, api::unsealed(computed->text)->answer);
    print_line("recomputed: " + (in_answer.empty() ? "the same values" : in_answer));
    // The hash does not cover the provenance. The commit differs between builds.
    Json provenance = api::describe(computed->provenance, stored.provenance["sha256"]);
    if (!word_of(part(stored.provenance, "/commit")).empty())
        provenance["commit"] = stored.provenance["commit"];
    const std::string in_provenance = difference(stored.provenance, provenance);
    if (!in_provenance.empty()) print_line("provenance: " + in_provenance);
    const bool is_same = in_answer.empty() && in_provenance.empty() && stored.is_unmodified;
    return is_same ? complete : differs;
}

/// Verifies the first line, the points that a file has, even if others are missing, and the last.
int verify_sweep(const SweepFile& file, const std::string& name) {
    const Json start = parse_answer(file.start);
    print_builds(start, start);
    api::SweepRequest request = request_of(file, name);
    request.plan.lines.clear();
    for (const auto& [index, line] : file.points) request.plan.lines.push_back(index);
    std::string first;
    const auto is_equal = [&first](
                              const std::string& what, const Json& stored, const Json& computed) {
        const std::string where = difference(stored, computed);
        if (!where.empty() && first.empty()) first = what + where;
        return where.empty();
    };
    Json computed_start = parse_answer(api::json_text(api::sweep_start(request)));
    for (const char* other : {"version", "commit", "of"})  // of the build, of the request's part
        if (start.contains(other)) computed_start[other] = start[other];
    is_equal("start: ", start, computed_start);
    std::size_t same = 0, all = 0;
    SignalControl control;
    const Stoppable stoppable(print_early_stop);
    api::run_sweep(request, cores(), control, [&](std::size_t index, const std::string& computed) {
        const std::string& stored = file.points.at(index).text;
        ++all;
        same += stored == computed ||
                is_equal(
                    fmt::format("point {}: ", index), parse_answer(stored), parse_answer(computed));
    });
    if (all == file.points.size() && !file.done.empty())
        is_equal("done: ", parse_answer(file.done), parse_answer(api::done_line(all, request)));
    print_line(fmt::format("recomputed: {} of {} points are the same", same, file.points.size()));
    if (!first.empty()) print_line(first);
    if (!first.empty()) return differs;
    return all < file.points.size() ? stopped_code() : complete;
}

/// The text with each JSON object on a line of its own, as in a sweep's file. Line ends are blanks
/// of JSON, never a part of a string.
std::string one_object_per_line(std::string text) {
    int depth = 0;
    bool in_string = false, escaped = false;
    for (char& c : text) {
        if (in_string) {
            in_string = c != '"' || escaped;
            escaped = c == '\\' && !escaped;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '}') {
            depth += c == '{' ? 1 : -1;
        } else if ((c == '\n' || c == '\r') && depth > 0) {
            c = ' ';
        }
    }
    return text;
}

int verify(const VerifyOptions& o) {
    std::string text = read_all(o.answer);
    std::optional<api::Unsealed> stored;
    std::string fault = "it has no provenance";
    try {
        stored = api::unsealed(text);
    } catch (const api::Problem& problem) {
        fault = problem.what();
    }
    if (stored) return verify_answer(*stored, o);
    text = one_object_per_line(std::move(text));
    if (part(parse_answer(text.substr(0, text.find('\n'))), "/type") != "start")
        throw api::Problem(
            422,
            "the file must be one JSON answer of this program, or the lines of a sweep: " + fault);
    const std::string name = is_standard(o.answer) ? "stdin" : o.answer;
    return verify_sweep(parse_sweep_file(text, name, LineChecks::index_only), name);
}

}  // namespace

Command add_verify(CLI::App& app) {
    const auto options = std::make_shared<VerifyOptions>();
    CLI::App* command = app.add_subcommand("verify", "recompute an answer and compare all values");
    add_file(*command, "answer", options->answer, "file with the answer; - or nothing: stdin");
    add_file(
        *command, "--record", options->record, "for an identification: the file that was sent");
    return with_exit_codes(
        command, [options] { return verify(*options); },
        "vines simulate -p preset=fig11 -o answer.json; vines verify answer.json\n"
        "vines identify record.csv -p preset=fig20 | vines verify --record record.csv");
}

}  // namespace vines::cli
