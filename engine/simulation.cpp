#include "percale/simulation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "percale/error.h"
#include "percale/options.h"
#include "plan/planning.h"
#include "start/start_check.h"
#include "state/saved_world.h"
#include "step/measure.h"
#include "step/sewing.h"
#include "step/step.h"
#include "support/hash.h"
#include "support/stage_timer.h"
#include "tolerances.h"

namespace percale {
namespace {

std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

void check_pose(const Pose& pose, const std::string& name) {
    const Rotation& q = pose.rotation;
    const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!pose.translation.allFinite()) throw SceneError(name, "the translation of its pose is not finite");
    if (!(std::abs(norm - 1.0) <= unit_length_error)) {
        throw SceneError(
            name, "the rotation of its pose has length " + number_text(norm) + ", a rotation is a unit quaternion (w, x, y, z)");
    }
    if (!(pose.scale > 0.0) || !std::isfinite(pose.scale)) {
        throw SceneError(name, "the scale of its pose is " + number_text(pose.scale) + ", it must be above 0");
    }
}

/// Exactly unit length, so that rotated lengths keep to rounding.
Pose normalised(Pose pose) {
    Rotation& q = pose.rotation;
    const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (norm != 1.0) q = {q.w / norm, q.x / norm, q.y / norm, q.z / norm};
    return pose;
}

void check_range(const std::string& owner, const std::string& what, const std::string& unit, double value, double lowest,
                 double highest) {
    if (value >= lowest && value <= highest) return;
    throw SceneError(owner, what + " = " + number_text(value) + " " + unit + " is outside the allowed range " +
                                number_text(lowest) + " ... " + number_text(highest));
}

void check_finite(const Vec3& value, const std::string& what) {
    if (!value.allFinite()) throw SceneError(what + " is not finite");
}

}  // namespace

struct Simulation::Implementation {
    World world;
    std::vector<StartMove> start_moves;

    const ClothRange& cloth(ClothId id) const {
        if (id.index >= 0 && id.index < static_cast<int>(world.scene.model.cloths.size()))
            return world.scene.model.cloths[id.index];
        throw SceneError("there is no cloth " + std::to_string(id.index) + ", cloths are 0 ... " +
                         std::to_string(static_cast<int>(world.scene.model.cloths.size()) - 1));
    }

    ObstacleState& obstacle(ObstacleId id) {
        if (id.index >= 0 && id.index < static_cast<int>(world.scene.script.obstacles.size()))
            return world.scene.script.obstacles[id.index];
        throw SceneError("there is no obstacle " + std::to_string(id.index) + ", obstacles are 0 ... " +
                         std::to_string(static_cast<int>(world.scene.script.obstacles.size()) - 1));
    }

    int vertex(ClothId id, int index) const {
        const ClothRange& range = cloth(id);
        if (index >= 0 && index < range.count) return range.index_of(index);
        throw SceneError(range.name, "there is no vertex " + std::to_string(index) + ", vertices are 0 ... " +
                                         std::to_string(range.count - 1));
    }

    int pinned_vertex(ClothId id, int index, const char* call) const {
        const int at = vertex(id, index);
        if (world.scene.script.free[at] == 0.0) return at;
        throw SceneError(cloth(id).name, std::string(call) + " of vertex " + std::to_string(index) + ", which is not pinned");
    }

    void change(const StepSettings& settings) {
        const bool same_air = settings.wind == world.scene.settings.wind,
                   same_gravity = settings.gravity == world.scene.settings.gravity;
        if (!same_air || !same_gravity || settings.time_step != world.scene.settings.time_step) scene_changed(world);
        world.scene.settings = settings;
    }

    /// Brings the view of positions up to date.
    void update_views() {
        for (const ClothRange& range : world.scene.model.cloths) {
            if (range.order.kept()) continue;
            world.views.positions.resize(world.state.cloth.points.size());
            for (int i = 0; i < range.count; ++i) {
                world.views.positions[range.first + i] = world.state.cloth.points[range.index_of(i)];
            }
        }
    }

    /// The view of masses, after a cloth was added.
    void add_masses(const ClothRange& range) {
        if (range.order.kept()) return;
        world.views.masses.resize(world.scene.model.mass.size());
        for (int i = 0; i < range.count; ++i) world.views.masses[range.first + i] = world.scene.model.mass[range.index_of(i)];
    }
};

Simulation::Simulation(const StepSettings& settings, std::unique_ptr<ContactDetector> detector, std::shared_ptr<Workers> workers)
    : implementation_(std::make_unique<Implementation>()) {
    check_options(settings, "settings");
    World& world = implementation_->world;
    world.scene.settings = settings;
    world.scene.detector = std::move(detector);
    world.own_workers = workers == nullptr;
    world.workers = std::move(workers);
    set_workers(world);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

ClothId Simulation::add_cloth(const TriangleMesh& mesh, const Fabric& fabric, const Pose& pose, const std::string& name,
                              const RestShape& rest) {
    World& world = implementation_->world;
    check_pose(pose, name);
    if (fabric.self_contact && !world.scene.detector) {
        throw SceneError(name, "self_contact needs a contact detector, give one to the simulation");
    }
    TriangleMesh placed = mesh;
    placed.vertices = transform(normalised(pose), mesh.vertices);
    RestShape shape = rest;
    for (std::array<Vec3, 3>& corners : shape.corners) {
        for (Vec3& corner : corners) corner *= pose.scale;
    }
    if (shape.corners.empty()) shape.warp = transform({.rotation = normalised(pose).rotation}, rest.warp);
    ClothModel model = world.scene.model;
    append_cloth(model, placed, fabric, name, shape);
    order_last_cloth(model);
    if (fabric.bend_stiffness.value_or(0.0) > 0.0) append_hinges_of_last_cloth(model, *fabric.bend_stiffness, shape);
    finish_model(model);
    world.scene.model = std::move(model);
    world.work.newton.solver.forget_model();
    set_workers(world);
    // The vertices of earlier cloths keep state and pins.
    ClothState state;
    for (auto* vectors : {&state.positions, &state.velocities}) vectors->resize(world.scene.model.vertex_count());
    state.points = world.state.cloth.points;
    state.points.insert(state.points.end(), world.scene.model.rest.end() - static_cast<long>(placed.vertices.size()),
                        world.scene.model.rest.end());
    state.grips = world.state.cloth.grips;
    state.rest_length = world.state.cloth.rest_length;
    add_rest_lengths(world.scene.model.springs, state.rest_length);
    copy_in(state.points, state.positions);
    for (std::size_t i = 0; i < world.state.cloth.points.size(); ++i) {
        state.velocities.set(static_cast<int>(i), world.state.cloth.velocities.at(static_cast<int>(i)));
    }
    AlignedVector<double> free(state.positions.padded_size(), 0.0);
    Vectors targets = state.positions;
    for (int i = 0; i < world.scene.model.vertex_count(); ++i) {
        const bool old = i < static_cast<int>(world.state.cloth.points.size());
        free[i] = old ? world.scene.script.free[i] : 1.0;
        if (old) targets.set(i, world.scene.script.pin_targets.at(i));
    }
    world.state.cloth = std::move(state);
    world.scene.script.free = std::move(free);
    world.scene.script.pin_targets = std::move(targets);
    implementation_->update_views();
    implementation_->add_masses(world.scene.model.cloths.back());
    pass_cloth_to_detector(world);
    world.changed = true;
    scene_changed(world);
    return {static_cast<int>(world.scene.model.cloths.size()) - 1};
}

ObstacleId Simulation::add_obstacle(const TriangleMesh& mesh, const Pose& pose, const ObstacleSettings& settings) {
    World& world = implementation_->world;
    if (!world.scene.detector)
        throw SceneError(settings.name, "an obstacle needs a contact detector, give one to the simulation");
    if (!(settings.friction >= 0.0 && settings.friction <= 10.0)) {
        throw SceneError(settings.name,
                         "friction = " + number_text(settings.friction) + " is outside the allowed range 0 ... 10");
    }
    check_range(settings.name, "restitution", "", settings.restitution, 0.0, 1.0);
    check_pose(pose, settings.name);
    check_mesh(mesh, settings.name, false);
    const Pose placed = normalised(pose);
    world.scene.detector->add_obstacle(mesh, placed, settings.friction);
    world.scene.script.obstacles.push_back(
        {settings.name, placed, placed, static_cast<int>(mesh.triangles.size()), settings.restitution});
    world.changed = true;
    scene_changed(world);
    return {static_cast<int>(world.scene.script.obstacles.size()) - 1};
}

void Simulation::pin(ClothId cloth, int vertex) {
    World& world = implementation_->world;
    const int at = implementation_->vertex(cloth, vertex);
    world.scene.script.free[at] = 0.0;
    world.scene.script.pin_targets.set(at, world.state.cloth.positions.at(at));
    world.state.cloth.velocities.set(at, Vec3::Zero());
    scene_changed(world);
}

void Simulation::unpin(ClothId cloth, int vertex) {
    World& world = implementation_->world;
    world.scene.script.free[implementation_->pinned_vertex(cloth, vertex, "unpin")] = 1.0;
    scene_changed(world);
}

void Simulation::move_pin(ClothId cloth, int vertex, const Vec3& target) {
    const int at = implementation_->pinned_vertex(cloth, vertex, "move_pin");
    check_finite(target, implementation_->cloth(cloth).name + ": the target of pinned vertex " + std::to_string(vertex));
    World& world = implementation_->world;
    if (target != world.state.cloth.positions.at(at)) wake(world.rest);
    world.scene.script.pin_targets.set(at, target);
}

void Simulation::move_obstacle(ObstacleId obstacle, const Pose& end) {
    ObstacleState& state = implementation_->obstacle(obstacle);
    check_pose(end, state.name);
    if (end.scale != state.start.scale) {
        throw SceneError(state.name, "the scale of an obstacle cannot change, it is " + number_text(state.start.scale));
    }
    state.end = normalised(end);
    if (state.end != state.start) wake(implementation_->world.rest);
}

void Simulation::set_gravity(const Vec3& gravity) {
    StepSettings settings = implementation_->world.scene.settings;
    settings.gravity = gravity;
    check_options(settings, "set_gravity");
    implementation_->change(settings);
}

void Simulation::set_wind(const Vec3& velocity) {
    StepSettings settings = implementation_->world.scene.settings;
    settings.wind = velocity;
    check_options(settings, "set_wind");
    implementation_->change(settings);
}

SeamId Simulation::add_seam(ClothId first, ClothId second, std::span<const Stitch> stitches, const SeamSettings& settings) {
    World& world = implementation_->world;
    check_range(settings.name, "over", "s", settings.over, 0.0, 1e6);
    check_range(settings.name, "stiffness", "N/m", settings.stiffness, 1e-3, 1e9);
    std::vector<Stitch> sewn;
    for (const Stitch& stitch : stitches) {
        check_range(settings.name, "the share of a stitch", "", stitch.share, 0.0, 1.0);
        sewn.push_back({implementation_->vertex(first, stitch.vertex), implementation_->vertex(second, stitch.from),
                        implementation_->vertex(second, stitch.to), stitch.share});
        if (!joins_itself(sewn.back())) continue;
        throw SceneError(settings.name, "vertex " + std::to_string(stitch.vertex) + " of " + implementation_->cloth(first).name +
                                            " is sewn to itself");
    }
    if (sewn.empty()) throw SceneError(settings.name, "no vertices, a seam joins at least one pair");
    return {sew(world, sewn, settings)};
}

SeamId Simulation::add_seam(ClothId first, ClothId second, std::span<const std::array<int, 2>> vertices,
                            const SeamSettings& settings) {
    std::vector<Stitch> stitches;
    for (const auto& [one, other] : vertices) stitches.push_back({one, other, other, 0.0});
    return add_seam(first, second, stitches, settings);
}

std::vector<double> Simulation::seam_gaps(SeamId seam) const {
    const std::vector<Seam>& seams = implementation_->world.scene.script.seams;
    if (seam.index < 0 || seam.index >= static_cast<int>(seams.size())) {
        throw SceneError("there is no seam " + std::to_string(seam.index) + ", seams are 0 ... " +
                         std::to_string(static_cast<int>(seams.size()) - 1));
    }
    std::vector<double> gaps;
    for (const Stitch& stitch : seams[seam.index].stitches) {
        gaps.push_back(stitch_gap(stitch, implementation_->world.state.cloth.positions).norm());
    }
    return gaps;
}

void Simulation::set_time_step(double time_step) {
    StepSettings settings = implementation_->world.scene.settings;
    settings.time_step = time_step;
    check_options(settings, "set_time_step");
    implementation_->change(settings);
}

void Simulation::set_positions(ClothId cloth, std::span<const Vec3> positions) {
    World& world = implementation_->world;
    const ClothRange& range = implementation_->cloth(cloth);
    if (static_cast<int>(positions.size()) != range.count) {
        throw SceneError(range.name, "set_positions got " + std::to_string(positions.size()) + " positions for " +
                                         std::to_string(range.count) + " vertices");
    }
    for (int i = 0; i < range.count; ++i) check_finite(positions[i], range.name + ": position " + std::to_string(i));
    for (int i = 0; i < range.count; ++i) {
        world.state.cloth.positions.set(range.index_of(i), positions[i]);
        world.scene.script.pin_targets.set(range.index_of(i), positions[i]);
    }
    const auto is_of_cloth = [&](const auto& held) {
        return held.vertex >= range.first && held.vertex < range.first + range.count;
    };
    std::erase_if(world.state.cloth.grips, is_of_cloth);
    std::erase_if(world.state.cloth.impacts, is_of_cloth);
    update_points(world.state.cloth);
    implementation_->update_views();
    world.state.contact_energy = 0.0;  // known again after the next step
    world.state.past.forget();
    world.changed = true;
    wake(world.rest);
}

void Simulation::set_velocities(ClothId cloth, std::span<const Vec3> velocities) {
    World& world = implementation_->world;
    const ClothRange& range = implementation_->cloth(cloth);
    if (static_cast<int>(velocities.size()) != range.count) {
        throw SceneError(range.name, "set_velocities got " + std::to_string(velocities.size()) + " velocities for " +
                                         std::to_string(range.count) + " vertices");
    }
    for (int i = 0; i < range.count; ++i) check_finite(velocities[i], range.name + ": velocity " + std::to_string(i));
    for (int i = 0; i < range.count; ++i) {
        const bool free = world.scene.script.free[range.index_of(i)] > 0.0;
        world.state.cloth.velocities.set(range.index_of(i), free ? velocities[i] : Vec3(Vec3::Zero()));
    }
    std::erase_if(world.state.cloth.impacts, [&](const Impact& impact) {
        return impact.vertex >= range.first && impact.vertex < range.first + range.count;
    });
    world.state.past.forget();
    wake(world.rest);
}

void Simulation::prepare() {
    World& world = implementation_->world;
    const bool sewn_now = world.cloth_waits && !sews_without_contact(world);
    if (sewn_now) {
        world.cloth_waits = false;
        pass_cloth_to_detector(world);
        world.changed = true;
    }
    if (!world.changed) return;
    check_scheme(implementation_->world.scene);
    const bool obstacles = !world.scene.script.obstacles.empty() && !world.scene.model.cloths.empty();
    if (world.scene.detector && (obstacles || (meets_cloth(world.scene) && !world.cloth_waits))) {
        std::vector<StartMove> moves = clear_start(world);
        std::vector<StartMove>& known = implementation_->start_moves;
        if (!sewn_now) known.clear();
        if (sewn_now && !moves.empty()) world.state.past.forget();
        known.insert(known.end(), moves.begin(), moves.end());
        implementation_->update_views();
    }
    world.state.contact.forget();
    world.changed = false;
}

std::span<const StartMove> Simulation::start_repair() const { return implementation_->start_moves; }

StepReport Simulation::step() {
    World& world = implementation_->world;
    const auto cpu_seconds = [&] { return thread_cpu_seconds() + (world.workers ? world.workers->other_cpu_seconds() : 0.0); };
    const double start = cpu_seconds();
    prepare();
    StepReport report = percale::step(world);
    if (!report.slept) implementation_->update_views();
    if (report.ok() && world.cloth_waits && !sews_without_contact(world)) prepare();
    report.cpu_s = cpu_seconds() - start;
    return report;
}

ScenePlan Simulation::plan(const ScriptedChanges& to_come) const {
    return scene_plan(implementation_->world.scene, implementation_->world.state.cloth, to_come);
}

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

Pose Simulation::obstacle_pose(ObstacleId obstacle) const { return implementation_->obstacle(obstacle).start; }

StepEnergy Simulation::energy() const { return energy_of(implementation_->world.scene, implementation_->world.state); }

double Simulation::largest_strain() const {
    return percale::largest_strain(implementation_->world.scene.model.springs, implementation_->world.state.cloth.positions);
}

double Simulation::largest_speed() const {
    return percale::largest_speed(implementation_->world.state.cloth.velocities,
                                  implementation_->world.scene.model.vertex_count());
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
    for (const Grip& grip : state.grips) {
        hash.add(grip.vertex);
        hash.add(grip.obstacle);
        for (int axis = 0; axis < 3; ++axis) hash.add(grip.stretch[axis]);
    }
    return hash.value();
}

std::vector<std::byte> Simulation::save() const { return saved_world(implementation_->world, implementation_->start_moves); }

void Simulation::restore(std::span<const std::byte> saved) {
    check_scheme(implementation_->world.scene);
    implementation_->start_moves = restore_world(saved, implementation_->world);
    implementation_->update_views();
}

}  // namespace percale
