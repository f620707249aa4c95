#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "doctor/doctor_report.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/common_options.h"
#include "program/exit_codes.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

struct DoctorOptions {
    CommonOptions common;
    std::vector<std::string> files;
    std::string role;
    bool json = false;
};

DoctorSettings settings_of(const DoctorOptions& options) {
    DoctorSettings settings{.overrides = scene_overrides(options.common)};
    if (!options.role.empty()) settings.role = options.role == "cloth" ? MeshRole::cloth : MeshRole::obstacle;
    return settings;
}

int examine(const DoctorOptions& options) {
    const DoctorSettings settings = settings_of(options);
    std::vector<Diagnosis> diagnoses;
    for (const std::string& file : options.files) diagnoses.push_back(diagnose(file, settings));
    long errors = 0;
    for (const Diagnosis& diagnosis : diagnoses) {
        errors += diagnosis.count(Severity::error);
        if (!options.json) std::fputs(diagnosis_text(diagnosis).c_str(), stdout);
    }
    if (options.json) std::fputs(diagnoses_json(diagnoses).c_str(), stdout);
    return errors == 0 ? all_well : not_as_expected;
}

}  // namespace

void add_doctor_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<DoctorOptions>();
    CLI::App* command = program.add_subcommand("doctor", "Find what will go wrong with scenes and meshes, and say what mends it");
    command->footer(
        "Examples: percale doctor data/scenes/hang.toml\n"
        "          percale doctor body.obj --as obstacle\n"
        "Runs nothing. Exit code 1 if there is an error: something that will be refused or fail.");
    command->add_option("FILE", options->files, "Scene files (TOML) and mesh files")->required();
    command->add_option("--as", options->role, "What a mesh file is to be: cloth or obstacle (default: looked at as both)")
        ->type_name("ROLE")
        ->check(CLI::IsMember({"cloth", "obstacle"}));
    command->add_flag("--json", options->json, "As JSON");
    add_scene_options(*command, options->common);
    command->callback([options, &action] { action = [options] { return examine(*options); }; });
}

}  // namespace percale::program
