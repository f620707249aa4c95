#include "run/run_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "common/scene_file_error.h"
#include "common/text.h"
#include "measures/frame_certifier.h"
#include "measures/references.h"
#include "measures/timed_measures.h"
#include "percale/error.h"
#include "run/frame_fields.h"
#include "run/motion_parts.h"
#include "run/scene_plan.h"
#include "run/step_lengths.h"
#include "run/timeline.h"

namespace percale::scenes {

const char* status_word(RunStatus status) {
    switch (status) {
        case RunStatus::finished:
            return "finished";
        case RunStatus::failed:
            return "failed";
        case RunStatus::stopped:
            return "stopped";
    }
    return "unknown";
}

namespace {

/// Beyond these, m, the certificates of the cloths need not say how far apart the surfaces are.
std::vector<double> distance_limits(const BuiltScene& built) {
    std::vector<double> limits;
    for (const ClothSpec& cloth : built.scene.cloths) {
        const auto fabric = built.scene.fabrics.find(cloth.fabric);
        limits.push_back(fabric == built.scene.fabrics.end() ? std::numeric_limits<double>::infinity()
                                                             : 4.0 * fabric->second.thickness);
    }
    return limits;
}

Frame first_frame(const BuiltScene& built) {
    return {.cloths = built.cloth_meshes, .obstacles = built.obstacle_meshes, .check = {}};
}

PairsOfCloths meeting_cloths(const BuiltScene& built) {
    PairsOfCloths meeting = all_pairs(static_cast<int>(built.cloths.size()));
    std::erase_if(meeting, [&](const std::array<int, 2>& pair) {
        return !built.simulation.meets(built.cloths[pair[0]], built.cloths[pair[1]]);
    });
    return meeting;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Looks at the state after each step: certificates, frames.
class Observer {
public:
    Observer(const BuiltScene& built, const RunHooks& hooks, Measures& measures, const RunState* from)
        : built_(built),
          hooks_(hooks),
          measures_(measures),
          frame_(first_frame(built)),
          certifier_(distance_limits(built)),
          framed_(from && from->framed) {
        frame_.index = from ? from->next_frame : 0;
    }

    int next_frame() const { return frame_.index; }
    /// s of wall time that certificates took so far.
    double certificate_s() const { return certificate_s_; }
    bool framed() const { return framed_; }
    /// The certificate of the present state, made unless it is there.
    const FrameCheck& check() {
        see();
        return frame_.check;
    }

    /// Whether the present time has a frame that was not made yet.
    bool frame_is_due() const {
        const double slack = 1e-6 * built_.scene.step.time_step;  // accumulated rounding of the time
        return static_cast<double>(frame_.index) / built_.scene.output.fps <= built_.simulation.time() + slack;
    }

    /// Looks at the state after so many steps.
    void look(int steps) {
        seen_ = framed_ = false;
        if (measures_.steps) {
            see();
            add_state(*measures_.steps, steps, frame_.time, frame_.check);
        }
        make_due_frames();
    }

    /// Makes a frame of the present state, which is the last one, unless it has one.
    void look_at_end() {
        if (framed_) return;
        see();
        make_frame();
    }

private:
    void see() {
        if (!seen_) certify_state();
        seen_ = true;
    }

    void certify_state() {
        frame_.time = built_.simulation.time();
        place_shapes(built_, frame_.cloths, frame_.obstacles);
        frame_.meeting = meeting_cloths(built_);
        const auto start = std::chrono::steady_clock::now();
        frame_.check = certifier_.check({frame_.cloths, frame_.obstacles, sewn_stitches(built_), frame_.meeting}, hooks_.cancel);
        certificate_s_ += seconds_since(start);
    }

    /// Makes the frames due by now; several where the frame rate is higher than the step rate.
    void make_due_frames() {
        while (frame_is_due()) {
            see();
            make_frame();
        }
    }

    void make_frame() {
        // The fields come before anything counts the frame: if they are cancelled, there is no frame.
        if (hooks_.frame) frame_.fields = fields_of(built_, frame_.cloths, frame_.obstacles, hooks_.cancel);
        add_frame(measures_, frame_.index, frame_.check);
        if (hooks_.frame) hooks_.frame(frame_);
        ++frame_.index;
        framed_ = true;
    }

    const BuiltScene& built_;
    const RunHooks& hooks_;
    Measures& measures_;
    Frame frame_;
    FrameCertifier certifier_;
    double certificate_s_ = 0.0;
    bool seen_ = false;  // the frame shows the current state
    bool framed_;        // and was made
};

void add_cost(RunTotals& totals, const StepReport& report) {
    totals.newton_iterations += report.newton_iterations;
    totals.linear_iterations += report.linear_iterations;
    totals.rejected_steps += report.halvings + report.rejected;
    totals.dropped += report.dropped;
    if (report.linear_solver != LinearSolver::automatic) totals.linear_solver = report.linear_solver;
    totals.contacts_most = std::max(totals.contacts_most, report.contacts);
    totals.contact_stiffness = std::max(totals.contact_stiffness, report.contact_stiffness);
    totals.stages += report.stages;
}

void add_accepted(RunTotals& totals, const StepReport& report) {
    totals.steps += report.parts;
    totals.sleeping_steps += report.slept;
    totals.unsolved_steps += report.unsolved();
    totals.smallest_step_s = std::min(totals.smallest_step_s, report.smallest_dt);
    totals.largest_step_s = std::max(totals.largest_step_s, report.largest_dt);
    totals.largest_residual = std::max(totals.largest_residual, report.residual);
    add_step_energy(report.energy, totals.energy);
    add_pinch(totals.pinches, report);
}

/// Whether frames measure and steps do not; with nothing skipped steps measure, too.
bool is_measured_by_frames(const BuiltScene& built) {
    return built.scene.step.measure == StepMeasures::automatic && built.scene.step.skip;
}

bool changes_gravity(const Scene& scene) {
    return std::any_of(scene.events.begin(), scene.events.end(),
                       [](const EventSpec& event) { return std::holds_alternative<GravityEvent>(event.what); });
}

/// What a step that measures nothing leaves out, and a frame shows.
void measure_frame(const Simulation& simulation, StepReport& report) {
    set_stored_energy(simulation.energy(), report.energy);
    report.largest_strain = simulation.largest_strain();
    report.largest_speed = simulation.largest_speed();
}

/// What happens beside the steps.
struct RunScript {
    Timeline timeline;
    Observer observer;
    std::optional<RestWatch> rest;  // where the scene ends at rest
    TimedMeasures timed;
    StepReport step = {};  // the last one
    double energy_gain = 0.0;

    /// Shows the state to the expectations that have times.
    void look_at_state(const BuiltScene& built, const StepReport* ended) {
        timed.look({.simulation = built.simulation,
                    .cloths = built.cloths,
                    .step = ended,
                    .energy_gain = ended != nullptr ? energy_gain : std::numeric_limits<double>::quiet_NaN(),
                    .check = [this]() -> const FrameCheck& { return observer.check(); },
                    .seam_gap = [&built] { return largest_seam_gap(built); },
                    .framed = observer.framed()});
    }
};

/// `where`: "", or what else the reason has to say.
void stop_at(const BuiltScene& built, const std::string& where, RunResult& result) {
    result.status = RunStatus::stopped;
    result.reason = "stopped at " + short_number(built.simulation.time()) + " of " + short_number(built.scene.latest_end()) +
                    " s" + (where.empty() ? "" : ", " + where);
}

/// One step of the simulation: script, simulation, figures. False if it failed.
bool make_step(BuiltScene& built, const RunHooks& hooks, RunScript& script, double dt, RunResult& result) {
    RunTotals& totals = result.totals;
    try {
        script.timeline.apply(built, built.simulation.time(), dt);
    } catch (const SceneError& error) {  // a frame of a body that cannot be read, or is of another mesh
        result.status = RunStatus::failed;
        result.reason = error.what();
        return false;
    }
    // A gravity event changes the potential energy without any work, so the energy before the step is taken after it.
    const bool look = changes_gravity(built.scene) && !is_measured_by_frames(built);
    const double before = look ? built.simulation.energy().total() : totals.energy.total();
    if (script.rest) script.rest->begin(built.simulation, built.cloths);
    StepReport report;
    try {
        report = built.simulation.step();
    } catch (const StartError& error) {
        if (hooks.cancel != nullptr && *hooks.cancel) {
            stop_at(built, "before cloth was untangled", result);
            return false;
        }
        result.status = RunStatus::failed;
        result.reason = error.what();
        return false;
    }
    totals.cpu_s += report.cpu_s;
    if (report.status == StepStatus::cancelled) {
        stop_at(built, "within a step", result);
        return false;
    }
    if (is_measured_by_frames(built) && script.observer.frame_is_due()) measure_frame(built.simulation, report);
    add_cost(totals, report);
    if (hooks.step) hooks.step(report, built.simulation);
    if (!report.ok()) {
        result.status = RunStatus::failed;
        result.reason = report.explanation();
        return false;
    }
    if (script.rest)
        script.rest->look(built.simulation, built.cloths, report, gravity_at(built.scene, report.time - 0.5 * report.dt),
                          !script.timeline.more_to_come(built, report.time));
    add_step(result.measures, report, before);
    find_strained_cloth(result.measures, report, built.simulation, built.cloths);
    add_accepted(totals, report);
    script.energy_gain = energy_gain(report, before);
    script.step = std::move(report);
    return true;
}

/// One step of the scene, in parts where an obstacle moves far; looks at the state after each. False if it failed.
bool make_parts(BuiltScene& built, const RunHooks& hooks, RunScript& script, double dt, RunResult& result) {
    const int parts = motion_parts(built, dt);
    built.simulation.set_time_step(dt / parts);
    for (int part = 0; part < parts; ++part) {
        if (!make_step(built, hooks, script, dt / parts, result)) return false;
        script.observer.look(result.totals.steps);
        script.look_at_state(built, &script.step);
    }
    return true;
}

TimedMeasures timed_of(const BuiltScene& built, std::vector<std::vector<Vec3>> references) {
    // Times are sums of steps.
    return {built.scene.expectations, std::move(references), 1e-6 * built.scene.step.time_step};
}

/// A scene on its way from its start, or from where it was left, to its end.
class Run {
public:
    Run(BuiltScene& built, const RunHooks& hooks, const RunSettings& settings, std::vector<std::vector<Vec3>> references,
        RunResult& result)
        : built_(built),
          hooks_(hooks),
          result_(result),
          lengths_(built.scene, settings.from ? settings.from->steps_made : 0,
                   settings.from ? settings.from->step_length : built.scene.step.time_step),
          script_{Timeline(built),
                  Observer(built, hooks, result.measures, settings.from),
                  {},
                  timed_of(built, std::move(references))},
          checkpoints_(settings.checkpoint_every, settings.from ? settings.from->totals.simulated_s : 0.0) {
        if (built.scene.until_rest) script_.rest.emplace(settings.from ? settings.from->rest : RestFigures{});
        if (settings.from) {
            go_on_from(settings);
        } else {
            result.totals.energy = built.simulation.energy();
            if (settings.certify_steps) result.measures.steps.emplace();
        }
    }

    void make_steps() {
        try {
            make_all_steps();
        } catch (const CertificateCancelled&) {
            stop_at(built_, "before its state was certified", result_);
        }
    }

    const std::vector<std::vector<Vec3>>& shapes() const { return script_.timed.shapes(); }

    /// Brings the totals up to date that are no sums over steps.
    void measure() {
        if (script_.rest) result_.rest = script_.rest->figures();
        result_.timed = script_.timed.values();
        result_.totals.simulated_s = built_.simulation.time();
        result_.totals.wall_s = earlier_wall_s_ + seconds_since(start_);
        result_.totals.certificate_s = earlier_certificate_s_ + script_.observer.certificate_s();
    }

private:
    void make_all_steps() {
        if (lengths_.made() == 0) {
            script_.observer.look(0);
            script_.look_at_state(built_, nullptr);
        }
        while (!over()) {
            if (!make_parts(built_, hooks_, script_, lengths_.next(built_.simulation.time()), result_)) return;
            const bool stop = !over() && hooks_.stop_asked && hooks_.stop_asked();
            const bool due = checkpoints_.due(built_.simulation.time());
            if ((stop || due) && hooks_.checkpoint) hooks_.checkpoint(state());
            if (!stop) continue;
            return stop_at(built_, "", result_);
        }
        if (script_.rest) end_at_rest(script_.rest->figures());
    }

    bool over() const { return (script_.rest && script_.rest->figures().at_rest) || lengths_.over(built_.simulation.time()); }

    /// Makes the last frame, and judges a scene that has to end at rest.
    void end_at_rest(const RestFigures& figures) {
        script_.observer.look_at_end();
        if (is_measured_by_frames(built_))
            result_.measures.largest_strain = std::max(result_.measures.largest_strain, built_.simulation.largest_strain());
        if (figures.at_rest) return;
        result_.status = RunStatus::failed;
        result_.reason =
            not_at_rest_text(figures, built_.scene.cloths.at(static_cast<std::size_t>(std::max(0, figures.fastest_cloth))).name);
        if (!built_.scene.step.kinetic_damping)
            result_.reason += "; step.kinetic_damping = true stops what swings, where only the rest counts";
    }

    void go_on_from(const RunSettings& settings) {
        const RunState& from = *settings.from;
        at_place({.file = settings.from_file}, "", [&] {
            script_.timeline.go_on_from(built_, from.timeline);
            if (from.rest.fastest_cloth < -1 || from.rest.fastest_cloth >= static_cast<int>(built_.cloths.size()))
                throw SceneError("how still the cloth is, is that of another scene");
            const auto known = [&](int obstacle) {
                return obstacle >= 0 && obstacle < static_cast<int>(built_.obstacles.size());
            };
            for (const Pinch& pinch : from.totals.pinches)
                if (!std::ranges::all_of(pinch.obstacles, known)) throw SceneError("its pinches are of another scene");
            if (from.timed.size() != built_.scene.expectations.size())
                throw SceneError("what was expected of it is not what the scene expects");
            built_.simulation.restore(from.simulation);
        });
        script_.timed.go_on_from(from.timed, built_.simulation.time());
        result_.totals = from.totals;
        result_.measures = from.measures;
        result_.resumed_at = from.resumed_at;
        result_.resumed_at.push_back(built_.simulation.time());
        earlier_wall_s_ = from.totals.wall_s;
        earlier_certificate_s_ = from.totals.certificate_s;
    }

    RunState state() {
        measure();
        return {.totals = result_.totals,
                .measures = result_.measures,
                .resumed_at = result_.resumed_at,
                .steps_made = lengths_.made(),
                .step_length = lengths_.length(),
                .next_frame = script_.observer.next_frame(),
                .framed = script_.observer.framed(),
                .rest = script_.rest ? script_.rest->figures() : RestFigures{},
                .timed = script_.timed.values(),
                .timeline = script_.timeline.state(),
                .simulation = built_.simulation.save()};
    }

    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double earlier_wall_s_ = 0.0, earlier_certificate_s_ = 0.0;
    BuiltScene& built_;
    const RunHooks& hooks_;
    RunResult& result_;
    StepLengths lengths_;
    RunScript script_;
    CheckpointTimes checkpoints_;
};

/// Measures the expectations `matches` of the end, each with its own file.
void measure_matches(const BuiltScene& built, std::span<const std::vector<Vec3>> references, RunResult& result) {
    for (std::size_t i = 0; i < references.size(); ++i) {
        const Expectation& expectation = built.scene.expectations[i];
        if (references[i].empty() || expectation.at || expectation.during) continue;
        result.timed[i] = largest_vertex_distance(built.simulation, built.cloths, references[i]);
        if (!result.measures.matches) result.measures.matches = result.timed[i];
    }
}

}  // namespace

RunResult run_scene(BuiltScene& built, const RunHooks& hooks, const RunSettings& settings) {
    std::size_t vertices = 0;
    for (const TriangleMesh& mesh : built.cloth_meshes) vertices += mesh.vertices.size();
    const std::vector<std::vector<Vec3>> references =
        settings.compare ? read_references(built.scene, vertices) : std::vector<std::vector<Vec3>>();
    RunResult result;
    result.plan = plan_of(built);
    Run run(built, hooks, settings, references, result);
    if (hooks.begin) hooks.begin();
    built.simulation.set_cancel(hooks.cancel);
    run.make_steps();
    built.simulation.set_cancel(nullptr);
    if (is_measured_by_frames(built)) {
        set_stored_energy(built.simulation.energy(), result.totals.energy);
        result.measures.energy_gain = std::numeric_limits<double>::quiet_NaN();
    } else if (std::isnan(result.totals.energy.elastic)) {
        result.measures.largest_strain = result.measures.energy_gain = result.totals.energy.elastic;
    }
    add_end(result.measures, built.simulation, built.cloths);
    result.measures.largest_seam_gap = largest_seam_gap(built);
    run.measure();
    measure_matches(built, references, result);
    result.shapes = run.shapes();
    return result;
}

}  // namespace percale::scenes
