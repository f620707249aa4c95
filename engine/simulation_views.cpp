#include <Eigen/Geometry>
#include <algorithm>

#include "mesh/vertex_normals.h"
#include "simulation_implementation.h"
#include "step/measure.h"
#include "support/hash.h"

namespace percale {

double Simulation::time() const { return implementation_->world.state.time; }

int Simulation::cloth_count() const { return static_cast<int>(implementation_->world.scene.model.cloths.size()); }

std::span<const Vec3> Simulation::positions(ClothId cloth) const {
    const ClothRange& range = implementation_->cloth(cloth);
    const World& world = implementation_->world;
    const std::vector<Vec3>& all = range.order.kept() ? world.state.cloth.points : world.views.positions;
    return std::span(all).subspan(range.first, range.count);
}

std::span<const Vec3> Simulation::velocities(ClothId cloth) const {
    const ClothRange& range = implementation_->cloth(cloth);
    World& world = implementation_->world;
    std::vector<Vec3>& all = world.views.velocities;
    all.resize(world.state.cloth.points.size());
    for (int i = 0; i < range.count; ++i) all[range.first + i] = world.state.cloth.velocities.at(range.index_of(i));
    return std::span<const Vec3>(all).subspan(range.first, range.count);
}

std::span<const double> Simulation::masses(ClothId cloth) const {
    const ClothRange& range = implementation_->cloth(cloth);
    const World& world = implementation_->world;
    const std::vector<double>& all = range.order.kept() ? world.scene.model.mass : world.views.masses;
    return std::span(all).subspan(range.first, range.count);
}

std::vector<int> Simulation::pinned_vertices(ClothId cloth) const {
    const ClothRange& range = implementation_->cloth(cloth);
    std::vector<int> pinned;
    for (int i = 0; i < range.count; ++i)
        if (implementation_->world.scene.script.free[range.index_of(i)] == 0.0) pinned.push_back(i);
    return pinned;
}

std::vector<Vec3> Simulation::normals(ClothId cloth) const {
    std::vector<Vec3> all(implementation_->cloth(cloth).count);
    normals(cloth, all);
    return all;
}

void Simulation::normals(ClothId cloth, std::span<Vec3> out) const {
    const ClothRange& range = implementation_->cloth(cloth);
    implementation_->check_size(range, out.size(), "normals", "places");
    const ClothModel& model = implementation_->world.scene.model;
    vertex_normals({.triangles = triangles_of(model, range),
                    .points = implementation_->world.state.cloth.points,
                    .first_vertex = range.first,
                    .order = range.order},
                   out);
}

void Simulation::interpolate(double fraction, ClothId cloth, std::span<Vec3> out) const {
    const ClothRange& range = implementation_->cloth(cloth);
    if (!implementation_->keeps_previous)
        throw SceneError(range.name, "interpolate: no positions are kept, call keep_previous_positions before the step");
    if (!(fraction >= 0.0 && fraction <= 1.0)) {
        throw SceneError(range.name,
                         "interpolate: fraction = " + number_text(fraction) + " is outside the allowed range 0 ... 1");
    }
    implementation_->check_size(range, out.size(), "interpolate", "places");
    const std::vector<Vec3>&now = implementation_->world.state.cloth.points, &before = implementation_->previous;
    for (int i = 0; i < range.count; ++i) {
        const auto at = static_cast<std::size_t>(range.index_of(i));
        const bool moved = fraction < 1.0 && at < before.size();
        out[i] = moved ? Vec3(before[at] + fraction * (now[at] - before[at])) : now[at];
    }
}

Pose Simulation::obstacle_pose(ObstacleId obstacle) const { return implementation_->obstacle(obstacle).start; }

std::span<const Vec3> Simulation::obstacle_shape(ObstacleId obstacle) const {
    const Shape& shape = implementation_->obstacle(obstacle).start_shape;
    return shape ? std::span<const Vec3>(*shape) : std::span<const Vec3>();
}

StepEnergy Simulation::energy() const { return energy_of(implementation_->world.scene, implementation_->world.state); }

double Simulation::largest_strain() const {
    return percale::largest_strain(implementation_->world.scene.model.springs, implementation_->world.state.cloth.positions);
}

double Simulation::largest_strain(ClothId cloth) const {
    const ClothRange& range = implementation_->cloth(cloth);
    return percale::largest_strain(implementation_->world.scene.model.springs, implementation_->world.state.cloth.positions,
                                   range.first, range.count);
}

double Simulation::largest_speed() const {
    return percale::largest_speed(implementation_->world.state.cloth.velocities,
                                  implementation_->world.scene.model.vertex_count());
}

std::vector<ContactLoad> Simulation::contact_loads(ClothId cloth) const {
    const ClothRange& range = implementation_->cloth(cloth);
    std::vector<ContactLoad> loads;
    for (ContactLoad load : percale::contact_loads(implementation_->world)) {
        if (load.vertex < range.first || load.vertex >= range.first + range.count) continue;
        load.vertex = range.user_vertex(load.vertex);
        load.obstacle = implementation_->obstacle_number(load.obstacle);
        loads.push_back(load);
    }
    std::ranges::stable_sort(loads, {}, &ContactLoad::vertex);
    return loads;
}

Vec3 Simulation::force_on(ObstacleId obstacle) const {
    Vec3 sum = Vec3::Zero();
    for (const ContactLoad& load : percale::contact_loads(implementation_->world, implementation_->index(obstacle)))
        sum -= load.force();
    return sum;
}

Vec3 Simulation::torque_on(ObstacleId obstacle, const Vec3& about) const {
    check_finite(about, implementation_->obstacle(obstacle).name + ": the point that torque_on is about");
    Vec3 sum = Vec3::Zero();
    for (const ContactLoad& load : percale::contact_loads(implementation_->world, implementation_->index(obstacle)))
        sum -= (load.cloth_point - about).cross(load.force());
    return sum;
}

Vec3 Simulation::impulse_on(ObstacleId obstacle) const { return implementation_->impulse("impulse_on", obstacle).linear; }

Vec3 Simulation::angular_impulse_on(ObstacleId obstacle, const Vec3& about) const {
    check_finite(about, implementation_->obstacle(obstacle).name + ": the point that angular_impulse_on is about");
    const ObstacleImpulse impulse = implementation_->impulse("angular_impulse_on", obstacle);
    return impulse.angular - about.cross(impulse.linear);
}

std::uint64_t Simulation::state_hash() const {
    Hash hash;
    const ClothState& state = implementation_->world.state.cloth;
    for (int i = 0; i < implementation_->world.scene.model.vertex_count(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            hash.add(state.positions.at(i)[axis]);
            hash.add(state.velocities.at(i)[axis]);
        }
    }
    for (const StickAnchor& stick_anchor : state.stick_anchors) {
        hash.add(stick_anchor.vertex);
        hash.add(stick_anchor.obstacle);
        for (int axis = 0; axis < 3; ++axis) hash.add(stick_anchor.stretch[axis]);
    }
    return hash.value();
}

}  // namespace percale
