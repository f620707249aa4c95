#include <algorithm>

#include "collision/detector.h"
#include "tests/support/catch.h"
#include "tests/support/collision/scenes.h"
#include "tests/support/random.h"

namespace percale::test::detector_start_test {

TEST_CASE("a start is checked: clean, through, inside and touching are distinguished") {
    Random random(440);
    Steps steps = make_steps(Scene::two, small_sheet(), backends().back());
    const auto fault_at = [&](const Vec3& by) { return steps.detector->check_start(shifted(steps.cloth, by, 0.0, random)); };

    const StartFault clean = fault_at({0.0, 0.5, 0.0});
    CHECK_FALSE(clean.any());
    CHECK(clean.obstacle == -1);
    CHECK_FALSE(fault_at({0.0, 0.2001, 0.0}).any());

    const StartFault through = fault_at({0.0, 0.1, 0.0});  // the box is 0.4 high
    CHECK(through.any());
    CHECK(through.obstacle == 0);
    CHECK(through.intersecting_pairs > 0);
    CHECK(through.vertices_inside == 1);
    CHECK(through.inside_vertex == 12);
    CHECK(through.inside_vertices == std::vector<int>{12});
    const TriangleMesh box = steps.obstacles[0].mesh;
    REQUIRE(through.cloth_triangle >= 0);
    REQUIRE(through.obstacle_triangle >= 0);
    REQUIRE(through.obstacle_triangle < 12);

    const StartFault second = fault_at({0.45, 0.05, 0.0});
    CHECK(second.obstacle == 1);
    CHECK(second.intersecting_pairs > 0);

    // The sheet's border lies on the box's side.
    Steps beside{.cloth = make_grid(0.5, 0.5, 5, 5),
                 .obstacles = {{.mesh = make_box({0.5, 0.5, 0.5}), .start = {}, .end = {}}},
                 .detector = nullptr};
    beside.start(backends().back().make_detector(), sheet_thickness);
    const StartFault touching = beside.detector->check_start(shifted(beside.cloth, {0.5, 0.0, 0.0}, 0.0, random));
    CHECK(touching.any());
    CHECK(touching.obstacle == 0);
    CHECK(touching.intersecting_pairs == 0);
    CHECK(touching.vertices_inside == 0);

    Steps inner{.cloth = make_grid(0.05, 0.05, 3, 3),
                .obstacles = {{.mesh = make_box({1, 1, 1}), .start = {}, .end = {}}},
                .detector = nullptr};
    inner.start(backends().back().make_detector(), sheet_thickness);
    const StartFault inside = inner.detector->check_start(inner.cloth.vertices);
    CHECK(inside.any());
    CHECK(inside.intersecting_pairs == 0);
    CHECK(inside.vertices_inside == 9);
    CHECK(inside.inside_vertices == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8});
    CHECK(inside.inside_vertex >= 0);
    CHECK(inside.obstacle == 0);
}

TEST_CASE("a start is checked where the obstacle is at the start of the step, not where it was built") {
    Steps steps = make_steps(Scene::ball, small_sheet(), backends().back());
    steps.obstacles[0].start.translation = Vec3(0, -3, 0);
    steps.obstacles[0].end.translation = Vec3(0, 0, 0);
    steps.report_poses();
    CHECK_FALSE(steps.detector->check_start(steps.cloth.vertices).any());
    std::swap(steps.obstacles[0].start, steps.obstacles[0].end);
    steps.report_poses();
    CHECK(steps.detector->check_start(steps.cloth.vertices).any());
}

TEST_CASE("obstacles are numbered in order, and one without any area is refused") {
    const auto detector = make_detector(make_brute_force_tree);
    const TriangleMesh cloth = small_sheet();
    detector->set_cloth(cloth.triangles, std::vector<double>(25, sheet_thickness));
    CHECK(detector->add_obstacle(make_box({1, 1, 1}), {}, 0.2) == 0);
    CHECK(detector->add_obstacle(make_sphere(1, 1), {}, 0.2) == 1);
    CHECK_THROWS(detector->add_obstacle({.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .triangles = {{0, 1, 2}}}, {}, 0.2));
    CHECK(detector->add_obstacle(make_sphere(1, 1), {}, 0.2) == 2);
}

TEST_CASE("without obstacles there is no contact, no clamp and no fault") {
    const auto detector = make_detector(make_brute_force_tree);
    const TriangleMesh cloth = small_sheet();
    detector->set_cloth(cloth.triangles, std::vector<double>(25, sheet_thickness));
    ContactConstraints constraints;
    detector->update_candidates(cloth.vertices, cloth.vertices);
    detector->find_contacts(cloth.vertices, 0.0, constraints);
    CHECK(constraints.size() == 0);
    CHECK(detector->smallest_distance() == infinity);
    CHECK(detector->collision_free_step_size(cloth.vertices, cloth.vertices, {}) == 1.0);
    CHECK_FALSE(detector->check_start(cloth.vertices).any());
}

TEST_CASE("every backend untangles to the same bits, from where the obstacle is at the start of the step") {
    std::vector<std::vector<Vec3>> results;
    for (const Backend& backend : backends()) {
        Steps steps = make_steps(Scene::ball, small_sheet(), backend);
        steps.obstacles[0].start.translation = Vec3(0, 0.1, 0);
        steps.obstacles[0].end.translation = Vec3(0, 7, 0);
        steps.report_poses();
        REQUIRE(steps.detector->check_start(steps.cloth.vertices).any());
        const auto out = steps.detector->untangle(steps.cloth.vertices, std::vector<double>(25, 1.0));
        REQUIRE(out);
        CHECK_FALSE(steps.detector->check_start(out->positions).any());
        CHECK_FALSE(steps.detector->untangle(steps.cloth.vertices, std::vector<double>(25, 0.0)));
        results.push_back(out->positions);
    }
    for (const std::vector<Vec3>& result : results) CHECK(result == results[0]);
}

TEST_CASE("untangling that is cancelled finds no result, until the request is withdrawn") {
    std::atomic<bool> cancel = false;
    Steps steps = make_steps(Scene::ball, small_sheet(), backends()[0]);
    steps.obstacles[0].start.translation = Vec3(0, 0.1, 0);
    steps.report_poses();
    steps.detector->set_cancel(&cancel);
    // Two sheets at right angles, through each other.
    const TriangleMesh sheet = make_grid(0.3, 0.3, 6, 6);
    const TriangleMesh crossed =
        joined(sheet, placed(sheet, {.translation = {0.01, 0.11, 0.0}, .rotation = {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}}));
    std::vector<int> cloth(crossed.vertices.size(), 0);
    const std::vector<double> thickness(cloth.size(), 1e-3), free(cloth.size(), 1.0);
    const auto sheets = backends()[0].make_detector();
    sheets->set_cloth(crossed.triangles, thickness);
    sheets->set_self_contact({.cloth = cloth, .rest = crossed.vertices, .friction = thickness});
    sheets->set_cancel(&cancel);
    REQUIRE(sheets->check_start(crossed.vertices).any());
    for (const bool cancelled : {true, false}) {
        cancel = cancelled;
        CHECK(steps.detector->untangle(steps.cloth.vertices, std::vector<double>(25, 1.0)).has_value() != cancelled);
        CHECK(sheets->untangle_cloth(crossed.vertices, free).has_value() != cancelled);
    }
}

}  // namespace percale::test::detector_start_test
