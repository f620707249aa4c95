#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace percale::program {

/// What is left to do once the command line is read; returns an ExitCode and throws SceneError for wrong input.
using Action = std::function<int()>;

// Each adds one subcommand to the program, which sets the action when it is given.
void add_run_command(CLI::App& program, Action& action);
void add_plan_command(CLI::App& program, Action& action);
void add_check_command(CLI::App& program, Action& action);
void add_explain_command(CLI::App& program, Action& action);
void add_certify_command(CLI::App& program, Action& action);
void add_doctor_command(CLI::App& program, Action& action);
void add_drape_command(CLI::App& program, Action& action);
void add_picture_command(CLI::App& program, Action& action);
void add_replay_command(CLI::App& program, Action& action);
void add_report_command(CLI::App& program, Action& action);
void add_sew_command(CLI::App& program, Action& action);

/// Adds study, and its presets as commands: compare, stress, sweep.
void add_study_commands(CLI::App& program, Action& action);

}  // namespace percale::program
