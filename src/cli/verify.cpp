// `vines verify`: recomputes an answer and compares it byte for byte. An answer ends with its
// provenance: route, request, commit, and the SHA-256 of the text before it. verify checks the
// hash, repeats the request, and compares text and provenance. For a sweep it recomputes each point
// that the file has.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "api/format/answer_request.hpp"
#include "api/parse.hpp"
#include "api/sweep.hpp"
#include "api/version.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/json_values.hpp"
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

/// First difference of two answers, as in "impacts.tau[3]: 1.0 became 2.0"; empty if they are
/// equal.
std::string difference(const Json& stored, const Json& computed, const std::string& path) {
    const auto below = [&path](const std::string& name) {
        return path.empty() ? name : path + "." + name;
    };
    if (stored.is_object() && computed.is_object()) {
        for (const auto& [name, value] : stored.items()) {
            if (!computed.contains(name)) return below(name) + " is missing";
            if (std::string found = difference(value, computed[name], below(name)); !found.empty())
                return found;
        }
        for (const auto& [name, value] : computed.items())
            if (!stored.contains(name)) return below(name) + " is new";
        return {};
    }
    if (stored.is_array() && computed.is_array()) {
        for (std::size_t k = 0; k < std::min(stored.size(), computed.size()); ++k)
            if (std::string found =
                    difference(stored[k], computed[k], fmt::format("{}[{}]", path, k));
                !found.empty())
                return found;
        if (stored.size() == computed.size()) return {};
        return fmt::format("{} has {} entries instead of {}", path, computed.size(), stored.size());
    }
    return stored == computed
               ? std::string()
               : fmt::format("{}: {} became {}", path, in_line(stored), in_line(computed));
}

/// A recomputed answer: its text without provenance, and the provenance.
struct Recomputed {
    std::string text;
    api::Provenance provenance;
};

/// Returns whether two answers are equal; prints the first difference.
bool same_text(const std::string& stored, const std::string& computed) {
    if (stored == computed) {
        print_line(fmt::format("recomputed: the same {} bytes", computed.size()));
        return true;
    }
    const std::string where = difference(parse_answer(stored), parse_answer(computed), "");
    print_line(
        "recomputed: " + (where.empty() ? "the same numbers, formatted differently" : where));
    return false;
}

/// The same for the provenance, which the hash does not cover. Ignores the hash and the commit,
/// which differs between builds.
bool same_provenance(const Json& stored, const api::Provenance& provenance) {
    Json computed = api::describe(provenance, stored["sha256"]);
    if (!word_of(part(stored, "/commit")).empty()) computed["commit"] = stored["commit"];
    if (stored.dump() == computed.dump()) return true;
    const std::string where = difference(stored, computed, "");
    print_line("provenance: " + (where.empty() ? "the same, formatted differently" : where));
    return false;
}

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
        computed.provenance = std::move(*std::exchange(answer.provenance, {}));
        RunControl control;
        api::write_answer(std::move(answer), control, [&computed](std::string_view piece) {
            computed.text += piece;
        });
        computed.text.pop_back();    // line feed
    } catch (const api::Problem&) {  // thrown by a stopped identification
        if (!stopped()) throw;
    }
    return stopped() ? std::nullopt : std::optional(std::move(computed));
}

/// Returns whether the run ended early, so that another attempt can get further.
bool ended_early(const Json& answer) {
    const std::string reason = word_of(part(answer, "/status/reason"));
    return reason == "deadline" || reason == "interrupted";
}

std::string build_of(const std::string& version, const std::string& commit) {
    return commit.empty() ? version : version + " (" + commit + ")";
}

/// Prints the program versions of an answer and of its recomputation.
void print_builds(const Json& answer, const Json& provenance) {
    const std::string version = word_of(part(answer, "/version")),
                      commit = word_of(part(provenance, "/commit"));
    print_line(fmt::format(
        "answered by {}, recomputed by {}",
        build_of(api::shortened(version), api::shortened(commit)),
        build_of(api::version(), api::commit())));
    if (commit != api::commit())
        print_line(
            "commit: not this program's; that such a build computed the answer is not proven");
}

/// The record of an identification; empty for other answers. Throws Problem if its file is not
/// named.
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
    const Json& limit = part(stored, "/answer_limit");
    if (limit.is_number_unsigned()) read.answer_limit = limit.get<std::size_t>();
    return read;
}

int verify_answer(const api::Unsealed& stored, const VerifyOptions& o) {
    const Json answer = parse_answer(stored.text);
    if (!answer.is_object())
        throw api::Problem(
            422,
            "the text before the provenance is not a JSON object: the file must be one unmodified "
            "answer");
    print_builds(answer, stored.provenance);
    const bool unmodified = stored.provenance["sha256"] == api::sha256(stored.text);
    print_line(unmodified ? "sha256: matches" : "sha256: the answer was modified");
    const std::string record = record_of(stored.provenance, o);
    if (ended_early(answer)) {
        print_line("not decided: a time limit or a signal ended the run early");
        return incomplete;
    }
    const std::optional<Recomputed> computed =
        recomputed(read_provenance(stored.provenance), record);
    if (!computed) {
        print_early_stop();
        return stopped_code();
    }
    const bool same = same_text(stored.text, computed->text);
    return same_provenance(stored.provenance, computed->provenance) && same && unmodified ? complete
                                                                                          : differs;
}

/// Verifies the points that a file has, even if others are missing.
int verify_sweep(const SweepFile& file, const std::string& name) {
    const Json start = parse_answer(file.start);
    print_builds(start, start);
    api::SweepRequest request = request_of(file, name);
    request.plan.lines.clear();
    for (const auto& [index, line] : file.points) request.plan.lines.push_back(index);
    std::optional<std::string> first;
    std::size_t same = 0, all = 0;
    SignalControl control;
    const Stoppable stoppable(print_early_stop);
    api::run_sweep(request, cores(), control, [&](std::size_t index, const std::string& computed) {
        const std::string& stored = file.points.at(index).text;
        ++all;
        same += stored == computed;
        if (stored != computed && !first)
            first = fmt::format(
                "point {}: {}", index,
                difference(parse_answer(stored), parse_answer(computed), ""));
    });
    print_line(fmt::format("recomputed: {} of {} points are the same", same, file.points.size()));
    if (first) print_line(*first);
    if (all < file.points.size()) return stopped_code();
    return first ? differs : complete;
}

int verify(const VerifyOptions& o) {
    const std::string text = read_all(o.answer);
    if (text.starts_with("{\"type\":\"start\"")) {
        const std::string name = is_standard(o.answer) ? "stdin" : o.answer;
        return verify_sweep(parse_sweep_file(text, name, LineChecks::index_only), name);
    }
    const std::optional<api::Unsealed> stored = api::unsealed(text);
    if (!stored)
        throw api::Problem(
            422,
            "this answer does not end with a provenance: it must be an unmodified JSON answer of "
            "this program");
    return verify_answer(*stored, o);
}

}  // namespace

Command add_verify(CLI::App& app) {
    const auto options = std::make_shared<VerifyOptions>();
    CLI::App* command =
        app.add_subcommand("verify", "recompute an answer and compare byte for byte");
    add_file(*command, "answer", options->answer, "file with the answer; - or nothing: stdin");
    add_file(
        *command, "--record", options->record, "for an identification: the file that was sent");
    return with_exit_codes(
        command, [options] { return verify(*options); },
        "vines simulate -p preset=fig11 -o answer.json; vines verify answer.json\n"
        "vines identify record.csv -p preset=fig20 | vines verify --record record.csv");
}

}  // namespace vines::cli
