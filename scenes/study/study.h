#pragma once

#include <string>
#include <vector>

#include "format/override.h"

namespace percale::scenes {

/// A scene run many times with other values of some keys, as a study file (TOML) says it:
///   scene = "drape.toml"                                      # relative to the study file
///   seed = 1, draws = 20                                      # for random values
///   frames = "none"                                           # of the runs
///   plot = ["fabric.sheet.springs.bend", "largest_strain"]    # what study.svg shows; else the first key that is a number
///   [vary]
///   "fabric.sheet.springs.bend" = [1.0, 10.0]                 # a list: each
///   "step.time_step" = { from = 1e-3, to = 1e-2, count = 4, scale = "log" }
///   "obstacle.ball.friction" = { uniform = [0.1, 0.9] }       # random: also log_uniform, normal = [mean, deviation]
/// Runs are all combinations of the lists and ranges, the last key changing fastest, and `draws` runs of each with values of its
/// own for what is random.
struct Study {
    std::string file, scene;  // paths that open
    std::string frames = "none";
    std::string plot_key = {}, plot_measure = "largest_strain";
    std::vector<std::string> keys;   // in the order of the file
    std::vector<std::string> forms;  // of each, how its values were said: list, linear, log, uniform, log_uniform, normal
    std::vector<std::vector<std::string>> runs;  // of each run the values of the keys, as --set takes them
};

/// Whether values said in this form are random.
bool is_random_form(const std::string& form);
/// Whether they are spread evenly in the logarithm.
bool is_log_form(const std::string& form);

/// Whether a file is a study: TOML with `scene` or [vary] at the top, which no scene has. Throws SceneError for what cannot be
/// read or is no TOML.
bool is_study_file(const std::string& file);

/// Whether a value, as --set takes it, is a number.
bool is_number(const std::string& value);
/// A value as people read it: a text without its quotes.
std::string shown_value(const std::string& value);

/// Runs of one study.
inline constexpr std::size_t max_runs = 1000000;

/// Reads a study file and has every run's scene checked. Throws SceneError with file, line and column: what is no study, and, for
/// the first run whose scene is refused, why.
Study read_study(const std::string& file);

/// What is changed in the scene of a run.
std::vector<Override> overrides_of(const Study& study, std::size_t run);

/// The study as it is kept in the folder of its runs, with the settings of its scene: what has another text is another study.
std::string study_text(const Study& study);
/// Reads it back; throws SceneError naming the file for what study_text has not written.
Study stored_study(const std::string& file);

}  // namespace percale::scenes
