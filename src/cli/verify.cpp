// `vines verify`: whether an answer is what this program answers, too.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "api/answers/asked.hpp"
#include "api/parse_object.hpp"
#include "api/sweep.hpp"
#include "api/version.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/numbers.hpp"
#include "cli/read_back.hpp"
#include "cli/signal_pace.hpp"
#include "cli/stop_signals.hpp"
#include "cli/sweep_file.hpp"
#include "program/print.hpp"
#include "program/tell.hpp"

namespace vines::cli {

namespace {

using api::Json;

struct VerifyOptions {
    std::string answer, record;
};

void say(const std::string& line) { print(line + "\n"); }

void say_stopped() { tell("stopped before all was recomputed"); }

/// A value in a line, however large and deep it is.
std::string in_line(const Json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return fmt::format("a list of {}", value.size());
    return api::shortened(value.dump());
}

/// Where two answers first differ: "impacts.tau[3]: 1.0 became 2.0"; empty: nowhere.
std::string difference(const Json& told, const Json& made, const std::string& path) {
    const auto below = [&path](const std::string& name) {
        return path.empty() ? name : path + "." + name;
    };
    if (told.is_object() && made.is_object()) {
        for (const auto& [name, value] : told.items()) {
            if (!made.contains(name)) return below(name) + " is no more";
            if (std::string found = difference(value, made[name], below(name)); !found.empty())
                return found;
        }
        for (const auto& [name, value] : made.items())
            if (!told.contains(name)) return below(name) + " is new";
        return {};
    }
    if (told.is_array() && made.is_array()) {
        for (std::size_t k = 0; k < std::min(told.size(), made.size()); ++k)
            if (std::string found = difference(told[k], made[k], fmt::format("{}[{}]", path, k));
                !found.empty())
                return found;
        if (told.size() == made.size()) return {};
        return fmt::format("{} has {} entries in place of {}", path, made.size(), told.size());
    }
    return told == made ? std::string()
                        : fmt::format("{}: {} became {}", path, in_line(told), in_line(made));
}

/// An answer that is made once more: its text without provenance, and that.
struct Recomputed {
    std::string text;
    api::Provenance provenance;
};

/// Whether an answer's text is the same; says where it is not.
bool same_text(const std::string& told, const std::string& made) {
    if (told == made) {
        say(fmt::format("recomputed: the same {} bytes", made.size()));
        return true;
    }
    const std::string where = difference(read_back(told), read_back(made), "");
    say("recomputed: " + (where.empty() ? "the same numbers, written in another way" : where));
    return false;
}

/// The same of what it was made of, which its hash does not cover: but for the hash, and for the
/// commit, which another build has another one of.
bool same_provenance(const Json& told, const api::Provenance& provenance) {
    Json made = api::describe(provenance, told["sha256"]);
    if (!word_at(told, "commit").empty()) made["commit"] = told["commit"];
    if (told.dump() == made.dump()) return true;
    const std::string where = difference(told, made, "");
    say("provenance: " + (where.empty() ? "the same, written in another way" : where));
    return false;
}

/// A request with what was measured, of the file that was sent.
api::Asked asked_again(const api::Provenance& p, const std::string& record) {
    Json fields = p.request;
    const bool is_columns = !record.empty() && !is_json(record);
    if (!record.empty() && !is_columns) {
        const Json whole = api::parse_object(record);
        for (const char* name : {"record", "impacts"})
            if (whole.contains(name)) fields[name] = whole[name];
    }
    return api::read_asked(p.route, std::move(fields), {record, is_columns});
}

/// The same request's answer. Throws Problem where it has none.
Recomputed recomputed(const api::Provenance& p, const std::string& record) {
    api::Answer answer = api::answered(
        asked_again(p, record),
        {.stop = {.asked = stopped}, .most_bytes = p.answer_limit.value_or(api::any_size)});
    Recomputed made{.text = {}, .provenance = std::move(*answer.provenance)};
    answer.provenance.reset();
    Pace pace;
    api::write_answer(
        std::move(answer), pace, [&made](std::string_view piece) { made.text += piece; });
    made.text.pop_back();  // the line's end
    return made;
}

/// The same; none where a signal stops it.
std::optional<Recomputed> recomputed_to_its_end(
    const api::Provenance& p, const std::string& record) {
    const Stoppable stoppable(say_stopped);
    Recomputed made;
    try {
        made = recomputed(p, record);
    } catch (const api::Problem&) {  // what an identification that is stopped says
        if (!stopped()) throw;
    }
    return stopped() ? std::nullopt : std::optional(std::move(made));
}

/// Whether it ended before its end, so that another time it may get further.
bool was_ended(const Json& answer) {
    const auto status = answer.find("status");
    const std::string reason = status != answer.end() ? word_at(*status, "reason") : "";
    return reason == "deadline" || reason == "interrupted";
}

std::string build_of(const std::string& version, const std::string& commit) {
    return commit.empty() ? version : version + " (" + commit + ")";
}

/// What an answer, and its provenance, say of the program that made it.
void say_builds(const Json& answer, const Json& provenance) {
    const std::string version = word_at(answer, "version"), commit = word_at(provenance, "commit");
    say(fmt::format(
        "answered by {}, recomputed by {}",
        build_of(api::shortened(version), api::shortened(commit)),
        build_of(api::version(), api::commit())));
    if (commit != api::commit())
        say("commit: another build's than this program's; that such a build answered is not shown");
}

/// The file that an identification was sent; empty of another answer. Throws Problem where it is
/// not named.
std::string record_of(const Json& provenance, const VerifyOptions& o) {
    if (!provenance.contains("record_sha256")) return "";
    if (o.record.empty())
        throw api::Problem(
            422, "what was measured is not in the answer: name its file by --record");
    std::string record = read_file(o.record);
    if (provenance["record_sha256"] != api::sha256(record))
        say("record: another file than the one that was sent");
    return record;
}

api::Provenance read_provenance(const Json& told) {
    api::Provenance read{.route = told["route"], .request = told["request"]};
    const auto limit = told.find("answer_limit");
    if (limit != told.end() && limit->is_number_unsigned())
        read.answer_limit = limit->get<std::size_t>();
    return read;
}

int verify_answer(const api::Unsealed& told, const VerifyOptions& o) {
    const Json answer = read_back(told.text);
    if (!answer.is_object())
        throw api::Problem(
            422,
            "what stands before the provenance is no JSON object: the file is not one answer, as "
            "it was answered");
    say_builds(answer, told.provenance);
    const bool untouched = told.provenance["sha256"] == api::sha256(told.text);
    say(untouched ? "sha256: as told" : "sha256: the answer was changed");
    const std::string record = record_of(told.provenance, o);
    if (was_ended(answer)) {
        say("not decided: the run was ended before its end, by a time limit or a signal");
        return incomplete;
    }
    const std::optional<Recomputed> made =
        recomputed_to_its_end(read_provenance(told.provenance), record);
    if (!made) {
        say_stopped();
        return stopped_code();
    }
    const bool same = same_text(told.text, made->text);
    return same_provenance(told.provenance, made->provenance) && same && untouched ? complete
                                                                                   : differs;
}

/// The points that a file has, whatever is missing.
int verify_sweep(const SweepFile& file, const std::string& name) {
    const Json start = read_back(file.start);
    say_builds(start, start);
    api::SweepRequest request = request_of(file, name);
    request.plan.lines.clear();
    for (const auto& [index, line] : file.points) request.plan.lines.push_back(index);
    std::optional<std::string> first;
    std::size_t same = 0, all = 0;
    SignalPace pace;
    const Stoppable stoppable(say_stopped);
    api::run_sweep(request, cores(), pace, [&](std::size_t index, const std::string& made) {
        const std::string& told = file.points.at(index).text;
        ++all;
        same += told == made;
        if (told != made && !first)
            first = fmt::format(
                "point {}: {}", index, difference(read_back(told), read_back(made), ""));
    });
    say(fmt::format("recomputed: {} of {} points are the same", same, file.points.size()));
    if (first) say(*first);
    if (all < file.points.size()) return stopped_code();
    return first ? differs : complete;
}

int verify(const VerifyOptions& o) {
    const std::string text = read_all(o.answer);
    if (text.starts_with("{\"type\":\"start\"")) {
        const std::string name = is_standard(o.answer) ? "stdin" : o.answer;
        return verify_sweep(parse_sweep_file(text, name, Lines::placed), name);
    }
    const std::optional<api::Unsealed> told = api::unsealed(text);
    if (!told)
        throw api::Problem(
            422,
            "there is no provenance at the end of this answer: it is none of this program's, or "
            "not as it was answered, in JSON");
    return verify_answer(*told, o);
}

}  // namespace

Command add_verify(CLI::App& app) {
    const auto options = std::make_shared<VerifyOptions>();
    CLI::App* command =
        app.add_subcommand("verify", "recompute an answer and compare byte for byte");
    command->add_option("answer", options->answer, "file with the answer; - or nothing: stdin")
        ->type_name("FILE");
    command->add_option("--record", options->record, "of an identification: the file that was sent")
        ->type_name("FILE");
    return with_exit_codes(
        command, [options] { return verify(*options); },
        "vines simulate -p preset=fig11 -o answer.json; vines verify answer.json\n"
        "vines identify record.csv -p preset=fig20 | vines verify --record record.csv");
}

}  // namespace vines::cli
