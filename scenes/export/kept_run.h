#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "export/checkpoint.h"
#include "run/run_scene.h"

namespace percale::scenes {

/// What a report says of a run that has ended by itself.
struct EndedRun {
    struct Expected {
        bool passed = false;
        std::string text;  // "largest_strain 0.12, expected < 0.3: passed"
    };
    std::string status, reason;  // of RunVerdict
    int steps = 0;
    double simulated_s = 0.0, wall_s = 0.0;
    std::vector<Expected> expectations;     // in the order of the scene
    std::map<std::string, double> numbers;  // measures, costs and whatever else the report says as one number, by its name

    /// How many expectations passed.
    std::size_t passed() const { return static_cast<std::size_t>(std::ranges::count(expectations, true, &Expected::passed)); }
};

/// Nothing where a run's folder holds no report, one that is not whole, or one of a run that was stopped.
std::optional<EndedRun> ended_run(const std::string& folder);

/// All that determines the result of a run, as JSON: the program, options, settings, expectations, and a checksum of the scene
/// file and of every file that it names. Files that those name in turn (a .gltf's buffers) are not looked at. Throws SceneError
/// where a file that is there cannot be read.
std::string run_origin(const Scene& scene, const RunMarks& marks, const std::string& program);

/// The difference between two origins: "step.time_step is 0.01, was 0.02", "expectations have changed", "ball.obj has changed";
/// "" where nothing does.
std::string changed_origin(const std::string& now, const std::string& before);

/// The version of this program and a checksum of its file and the libraries of the project that it has loaded (own_files); other
/// libraries are not looked at. Throws SceneError where a file cannot be read.
std::string program_checksum();

/// A run whose folder is kept to be taken up again: what has ended is not made again, what was interrupted goes on from its last
/// checkpoint, and what follows from other files, settings, expectations or another program begins anew. Beside what a run leaves
/// the folder holds origin.json, and a checkpoint until the run has ended.
class KeptRun {
public:
    /// Looks at what the folder holds; changes nothing. Throws SceneError for what run_origin does, and for the folder of a run
    /// that was made otherwise.
    KeptRun(std::string folder, const Scene& scene, const RunMarks& marks, const std::string& program);

    const std::optional<EndedRun>& ended() const { return ended_; }
    /// Why the kept result cannot be used: "ball.obj has changed"; "" where there is none, or it can be used.
    const std::string& why_again() const { return why_again_; }
    /// The hash of the last state of a run that has ended, if its table has one, as 16 hexadecimal digits.
    std::string state_hash() const;

    /// Runs the scene, or goes on with it, and leaves its report. `stops`: stop_asked and cancel alone are looked at. Throws what
    /// run_scene and RunFolder do.
    RunResult run(BuiltScene& built, const RunHooks& stops, std::span<const Expectation> expectations);

private:
    void look(const Scene& scene);

    std::string folder_, origin_, why_again_;
    RunMarks marks_;
    std::optional<EndedRun> ended_;
    std::optional<Checkpoint> from_;
};

}  // namespace percale::scenes
