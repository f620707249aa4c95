#include "format/rest_check.h"

#include <cmath>

#include "common/scene_file_error.h"
#include "common/text.h"
#include "percale/stability.h"

namespace percale::scenes {
namespace {

/// When an event is over, s: a move takes its time, what others do is done at once.
double event_end(const EventSpec& event) {
    const auto* move = std::get_if<MoveEvent>(&event.what);
    return event.time + (move != nullptr ? move->over : 0.0);
}

void check_ends(const Scene& scene, double end, const SourcePlace& place, const std::string& what) {
    if (end < scene.max_duration) return;
    fail_at(place, what + " goes on until " + number_text(end) +
                       " s; with duration = \"rest\" all must be over before max_duration = " + number_text(scene.max_duration) +
                       " s");
}

void check_script_ends(const Scene& scene) {
    for (const EventSpec& event : scene.events) check_ends(scene, event_end(event), event.place, "event");
    for (const SeamSpec& seam : scene.seams) check_ends(scene, seam.start_time + seam.duration, seam.place, "seam: closing");
    for (const ObstacleSpec& obstacle : scene.obstacles) {
        const std::string name = "obstacle '" + obstacle.name + "': ";
        if (obstacle.spin && obstacle.spin->turns_per_s != 0.0)
            fail_at(obstacle.place, name +
                                        "with a spin it never stands still, so that a scene with duration = \"rest\" never ends; "
                                        "say a duration in s, or turn it by motion");
        if (obstacle.loop)
            fail_at(obstacle.place, name + "with loop it never stands still; say a duration in s, or leave loop out");
        if (!obstacle.motion.empty()) check_ends(scene, obstacle.motion.back().time, obstacle.place, name + "motion");
    }
}

}  // namespace

void check_shapes_end(const Scene& scene, std::span<const double> ends) {
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const ObstacleSpec& obstacle = scene.obstacles[i];
        check_ends(scene, ends[i], obstacle.place, "obstacle '" + obstacle.name + "': what it plays");
    }
}

void check_can_rest(const Scene& scene, const ScenePlan& plan) {
    if (!scene.until_rest) return;
    if (!scene.step.skip)
        fail_at(
            scene.duration_place,
            "duration = \"rest\": cloth at rest falls asleep, which is what proves it, and with step.skip = false (--no-skip) "
            "none does; say a duration in s");
    if (std::isfinite(longest_stable_step(plan.scheme, {.square = 1.0})))
        fail_at(scene.scheme_place, "step.scheme: with " + plan.scheme_word +
                                        ", an explicit scheme, rest is not detected; with duration = \"rest\" take an implicit "
                                        "one, such as backward_euler");
    check_script_ends(scene);
}

}  // namespace percale::scenes
