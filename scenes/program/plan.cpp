#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "program/commands.h"
#include "program/common_options.h"
#include "program/exit_codes.h"
#include "run/scene_plan.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

struct PlanOptions {
    CommonOptions common;
    std::string scene;
    bool json = false;
};

int plan(const PlanOptions& options) {
    const BuiltScene built = build_scene(load_scene(options.scene, scene_overrides(options.common)));
    std::fputs((options.json ? plan_json(built) : plan_text(built)).c_str(), stdout);
    return all_well;
}

}  // namespace

void add_plan_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<PlanOptions>();
    CLI::App* command = program.add_subcommand("plan", "Say what a run of a scene would do, leave out and cost; runs nothing");
    command->footer("Example: percale plan data/scenes/hang.toml --set duration=1");
    command->add_option("SCENE", options->scene, "Scene file (TOML)")->required();
    command->add_flag("--json", options->json, "As JSON");
    add_scene_options(*command, options->common);
    command->callback([options, &action] { action = [options] { return plan(*options); }; });
}

}  // namespace percale::program
