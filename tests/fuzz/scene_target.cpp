#include <algorithm>
#include <string>

#include "fuzz_entry.h"
#include "percale/error.h"
#include "scenes/format/scene_file.h"
#include "scenes/run/scene_build.h"
#include "scenes/run/scene_plan.h"
#include "tests/scenes/test_folder.h"

// A scene file from its text to the first step of its simulation.
namespace percale::fuzz {
namespace {

constexpr int max_vertices = 40, max_parts = 3, max_threads = 2, max_iterations = 2;

/// Beside the scene lie two meshes, so that scenes with meshes are built, too.
const scenes::test::TestFolder& folder() {
    static const scenes::test::TestFolder made;
    static const bool filled = [] {
        made.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 3 2\nf 1 4 3\n");
        made.write("body.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
        return true;
    }();
    static_cast<void>(filled);
    return made;
}

/// Files elsewhere are none of this target's business.
bool stays_in_folder(const std::string& mesh) { return mesh.find('/') == std::string::npos; }

/// Whether building and a step take milliseconds: size is allowed to cost, so it says nothing.
bool is_small(const scenes::Scene& scene) {
    using scenes::ClothSpec;
    using scenes::ObstacleSpec;
    long vertices = 0;
    bool here = true;
    for (const ClothSpec& cloth : scene.cloths) {
        vertices += cloth.grid ? static_cast<long>(cloth.grid->vertices[0]) * cloth.grid->vertices[1] : 4;
        here = here && stays_in_folder(cloth.mesh);
    }
    for (const ObstacleSpec& obstacle : scene.obstacles) here = here && stays_in_folder(obstacle.mesh);
    return here && vertices <= max_vertices && scene.cloths.size() <= max_parts && scene.obstacles.size() <= max_parts &&
           scene.step.threads <= max_threads;
}

/// Adaptive steps and checked derivatives may take as long as was asked for.
bool is_quick(const StepSettings& step) { return !step.adaptive && !step.check_derivatives; }

void require_finite(const scenes::BuiltScene& built) {
    for (const ClothId cloth : built.cloths) {
        for (const Vec3& x : built.simulation.positions(cloth)) require(x.allFinite(), "positions are finite whatever happens");
        for (const Vec3& v : built.simulation.velocities(cloth)) require(v.allFinite(), "velocities are finite whatever happens");
    }
}

/// Time limit of a step, s: some scenes take hundreds of Newton iterations, which sanitizers make slow.
constexpr double max_seconds = 2.0;

void try_step(scenes::BuiltScene& built) {
    built.simulation.set_time_limit(max_seconds);
    const StepReport report = built.simulation.step();
    require(!report.explanation().empty(), "a step says what happened");
    require_finite(built);
}

void try_scene(const std::string& text) {
    const std::string name = folder().path("scene.toml");
    try {
        scenes::Scene scene = scenes::parse_scene(text, name);
        if (!is_small(scene)) return;
        scene.step.newton_iterations = std::min(scene.step.newton_iterations, max_iterations);
        scenes::BuiltScene built = scenes::build_scene(scene);
        require(!scenes::plan_text(built).empty(), "a scene that builds has a plan");
        if (is_quick(scene.step)) try_step(built);
    } catch (const SceneError& error) {
        require(std::string(error.what()).find(name) != std::string::npos, "a refusal names the file");
    }
}

}  // namespace
}  // namespace percale::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    percale::fuzz::try_scene(std::string(reinterpret_cast<const char*>(data), size));
    return 0;
}
