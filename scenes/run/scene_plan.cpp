#include "run/scene_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/finding_json.h"
#include "common/scene_file_error.h"
#include "common/text.h"
#include "frames/frame_formats.h"
#include "run/obstacle_motion.h"
#include "run/start_fault.h"
#include "run/step_lengths.h"

namespace percale::scenes {

using nlohmann::ordered_json;

namespace {

/// Thicknesses that a repair of the start may move cloth before that is a warning.
constexpr double far_start_move = 2.0;

ScriptedChanges changes_of(const Scene& scene) {
    ScriptedChanges changes;
    changes.obstacles = std::any_of(scene.obstacles.begin(), scene.obstacles.end(), [](const ObstacleSpec& obstacle) {
        return !obstacle.motion.empty() || obstacle.spin || obstacle.bends();
    });
    for (const ClothSpec& cloth : scene.cloths) {  // pins that go with an obstacle
        const auto* box = std::get_if<VertexBox>(&cloth.pin);
        changes.pins = changes.pins || (box != nullptr && !box->to.empty() && changes.obstacles);
    }
    for (const EventSpec& event : scene.events) {
        const bool gravity = std::holds_alternative<GravityEvent>(event.what),
                   wind = std::holds_alternative<WindEvent>(event.what);
        changes.gravity = changes.gravity || gravity;
        changes.wind = changes.wind || wind;
        changes.pins = changes.pins || !(gravity || wind);
    }
    return changes;
}

std::string line(const std::string& label, const std::string& value) {
    char text[32];
    std::snprintf(text, sizeof text, "%-11s", label.c_str());
    return text + value + "\n";
}

std::string springs_text(const SpringCounts& springs) {
    return std::to_string(springs.total()) + " (" + std::to_string(springs.structural) + " structural, " +
           std::to_string(springs.shear) + " shear, " + std::to_string(springs.bend) + " bending" +
           (springs.seam > 0 ? ", " + std::to_string(springs.seam) + " of seams)" : ")");
}

}  // namespace

std::string steps_text(const Scene& scene) {
    const StepSettings& step = scene.step;
    const std::string until = scene.until_rest ? "until rest, at most " + short_number(scene.max_duration) + " s; " : "";
    if (step.adaptive) return until + "steps as long as an error of " + short_number(step.tolerance) + " m a second allows";
    const StepCount count = count_steps(scene.latest_end(), step.time_step);
    return until + (scene.until_rest ? "at most " : "") + counted(count.steps, "step") + " of " + short_number(step.time_step) +
           " s";
}

std::vector<CleaningReport> cleaning_of(const BuiltScene& built) {
    if (!built.cleaning.empty()) return built.cleaning;
    std::vector<CleaningReport> reports;
    for (std::size_t i = 0; i < built.obstacle_meshes.size(); ++i) {
        const bool deforming = built.shapes[i] != nullptr || built.scene.obstacles[i].yields;
        reports.push_back(cleaning_report(built.obstacle_meshes[i], deforming));
    }
    return reports;
}

void keep_plan(BuiltScene& built) { built.plan = plan_of(built); }
void keep_cleaning(BuiltScene& built) { built.cleaning = cleaning_of(built); }

ScenePlan plan_of(const BuiltScene& built) { return built.plan ? *built.plan : built.simulation.plan(changes_of(built.scene)); }

std::vector<Finding> plan_findings(const BuiltScene& built, const ScenePlan& plan) {
    std::vector<Finding> found = built.warnings;
    const Scene& scene = built.scene;
    for (const PlanWarning& warning : plan.warnings)
        found.push_back(finding(warning.kind, scene.scheme_place, warning.what, warning.fix));
    const double end = scene.latest_end();
    const auto late = std::ranges::find_if(scene.events, [&](const EventSpec& event) { return event.time > end; });
    if (late == scene.events.end()) return found;  // their times ascend
    found.push_back(finding("late_events", late->place,
                            std::to_string(scene.events.end() - late) + " of " +
                                counted(static_cast<long>(scene.events.size()), "event") + " would come after the end, " +
                                short_number(end) + " s, the first at " + short_number(late->time) + " s"));
    return found;
}

std::vector<Finding> start_findings(const BuiltScene& built) {
    std::vector<Finding> found;
    const std::string_view when = built.seams.empty() ? "before the start" : "before the start or when the seams had closed";
    for (const StartMove& move : built.simulation.start_repair()) {
        const ClothSpec& cloth = built.scene.cloths[static_cast<std::size_t>(move.cloth)];
        const bool far = move.largest_move > far_start_move * built.scene.fabrics.at(cloth.fabric).thickness;
        found.push_back(finding("start_moved", cloth.place, start_move_text(move, when),
                                "move it there by pose.translation, enlarge it by pose.scale if it is too small for what it is "
                                "around, or set step.start = \"refuse\" to have it refused",
                                far ? Severity::warning : Severity::note));
    }
    return found;
}

OutputSize output_size_of(const BuiltScene& built) {
    const Scene& scene = built.scene;
    OutputSize size{.frames = std::floor(scene.latest_end() * scene.output.fps + 1e-9) + 1.0};
    if (!scene.output.writes_frames()) return {};
    const auto has = [&](std::string_view word) {
        return std::ranges::find(scene.output.fields, word) != scene.output.fields.end();
    };
    const double of_strain = has("strain") ? 3.0 : 0.0, others = (has("pressure") ? 1.0 : 0.0) + (has("distance") ? 1.0 : 0.0);
    const auto counts = [](const TriangleMesh& mesh) {
        return MeshCounts{.vertices = static_cast<double>(mesh.vertices.size()),
                          .triangles = static_cast<double>(mesh.triangles.size())};
    };
    for (const FrameFormat& format : frame_formats()) {
        if (std::ranges::find(scene.output.frames, format.word) == scene.output.frames.end()) continue;
        for (const TriangleMesh& mesh : built.cloth_meshes) {
            MeshCounts cloth = counts(mesh);
            cloth.vertex_fields = of_strain + others;
            cloth.triangle_fields = of_strain;
            const FrameBytes bytes = format.bytes(cloth);
            size.bytes += bytes.once + size.frames * bytes.each_frame;
        }
        for (std::size_t i = 0; i < built.obstacle_meshes.size(); ++i) {
            const ObstacleSpec& obstacle = scene.obstacles[i];
            const FrameBytes bytes = format.bytes(counts(built.obstacle_meshes[i]));
            size.bytes += bytes.once + (obstacle_changes(obstacle) ? size.frames : 1.0) * bytes.each_frame;
        }
    }
    return size;
}

std::string plan_text(const BuiltScene& built) {
    const ScenePlan plan = plan_of(built);
    std::string text = line("title", built.scene.title) + line("steps", steps_text(built.scene) + ", " + plan.scheme_word);
    if (!plan.scheme_reason.empty()) text += line("scheme", plan.scheme_word + ": " + plan.scheme_reason);
    for (const Finding& warning : plan_findings(built, plan)) text += line("warning", finding_text(warning));
    text += line("vertices", std::to_string(plan.vertices) + ", " + std::to_string(plan.pinned_vertices) + " pinned");
    text += line("springs", springs_text(plan.springs));
    if (plan.springs.triangle > 0) text += line("membrane", counted(plan.springs.triangle, "triangle"));
    if (plan.springs.hinge > 0) text += line("hinges", std::to_string(plan.springs.hinge));
    for (std::size_t i = 0; i < built.obstacles.size(); ++i)
        text += line("obstacle", built.scene.obstacles[i].name + ", " +
                                     counted(static_cast<long>(built.obstacle_meshes[i].triangles.size()), "triangle") +
                                     (built.shapes[i] ? ", " + built.shapes[i]->text() : ""));
    for (const StartMove& move : built.simulation.start_repair()) text += line("start", start_move_text(move));
    const bool detects = built.scene.has_contact();
    text += line("memory",
                 short_number(1e-6 * plan.memory_bytes) + " MB predicted" + (detects ? ", lists of near pairs on top" : ""));
    text += line("cost", short_number(plan.evaluations_a_step) + " evaluations of all springs a step predicted" +
                             (detects ? ", detection on top" : ""));
    if (const OutputSize output = output_size_of(built); output.frames > 0.0)
        text +=
            line("output", short_number(output.frames) + (built.scene.until_rest ? " frames at most" : " frames") + " as " +
                               joined(built.scene.output.frames) + ", " + short_number(1e-6 * output.bytes) + " MB predicted");
    text += plan.skipped.empty() ? line("skipped", "nothing") : "skipped\n";
    for (const Skip& skip : plan.skipped) text += "  " + skip.what + ": " + skip.why + "\n";
    return text;
}

std::string plan_json(const BuiltScene& built) {
    const ScenePlan plan = plan_of(built);
    const StepCount count = count_steps(built.scene.latest_end(), built.scene.step.time_step);
    ordered_json json;
    json["title"] = built.scene.title;
    json["scene"] = built.scene.file;
    json["scheme"] = plan.scheme_word;
    if (!plan.scheme_reason.empty()) json["scheme_reason"] = plan.scheme_reason;
    const std::vector<Finding> findings = plan_findings(built, plan);
    json["warnings"] = finding_texts(findings);
    json["findings"] = findings;
    json["time_step_s"] = built.scene.step.adaptive ? ordered_json("auto") : ordered_json(built.scene.step.time_step);
    json["steps"] = built.scene.step.adaptive ? ordered_json(nullptr) : ordered_json(count.steps);
    json["until_rest"] = built.scene.until_rest;
    json["vertices"] = plan.vertices;
    json["pinned_vertices"] = plan.pinned_vertices;
    json["springs"] = {{"structural", plan.springs.structural},
                       {"shear", plan.springs.shear},
                       {"bend", plan.springs.bend},
                       {"seam", plan.springs.seam},
                       {"hinge", plan.springs.hinge},
                       {"triangle", plan.springs.triangle}};
    json["obstacles"] = ordered_json::array();
    for (std::size_t i = 0; i < built.obstacles.size(); ++i)
        json["obstacles"].push_back(
            {{"name", built.scene.obstacles[i].name}, {"triangles", built.obstacle_meshes[i].triangles.size()}});
    json["memory_bytes"] = plan.memory_bytes;
    json["evaluations_a_step"] = plan.evaluations_a_step;
    const OutputSize output = output_size_of(built);
    json["frames"] = output.frames;
    json["frame_bytes"] = output.bytes;
    json["skipped"] = plan.skipped;
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace percale::scenes
