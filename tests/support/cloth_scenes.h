#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/cloth_model.h"
#include "engine/plan/planning.h"
#include "engine/plan/step_plan.h"
#include "engine/solve/explicit_update.h"
#include "engine/solve/newton.h"
#include "engine/step/motion.h"
#include "engine/step/world.h"
#include "engine/substep/advance.h"
#include "percale/percale.h"
#include "tests/support/random.h"

namespace percale::test {

/// The kernels and threads of tests: the best kernels of this machine.
inline const Compute compute;
inline const ForceBlocks no_blocks;

/// All schemes, in the order of the enum.
inline constexpr std::array all_schemes = {Scheme::forward_euler,  Scheme::symplectic_euler,  Scheme::midpoint,  Scheme::rk4,
                                           Scheme::backward_euler, Scheme::implicit_midpoint, Scheme::trapezoid, Scheme::bdf2,
                                           Scheme::tr_bdf2};

/// The schemes by which a SolverScene steps.
inline constexpr std::array basic_schemes = {Scheme::symplectic_euler, Scheme::rk4, Scheme::backward_euler};

/// The sheet that every measured figure refers to.
inline Fabric sheet_fabric() {
    return {.area_density = 0.2,
            .thickness = 0.005,
            .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0},
            .spring_damping = 0.1};
}

/// The same for meshes without rows and columns.
inline Fabric free_fabric() {
    Fabric fabric = sheet_fabric();
    fabric.springs.shear = 0.0;
    return fabric;
}

inline std::vector<Vec3> copy(std::span<const Vec3> view) { return {view.begin(), view.end()}; }

/// One spring of a hand-made system.
struct Link {
    int first, second;
    double rest_length, stiffness, damping;
};

/// Masses and springs without a mesh: pairs, ropes, strings, random networks. One cloth of all vertices.
inline ClothModel linked_masses(const std::vector<double>& mass, const std::vector<Link>& links) {
    ClothModel model;
    model.mass = mass;
    model.thickness.assign(mass.size(), 0.005);
    ClothRange range{.name = "links", .first = 0, .count = static_cast<int>(mass.size())};
    for (const double m : mass) range.mass += m;
    model.cloths = {range};
    for (const Link& link : links) {
        model.springs.first.push_back(link.first);
        model.springs.second.push_back(link.second);
        model.springs.rest_length.push_back(link.rest_length);
        model.springs.stiffness.push_back(link.stiffness);
        model.springs.damping.push_back(link.damping);
        model.springs.kind.push_back(SpringKind::structural);
    }
    finish_model(model);
    return model;
}

inline ClothModel cloth_model(const TriangleMesh& mesh, const Fabric& fabric) {
    ClothModel model;
    append_cloth(model, mesh, fabric, "cloth");
    finish_model(model);
    return model;
}

/// Random springs between random points, some stretched, some compressed; every vertex has at least one.
inline std::vector<Link> random_links(Random& random, int vertices, int links) {
    std::vector<Link> result;
    for (int k = 0; k < links; ++k) {
        const int first = k < vertices ? k : random.index(vertices);
        const int second = (first + 1 + random.index(vertices - 1)) % vertices;
        result.push_back({first, second, random.number(0.2, 1.5), random.decades(1.0, 1e4), random.number(0.0, 2.0)});
    }
    return result;
}

inline std::vector<double> random_masses(Random& random, int count) {
    std::vector<double> masses;
    for (int i = 0; i < count; ++i) masses.push_back(random.decades(1e-3, 1e-1));
    return masses;
}

inline std::vector<Vec3> random_points(Random& random, int count, double size) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back(random.point(size));
    return points;
}

inline Vec3Arrays to_vec3_arrays(const std::vector<Vec3>& points) {
    Vec3Arrays vectors;
    vectors.resize(static_cast<int>(points.size()));
    copy_in(points, vectors);
    return vectors;
}

inline std::vector<Vec3> to_points(const Vec3Arrays& vectors, int count) {
    std::vector<Vec3> points(count);
    copy_out(vectors, points);
    return points;
}

/// Exactly the same bits in every entry that belongs to a vertex.
inline bool same_bits(const Vec3Arrays& a, const Vec3Arrays& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

inline double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double largest = a.size() == b.size() ? 0.0 : 1e300;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

/// A scene with its state and the data of a solver. Not to be moved after the first solve.
struct SolverScene : StepScene {
    ClothState state, before;  // now, and before the last step
    Vec3Arrays targets;
    ContactWarmStart contact;
    NewtonOptions options;
    NewtonSpace newton;
    ExplicitSpace explicit_space;
    StageBase base;
    StageTimes stages;

    void pin(int vertex) { script.free[vertex] = 0.0; }

    NewtonReport step_implicit() {
        before = state;
        set_euler_base(before, settings.time_step, base);
        const ImplicitStage stage{.scene = *this, .base = base, .start = before, .targets = targets, .options = options};
        return solve_stage(stage, newton, {state, contact}, stages);
    }

    void step_explicit() {
        const ExplicitStep step{.scene = *this, .targets = targets, .dt = settings.time_step};
        percale::step_explicit(settings.scheme == Scheme::backward_euler ? Scheme::symplectic_euler : settings.scheme, step,
                               explicit_space, state);
    }

    void step() {
        if (settings.scheme != Scheme::backward_euler) return step_explicit();
        step_implicit();
    }
};

inline SolverScene solver_scene(ClothModel model, const std::vector<Vec3>& positions, const StepSettings& settings) {
    SolverScene scene;
    scene.settings = settings;
    scene.model = std::move(model);
    if (scene.model.rest.empty()) scene.model.rest = positions;
    scene.state.positions = to_vec3_arrays(positions);
    scene.state.velocities.resize(scene.model.vertex_count());
    scene.state.points = positions;
    scene.plan = make_step_plan(settings, {.cloth_vertices = scene.model.vertex_count()});
    scene.script.free.assign(scene.state.positions.padded_size(), 0.0);
    for (int i = 0; i < scene.model.vertex_count(); ++i) scene.script.free[i] = 1.0;
    scene.targets = scene.state.positions;
    return scene;
}

inline SolverScene solver_scene(const TriangleMesh& mesh, const Fabric& fabric, const StepSettings& settings) {
    return solver_scene(cloth_model(mesh, fabric), mesh.vertices, settings);
}

/// The same as a World, the state that steps work on.
inline World make_world(ClothModel model, const std::vector<Vec3>& positions, const StepSettings& settings) {
    SolverScene scene = solver_scene(std::move(model), positions, settings);
    World world;
    world.scene.settings = settings;
    world.scene.model = std::move(scene.model);
    world.state.cloth = std::move(scene.state);
    world.scene.script.free = std::move(scene.script.free);
    world.scene.script.pin_targets = std::move(scene.targets);
    return world;
}

/// Masses and springs, some of them held, as a World.
inline World linked_world(ClothModel model, const std::vector<Vec3>& positions, const std::vector<int>& held,
                          const StepSettings& settings) {
    World world = make_world(std::move(model), positions, settings);
    for (const int vertex : held) world.scene.script.free[vertex] = 0.0;
    return world;
}

/// The plan of the coming step, as step() makes it.
inline void plan_step(World& world) {
    renew_plan(world.scene, world.state.cloth);
    set_motion_of_step(world.scene, world.state.cloth, world.state.time);
    if (world.scene.detector) report_obstacles(world.scene);
}

/// Makes one substep of the coming step; its end becomes the state.
inline SubstepResult advance_world(World& world, StepFraction fraction, bool last_try = false) {
    const StepState start = world.state;
    StepState end;
    const SubstepResult result = advance({world.scene, start.cloth.positions, fraction, last_try}, start, world.work, end);
    world.state = end;
    return result;
}

/// A mass on a spring, away from its rest; the other end is held.
inline World mass_on_spring(const StepSettings& settings) {
    World world =
        linked_world(linked_masses({0.1, 0.2}, {{0, 1, 1.0, 50.0, 0.3}}), {Vec3(0, 0, 0), Vec3(1.2, 0, 0)}, {0}, settings);
    plan_step(world);
    return world;
}

/// The message of a SceneError; empty if nothing was thrown.
template <class Call>
std::string scene_error(Call&& call) {
    try {
        call();
    } catch (const SceneError& error) {
        return error.what();
    }
    return {};
}

inline bool mentions(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
        if (text.find(part) == std::string::npos) return false;
    }
    return true;
}

}  // namespace percale::test
