#include "export/checkpoint.h"

#include <nlohmann/json.hpp>

#include "common/input_file.h"
#include "common/scene_file_error.h"
#include "common/whole_file.h"
#include "export/run_settings.h"
#include "percale/error.h"
#include "percale/saved_report.h"

namespace percale::scenes {

constexpr SealKind checkpoint_seal{.name = "PERCALEC", .version = 11, .words = "checkpoint"};

template <class Archive, OfType<Pinch> Value>
void exchange(Archive& archive, Value& pinch) {
    archive(pinch.obstacles, pinch.from, pinch.to, pinch.yielded);
}

template <class Archive, OfType<RunTotals> Value>
void exchange(Archive& archive, Value& totals) {
    archive(totals.steps, totals.rejected_steps, totals.unsolved_steps, totals.dropped.not_converged, totals.dropped.blocked,
            totals.dropped.not_finite, totals.dropped.inexact, totals.sleeping_steps, totals.simulated_s, totals.smallest_step_s,
            totals.largest_step_s, totals.newton_iterations, totals.linear_iterations, totals.largest_residual);
    archive.choice(totals.linear_solver, 4);
    archive(totals.contacts_most, totals.contact_stiffness, totals.stages, totals.cpu_s, totals.wall_s, totals.certificate_s,
            totals.energy, totals.pinches);
}

template <class Archive, OfType<FrameCheck> Value>
void exchange(Archive& archive, Value& check) {
    archive(check.intersections, check.touching_pairs, check.at_seams, check.vertices_inside, check.deepest_penetration,
            check.smallest_distance);
}

template <class Archive, OfType<StepChecks> Value>
void exchange(Archive& archive, Value& checks) {
    archive(checks.states, checks.intersections, checks.deepest_penetration, checks.smallest_distance, checks.worst_step,
            checks.worst_time, checks.worst);
}

template <class Archive, OfType<Measures> Value>
void exchange(Archive& archive, Value& m) {
    archive(m.intersections, m.deepest_penetration, m.smallest_distance, m.worst_frame, m.largest_strain, m.strain_time,
            m.strained_cloth, m.energy_gain, m.worst, m.steps);
}

template <class Archive, OfType<Timeline::MovingPin> Value>
void exchange(Archive& archive, Value& pin) {
    archive(pin.cloth, pin.vertex, pin.start, pin.displacement, pin.from, pin.over);
}

template <class Archive, OfType<RestFigures> Value>
void exchange(Archive& archive, Value& rest) {
    archive(rest.at_rest, rest.time, rest.largest_speed, rest.rms_speed, rest.fastest_cloth, rest.force_over_weight);
}

template <class Archive, OfType<RunState> Value>
void exchange(Archive& archive, Value& run) {
    archive(run.totals, run.measures, run.resumed_at, run.steps_made, run.step_length, run.next_frame, run.framed, run.rest,
            run.timed, run.timeline.next_event, run.timeline.moving_pins, run.simulation);
}

template <class Archive, OfType<FrameRecord> Value>
void exchange(Archive& archive, Value& frame) {
    archive(frame.index, frame.time, frame.cloths, frame.obstacles, frame.others, frame.check, frame.meeting);
}

template <class Archive, OfType<GrownFile> Value>
void exchange(Archive& archive, Value& file) {
    archive(file.name, file.bytes);
}

template <class Archive, OfType<Checkpoint> Value>
void exchange(Archive& archive, Value& checkpoint) {
    archive(checkpoint.settings, checkpoint.certify_steps, checkpoint.replay_hash, checkpoint.run, checkpoint.folder.frames,
            checkpoint.folder.step_bytes, checkpoint.folder.grown);
}

namespace {

void check_option(const std::string& file, const char* option, bool here, bool saved) {
    if (here == saved) return;
    throw SceneError(file + ": cannot be resumed: it was made " + (saved ? "with " : "without ") + option +
                     "; say the same to go on");
}

}  // namespace

void write_checkpoint(const std::string& file, const Checkpoint& checkpoint) {
    StateWriter writer = begin_sealed();
    writer(checkpoint);
    write_durable_file(file, end_sealed(checkpoint_seal, writer));
}

void save_run(const std::string& file, const Scene& scene, const RunState& state, const RunMarks& marks, RunFolder& folder) {
    write_checkpoint(file, {.settings = settings_text(scene),
                            .certify_steps = marks.certify_steps,
                            .replay_hash = marks.replay_hash,
                            .run = state,
                            .folder = folder.state()});
    folder.keep();
}

Checkpoint read_checkpoint(const std::string& file) {
    const std::vector<std::byte> bytes = read_bytes(file);
    return at_place({.file = file}, "", [&] {
        StateReader reader(unsealed(checkpoint_seal, bytes));
        Checkpoint checkpoint;
        reader(checkpoint);
        reader.demand(reader.at_end(), "there is more than belongs to it");
        reader.demand(checkpoint.run.steps_made > 0 && checkpoint.run.next_frame >= 0, "a run that has not begun");
        reader.demand(nlohmann::json::accept(checkpoint.settings), "settings that are none");
        return checkpoint;
    });
}

void check_same_run(const std::string& file, const Checkpoint& checkpoint, const Scene& scene, bool certify_steps,
                    bool replay_hash) {
    const std::string what = different_settings(settings_text(scene), checkpoint.settings, "in the checkpoint");
    if (!what.empty()) throw SceneError(file + ": is of another run and cannot be resumed: " + what);
    check_option(file, "--certify-steps", certify_steps, checkpoint.certify_steps);
    check_option(file, "--replay-hash", replay_hash, checkpoint.replay_hash);
}

}  // namespace percale::scenes
