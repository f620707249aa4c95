#include "targets.h"

#include "schemes/schemes.h"

namespace percale {
namespace {

double time_at(const Substep& substep, double place, const StepState& start) {
    return start.time + substep.at(place) * substep.scene.settings.time_step;
}

}  // namespace

void set_targets(const Substep& substep, double fraction, Vec3Arrays& targets) {
    const StepScene& scene = substep.scene;
    targets.resize(scene.model.vertex_count());
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.is_free(i)) continue;
        const Vec3 start = substep.step_start.at(i), end = scene.script.pin_targets.at(i);
        targets.set(i, fraction == 1.0 ? end : Vec3(start + fraction * (end - start)));
    }
}

void set_obstacle_motions(const StepScene& scene, double fraction, std::vector<ObstacleMotion>& obstacle_motions) {
    obstacle_motions.clear();
    if (!scene.plan.obstacles_move) return;
    for (const ObstacleState& obstacle : scene.script.obstacles) {
        obstacle_motions.push_back(obstacle_motion(obstacle.start, obstacle.end, fraction));
        obstacle_motions.back().deforms = obstacle.deforms();
    }
}

std::span<const double> rest_lengths_at(const Substep& substep, double place, const StepState& start, std::vector<double>& list) {
    if (!substep.scene.plan.seams_close) return start.cloth.rest_length;
    list = substep.scene.model.springs.rest_length;
    for (const Seam& seam : substep.scene.script.seams) set_seam_lengths(seam, time_at(substep, place, start), list);
    return list;
}

void set_rest_length(const Substep& substep, const StepState& start, std::vector<double>& list, ClothState& end) {
    const std::span<const double> lengths = rest_lengths_at(substep, 1.0, start, list);
    end.rest_length.assign(lengths.begin(), lengths.end());
}

double seam_work(const Substep& substep, const StepState& start, const ClothState& end) {
    if (!substep.scene.plan.seams_close) return 0.0;
    const auto energy = [&](double place, const Vec3Arrays& positions) {
        double sum = 0.0;
        for (const Seam& seam : substep.scene.script.seams) {
            sum += seam_energy(seam, time_at(substep, place, start), substep.scene.model, positions);
        }
        return sum;
    };
    const double before = energy(0.0, start.cloth.positions);
    double work = 0.0;
    for (const auto& [weight, place] : stage_weights(substep.scene.plan.scheme)) {
        if (weight == 0.0) continue;
        const double at_start = energy(place, start.cloth.positions) - before;
        work += weight * (at_start - energy(place, end.positions));
    }
    return work + energy(1.0, end.positions);
}

}  // namespace percale
