#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measures/measures.h"
#include "meshes/mesh_fields.h"
#include "run/scene_build.h"
#include "run/timeline.h"

// Runs a scene from its start to its end: steps, output frames, certificates, measures. Writes and prints nothing.
namespace percale::scenes {

enum class RunStatus { finished, failed, stopped };
const char* status_word(RunStatus status);

/// Cloth and obstacles at one output time in world coordinates: what is certified and what is written are these same numbers.
struct Frame {
    int index = 0;
    double time = 0.0;                    // s, of the state shown
    std::vector<TriangleMesh> cloths;     // in the order of the scene
    std::vector<TriangleMesh> obstacles;  // in the order of the scene
    std::vector<MeshFields> fields = {};  // of the cloths, as output.fields says; empty where that is empty
    PairsOfCloths meeting = {};           // that meet now and are certified, by numbers of the scene
    FrameCheck check;
};

/// Sums and extremes over the steps of a run.
struct RunTotals {
    int steps = 0;            // accepted
    int rejected_steps = 0;   // steps that were redone as shorter ones
    DroppedSubsteps dropped;  // why they were redone
    int unsolved_steps = 0;   // accepted with what the solver had come to: not_converged or tolerance_missed
    int sleeping_steps = 0;   // in which all cloth was at rest: not solved
    double simulated_s = 0.0;
    double smallest_step_s =
        std::numeric_limits<double>::infinity();  // of the parts that steps were solved in; infinity if none was accepted
    double largest_step_s = 0.0;
    long newton_iterations = 0;
    long linear_iterations = 0;
    double largest_residual = 0.0;
    LinearSolver linear_solver = LinearSolver::automatic;  // last in use; automatic if nothing was solved
    int contacts_most = 0;
    double contact_stiffness = 0.0;  // N/m, largest
    StageTimes stages;               // CPU seconds
    double cpu_s = 0.0;              // CPU seconds of all threads inside steps only
    double wall_s = 0.0;             // whole run, output included
    double certificate_s = 0.0;      // of wall time that the certificates of frames and states took
    std::vector<Pinch> pinches;      // in the order of their beginnings
    StepEnergy energy;               // J, at the end; work and losses are summed over the run
};

struct RunResult {
    RunStatus status = RunStatus::finished;
    std::string reason;  // why it failed or was stopped
    RunTotals totals;
    ScenePlan plan;  // before the first step
    Measures measures;
    std::optional<RestFigures> rest;  // of a scene that ends at rest
    std::vector<double> timed;        // of the scene's expectations, in their order: TimedMeasures, and `matches` at the end
    std::vector<std::vector<Vec3>> shapes;  // TimedMeasures::shapes; empty where a time was over when the run was resumed
    std::vector<double> resumed_at;         // s, where the run was resumed; empty for one that was not
};

/// The state of a run between two steps of the scene: together with the scene, all that it takes to continue.
struct RunState {
    RunTotals totals;
    Measures measures;
    std::vector<double> resumed_at;  // s
    long steps_made = 0;             // of the scene, undivided
    double step_length = 0.0;        // s, of the last one
    int next_frame = 0;
    bool framed = false;             // the state has a frame
    RestFigures rest;                // of a scene that ends at rest
    std::vector<double> timed = {};  // of RunResult
    Timeline::State timeline;
    std::vector<std::byte> simulation;  // Simulation::save
};

/// What the caller does meanwhile; each may be empty.
struct RunHooks {
    std::function<void()> begin;                                     // once, after all input was checked
    std::function<void(const Frame&)> frame;                         // each output frame, after it was certified
    std::function<void(const StepReport&, const Simulation&)> step;  // each step, a failed one too
    std::function<bool()> stop_asked;                                // asked after each step
    const std::atomic<bool>* cancel = nullptr;                       // true: stop amid a step (taken back) or certificate
    std::function<void(const RunState&)> checkpoint;                 // where one is due, and when the run is stopped after a step
};

struct RunSettings {
    bool certify_steps = false;      // certify every state, not only those of output frames: Measures::steps
    bool compare = true;             // false: the files of `matches` are not read, and nothing is compared with them
    double checkpoint_every = 0.0;   // s of simulated time, counted from 0; 0: none are due
    const RunState* from = nullptr;  // where to go on; null: from the start
    std::string from_file = {};      // where that was read, for messages
};

/// Steps until the scene's duration is over, a step fails or a stop is asked for; with duration = "rest" until all cloth is
/// proven at rest and nothing is to come. Such a run has a last frame of its own, and has failed if it is not at rest by
/// max_duration. Where the duration is no multiple of the time step, the last step is shorter, or up to a thousandth longer.
/// Adaptive steps (time_step = "auto") end at every time of a frame, an event and an expectation's `at`. Frame k follows the
/// first step that ends at or after k / fps; frame 0 is the start. In every frame cloth is certified against every obstacle, and
/// against cloth that it meets, also when nothing is written. A step in which an obstacle moves far is made in equal parts
/// (motion_parts), each a step of the simulation and of the totals. Throws SceneError if the reference of a `matches` expectation
/// cannot be read or has another number of vertices, or if the state to go on from is not one of this scene, before the first
/// step; what a hook throws passes through. A run that goes on from a state ends with the same bits and figures as one that was
/// never interrupted; the scene must have been built anew.
RunResult run_scene(BuiltScene& built, const RunHooks& hooks = {}, const RunSettings& settings = {});

}  // namespace percale::scenes
