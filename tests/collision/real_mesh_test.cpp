#include <cmath>

#include "collision/detector.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/off.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/collision/steps.h"
#include "tests/support/random.h"
#include "tests/support/skip.h"

namespace percale::test::real_mesh_test {
namespace {

constexpr double thickness = 0.01;

/// The scan, centred, its longest side 1 m.
TriangleMesh scaled(TriangleMesh mesh) {
    Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
    for (const Vec3& x : mesh.vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    for (Vec3& x : mesh.vertices) x = (x - 0.5 * (low + high)) / (high - low).maxCoeff();
    return mesh;
}

/// A sheet bent to a part of a cylinder about the scan.
TriangleMesh bent_sheet(double radius) {
    TriangleMesh sheet = make_grid(1.0, 1.0, 33, 33);
    for (Vec3& x : sheet.vertices) x = {radius * std::sin(x.x() / radius), radius * std::cos(x.x() / radius), x.z()};
    return sheet;
}

/// The sheet, turned somehow, pushed in along a random direction as far as it goes in steps of 5 cm without touching.
TriangleMesh pushed_in(const Steps& steps, Random& random, Vec3& way) {
    way = random.unit();
    TriangleMesh sheet = moved(placed(steps.cloth, random.pose(0.0)), 1.5 * way);
    for (int k = 0; k < 40; ++k) {
        const TriangleMesh next = moved(sheet, -0.05 * way);
        if (!steps.clean(next.vertices, 0.0)) break;
        sheet = next;
    }
    return sheet;
}

}  // namespace

TEST_CASE("around a body scan all backends give the same contacts and clamps, and clamped moves stay clear of it") {
    const auto scan = read_off(real_mesh_folder() / "bunny00.off");
    if (!scan) {
        skip("no bunny00.off in " + real_mesh_folder().string() + " (PERCALE_REAL_MESHES)");
        return;
    }
    Random random(500);
    std::vector<Steps> all;
    const TriangleMesh sheet = bent_sheet(0.35);
    for (const Backend& backend : backends()) {
        all.push_back({.cloth = sheet, .obstacles = {{.mesh = scaled(*scan), .start = {}, .end = {}}}, .detector = nullptr});
        all.back().start(backend.make_detector(), thickness);
    }
    int with_constraints = 0, cut = 0, differing = 0, bad = 0;
    for (int state = 0; state < 6; ++state) {
        const Pose start = random.pose(0.05);
        Pose end = start;
        if (state % 2 == 1) end.translation += random.point(0.02);
        for (Steps& steps : all) {
            steps.obstacles[0].start = start;
            steps.obstacles[0].end = end;
            steps.report_poses();
        }
        Vec3 way;
        const TriangleMesh sheet_before = pushed_in(all[0], random, way);
        const std::vector<Vec3> from = sheet_before.vertices, to = moved(sheet_before, -0.05 * way).vertices;
        std::vector<ContactConstraints> constraints(all.size());
        std::vector<double> cuts;
        for (std::size_t b = 0; b < all.size(); ++b) {
            all[b].detector->update_candidates(from, to);
            const double safe = all[b].detector->collision_free_step_size(from, to, {0.0, 1.0});
            std::vector<Vec3> x = between(from, to, safe);
            // On from there, so that the sheet comes within the thickness.
            const double further = all[b].detector->collision_free_step_size(x, to, {safe, 1.0});
            const double fraction = safe + further * (1.0 - safe);
            x = between(x, to, further);
            all[b].detector->find_contacts(x, fraction, constraints[b]);
            cuts.push_back(fraction);
            if (b == 0) bad += all[b].clean(x, fraction) ? 0 : 1;
        }
        with_constraints += constraints[0].size() > 0 ? 1 : 0;
        cut += cuts[0] < 1.0 ? 1 : 0;
        for (std::size_t b = 1; b < all.size(); ++b)
            differing += same_constraints(constraints[b], constraints[0]) && cuts[b] == cuts[0] ? 0 : 1;
    }
    CHECK(differing == 0);
    CHECK(bad == 0);
    CHECK(cut > 0);
    CHECK(with_constraints > 0);
}

}  // namespace percale::test::real_mesh_test
