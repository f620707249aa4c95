#include "format/explain.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "program/commands.h"
#include "program/exit_codes.h"

namespace percale::program {

void add_explain_command(CLI::App& program, Action& action) {
    auto topic = std::make_shared<std::string>();
    CLI::App* command = program.add_subcommand("explain", "List the keys of scene files with unit, range and default");
    command->footer("Example: percale explain step.time_step");
    command->add_option("TOPIC", *topic,
                        "A key, a table of keys, or presets; scheme shows the table of schemes (default: all keys)");
    command->callback([topic, &action] {
        action = [topic] {
            scenes::explain(std::cout, *topic);
            return static_cast<int>(all_well);
        };
    });
}

}  // namespace percale::program
