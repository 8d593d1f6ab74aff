// Fuzz target: a sweep of a few points. Each line is JSON, is written once and is a row of a table.
#include "api/sweep.hpp"

#include <set>

#include "api/format/sweep_table.hpp"
#include "api/json_text.hpp"
#include "api/parse.hpp"
#include "fuzz.hpp"

using namespace vines;

namespace {

constexpr std::size_t most_points = 64;
// About a tenth of a second under the sanitizers.
constexpr long max_sweep_calls = 400;

class ShortControl : public RunControl {
public:
    bool stop_or_yield() override { return stopped_ = stopped_ || call_limit_.is_over(); }
    bool has_stopped() const { return stopped_; }

private:
    fuzz::CallLimit call_limit_{max_sweep_calls};
    bool stopped_ = false;
};

void check_line(std::size_t index, const std::string& text) {
    const api::Json line = api::Json::parse(text);
    fuzz::require(line["type"] == "point", "a line contains a point");
    fuzz::require(line["index"] == index, "a line contains its index");
}

void check_sweep(const api::SweepRequest& request) {
    const std::vector<std::size_t>& wanted = request.plan.lines;
    fuzz::require(
        api::Json::accept(api::json_line(api::sweep_start(request))), "the first line is JSON");
    ShortControl control;
    std::set<std::size_t> seen;
    api::SweepTable table(request, api::Format::csv);
    api::run_sweep(request, 1, control, [&](std::size_t index, const std::string& text) {
        check_line(index, text);
        fuzz::require(seen.insert(index).second, "a line is written once");
        fuzz::require(
            std::binary_search(wanted.begin(), wanted.end(), index), "a line was requested");
        table.add(index, text);  // throws for a name without column
    });
    fuzz::require(control.has_stopped() || seen.size() == wanted.size(), "all lines are written");
}

}  // namespace

void fuzz::sweep(std::string_view text) {
    fuzz::or_problem(
        [text] { check_sweep(api::read_sweep_request(api::parse_object(text), most_points)); });
}
