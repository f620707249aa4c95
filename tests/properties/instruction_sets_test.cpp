#include "engine/step/step.h"
#include "engine/support/hash.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::instruction_sets_test {
namespace {

constexpr int steps = 60;

struct Scene {
    const char* name;
    ClothModel model;
    std::vector<int> pins;
    StepSettings settings;
    bool floor = false;
};

/// A sheet as a grid, or as a free mesh.
ClothModel sheet(bool grid) {
    TriangleMesh mesh = make_grid(1.0, 1.0, 33, 33);
    if (!grid) mesh.grid_columns = mesh.grid_rows = 0;
    return cloth_model(mesh, grid ? sheet_fabric() : free_fabric());
}

std::vector<Scene> some_scenes() {
    StepSettings velocity;
    velocity.damping_form = DampingForm::velocity;
    std::vector<Scene> scenes = {{"grid", sheet(true), {0, 32}, {}}, {"free mesh", sheet(false), {0, 32}, {}}};
    scenes.push_back({"grid, multigrid", sheet(true), {0, 32}, {.linear_solver = LinearSolver::multigrid}});
    scenes.push_back({"grid, block Jacobi, damping by velocity", sheet(true), {0}, velocity});
    Fabric limited = free_fabric();
    limited.strain_limit = 0.02;
    scenes.push_back({"grid with a strain limit", cloth_model(make_grid(1.0, 1.0, 33, 33), limited), {0, 32}, {}});
    scenes.push_back({"grid on a plane", sheet(true), {}, {}, true});
    scenes.push_back({"free mesh, explicit", sheet(false), {5}, {.time_step = 1e-4, .scheme = Scheme::rk4}});
    return scenes;
}

World scene_world(const Scene& scene, const Kernels& kernels) {
    std::vector<Vec3> places = scene.model.rest;
    for (Vec3& x : places) x.y() += scene.floor ? 0.05 : 0.0;
    World world = make_world(scene.model, places, scene.settings);
    world.scene.settings.measure = StepMeasures::all;
    world.scene.compute.kernels = &kernels;
    for (const int pin : scene.pins) world.scene.script.free[pin] = 0.0;
    if (!scene.floor) return world;
    world.scene.detector = std::make_unique<PlaneDetector>();
    world.scene.detector->set_cloth(world.scene.model.triangles, world.scene.model.thickness);
    world.scene.detector->add_obstacle(make_plane(2.0), {}, 0.3);
    world.scene.script.obstacles.push_back({"plane", {}, {}});
    return world;
}

/// The hash of all states and of the energies in the reports.
std::uint64_t run(const Scene& scene, const Kernels& kernels) {
    World world = scene_world(scene, kernels);
    Hash hash;
    for (int n = 0; n < steps; ++n) {
        const StepReport report = step(world);
        REQUIRE(report.ok());
        hash.add(report.linear_iterations);
        for (int i = 0; i < world.scene.model.vertex_count(); ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                hash.add(world.state.cloth.positions.at(i)[axis]);
                hash.add(world.state.cloth.velocities.at(i)[axis]);
            }
        }
    }
    return hash.value();
}

}  // namespace

TEST_CASE("A whole run has the same bits in every instruction set", "[slow]") {
    for (const Scene& scene : some_scenes()) {
        const std::uint64_t baseline = run(scene, *kernels_for(InstructionSet::baseline));
        for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
            CAPTURE(scene.name, instruction_set_name(set));
            if (const Kernels* kernels = kernels_for(set)) CHECK(run(scene, *kernels) == baseline);
        }
    }
}

}  // namespace percale::test::instruction_sets_test
