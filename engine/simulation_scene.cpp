#include <algorithm>
#include <cmath>
#include <utility>

#include "compliant/compliant_obstacle.h"
#include "percale/options.h"
#include "plan/planning.h"
#include "simulation_implementation.h"
#include "start/start_check.h"
#include "state/saved_world.h"
#include "step/sewing.h"
#include "support/checked_workers.h"
#include "support/stage_timer.h"
#include "support/thread_pool.h"

namespace percale {

Simulation::Simulation(const StepSettings& settings, std::unique_ptr<ContactDetector> detector, std::shared_ptr<Workers> workers)
    : implementation_{std::make_unique<Implementation>()} {
    check_options(settings, "settings");
    World& world = implementation_->world;
    world.scene.settings = settings;
    world.scene.detector = std::move(detector);
    world.own_workers = workers == nullptr;
    if (workers && dynamic_cast<ThreadPool*>(workers.get()) == nullptr) {
        const auto checked = std::make_shared<CheckedWorkers>(std::move(workers));
        world.host = checked;
        workers = checked;
    }
    world.workers = std::move(workers);
    set_workers(world);
}

Simulation::Implementation* Simulation::Owner::operator->() const {
    if (!owned) throw SceneError("this simulation was moved from: only the one that it was moved to may be used");
    return owned.get();
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

ClothId Simulation::add_cloth(const TriangleMesh& mesh, const Fabric& fabric, const Pose& pose, const std::string& name,
                              const RestShape& rest) {
    World& world = implementation_->world;
    check_pose(pose, name);
    if (fabric.self_contact) implementation_->check_meets(name);
    TriangleMesh placed = mesh;
    placed.vertices = transform(normalised(pose), mesh.vertices);
    RestShape shape = rest;
    for (std::array<Vec3, 3>& corners : shape.corners) {
        for (Vec3& corner : corners) corner *= pose.scale;
    }
    if (shape.corners.empty()) shape.warp = transform({.rotation = normalised(pose).rotation}, rest.warp);
    ClothModel model = world.scene.model;
    append_whole_cloth(model, placed, fabric, name, shape);
    finish_model(model);
    world.scene.model = std::move(model);
    world.work.newton.system.solver.forget_model();
    set_workers(world);
    // The vertices of earlier cloths keep their state and their pins.
    ClothState state;
    for (auto* vectors : {&state.positions, &state.velocities}) vectors->resize(world.scene.model.vertex_count());
    state.points = world.state.cloth.points;
    state.points.insert(state.points.end(), world.scene.model.rest.end() - static_cast<long>(placed.vertices.size()),
                        world.scene.model.rest.end());
    state.stick_anchors = world.state.cloth.stick_anchors;
    state.rest_length = world.state.cloth.rest_length;
    add_rest_lengths(world.scene.model.springs, state.rest_length);
    copy_in(state.points, state.positions);
    for (std::size_t i = 0; i < world.state.cloth.points.size(); ++i) {
        state.velocities.set(static_cast<int>(i), world.state.cloth.velocities.at(static_cast<int>(i)));
    }
    AlignedVector<double> free(state.positions.padded_size(), 0.0);
    Vec3Arrays targets = state.positions;
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
    world.waiting = waiting_cloth(world.scene, world.state.time);
    pass_cloth_to_detector(world);
    world.changed = true;
    scene_changed(world);
    return {world.cloth_numbers.give()};
}

ObstacleId Simulation::add_obstacle(const TriangleMesh& mesh, const Pose& pose, const ObstacleSettings& settings) {
    World& world = implementation_->world;
    if (!world.scene.detector)
        throw SceneError(settings.name, "an obstacle needs a contact detector, give one to the simulation");
    check_friction(settings.name, settings.friction);
    check_range(settings.name, "restitution", "", settings.restitution, 0.0, 1.0);
    check_pose(pose, settings.name);
    check_mesh(mesh, settings.name, false);
    const Pose placed = normalised(pose);
    double square = 0.0;
    for (const Vec3& x : mesh.vertices) square = std::max(square, x.squaredNorm());
    Shape shape;
    const bool deforming = settings.deforming || settings.yields;
    if (deforming) {
        world.scene.detector->add_deforming_obstacle(mesh, placed, settings.friction);
        shape = std::make_shared<const std::vector<Vec3>>(mesh.vertices);
    } else {
        world.scene.detector->add_obstacle(mesh, placed, settings.friction);
    }
    world.scene.script.obstacles.push_back(
        {.name = settings.name,
         .start = placed,
         .end = placed,
         .triangles = static_cast<int>(mesh.triangles.size()),
         .restitution = settings.restitution,
         .reach = placed.scale * std::sqrt(square),
         .start_shape = shape,
         .end_shape = shape,
         .compliance = settings.yields ? Compliance{compliant_mesh(mesh), shape} : Compliance{},
         .friction = settings.friction});
    world.changed = true;
    scene_changed(world);
    return {world.obstacle_numbers.give()};
}

void Simulation::prepare() {
    World& world = implementation_->world;
    std::vector<int> waiting = waiting_cloth(world.scene, world.state.time);
    const bool sewn_now = waiting != world.waiting;
    if (sewn_now) {
        world.waiting = std::move(waiting);
        pass_cloth_to_detector(world);
        world.changed = true;
    }
    if (!world.changed) return;
    check_scheme(implementation_->world.scene);
    const bool obstacles = !world.scene.script.obstacles.empty() && !world.scene.model.cloths.empty();
    if (world.scene.detector && (obstacles || cloth_meets_now(world))) {
        std::vector<StartMove> moves = implementation_->cleared_start(sewn_now ? " is sewn " : " starts ");
        std::vector<StartMove>& known = implementation_->start_moves;
        if (!sewn_now) known.clear();
        if (sewn_now && !moves.empty()) world.state.past.forget();
        known.insert(known.end(), moves.begin(), moves.end());
        if (!moves.empty()) implementation_->previous.clear();
        implementation_->update_views();
    }
    world.state.contact.forget();
    world.changed = false;
}

std::span<const StartMove> Simulation::start_repair() const { return implementation_->start_moves; }

StepReport Simulation::step() {
    World& world = implementation_->world;
    if (world.host) world.host->check();
    const auto cpu_seconds = [&] { return thread_cpu_seconds() + (world.workers ? world.workers->other_cpu_seconds() : 0.0); };
    const double start = cpu_seconds();
    prepare();
    if (implementation_->keeps_previous) implementation_->previous = world.state.cloth.points;
    // If cloth does not come apart when seams have closed, the whole step is taken back.
    const double next = world.state.time + 1.5 * world.scene.settings.time_step;
    const bool may_close = meets_cloth(world.scene) && waiting_cloth(world.scene, next) != world.waiting;
    const std::vector<std::byte> before = may_close ? implementation_->saved_if_possible() : std::vector<std::byte>();
    StepReport report = percale::step(world);
    implementation_->report_numbers(report);
    if (!report.slept) implementation_->update_views();
    if (report.ok() && waiting_cloth(world.scene, world.state.time) != world.waiting) {
        const std::size_t moves = implementation_->start_moves.size();
        const double energy = this->energy().total();
        try {
            prepare();
        } catch (const StartError&) {
            if (!before.empty()) restore(before);
            throw;
        }
        if (implementation_->start_moves.size() > moves) implementation_->report_moves_of(energy, report);
    }
    report.cpu_s = cpu_seconds() - start;
    return report;
}

ScenePlan Simulation::plan(const ScriptedChanges& to_come) const {
    return scene_plan(implementation_->world.scene, implementation_->world.state.cloth, to_come);
}

std::vector<std::byte> Simulation::save() const { return implementation_->save(); }

void Simulation::restore(std::span<const std::byte> saved) {
    check_scheme(implementation_->world.scene);
    implementation_->start_moves = restore_world(saved, implementation_->world);
    implementation_->report_numbers(implementation_->start_moves);
    implementation_->previous.clear();
    implementation_->update_views();
}

}  // namespace percale
