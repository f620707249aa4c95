#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "collision/obstacle/obstacle_tree.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"

// Laws that every tree must satisfy.
namespace percale::test {

inline std::vector<Box> boxes_of(const TriangleMesh& mesh) {
    std::vector<Box> boxes;
    for (const Triangle& t : mesh.triangles) {
        Box& box = boxes.emplace_back();
        for (const int vertex : t) box.add(mesh.vertices[vertex]);
    }
    return boxes;
}

/// Boxes of all sizes in and around a mesh of size 1, points and flat ones included.
inline std::vector<Box> asked_boxes(int count, unsigned seed) {
    Random random(seed);
    std::vector<Box> boxes(count);
    for (int i = 0; i < count; ++i) {
        const Vec3 centre = random.point(i % 4 == 0 ? 1.2 : 0.6);
        boxes[i].add(centre);
        if (i % 5 != 0) boxes[i].add(centre + random.point(random.decades(1e-2, 1.5)));
        if (i % 11 == 0) boxes[i].add(-centre);
        if (i % 7 == 0) boxes[i].high.y() = boxes[i].low.y();
    }
    return boxes;
}

/// One list of a batch, filtered and sorted as Obstacle does.
inline std::vector<int> filtered(const IdLists& found, int i, const Box& asked, std::span<const Box> triangle_boxes) {
    std::vector<int> ids;
    for (int k = found.start[i]; k < found.start[i + 1]; ++k) {
        if (triangle_boxes[found.ids[k]].overlaps(asked)) ids.push_back(found.ids[k]);
    }
    std::sort(ids.begin(), ids.end());
    return ids;
}

/// Queries a tree over `mesh` and compares with a plain scan of all boxes. Returns how many triangles were found.
inline long check_tree(TreeFactory make_tree, const TriangleMesh& mesh, std::span<const Box> asked) {
    const std::vector<Box> boxes = boxes_of(mesh);
    const auto tree = make_tree(mesh.vertices, mesh.triangles);
    IdLists found;
    found.ids = {7, 7, 7};  // earlier contents must not matter
    found.start = {0, 3};
    tree->find(asked, found);
    REQUIRE(found.start.size() == asked.size() + 1);
    REQUIRE(found.start.front() == 0);
    REQUIRE(found.start.back() == static_cast<int>(found.ids.size()));
    long total = 0, wrong = 0;
    for (int i = 0; i < static_cast<int>(asked.size()); ++i) {
        std::vector<int> expected;
        for (int k = 0; k < static_cast<int>(boxes.size()); ++k) {
            if (boxes[k].overlaps(asked[i])) expected.push_back(k);
        }
        wrong += filtered(found, i, asked[i], boxes) != expected ? 1 : 0;
        total += static_cast<long>(expected.size());
    }
    CHECK(wrong == 0);
    return total;
}

/// The laws common to all backends; the caller adds those of its own.
inline void check_tree_laws(TreeFactory make_tree) {
    const std::vector<Box> asked = asked_boxes(400, 3);
    CHECK(check_tree(make_tree, make_sphere(0.7, 3), asked) > 1000);
    CHECK(check_tree(make_tree, make_box({1.0, 1.2, 0.8}), asked) > 100);
    CHECK(check_tree(make_tree, soup(1500, 8), asked) > 1000);
    CHECK(check_tree(make_tree, moved(soup(300, 9), {1000.0, -500.0, 0.0}), asked) == 0);
    CHECK(check_tree(make_tree, make_plane(0.9), asked) > 50);
    CHECK(check_tree(make_tree, soup(1, 4), asked) > 0);

    const TriangleMesh ball = make_sphere(0.5, 2);
    Box away, all, corner;
    away.add({0.6, 0.6, 0.6});
    corner.add(ball.vertices[17]);
    all.add({-1e6, -1e6, -1e6});
    all.add({1e6, 1e6, 1e6});
    CHECK(check_tree(make_tree, ball, std::vector<Box>{away}) == 0);
    CHECK(check_tree(make_tree, ball, std::vector<Box>{}) == 0);
    CHECK(check_tree(make_tree, ball, std::vector<Box>{all, away, all}) == 2 * 320);
    CHECK(check_tree(make_tree, ball, std::vector<Box>{corner}) >= 5);
}

/// Trees over triangles whose centres no split separates.
inline void check_degenerate_trees(TreeFactory make_tree) {
    Random random(21);
    TriangleMesh same_centre, same_place, lopsided, halving;
    for (int i = 0; i < 5000; ++i) {
        const double turn = random.number(0.0, 6.0), size = random.decades(1e-6, 0.5);
        const auto add = [&](TriangleMesh& mesh, const Vec3& centre, double radius) {
            const int first = static_cast<int>(mesh.vertices.size());
            for (int k = 0; k < 3; ++k) {
                const double angle = turn + k * 2.0943951023931953;
                mesh.vertices.push_back(centre + radius * Vec3(std::cos(angle), std::sin(angle), 0.0));
            }
            mesh.triangles.push_back({first, first + 1, first + 2});
        };
        add(same_centre, Vec3::Zero(), size);
        add(same_place, Vec3::Zero(), 0.25);
        add(lopsided, i % 100 == 0 ? Vec3(std::ldexp(1.0, -i / 100), 0.0, 0.0) : Vec3(Vec3::Zero()), 0.01);
        add(halving, Vec3(std::ldexp(1.0, -i / 5), std::ldexp(1.0, -(i % 100)), 0.0), 1e-3);
    }
    const std::vector<Box> asked = asked_boxes(60, 5);
    for (const TriangleMesh* mesh : {&same_centre, &same_place, &lopsided, &halving})
        CHECK(check_tree(make_tree, *mesh, asked) > 0);
}

}  // namespace percale::test
