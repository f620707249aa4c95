#include "format/explain.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "program/commands.h"
#include "program/exit_codes.h"

namespace percale::program {

namespace {

constexpr const char* key_file_head =
    "# Keys of a scene file\n\n"
    "Written by `percale explain --markdown`; a test compares. `percale explain cloth.pin` prints a part of it.\n\n";

}  // namespace

void add_explain_command(CLI::App& program, Action& action) {
    auto topic = std::make_shared<std::string>();
    auto markdown = std::make_shared<bool>(false);
    CLI::App* command = program.add_subcommand("explain", "List the keys of scene files with unit, range and default");
    command->footer("Example: percale explain step.time_step");
    CLI::Option* one = command->add_option(
        "TOPIC", *topic, "A key, a table of keys, or presets; scheme shows the table of schemes (default: all keys)");
    command->add_flag("--markdown", *markdown, "All keys as the tables of scenes/scene_keys.md")->excludes(one);
    command->callback([topic, markdown, &action] {
        action = [topic, markdown] {
            if (*markdown)
                std::cout << key_file_head << scenes::key_tables_markdown();
            else
                scenes::explain(std::cout, *topic);
            return static_cast<int>(all_well);
        };
    });
}

}  // namespace percale::program
