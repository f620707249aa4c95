#pragma once

#include <string>
#include <vector>

#include "format/scene_file.h"

namespace CLI {
class App;
}

namespace percale::program {

/// What `run` and `check` both take.
struct CommonOptions {
    std::vector<std::string> set;  // KEY=VALUE
    std::string frames, fps;       // "" = as the scene says
    std::string threads;
    bool quiet = false;
    bool replay_hash = false;
    bool no_skip = false;
    bool certify_steps = false;
};

/// Adds --set and --no-skip, which change the scene.
void add_scene_options(CLI::App& command, CommonOptions& options);
/// Adds these and all other common options.
void add_common_options(CLI::App& command, CommonOptions& options);

/// What the scene expects, and with --certify-steps that every step is clear.
std::vector<scenes::Expectation> expected_of(const scenes::Scene& scene, const CommonOptions& options);

/// The options that stand for keys of the scene file, --set first. Throws SceneError for a --set that is not KEY=VALUE.
std::vector<scenes::Override> scene_overrides(const CommonOptions& options);

/// The scene of a file with what these options and then others override.
scenes::SceneSource scene_source(const std::string& file, const CommonOptions& options);

/// Checks values as if each were given for a key of the scene file. Throws SceneError naming the option.
void check_as_key(const scenes::SceneSource& source, const char* key, const char* option, const std::vector<std::string>& values);
void check_as_key(const scenes::SceneSource& source, const char* key, const char* option, const std::vector<double>& values);

/// The name of the scene file without its ending. Throws SceneError if that is empty.
std::string default_folder(const std::string& scene);

/// Throws SceneError naming the option if a value is outside of a range.
void check_range(const char* option, double value, double lowest, double highest, const char* unit = "");

/// Throws SceneError naming the option if a value is there twice.
void check_once(const char* option, const std::vector<std::string>& values);

/// The values of a list of numbers such as 0.004 or 1/240. Throws SceneError naming the option and the first that is none or that
/// is there twice.
std::vector<double> read_numbers(const char* option, const std::vector<std::string>& texts);

}  // namespace percale::program
