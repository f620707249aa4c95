#include "collision/obstacle/obstacle.h"

#include <algorithm>

#include "percale/certify.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/collision/trees.h"
#include "tests/support/random.h"

namespace percale::test::obstacle_test {
namespace {

/// The patch whose packs a triangle is in.
int patch_of(const Obstacle& obstacle, std::size_t triangle) {
    return obstacle.packs().patch_of_pack[obstacle.packs().place_of[0][triangle] / pack_lanes];
}

std::vector<std::vector<int>> lists(Obstacle& obstacle, std::span<const Box> asked) {
    IdLists found;
    obstacle.find(asked, found);
    REQUIRE(found.start.size() == asked.size() + 1);
    std::vector<std::vector<int>> result;
    for (std::size_t i = 0; i < asked.size(); ++i) {
        result.emplace_back(found.ids.begin() + found.start[i], found.ids.begin() + found.start[i + 1]);
    }
    return result;
}

/// Points of triangles, at times during the step, that lie in a queried box whose list lacks the triangle's patch.
long missing(const Obstacle& obstacle, std::span<const Box> asked, const std::vector<std::vector<int>>& found) {
    Random random(77);
    long count = 0;
    for (int t = 0; t < int(obstacle.surface().triangles.size()); ++t) {
        const auto [a, b, c] = obstacle.surface().triangles[t];
        for (int sample = 0; sample < 12; ++sample) {
            const double fraction = 0.25 * (sample % 5), u = random.number(0.0, 1.0), v = random.number(0.0, 1.0 - u);
            const Vec3 x = (1 - u - v) * obstacle.at(a, fraction) + u * obstacle.at(b, fraction) + v * obstacle.at(c, fraction);
            for (std::size_t i = 0; i < asked.size(); ++i) {
                const int patch = patch_of(obstacle, t);
                count += asked[i].contains(x) && !std::binary_search(found[i].begin(), found[i].end(), patch) ? 1 : 0;
            }
        }
    }
    return count;
}

long all_ids(const std::vector<std::vector<int>>& lists) {
    long total = 0;
    for (const auto& list : lists) total += static_cast<long>(list.size());
    return total;
}

TriangleMesh mesh_number(int i) {
    switch (i) {
        case 0:
            return make_sphere(0.5, 2);
        case 1:
            return make_box({1.0, 0.6, 0.8});
        case 2:
            return spiky_ball(0.5, 2, 0.4, 5);
        case 3:
            return soup(300, 6);
        default:
            return make_plane(0.7);
    }
}

Obstacle make(const TriangleMesh& mesh, const Pose& pose) { return {mesh, pose, 0.3, make_brute_force_tree}; }

}  // namespace

TEST_CASE("every backend gives the same patches, none missing, at rest, turned away and on the move") {
    const TriangleMesh mesh = mesh_number(GENERATE(0, 1, 2, 3, 4));
    Random random(30);
    const Pose built = random.pose(0.3);
    std::vector<Obstacle> obstacles;
    for (const Backend& backend : backends()) obstacles.emplace_back(mesh, built, 0.3, backend.make_tree);
    const std::vector<Box> asked = asked_boxes(120, 31);
    for (int round = 0; round < 20; ++round) {
        const Pose start = round == 0 ? built : random.pose(0.5);
        Pose end = start;
        if (round % 3 == 1) end.translation += random.point(random.decades(1e-4, 1.0));
        if (round % 3 == 2) end = random.pose(0.5);
        std::vector<std::vector<int>> first;
        for (Obstacle& obstacle : obstacles) {
            if (round > 0) obstacle.move(start, end);
            const auto found = lists(obstacle, asked);
            if (first.empty()) first = found;
            CHECK(found == first);
        }
        CHECK(missing(obstacles[0], asked, first) == 0);
        CHECK(all_ids(first) > 0);
        for (const auto& ids : first) CHECK(std::is_sorted(ids.begin(), ids.end()));
    }
}

TEST_CASE("every backend gives the same patches of an obstacle that changes its shape, none missing") {
    const TriangleMesh mesh = mesh_number(GENERATE(0, 1, 2, 3, 4));
    Random random(37);
    std::vector<Obstacle> obstacles;
    for (const Backend& backend : backends())
        obstacles.emplace_back(mesh, Pose{}, 0.3, backend.make_tree, SurfaceShape::deforming);
    const std::vector<Box> asked = asked_boxes(120, 38);
    std::vector<Vec3> shape = mesh.vertices;
    for (int round = 0; round < 20; ++round) {
        const std::vector<Vec3> start = shape;
        const double size = random.decades(1e-3, 0.5);
        for (Vec3& x : shape) x += random.point(size);
        const Pose start_pose = random.pose(0.2), end_pose = round % 2 == 0 ? start_pose : random.pose(0.2);
        std::vector<std::vector<int>> first;
        for (Obstacle& obstacle : obstacles) {
            obstacle.deform(start, shape);
            obstacle.move(start_pose, end_pose);
            const auto found = lists(obstacle, asked);
            if (first.empty()) first = found;
            CHECK(found == first);
        }
        CHECK(missing(obstacles[0], asked, first) == 0);
        CHECK(all_ids(first) > 0);
        const int v = random.index(static_cast<int>(obstacles[0].surface().vertices.size()));
        const int given = obstacles[0].surface().given[v];
        CHECK(obstacles[0].at(v, 0.0) == transform(start_pose, start[given]));
        CHECK((obstacles[0].at(v, 1.0) - transform(end_pose, shape[given])).norm() < 1e-14);
    }
}

TEST_CASE("at rest where it was built an obstacle gives exactly the patches whose boxes overlap") {
    const Pose pose = Random(32).pose(0.2);
    Obstacle obstacle = make(make_sphere(0.5, 2), pose);
    const std::vector<Box> asked = asked_boxes(200, 33);
    const auto found = lists(obstacle, asked);
    for (std::size_t i = 0; i < asked.size(); ++i) {
        std::vector<int> expected;
        for (int patch = 0; patch < 20; ++patch) {
            if (obstacle.packs().box[patch].overlaps(asked[i])) expected.push_back(patch);
        }
        CHECK(found[i] == expected);
    }
}

TEST_CASE("a turned obstacle is queried with a box not much larger than needed") {
    Random random(34);
    Obstacle obstacle = make(make_sphere(0.5, 4), {});
    const Pose still = random.pose(0.3);
    obstacle.move(still, still);
    const std::vector<Box> asked = asked_boxes(300, 35);
    const auto found = lists(obstacle, asked);
    long needed = 0;
    for (const Box& box : asked) {
        for (const Box& patch : obstacle.packs().box) needed += patch.overlaps(box) ? 1 : 0;
    }
    CHECK(missing(obstacle, asked, found) == 0);
    CHECK(all_ids(found) < 6 * needed);
}

TEST_CASE("within a step every vertex runs straight from its place at the start to its place at the end") {
    Random random(36);
    const TriangleMesh mesh = make_box({1, 2, 3});
    const Pose built{.translation = random.point(1.0), .rotation = random.rotation(), .scale = 1.7};
    Obstacle obstacle = make(mesh, built);
    Pose start = random.pose(1.0), end = random.pose(1.0);
    start.scale = end.scale = 1.7;
    obstacle.move(start, end);
    CHECK(obstacle.moves());
    double longest = 0.0;
    for (int v = 0; v < 8; ++v) {
        const Vec3 from = transform(start, mesh.vertices[v]), to = transform(end, mesh.vertices[v]);
        CHECK(obstacle.at(v, 0.0) == from);
        CHECK((obstacle.at(v, 1.0) - to).norm() < 1e-14);
        CHECK((obstacle.at(v, 0.3) - (0.7 * from + 0.3 * to)).norm() < 1e-14);
        CHECK(obstacle.displacement(v) == to - from);
        longest = std::max(longest, (to - from).norm());
    }
    CHECK(obstacle.largest_displacement() == longest);
    for (int t = 0; t < 12; ++t) {
        Box inside = obstacle.packs().box[patch_of(obstacle, t)];
        inside.grow(1e-12);
        for (const double fraction : {0.0, 0.25, 0.5, 1.0}) {
            for (const int v : obstacle.surface().triangles[t]) CHECK(inside.contains(obstacle.at(v, fraction)));
        }
    }
}

TEST_CASE("at rest nothing is displaced, and a pose that stays costs no new version") {
    Random random(37);
    const Pose pose = random.pose(1.0), other = random.pose(1.0);
    Obstacle obstacle = make(make_box({1, 1, 1}), pose);
    const int version = obstacle.version();
    obstacle.move(pose, pose);
    CHECK(obstacle.version() == version);
    CHECK_FALSE(obstacle.moves());
    CHECK(obstacle.largest_displacement() == 0.0);
    CHECK(obstacle.displacement(3) == Vec3(Vec3::Zero()));
    CHECK(obstacle.at(2, 0.7) == transform(pose, make_box({1, 1, 1}).vertices[2]));

    obstacle.move(pose, other);
    CHECK(obstacle.version() > version);
    CHECK(obstacle.largest_displacement() > 0.0);
    const int moving = obstacle.version();
    obstacle.move(other, other);  // arrived: rests, at another place
    CHECK(obstacle.version() > moving);
    CHECK(obstacle.largest_displacement() == 0.0);
    CHECK_FALSE(obstacle.moves());
    CHECK(obstacle.at(2, 0.5) == transform(other, make_box({1, 1, 1}).vertices[2]));
    const int arrived = obstacle.version();
    obstacle.move(other, other);
    CHECK(obstacle.version() == arrived);
}

TEST_CASE("the given mesh is kept with what cleaning drops, at the start of the step") {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.vertices.emplace_back(5, 5, 5);
    mesh.triangles.push_back({0, 0, 1});
    Random random(38);
    Obstacle obstacle = make(mesh, random.pose(1.0));
    const Pose start = random.pose(1.0);
    obstacle.move(start, random.pose(1.0));
    CHECK(obstacle.surface().triangles.size() == 12);
    CHECK(obstacle.start_mesh().triangles == mesh.triangles);
    CHECK(obstacle.start_mesh().vertices == transform(start, mesh.vertices));
    CHECK(obstacle.friction() == 0.3);
}

TEST_CASE("cloth inside a body that is closed but for repeated vertices or triangles does not start clear") {
    const TriangleMesh ball = make_sphere(0.3, 2);
    TriangleMesh loose;  // every triangle has corners of its own, as files without shared vertices have
    for (const Triangle& t : ball.triangles) {
        const int first = static_cast<int>(loose.vertices.size());
        for (const int v : t) loose.vertices.push_back(ball.vertices[v]);
        loose.triangles.push_back({first, first + 1, first + 2});
    }
    const TriangleMesh sheet = make_grid(0.1, 0.1, 3, 3), far = moved(sheet, {1.0, 0.0, 0.0}),
                       across = moved(sheet, {0.3, 0.013, 0.017});
    for (const TriangleMesh& mesh : {ball, loose, joined(ball, ball), joined(ball, inside_out(ball))}) {
        const Obstacle obstacle = make(mesh, {});
        const auto inside = obstacle.start_fault(sheet, 0);
        REQUIRE(inside.has_value());
        CHECK(inside->vertices_inside == 9);
        CHECK_FALSE(obstacle.start_fault(far, 0).has_value());
        const auto crossed = obstacle.start_fault(across, 0);
        REQUIRE(crossed.has_value());
        REQUIRE(crossed->obstacle_triangle >= 0);
        REQUIRE(crossed->obstacle_triangle < static_cast<int>(mesh.triangles.size()));
        CHECK(certify(across, {.vertices = mesh.vertices, .triangles = {mesh.triangles[crossed->obstacle_triangle]}}, 0.0)
                  .pairs.size() > 0);
    }
}

}  // namespace percale::test::obstacle_test
