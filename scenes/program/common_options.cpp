#include "program/common_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>

#include "common/text.h"
#include "format/expectations.h"
#include "frames/frame_formats.h"
#include "percale/error.h"

namespace percale::program {

namespace {

/// "a, b or c".
std::string alternatives(std::vector<std::string> words) {
    const std::string last = words.back();
    words.pop_back();
    return words.empty() ? last : scenes::joined(words) + " or " + last;
}

/// a,b as TOML writes a list of texts.
std::string list_of_words(const std::string& text) {
    std::string list = "[\"";
    for (const char letter : text) list += letter == ',' ? std::string("\", \"") : std::string(1, letter);
    return list + "\"]";
}

}  // namespace

void add_scene_options(CLI::App& command, CommonOptions& options) {
    command.add_option("--set", options.set, "Override one key of the scene file; may be given several times")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command.add_flag("--no-skip", options.no_skip, "Run also what the scene does not need (step.skip = false)");
}

void add_common_options(CLI::App& command, CommonOptions& options) {
    add_scene_options(command, options);
    command.add_option("--threads", options.threads, "Threads of the simulation (step.threads)")->type_name("N");
    command.add_flag("--quiet", options.quiet, "Print nothing but errors");
    command
        .add_option("--frames", options.frames,
                    "Format of the frames: " + alternatives(scenes::frame_words()) + "; or several, with commas between")
        ->type_name("FORMAT");
    command.add_option("--fps", options.fps, "Output frames per simulated second (default 30)")->type_name("F");
    command.add_flag("--certify-steps", options.certify_steps,
                     "Certify the state after every step, not only output frames; fails where one is not clear");
    command.add_flag("--replay-hash", options.replay_hash,
                     "A hash of the state for every step in steps.csv; check prints the last");
}

std::vector<scenes::Expectation> expected_of(const scenes::Scene& scene, const CommonOptions& options) {
    return options.certify_steps ? scenes::with_every_step(scene.expectations) : scene.expectations;
}

std::vector<scenes::Override> scene_overrides(const CommonOptions& options) {
    std::vector<scenes::Override> overrides;
    for (const std::string& text : options.set) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0)
            throw SceneError("--set " + text + ": must be KEY=VALUE, such as --set step.time_step=0.01");
        overrides.push_back({text.substr(0, equals), text.substr(equals + 1)});
    }
    if (!options.threads.empty()) overrides.push_back({"step.threads", options.threads, "--threads"});
    if (options.no_skip) overrides.push_back({"step.skip", "false", "--no-skip"});
    if (!options.frames.empty()) overrides.push_back({"output.frames", list_of_words(options.frames), "--frames"});
    if (!options.fps.empty()) overrides.push_back({"output.fps", options.fps, "--fps"});
    return overrides;
}

scenes::SceneSource scene_source(const std::string& file, const CommonOptions& options) {
    return [file, given = scene_overrides(options)](std::span<const scenes::Override> more) {
        std::vector<scenes::Override> overrides = given;
        overrides.insert(overrides.end(), more.begin(), more.end());
        return scenes::load_scene(file, overrides);
    };
}

void check_as_key(const scenes::SceneSource& source, const char* key, const char* option,
                  const std::vector<std::string>& values) {
    for (const std::string& value : values) source(std::vector<scenes::Override>{{key, value, option}});
}

void check_as_key(const scenes::SceneSource& source, const char* key, const char* option, const std::vector<double>& values) {
    std::vector<std::string> texts;
    for (const double value : values) texts.push_back(scenes::number_text(value));
    check_as_key(source, key, option, texts);
}

std::string default_folder(const std::string& scene) {
    const std::string stem = std::filesystem::path(scene).stem().string();
    if (stem.empty()) throw SceneError(scene + ": no folder can be named after this; name one with -o");
    return stem;
}

void check_range(const char* option, double value, double lowest, double highest, const char* unit) {
    if (value >= lowest && value <= highest) return;
    throw SceneError(std::string(option) + " " + scenes::number_text(value) + " is outside the allowed range " +
                     scenes::number_text(lowest) + " ... " + scenes::number_text(highest) + unit);
}

void check_once(const char* option, const std::vector<std::string>& values) {
    for (auto value = values.begin(); value != values.end(); ++value)
        if (std::find(values.begin(), value, *value) != value)
            throw SceneError(std::string(option) + " " + *value + ": given twice");
}

namespace {

std::optional<double> read_number(std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// "0.004" or "1/240".
std::optional<double> read_quotient(const std::string& text) {
    const std::size_t slash = text.find('/');
    const std::optional<double> first = read_number(std::string_view(text).substr(0, slash));
    if (!first || slash == std::string::npos) return first;
    const std::optional<double> second = read_number(std::string_view(text).substr(slash + 1));
    return second ? std::optional(*first / *second) : std::nullopt;
}

}  // namespace

std::vector<double> read_numbers(const char* option, const std::vector<std::string>& texts) {
    std::vector<double> values;
    for (const std::string& text : texts) {
        const std::optional<double> value = read_quotient(text);
        if (!value) throw SceneError(std::string(option) + " " + text + ": must be numbers such as 0.004 or 1/240");
        if (std::find(values.begin(), values.end(), *value) != values.end())
            throw SceneError(std::string(option) + " " + text + ": given twice");
        values.push_back(*value);
    }
    return values;
}

}  // namespace percale::program
