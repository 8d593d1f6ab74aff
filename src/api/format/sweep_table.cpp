#include "api/format/sweep_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace vines::api {

namespace {

// Lists of four are numbered: the exponents, their statuses and errors.
constexpr std::size_t numbered = 4;

using VisitCell = std::function<void(const std::string& name, const Json& value)>;

/// Visits a line's values, and those of objects in it.
void visit_cells(const Json& line, const std::string& before, const VisitCell& visit) {
    for (const auto& [name, value] : line.items()) {
        if (name == "type" || name == "section") continue;
        if (value.is_object()) {
            visit_cells(value, before + name + ".", visit);
        } else if (!value.is_array()) {
            visit(before + name, value);
        } else if (value.size() == numbered && !value[0].is_structured()) {
            for (std::size_t k = 0; k < numbered; ++k)
                visit(before + name + std::to_string(k + 1), value[k]);
        }
    }
}

}  // namespace

std::string LinesInOrder::add(std::size_t index, std::string text) {
    waiting_[index] = std::move(text);
    std::string next;
    while (!waiting_.empty() && waiting_.begin()->first == indices_[returned_]) {
        next += waiting_.begin()->second;
        waiting_.erase(waiting_.begin());
        ++returned_;
    }
    return next;
}

std::string LinesInOrder::rest() const {
    std::string all;
    for (const auto& [index, text] : waiting_) all += text;
    return all;
}

SweepTable::SweepTable(const SweepRequest& request, Format format, std::size_t most_bytes)
    : request_(request),
      format_(format),
      rows_(request.plan.lines) {
    add_columns(describe_place(request, 0));
    for (const Json& line : sample_lines(request)) add_columns(line);
    if (format == Format::csv) return;
    if (bytes() > most_bytes)
        throw Problem(
            413, fmt::format(
                     "a table of {} points as {} has about {} bytes, more than {}: request ndjson, "
                     "csv, or fewer points (indices)",
                     request.plan.lines.size(), name_of(format).word, bytes(), most_bytes));
}

void SweepTable::make_rows() {
    has_rows_ = true;
    const std::size_t count = request_.plan.lines.size();
    for (Column& column : columns_) {
        if (column.kind == Kind::word) column.words.resize(count);
        else column.numbers.assign(count, std::numeric_limits<double>::quiet_NaN());
    }
}

void SweepTable::add_columns(const Json& line) {
    visit_cells(line, "", [this](const std::string& name, const Json& value) {
        // Null in the place of a list of four.
        if (value.is_null() && column_of_.contains(name + "1")) return;
        const auto [at, is_new] = column_of_.try_emplace(name, columns_.size());
        if (is_new) columns_.push_back({name});
        if (value.is_boolean()) columns_[at->second].kind = Kind::flag;
        if (value.is_string()) columns_[at->second].kind = Kind::word;
    });
}

std::string SweepTable::begin() const {
    std::string text;
    if (format_ != Format::csv) return text;
    for (const Column& column : columns_) text += (text.empty() ? "" : ",") + column.name;
    return text + '\n';
}

std::string SweepTable::add(std::size_t index, const std::string& line) {
    std::vector<Json> cells(columns_.size());  // null where there is none
    const auto take = [&](const std::string& name, const Json& value) {
        if (!value.is_null()) cells[column_of_.at(name)] = value;
    };
    visit_cells(Json::parse(line), "", take);
    // Exponents, also named lambda, hide a swept lambda.
    visit_cells(describe_place(request_, index), "", take);
    std::string text;
    if (format_ == Format::csv) {
        for (const Json& cell : cells) {
            if (&cell != cells.data()) text += ',';
            put_csv_value(cell, text);
        }
        return rows_.add(index, text + '\n');
    }
    if (!has_rows_) make_rows();
    const std::vector<std::size_t>& wanted = request_.plan.lines;
    const auto row =
        static_cast<std::size_t>(std::ranges::lower_bound(wanted, index) - wanted.begin());
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const Json& cell = cells[c];
        if (cell.is_string()) columns_[c].words[row] = cell.get<std::string>();
        else if (cell.is_boolean()) columns_[c].numbers[row] = cell.get<bool>();
        else if (cell.is_number()) columns_[c].numbers[row] = cell.get<double>();
    }
    return text;
}

std::string SweepTable::end(const std::string& warning) {
    if (format_ == Format::csv) return "";
    Json answer = sweep_start(request_);
    answer.erase("type");
    answer.erase("points");  // their count
    if (request_.basins) answer.update(describe_basins(request_));
    if (!warning.empty()) answer["warnings"].push_back(warning);
    Json points = Json::object();
    for (Column& c : columns_) {
        if (c.kind == Kind::word) points[c.name] = std::exchange(c.words, {});
        else if (c.name == "index")
            points[c.name] = column(c.numbers, [](double n) { return static_cast<int>(n); });
        else points[c.name] = column(std::exchange(c.numbers, {}));
    }
    if (format_ == Format::npz)
        return npz_bytes(std::move(answer), {}, object({{"points", std::move(points)}}));
    answer["points"] = std::move(points);
    return cbor_bytes(std::move(answer));
}

std::size_t SweepTable::bytes() const {
    // A word has up to 16 characters, most have less; npz takes four bytes for each.
    constexpr std::size_t number = sizeof(double), word = 64, others = std::size_t{1} << 20;
    if (format_ == Format::csv) return others;
    std::size_t of_row = 0;
    for (const Column& c : columns_) of_row += c.kind == Kind::word ? word : number;
    return others + of_row * request_.plan.lines.size();
}

SweepStream::SweepStream(SweepRequest request, Format format, std::size_t most_bytes)
    : request_(std::move(request)) {
    request_.plan.in_order = format == Format::csv;
    if (format != Format::json) table_.emplace(request_, format, most_bytes);
}

std::string SweepStream::begin() const {
    if (table_) return table_->begin();
    Json start = sweep_start(request_);
    start["of"] = request_.plan.lines.size();
    return json_line(std::move(start));
}

// Memory of a row of a section: in a point in work, in its line, and in the line on its way. Bytes.
constexpr std::size_t bytes_of_row = 400;
// Points in work at once have at most this, or are one. A thread keeps its point while it waits.
constexpr std::size_t most_in_work = 48 << 20;
// Memory of a start of basins, with its part of the system and the motions.
constexpr std::size_t bytes_of_start = 300;
// Memory of a sample of a recorded load in the request, which keeps time and value three times.
constexpr std::size_t bytes_of_sample = 6 * sizeof(Json);

std::size_t SweepStream::listed() const {
    const PointOptions& options = request_.plan.options;
    return options.section == SectionKind::none ? 0 : options.section_points;
}

std::size_t SweepStream::bytes_of_point() const {
    const SystemFields& fields = request_.systems->kinds[0].fields;
    const std::size_t of_load = fields.forcing ? fields.forcing->bytes(si_of(fields).f0()) : 0;
    return listed() * bytes_of_row + of_load;
}

/// How many of these threads compute.
int SweepStream::used_of(int threads) const {
    const std::size_t fitting = most_in_work / std::max<std::size_t>(1, bytes_of_point());
    return std::clamp(static_cast<int>(fitting), 1, threads);
}

std::size_t SweepStream::bytes(int threads) const {
    const Json::json_pointer samples("/base/forcing/time_s");
    return static_cast<std::size_t>(used_of(threads)) * bytes_of_point() +
           (request_.basins ? request_.plan.lines.size() * bytes_of_start : 0) +
           (request_.given.contains(samples) ? request_.given[samples].size() * bytes_of_sample
                                             : 0) +
           (table_ ? table_->bytes() : 0);
}

bool SweepStream::compute(int threads, RunControl& control, const Take& take) {
    warning_ = run_sweep(
        request_, used_of(threads), control, [&](std::size_t index, const std::string& line) {
            take(table_ ? table_->add(index, line) : line + '\n');
            ++lines_;
        });
    return lines_ == request_.plan.lines.size();
}

std::string SweepStream::progress(
    std::size_t done, const RunControl& control, double seconds) const {
    if (table_) return "";
    const std::size_t of = request_.plan.lines.size(), runs = control.runs,
                      runs_of = request_.plan.runs(),
                      runs_left = done < of ? runs_of - std::min(runs, runs_of) : 0;
    return json_line(
        {{"type", "progress"},
         {"done", done},
         {"of", of},
         {"per_second", seconds > 0 ? static_cast<double>(done) / seconds : 0},
         {"seconds_left",
          runs > 0 ? Json(static_cast<double>(runs_left) * seconds / static_cast<double>(runs))
                   : Json(nullptr)},
         {"runs", runs},
         {"runs_of", runs_of}});
}

std::string SweepStream::end() {
    if (lines_ < request_.plan.lines.size()) return "";
    if (table_) return table_->end(warning_);
    std::string last = done_line(lines_, request_);
    if (warning_.empty()) return last;
    return json_line({{"type", "warning"}, {"message", warning_}}) + last;
}

const char* SweepStream::remedy() const {
    return table_ ? nullptr : "request the missing indices again";
}

}  // namespace vines::api
