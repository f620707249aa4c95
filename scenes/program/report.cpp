#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "common/text.h"
#include "export/run_folder.h"
#include "page/run_page.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/exit_codes.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

struct ReportOptions {
    std::string folder, file;  // "" = in the folder
    PageOptions page;
    bool no_distance = false, quiet = false;
};

int report(ReportOptions options) {
    check_pages("percale report");
    if (!std::filesystem::is_directory(options.folder))
        throw SceneError(options.folder + ": is not the folder of a run; name one that `percale run` wrote");
    if (options.file.empty()) options.file = page_in(options.folder);
    options.page.distances = !options.no_distance;
    const PageSummary page = write_run_page(options.folder, options.file, options.page);
    if (!options.quiet) std::printf("%s\n", page_summary_text(options.file, page).c_str());
    return all_well;
}

}  // namespace

void add_report_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<ReportOptions>();
    CLI::App* command = program.add_subcommand("report", "Write a run as one HTML page: playback, diagrams, certificate, tables");
    command->footer(
        "The page needs no network and no other file. Frames must be OBJ or PLY; with output.fields the page shows them.\n"
        "Example: percale report out -o out.html");
    command->add_option("DIR", options->folder, "Folder of a run")->required();
    command->add_option("-o", options->file, "The page (default: DIR/report.html)")->type_name("FILE");
    command
        ->add_option("--most-megabytes", options->page.max_megabytes,
                     "Size of the page at most; frames are left out evenly to keep it (default 50)")
        ->type_name("MB");
    command->add_flag("--no-distance", options->no_distance, "Do not measure how far cloth is from obstacles");
    command->add_flag("--quiet", options->quiet, "Print nothing but errors");
    command->callback([options, &action] { action = [options] { return report(*options); }; });
}

}  // namespace percale::program
