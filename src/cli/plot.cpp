// `vines plot`: draws an answer.
#include <memory>

#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/pictures.hpp"

namespace vines::cli {

Command add_plot(CLI::App& app) {
    const auto files = std::make_shared<Files>();
    CLI::App* command = app.add_subcommand("plot", "draw an answer, here or as SVG");
    command
        ->add_option(
            "answer", files->input, "a run's answer or a sweep's lines; - or nothing: stdin")
        ->type_name("FILE");
    command
        ->add_option("--output,-o", files->output, "file for SVG, FILE.svg; nothing: the terminal")
        ->type_name("FILE");
    return with_exit_codes(
        command,
        [files] {
            draw(plots_of(read_all(files->input)), files->output);
            return static_cast<int>(complete);
        },
        "vines simulate -p preset=fig11 -o answer.json; vines plot answer.json\n"
        "vines plot sweep.ndjson -o sweep.svg");
}

}  // namespace vines::cli
