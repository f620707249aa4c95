#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
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
    std::string text;
    const auto look_at = [&](const std::string& file, std::string (*reported)(const Diagnosis&)) {
        diagnoses.push_back(diagnose(file, settings));
        text += reported(diagnoses.back());
    };
    for (const std::string& place : options.files) {
        std::error_code status;
        if (std::filesystem::is_directory(place, status)) {
            for (const std::string& file : examinable_files(place)) look_at(file, diagnosis_line);
        } else {
            look_at(place, diagnosis_text);
        }
    }
    std::fputs(options.json ? diagnoses_json(diagnoses).c_str() : text.c_str(), stdout);
    if (std::ranges::any_of(diagnoses, [](const Diagnosis& d) { return d.has("unreadable"); })) return wrong_input;
    const bool any = std::ranges::any_of(diagnoses, [](const Diagnosis& d) { return d.count(Severity::error) > 0; });
    return any ? not_as_expected : all_well;
}

}  // namespace

void add_doctor_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<DoctorOptions>();
    CLI::App* command = program.add_subcommand("doctor", "Find what will go wrong with scenes and meshes, and say what mends it");
    command->footer(
        "Examples: percale doctor data/scenes/hang.toml\n"
        "          percale doctor body.obj --as obstacle\n"
        "          percale doctor meshes/\n"
        "Runs nothing. Exit code 1 if there is an error: something that will be refused or fail.");
    command->add_option("FILE", options->files, "Scene files (TOML) and mesh files; of folders every such file in one line")
        ->required();
    command->add_option("--as", options->role, "What a mesh file is to be: cloth or obstacle (default: looked at as both)")
        ->type_name("ROLE")
        ->check(CLI::IsMember({"cloth", "obstacle"}));
    command->add_flag("--json", options->json, "As JSON");
    add_scene_options(*command, options->common);
    command->callback([options, &action] { action = [options] { return examine(*options); }; });
}

}  // namespace percale::program
