#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "collision/detector.h"
#include "scenes/meshes/mesh_import.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/collision/steps.h"
#include "tests/support/random.h"
#include "tests/support/real_meshes.h"
#include "tests/support/skip.h"

// Whatever the tree: the same contacts, clamps and distances, to the last bit.
namespace percale::test::backends_test {
namespace {

TriangleMesh random_obstacle(Random& random) {
    const double size = random.number(0.1, 0.3);
    const auto seed = static_cast<unsigned>(random.index(1000));
    switch (random.index(7)) {
        case 0:
            return make_sphere(size, 2);
        case 1:
            return make_box({size, 0.2, 0.3});
        case 2:
            return spiky_ball(size, 2, 0.5, seed);
        case 3:
            return soup(20, seed);
        case 4:
            return make_plane(2.0 * size);
        case 5:
            return make_capsule(0.5 * size, size, 12);
        default:
            return crumpled_sheet(3.0 * size, 8, 0.05, random);
    }
}

struct Differences {
    int states = 0, with_constraints = 0, cut = 0, differing = 0;
    long constraints = 0;
};

/// The cloth goes from `from` to `to` with the obstacles at `fraction` and further; every backend is asked the same.
void compare(std::vector<Steps>& all, const std::vector<Vec3>& from, const std::vector<Vec3>& to, double fraction,
             Differences& found) {
    std::optional<ContactConstraints> first;
    double first_cut = 0.0, first_distance = 0.0;
    for (Steps& steps : all) {
        ContactConstraints constraints;
        steps.detector->update_candidates(from, to);
        steps.detector->find_contacts(from, fraction, constraints);
        const double distance = steps.detector->smallest_distance();
        const double cut = steps.detector->collision_free_step_size(from, to, {fraction, 1.0});
        if (first) {
            found.differing += same_constraints(constraints, *first) && cut == first_cut && distance == first_distance ? 0 : 1;
            continue;
        }
        first = constraints;
        first_cut = cut;
        first_distance = distance;
    }
    ++found.states;
    found.constraints += static_cast<long>(first->size());
    found.with_constraints += first->size() > 0 ? 1 : 0;
    found.cut += first_cut < 1.0 ? 1 : 0;
}

std::vector<Steps> steps_of(const TriangleMesh& cloth, const std::vector<MovingMesh>& obstacles, double thickness) {
    std::vector<Steps> all;
    for (const Backend& backend : backends()) {
        all.push_back({.cloth = cloth, .obstacles = obstacles, .detector = nullptr});
        all.back().start(backend.make_detector(), thickness);
    }
    return all;
}

/// The pose stays every second time; else it moves by some centimetres and turns.
Pose later(const Pose& pose, Random& random) {
    if (random.index(2) == 0) return pose;
    Pose next = pose;
    next.translation += random.point(0.05);
    next.rotation = random.rotation();
    return next;
}

TEST_CASE("FCL, Bullet and brute force give the same contacts in 500 random states") {
    Random random(910);
    Differences found;
    for (int state = 0; state < 500; ++state) {
        std::vector<MovingMesh> obstacles;
        for (int k = random.index(3); k >= 0; --k) {
            const TriangleMesh mesh = random_obstacle(random);
            const Pose start = random.pose(0.2);
            obstacles.push_back({.mesh = mesh, .start = start, .end = later(start, random)});
        }
        const int count = 3 + random.index(8);
        const double size = random.number(0.1, 0.8), thickness = random.decades(0.002, 0.05);
        const TriangleMesh cloth = placed(crumpled_sheet(size, count, 0.1 * size / count, random), random.pose(0.2));
        std::vector<Steps> all = steps_of(cloth, obstacles, thickness);
        const Vec3 way = random.point(0.1);
        TriangleMesh moved_cloth = moved(cloth, way);
        for (Vec3& x : moved_cloth.vertices) x += random.point(0.02);
        compare(all, cloth.vertices, moved_cloth.vertices, random.number(0.0, 1.0), found);
    }
    std::printf("500 random states: %ld rows in %d states, %d moves cut\n", found.constraints, found.with_constraints, found.cut);
    CHECK(found.differing == 0);
    CHECK(found.states == 500);
    CHECK(found.with_constraints > 250);
    CHECK(found.cut > 250);
}

TEST_CASE("FCL, Bullet and brute force give the same contacts on body scans") {
    const std::string name = GENERATE("bunny00.off", "man.off", "armadillo.off", "refined_elephant.off", "fandisk.off");
    const std::filesystem::path file = real_mesh_folder() / name;
    if (!std::filesystem::exists(file)) {
        skip("no " + file.string() + "; .ci/fetch_meshes.sh fetches it");
        return;
    }
    const TriangleMesh body = unit_size(scenes::import_mesh(file.string()));
    Random random(920);
    Differences found;
    const TriangleMesh sheet = make_grid(0.6, 0.6, 17, 17);
    std::vector<Steps> all = steps_of(sheet, {{.mesh = body, .start = {}, .end = {}}}, 0.01);
    for (int state = 0; state < 20; ++state) {
        const Pose start = random.pose(0.05);
        Pose end = start;
        if (state % 2 == 1) end.translation += random.point(0.01);
        for (Steps& steps : all) {
            steps.obstacles[0].start = start;
            steps.obstacles[0].end = end;
            steps.report_poses();
        }
        const TriangleMesh cloth = placed(sheet, random.pose(0.3));
        const Vec3 way = random.point(0.02);
        compare(all, cloth.vertices, moved(cloth, way).vertices, random.number(0.0, 1.0), found);
    }
    std::printf("%s: %ld rows in %d of %d states, %d moves cut\n", name.c_str(), found.constraints, found.with_constraints,
                found.states, found.cut);
    CHECK(found.differing == 0);
    CHECK(found.with_constraints > 5);
    CHECK(found.cut > 5);
}

}  // namespace
}  // namespace percale::test::backends_test
