#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "scenes/format/scene_file.h"
#include "scenes/meshes/mesh_import.h"
#include "scenes/run/run_scene.h"
#include "tests/support/catch.h"
#include "tests/support/real_meshes.h"
#include "tests/support/skip.h"

// Body meshes nobody here made: a sheet is dropped on each, every frame certified.
namespace percale::scenes::body_scans_test {
namespace {

struct Extent {
    Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
};

Extent extent_of(const TriangleMesh& mesh) {
    Extent extent;
    for (const Vec3& x : mesh.vertices) {
        extent.low = extent.low.cwiseMin(x);
        extent.high = extent.high.cwiseMax(x);
    }
    return extent;
}

/// A 65 x 65 sheet 5 cm above the mesh, which is scaled to `size` along its longest side and centred.
std::string drop_scene(const std::filesystem::path& file, double size) {
    const Extent extent = extent_of(import_mesh(file.string()));
    const double scale = size / (extent.high - extent.low).maxCoeff();
    const Vec3 centre = 0.5 * (extent.low + extent.high);
    const double top = scale * (extent.high.y() - centre.y());
    std::ostringstream text;
    text.precision(17);
    text << "duration = 2.0\n[step]\ntime_step = 0.016666666666666666\nmeasure = \"all\"\n"
         << "[fabric.sheet]\narea_density = 0.2\nthickness = 0.005\nspring_damping = 0.1\n"
         << "springs = { structural = 1000.0, shear = 500.0, bend = 10.0 }\n"
         << "[[cloth]]\nname = \"sheet\"\nfabric = \"sheet\"\ngrid = { size = [1.0, 1.0], vertices = [65, 65] }\n"
         << "pose = { translation = [0.0, " << top + 0.05 << ", 0.0] }\n"
         << "[[obstacle]]\nname = \"body\"\nmesh = '" << file.string() << "'\nfriction = 0.3\npose = { translation = ["
         << -scale * centre.x() << ", " << -scale * centre.y() << ", " << -scale * centre.z() << "], scale = " << scale << " }\n"
         << "[output]\nfps = 30.0\n";
    return text.str();
}

template <typename Points>
bool all_finite(const Points& points) {
    return std::all_of(points.begin(), points.end(), [](const Vec3& x) { return x.allFinite(); });
}

struct FrameCounts {
    int frames = 0, uncertified = 0, not_finite = 0;
};

/// Counts the frames of a run with one cloth; a frame shows the state that the simulation is in.
RunHooks counting_hooks(const BuiltScene& built, FrameCounts& counts) {
    RunHooks hooks;
    hooks.frame = [&](const Frame& frame) {
        ++counts.frames;
        counts.uncertified += frame.check.clean() ? 0 : 1;
        const bool finite =
            all_finite(frame.cloths.at(0).vertices) && all_finite(built.simulation.velocities(built.cloths.at(0)));
        counts.not_finite += finite ? 0 : 1;
    };
    return hooks;
}

void drop_on(const std::string& name, double size) {
    const std::filesystem::path file = test::real_mesh_folder() / name;
    if (!std::filesystem::exists(file)) {
        test::skip("no " + file.string() + "; .ci/fetch_meshes.sh fetches it, PERCALE_REAL_MESHES names its folder");
        return;
    }
    BuiltScene built = build_scene(parse_scene(drop_scene(file, size), name));
    FrameCounts counts;
    const RunResult run = run_scene(built, counting_hooks(built, counts));
    std::printf("%s, %.1f m: %d frames, %d bad, smallest distance %.2f mm, largest strain %.1f %%, %.1f CPU s for %.1f s\n",
                name.c_str(), size, counts.frames, counts.uncertified, 1e3 * run.measures.smallest_distance,
                100.0 * run.measures.largest_strain, run.totals.cpu_s, run.totals.simulated_s);
    CHECK(run.status == RunStatus::finished);
    CHECK(counts.frames == 61);
    CHECK(counts.uncertified == 0);
    CHECK(counts.not_finite == 0);
    CHECK(run.measures.intersections == 0);
    CHECK(run.measures.smallest_distance > 0.0);
    CHECK(std::isfinite(run.totals.energy.total()));
    // The sheet did meet the body.
    CHECK(run.measures.smallest_distance < 0.005);
}

TEST_CASE("A sheet dropped on a scanned man never goes through him") { drop_on("man.off", 1.8); }

TEST_CASE("A sheet dropped on a scanned armadillo never goes through it") { drop_on("armadillo.off", 1.0); }

TEST_CASE("A sheet dropped on a scanned bunny never goes through it") { drop_on("bunny00.off", 0.5); }

}  // namespace
}  // namespace percale::scenes::body_scans_test
