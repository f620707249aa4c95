#include "targets.h"

#include "schemes/schemes.h"

namespace percale {
namespace {

double time_at(const Span& span, double place, const StepState& start) {
    return start.time + span.at(place) * span.scene.settings.time_step;
}

}  // namespace

void set_targets(const Span& span, double fraction, Vectors& targets) {
    const StepScene& scene = span.scene;
    targets.resize(scene.model.vertex_count());
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (scene.is_free(i)) continue;
        const Vec3 start = span.step_start.at(i), end = scene.script.pin_targets.at(i);
        targets.set(i, fraction == 1.0 ? end : Vec3(start + fraction * (end - start)));
    }
}

void set_flows(const StepScene& scene, double fraction, std::vector<ObstacleFlow>& flows) {
    flows.clear();
    if (!scene.plan.obstacles_move) return;
    for (const ObstacleState& obstacle : scene.script.obstacles) {
        flows.push_back(obstacle_flow(obstacle.start, obstacle.end, fraction));
        flows.back().deforms = obstacle.deforms();
    }
}

std::span<const double> rest_lengths_at(const Span& span, double place, const StepState& start, std::vector<double>& list) {
    if (!span.scene.plan.seams_close) return start.cloth.rest_length;
    list = span.scene.model.springs.rest_length;
    for (const Seam& seam : span.scene.script.seams) set_seam_lengths(seam, time_at(span, place, start), list);
    return list;
}

void set_rest_length(const Span& span, const StepState& start, std::vector<double>& list, ClothState& end) {
    const std::span<const double> lengths = rest_lengths_at(span, 1.0, start, list);
    end.rest_length.assign(lengths.begin(), lengths.end());
}

double seam_work(const Span& span, const StepState& start, const ClothState& end) {
    if (!span.scene.plan.seams_close) return 0.0;
    const auto energy = [&](double place, const Vectors& positions) {
        double sum = 0.0;
        for (const Seam& seam : span.scene.script.seams) {
            sum += seam_energy(seam, time_at(span, place, start), span.scene.model, positions);
        }
        return sum;
    };
    const double before = energy(0.0, start.cloth.positions);
    double work = 0.0;
    for (const auto& [weight, place] : stage_weights(span.scene.plan.scheme)) {
        if (weight == 0.0) continue;
        const double at_start = energy(place, start.cloth.positions) - before;
        work += weight * (at_start - energy(place, end.positions));
    }
    return work + energy(1.0, end.positions);
}

}  // namespace percale
