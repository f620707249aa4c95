#include "step_parts.h"

#include <algorithm>
#include <utility>

namespace percale {
namespace {

/// m, by which a pin that goes with an obstacle may miss its place on it, because of rounding. Smaller: in parts of a step
/// the pin goes straight, and leaves the arc of its place. Larger: pins that go their own way are carried along that arc.
constexpr double carried_pin_error = 1e-8;

/// The shape of an obstacle after a fraction of the step.
Shape shape_after(double fraction, const ObstacleState& obstacle) {
    const Shape& end = obstacle.compliance.mesh ? obstacle.compliance.aim : obstacle.end_shape;
    if (fraction == 1.0) return end;
    auto between = std::make_shared<std::vector<Vec3>>(*obstacle.start_shape);
    for (std::size_t i = 0; i < obstacle.compliance.deflection.size(); ++i) (*between)[i] -= obstacle.compliance.deflection[i];
    for (std::size_t i = 0; i < between->size(); ++i) (*between)[i] += fraction * ((*end)[i] - (*between)[i]);
    return between;
}

/// The state of a simulation and its script before the first part, as far as steps change it. Cloth at rest is awake by then.
class Beginning {
public:
    explicit Beginning(const World& world)
        : vertices_(world.scene.model.vertex_count()),
          state_(world.state),
          obstacles_(world.scene.script.obstacles),
          pin_targets_(world.scene.script.pin_targets) {
        copy_holds(world.scene.model, holds_);
        find_carried_pins(world.scene);
    }

    /// Sets the targets of obstacles and pins after a fraction of the step, from where they are now.
    void aim_at(double fraction, Script& script) const {
        for (std::size_t k = 0; k < obstacles_.size(); ++k) {
            const auto& [start, end] = std::pair(obstacles_[k].start, obstacles_[k].end);
            script.obstacles[k].end = fraction == 1.0 || start == end ? end : interpolate(start, end, fraction);
            if (obstacles_[k].compliance.mesh)
                script.obstacles[k].aim_at(shape_after(fraction, obstacles_[k]));
            else if (obstacles_[k].deforms())
                script.obstacles[k].end_shape = shape_after(fraction, obstacles_[k]);
        }
        for (int i = 0; i < vertices_; ++i) {
            if (script.free[i] > 0.0) continue;
            const Vec3 start = state_.cloth.positions.at(i), end = pin_targets_.at(i);
            script.pin_targets.set(i, fraction == 1.0 ? end : Vec3(start + fraction * (end - start)));
        }
        if (fraction == 1.0) return;
        for (const auto& [vertex, obstacle, place] : carried_) {
            script.pin_targets.set(vertex, transform(script.obstacles[obstacle].end, place));
        }
    }

    /// Sets the script's targets to the end of the step again.
    void restore(World& world) && {
        aim_at(1.0, world.scene.script);
        world.state = std::move(state_);
        put_holds(holds_, world.scene.model);
        for (std::size_t k = 0; k < obstacles_.size(); ++k) {
            world.scene.script.obstacles[k] = obstacles_[k];
            world.scene.script.obstacles[k].settled = false;
        }
    }

private:
    /// A pin that moves with an obstacle, and its place in the mesh.
    struct Carried {
        int vertex;
        std::size_t obstacle;
        Vec3 place;
    };

    /// Finds the pins that a turning obstacle carries to their targets.
    void find_carried_pins(const StepScene& scene) {
        for (std::size_t k = 0; k < obstacles_.size(); ++k) {
            const auto& [start, end] = std::pair(obstacles_[k].start, obstacles_[k].end);
            if (angle_between(start.rotation, end.rotation) == 0.0) continue;
            for (int i = 0; i < vertices_; ++i) {
                if (scene.is_free(i)) continue;
                const Vec3 place = inverse_transform(start, state_.cloth.positions.at(i));
                if ((transform(end, place) - pin_targets_.at(i)).norm() < carried_pin_error) carried_.push_back({i, k, place});
            }
        }
    }

    int vertices_;
    std::vector<Carried> carried_;
    StepState state_;
    std::vector<ObstacleState> obstacles_;
    Vec3Arrays pin_targets_;
    Holds holds_;
};

/// `sum` becomes the report of both: work is added, the end state is the later part's.
void add_part(StepReport part, StepReport& sum) {
    const StepReport before = sum;
    sum = std::move(part);
    sum.status = std::max(sum.status, before.status);  // accepted statuses come first, in ascending order of severity
    sum.smallest_dt = std::min(sum.smallest_dt, before.smallest_dt);
    sum.largest_dt = std::max(sum.largest_dt, before.largest_dt);
    sum.parts += before.parts;
    sum.time_error += before.time_error;
    add_work(before, sum);
    if (sum.ok()) sum.out_of_time = sum.out_of_time || before.out_of_time;  // the last part's failure decides
    sum.smallest_fraction = std::min(sum.smallest_fraction, before.smallest_fraction);
    sum.contact_stiffness = std::max(sum.contact_stiffness, before.contact_stiffness);
    if (sum.pinched < before.pinched) {
        sum.pinched = before.pinched;
        sum.pinching = before.pinching;
    }
    if (before.stretch > sum.stretch) {
        sum.stretch = before.stretch;
        sum.stretched_cloth = before.stretched_cloth;
        sum.stretched_pins = before.stretched_pins;
        sum.stretched_name = before.stretched_name;
    }
    StepEnergy energy = before.energy;
    add_step_energy(sum.energy, energy);
    sum.energy = energy;
}

}  // namespace

void add_work(const StepReport& other, StepReport& report) {
    report.rejected += other.rejected;
    report.newton_iterations += other.newton_iterations;
    report.linear_iterations += other.linear_iterations;
    report.line_search_cuts += other.line_search_cuts;
    report.halvings += other.halvings;
    report.dropped += other.dropped;
    report.stages += other.stages;
}

StepReport step_in_parts(World& world, int parts, StepReport (*step_once)(World&)) {
    StepSettings& settings = world.scene.settings;
    const double whole = settings.time_step;
    Beginning beginning(world);
    settings.time_step = whole / parts;
    scene_changed(world);
    StepReport sum;
    for (int part = 0; part < parts; ++part) {
        beginning.aim_at(part + 1 == parts ? 1.0 : static_cast<double>(part + 1) / parts, world.scene.script);
        StepReport report = step_once(world);
        world.work.iterations_left -= report.newton_iterations;
        if (part == 0) {
            sum = std::move(report);
        } else {
            add_part(std::move(report), sum);
        }
        if (!sum.ok()) break;
    }
    settings.time_step = whole;
    if (!sum.ok()) std::move(beginning).restore(world);
    scene_changed(world);
    return sum;
}

}  // namespace percale
