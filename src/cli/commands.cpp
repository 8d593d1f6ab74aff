#include "cli/commands.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "api/identify.hpp"
#include "api/simulate.hpp"
#include "api/sweep.hpp"
#include "cli/sweep_file.hpp"

namespace vines::cli {

namespace {

using api::Json;
using Clock = std::chrono::steady_clock;

// More points than this do not fit a file that is put in order in memory.
constexpr std::size_t most_points = 10'000'000;

std::atomic<bool> stopped = false;

bool standard(const std::string& path) { return path.empty() || path == "-"; }

std::string read_all(const std::string& path) {
    std::ostringstream text;
    if (standard(path)) {
        text << std::cin.rdbuf();
        return text.str();
    }
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno));
    text << in.rdbuf();
    return text.str();
}

void write_all(const std::string& path, const std::string& text) {
    if (!standard(path)) return replace_file(path, text);
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw std::runtime_error(std::string("cannot write to stdout: ") + std::strerror(errno));
}

/// Runs a command; what is wrong with its request or its files becomes a message and an exit code.
int guarded(const std::function<int()>& command) {
    try {
        return command();
    } catch (const api::Problem& problem) {
        std::fprintf(stderr, "%s\n", problem.body().c_str());
        return refused;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "vines: %s\n", e.what());
        return failed;
    }
}

/// A bar on stderr, where that is a terminal.
class Bar {
public:
    Bar(std::size_t done, std::size_t of) : done_(done), of_(of), done_before_(done) { draw(true); }
    ~Bar() {
        if (shown_) std::fputs("\n", stderr);
    }
    void step() {
        ++done_;
        draw(done_ == of_);
    }

private:
    void draw(bool always) {
        const auto now = Clock::now();
        if (!shown_ || (!always && now - drawn_ < std::chrono::milliseconds(100))) return;
        drawn_ = now;
        const double seconds = std::chrono::duration<double>(now - started_).count(),
                     rate = static_cast<double>(done_ - done_before_) / std::max(seconds, 1e-9);
        const int width = 30, full = of_ ? static_cast<int>(width * done_ / of_) : width;
        std::fprintf(
            stderr, "\r[%s%s] %zu of %zu points", std::string(full, '#').c_str(),
            std::string(width - full, '.').c_str(), done_, of_);
        if (done_ > done_before_)
            std::fprintf(
                stderr, ", %.3g per second, %.0f s left  ", rate,
                static_cast<double>(of_ - done_) / rate);
        std::fflush(stderr);
    }
    std::size_t done_;
    const std::size_t of_, done_before_;
    const bool shown_ = ::isatty(2) == 1;
    const Clock::time_point started_ = Clock::now();
    Clock::time_point drawn_{};
};

class SignalPace : public api::Pace {
public:
    bool stop_or_yield() override { return stopped; }
};

std::pair<std::size_t, std::size_t> numbers(const std::string& shard, const std::string& of) {
    const auto number = [](const std::string& text) -> long {
        char* end = nullptr;
        errno = 0;
        const long value = std::strtol(text.c_str(), &end, 10);
        return text.empty() || *end || errno || value < 0 ? -1 : value;
    };
    const long i = number(shard), n = number(of);
    if (i < 0 || n < 1 || i >= n)
        throw api::Problem(422, "a shard is i/N with 0 <= i < N, not " + shard + "/" + of);
    return {static_cast<std::size_t>(i), static_cast<std::size_t>(n)};
}

/// i and N of "i/N", or of "auto" from the environment.
std::pair<std::size_t, std::size_t> shard_numbers(const SweepOptions& o) {
    if (o.shard.empty()) return {0, 1};
    if (o.shard != "auto") {
        const std::size_t slash = std::min(o.shard.find('/'), o.shard.size());
        return numbers(
            o.shard.substr(0, slash), slash < o.shard.size() ? o.shard.substr(slash + 1) : "");
    }
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::string(value ? value : "");
    };
    const std::string given = o.shards > 0 ? std::to_string(o.shards) : "";
    if (!variable("SLURM_ARRAY_TASK_ID").empty()) {
        const std::string least = variable("SLURM_ARRAY_TASK_MIN"),
                          id = variable("SLURM_ARRAY_TASK_ID");
        const long first = least.empty() ? 0 : std::strtol(least.c_str(), nullptr, 10);
        return numbers(
            std::to_string(std::strtol(id.c_str(), nullptr, 10) - first),
            given.empty() ? variable("SLURM_ARRAY_TASK_COUNT") : given);
    }
    if (!variable("JOB_COMPLETION_INDEX").empty())
        return numbers(variable("JOB_COMPLETION_INDEX"), given);
    throw api::Problem(
        422,
        "--shard auto needs SLURM_ARRAY_TASK_ID and SLURM_ARRAY_TASK_COUNT, or "
        "JOB_COMPLETION_INDEX and --shards, in the environment");
}

/// Appends lines to a file as they come, each in one write, so that a killed run keeps all of them.
class Appending {
public:
    explicit Appending(const std::string& path)
        : path_(path),
          file_(std::fopen(path.c_str(), "ab")) {
        if (!file_) throw std::runtime_error("cannot write " + path + ": " + std::strerror(errno));
    }
    ~Appending() { std::fclose(file_); }
    Appending(const Appending&) = delete;
    Appending& operator=(const Appending&) = delete;
    void line(const std::string& text) {
        const std::string whole = text + "\n";
        if (std::fwrite(whole.data(), 1, whole.size(), file_) != whole.size() ||
            std::fflush(file_) != 0)
            throw std::runtime_error("cannot write " + path_ + ": " + std::strerror(errno));
    }

private:
    const std::string path_;
    std::FILE* file_;
};

/// The output file as an earlier run left it; a new one where there is none.
SweepFile resumed(const SweepOptions& o, const std::string& start) {
    SweepFile file;
    if (!standard(o.files.output) && ::access(o.files.output.c_str(), F_OK) == 0) {
        if (!o.resume)
            throw std::runtime_error(o.files.output + " is there already; --resume completes it");
        file = read_sweep_file(o.files.output);
        if (!file.start.empty() && file.start != start)
            throw std::runtime_error(
                o.files.output +
                " belongs to another sweep (or another version): its first line differs");
    }
    file.start = start;
    return file;
}

int run(const SweepOptions& o) {
    api::SweepRequest request =
        api::read_sweep_request(api::parse_object(read_all(o.files.input)), most_points);
    const auto [shard, shards] = shard_numbers(o);
    request.plan.lines = api::shard_of(request, shard, shards);
    const std::size_t of = request.plan.lines.size();
    const bool to_file = !standard(o.files.output);
    SweepFile file = resumed(o, api::sweep_start(request).dump());
    std::erase_if(request.plan.lines, [&](std::size_t i) { return file.points.contains(i); });

    // Without what a killed run left half written.
    if (to_file) {
        std::string kept = file.start + "\n";
        for (const auto& [index, line] : file.points) kept += line + "\n";
        replace_file(o.files.output, kept);
    }
    std::optional<Appending> out;
    if (to_file) out.emplace(o.files.output);
    Bar bar(of - request.plan.lines.size(), of);
    SignalPace pace;
    const int threads = o.threads > 0
                            ? o.threads
                            : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const std::string warning =
        api::run_sweep(request, threads, pace, [&](std::size_t index, const Json& line) {
            std::string text = line.dump();
            if (out) out->line(text);
            file.points[index] = std::move(text);
            bar.step();
        });
    out.reset();
    if (!warning.empty()) std::fprintf(stderr, "vines: %s\n", warning.c_str());
    if (file.points.size() == of) {
        write_all(o.files.output, file.text());
        return complete;
    }
    if (!to_file) write_all("", file.text().substr(0, file.text().rfind("{\"type\":\"done\"")));
    std::fprintf(
        stderr, "vines: stopped after %zu of %zu points%s\n", file.points.size(), of,
        to_file ? "; --resume completes the file" : "");
    return incomplete;
}

}  // namespace

int simulate(const Files& files) {
    return guarded([&] {
        const api::SimulateRequest request =
            api::read_simulate_request(api::parse_object(read_all(files.input)));
        write_all(
            files.output, api::simulate_answer(
                              request, {[] { return stopped.load(); }, "interrupted",
                                        "ended by a signal, before tau_end"})
                                  .dump() +
                              "\n");
        return stopped ? incomplete : complete;
    });
}

int identify(const Files& files, const std::string& query) {
    return guarded([&] {
        const std::string text = read_all(files.input);
        std::vector<std::pair<std::string, std::string>> pairs;
        for (std::size_t from = 0; from < query.size();) {
            const std::size_t end = std::min(query.find('&', from), query.size()),
                              equals = std::min(query.find('=', from), end);
            if (end > from)
                pairs.emplace_back(
                    query.substr(from, equals - from),
                    query.substr(std::min(equals + 1, end), end - std::min(equals + 1, end)));
            from = end + 1;
        }
        const std::size_t first = text.find_first_not_of(" \t\r\n");
        const bool json = first != std::string::npos && text[first] == '{';
        const api::IdentifyRequest request =
            json ? api::read_identify_request(api::parse_object(text))
                 : api::read_identify_request(api::from_query(api::identify_fields(), pairs), text);
        write_all(files.output, api::identify_answer(request).dump() + "\n");
        return complete;
    });
}

int sweep(const SweepOptions& options) {
    return guarded([&] { return run(options); });
}

int merge(const std::vector<std::string>& inputs, const std::string& output) {
    return guarded([&] {
        SweepFile all;
        for (const std::string& path : inputs) {
            SweepFile part = read_sweep_file(path);
            if (part.start.empty()) throw std::runtime_error(path + " is empty");
            if (all.start.empty()) all.start = part.start;
            if (part.start != all.start)
                throw std::runtime_error(
                    path + " belongs to another sweep than " + inputs[0] +
                    ": its first line differs");
            for (auto& [index, line] : part.points) {
                const auto [there, added] = all.points.try_emplace(index, line);
                if (!added && there->second != line)
                    throw std::runtime_error(
                        path + ": point " + std::to_string(index) +
                        " differs from the same point in another file");
            }
        }
        const std::size_t points = Json::parse(all.start)["points"].get<std::size_t>();
        if (all.points.size() < points) {
            std::size_t first = 0;
            for (const auto& [index, line] : all.points) {
                if (index != first) break;
                ++first;
            }
            std::fprintf(
                stderr,
                "vines: %zu of %zu points are missing, the first is %zu: a shard is not complete "
                "or was not given\n",
                points - all.points.size(), points, first);
            return incomplete;
        }
        write_all(output, all.text());
        return complete;
    });
}

void stop_on_signals() {
    std::thread([] {
        sigset_t signals;
        sigemptyset(&signals);
        sigaddset(&signals, SIGTERM);
        sigaddset(&signals, SIGINT);
        int signal;
        sigwait(&signals, &signal);
        stopped = true;
        sigwait(&signals, &signal);  // asked a second time: at once
        std::_Exit(128 + signal);
    }).detach();
}

}  // namespace vines::cli
