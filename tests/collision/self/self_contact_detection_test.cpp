#include "collision/self/self_contact_detection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/geometry/triangle_distance.h"
#include "percale/workers.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/cloths.h"
#include "tests/support/collision/steps.h"

namespace percale::test::self_contact_detection_test {
namespace {

std::unique_ptr<ContactDetector> detector_for(const Cloths& cloths, const Backend& backend) {
    std::unique_ptr<ContactDetector> detector = backend.make_detector();
    detector->set_cloth(cloths.mesh.triangles, cloths.thickness);
    detector->set_self_contact(cloths.self_contact());
    return detector;
}

std::vector<Vec3> shaken(std::vector<Vec3> x, double by, Random& random) {
    for (Vec3& point : x) point += random.point(by);
    return x;
}

/// A sheet folded over along the middle of its columns, upper half `gap` above the lower.
std::vector<Vec3> folded(const TriangleMesh& sheet, double gap) {
    std::vector<Vec3> x = sheet.vertices;
    for (Vec3& point : x) {
        if (point.x() > 0.0) point = {-point.x() + 0.03, point.y() + gap, point.z() + 0.02};
    }
    return x;
}

/// Two to five sectors of a fan, all with its apex, some with an edge in common.
TriangleMesh random_fan(Random& random) {
    TriangleMesh fan{.vertices = {Vec3::Zero()}, .triangles = {}};
    const int sectors = 2 + random.index(4);
    for (int k = 0; k < sectors; ++k) {
        const int next = static_cast<int>(fan.vertices.size());
        const bool hinged = k > 0 && random.index(2) == 0;
        fan.vertices.push_back(random.point(1.0));
        if (!hinged) fan.vertices.push_back(random.point(1.0));
        fan.triangles.push_back({0, hinged ? next - 1 : next + 1, next});
    }
    return fan;
}

Cloths clear_fan(Random& random) {
    while (true) {
        Cloths cloths;
        cloths.add(random_fan(random), random.decades(1e-4, 1e-2));
        if (cloths.clean(cloths.mesh.vertices)) return cloths;
    }
}

ContactConstraints constraints_where_sewn(const Cloths& cloths, std::span<const Stitch> stitches) {
    SelfContact self = cloths.self_contact();
    self.stitches = stitches;
    const auto detector = backends()[0].make_detector();
    detector->set_cloth(cloths.mesh.triangles, cloths.thickness);
    detector->set_self_contact(self);
    detector->update_candidates(cloths.mesh.vertices, cloths.mesh.vertices);
    ContactConstraints constraints;
    detector->find_contacts(cloths.mesh.vertices, 0.0, constraints);
    return constraints;
}

}  // namespace

TEST_CASE("after a clamp no cloth crosses cloth, on thousands of random moves", "[slow]") {
    Random random(GENERATE(1U, 2U, 3U));
    const Cloths cloths = sheet_stack(3, 6, 0.1, random.decades(1e-3, 0.05), random);
    const auto detector = detector_for(cloths, backends()[0]);
    std::vector<Vec3> x = cloths.mesh.vertices;
    REQUIRE(cloths.clean(x));
    int clamps = 0;
    for (int move = 0; move < 400; ++move) {
        const Vec3 together = random.point(1.0);
        std::vector<Vec3> to = shaken(x, random.decades(1e-3, 1.0), random);
        for (Vec3& point : to) point += together;
        if (move % 4 == 0) detector->update_candidates(x, to);
        const double fraction = detector->collision_free_step_size(x, to, {0.0, 1.0});
        REQUIRE((fraction >= 0.0 && fraction <= 1.0));
        clamps += fraction < 1.0;
        REQUIRE(cloths.clean(between(x, to, 0.5 * fraction)));
        x = between(x, to, fraction);
        REQUIRE(cloths.clean(x));
        if (move % 20 == 19) x = cloths.mesh.vertices;
    }
    CHECK(clamps > 200);
    CHECK(clamps < 400);
}

TEST_CASE("triangles that share a vertex or an edge do not come to share more, on thousands of random moves", "[slow]") {
    Random random(GENERATE(1U, 2U, 3U));
    int would_cross = 0, clamps = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const Cloths cloths = clear_fan(random);
        const auto detector = detector_for(cloths, backends()[0]);
        std::vector<Vec3> x = cloths.mesh.vertices;
        for (int move = 0; move < 10; ++move) {
            const std::vector<Vec3> to = shaken(x, random.decades(1e-2, 2.0), random);
            detector->update_candidates(x, to);
            const double fraction = detector->collision_free_step_size(x, to, {0.0, 1.0});
            would_cross += cloths.clean(to) ? 0 : 1;
            clamps += fraction < 1.0;
            REQUIRE(cloths.clean(between(x, to, 0.5 * fraction)));
            x = between(x, to, fraction);
            REQUIRE(cloths.clean(x));
        }
    }
    CHECK(would_cross > 200);
    CHECK(clamps >= would_cross);
}

TEST_CASE("contact constraints between cloths satisfy the equation of their header") {
    Random random(GENERATE(1U, 2U));
    const double h = 0.05;
    Cloths cloths = sheet_stack(3, 8, 0.04, h, random);
    for (std::size_t i = 0; i < 64; ++i) cloths.thickness[i] = 0.02;
    const auto detector = detector_for(cloths, backends()[0]);
    const auto& x = cloths.mesh.vertices;
    ContactConstraints constraints;
    detector->update_candidates(x, x);
    detector->find_contacts(x, 0.3, constraints);
    REQUIRE(constraints.size() > 50);
    double least = 1e300;
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        Vec3 apart = -constraints.obstacle_point[i];
        double sum = 0.0;
        for (int k = 0; k < 4 && constraints.vertex[i][k] >= 0; ++k) {
            apart += constraints.weight[i][k] * x[constraints.vertex[i][k]];
            sum += constraints.weight[i][k];
        }
        CHECK(sum == Approx(0.0).margin(1e-14));
        CHECK((apart - constraints.distance[i] * constraints.direction[i]).norm() < 1e-12);
        CHECK(constraints.distance[i] < constraints.thickness[i]);
        CHECK(constraints.distance[i] > 0.0);
        CHECK(constraints.obstacle[i] == -1);
        CHECK(constraints.obstacle_displacement[i] == Vec3(Vec3::Zero()));
        // The last vertex that there is belongs to the second side.
        const auto last = std::ranges::find(constraints.vertex[i], -1) - 1;
        const int first = constraints.vertex[i][0], second = *last;
        CHECK(constraints.friction[i] == Approx(0.5 * (cloths.friction[first] + cloths.friction[second])));
        CHECK(constraints.thickness[i] <= 0.5 * (cloths.thickness[first] + cloths.thickness[second]) * (1 + 1e-12));
        least = std::min(least, constraints.distance[i]);
    }
    CHECK(detector->smallest_distance() == least);
}

TEST_CASE("every vertex of cloth that lies above a face of other cloth nearer than the thickness has a constraint") {
    Random random(GENERATE(3U, 4U, 5U));
    const double h = 0.05;
    const Cloths cloths = sheet_stack(2, 8, 0.04, h, random);
    const auto detector = detector_for(cloths, backends()[0]);
    const std::vector<Vec3> x = shaken(cloths.mesh.vertices, 0.004, random);
    ContactConstraints constraints;
    detector->find_contacts(x, 0.0, constraints);
    std::vector<double> nearest(x.size(), 1e300);
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        if (constraints.feature[i] == 1)
            nearest[constraints.vertex[i][0]] = std::min(nearest[constraints.vertex[i][0]], constraints.distance[i]);
    }
    int above = 0;
    const ClothSurface surface = make_cloth_surface(cloths.mesh.triangles, x.size());
    for (int v = 0; v < static_cast<int>(x.size()); ++v) {
        for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
            const Triangle& c = surface.triangles[t];
            if (cloths.cloth[v] == cloths.cloth[c[0]]) continue;
            const PointTriangle closest = closest_on_triangle(x[v], x[c[0]], x[c[1]], x[c[2]]);
            if (closest.region != TriangleRegion::face || closest.distance_squared >= h * h) continue;
            ++above;
            CHECK(nearest[v] <= std::sqrt(closest.distance_squared) * (1.0 + 1e-12));
        }
    }
    CHECK(above > 40);
}

TEST_CASE("a sheet folded onto itself is in contact with itself") {
    Cloths cloths;
    cloths.add(make_grid(1, 1, 21, 21), 0.02);
    const auto detector = detector_for(cloths, backends()[0]);
    const std::vector<Vec3> x = folded(cloths.mesh, 0.01);
    ContactConstraints constraints;
    detector->find_contacts(x, 0.0, constraints);
    CHECK(constraints.size() > 200);
    CHECK(detector->smallest_distance() == Approx(0.01).epsilon(0.1));
    std::vector<Vec3> through = x;
    for (std::size_t i = 0; i < through.size(); ++i) {
        if (cloths.mesh.vertices[i].x() > 0.1) through[i].y() -= 0.05;
    }
    const double fraction = detector->collision_free_step_size(x, through, {0.0, 1.0});
    CHECK(fraction < 0.2);
    CHECK(fraction > 0.05);
    CHECK(cloths.clean(between(x, through, fraction)));
}

TEST_CASE(
    "a flat sheet much finer than its thickness has no contact with itself, nor when it is stretched, squeezed or bent a "
    "little") {
    Cloths cloths;
    const TriangleMesh sheet = make_grid(0.1, 0.1, 29, 29);  // edges of 3.6 mm
    cloths.add(sheet, 0.02);
    const auto detector = detector_for(cloths, backends()[0]);
    ContactConstraints constraints;
    for (const double scale : {1.0, 1.5, 0.6}) {
        std::vector<Vec3> x = sheet.vertices;
        for (Vec3& point : x) point = {scale * point.x(), 0.5 * std::sin(20.0 * point.x()) / 20.0, point.z()};
        detector->find_contacts(x, 0.0, constraints);
        CHECK(constraints.size() == 0);
        CHECK(std::isinf(detector->smallest_distance()));
    }
}

TEST_CASE("cloth that moves as a whole or apart is not clamped, cloth that is not set to meet cloth passes through it") {
    Random random(7);
    const Cloths cloths = sheet_stack(3, 6, 0.1, 0.02, random);
    const auto detector = detector_for(cloths, backends()[0]);
    std::vector<Vec3> to = cloths.mesh.vertices;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += Vec3(3.0, 20.0 + 0.5 * cloths.cloth[i], -1.0);
    CHECK(detector->collision_free_step_size(cloths.mesh.vertices, to, {0.0, 1.0}) == 1.0);
    for (std::size_t i = 0; i < to.size(); ++i) to[i].y() -= 2.0 * cloths.cloth[i];
    CHECK(detector->collision_free_step_size(cloths.mesh.vertices, to, {0.0, 1.0}) < 0.2);
    detector->set_cloth(cloths.mesh.triangles, cloths.thickness);
    CHECK(detector->collision_free_step_size(cloths.mesh.vertices, to, {0.0, 1.0}) == 1.0);
    ContactConstraints constraints;
    detector->find_contacts(cloths.mesh.vertices, 0.0, constraints);
    CHECK(constraints.size() == 0);
}

TEST_CASE("threads change no bit of constraints, distances and clamps between cloths", "[slow]") {
    Random random(41);
    const Cloths cloths = sheet_stack(3, 25, 0.06, 0.03, random);
    const auto workers = make_workers(3);
    SelfContactDetection one(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    SelfContactDetection several(cloths.mesh.triangles, cloths.thickness, cloths.self_contact());
    std::vector<Vec3> x = cloths.mesh.vertices;
    int clamps = 0;
    std::size_t count = 0;
    for (int step = 0; step < 12; ++step) {
        const std::vector<Vec3> to = shaken(x, 0.03, random);
        one.update_candidates(x, to);
        several.update_candidates(x, to, workers.get());
        ContactConstraints constraints, same;
        CHECK(one.add_constraints(x, constraints) == several.add_constraints(x, same, workers.get()));
        CHECK(same_constraints(constraints, same));
        count += constraints.size();
        const double fraction = one.collision_free_step_size(x, to);
        CHECK(several.collision_free_step_size(x, to, workers.get()) == fraction);
        clamps += fraction < 1.0;
        x = between(x, to, fraction);
    }
    CHECK(clamps > 3);
    CHECK(count > 100);
}

TEST_CASE("all backends give the same constraints between cloths, behind those of obstacles, and the same clamps") {
    Random random(2);
    const Cloths cloths = sheet_stack(3, 7, 0.06, 0.05, random);
    const std::vector<Vec3> to = shaken(cloths.mesh.vertices, 0.2, random);
    const TriangleMesh ball = moved(make_sphere(0.3, 2), {0, -0.33, 0});
    ContactConstraints first;
    double clamp = -1.0;
    for (const Backend& backend : backends()) {
        const auto detector = detector_for(cloths, backend);
        detector->add_obstacle(ball, {}, 0.2);
        detector->update_candidates(cloths.mesh.vertices, to);
        const double fraction = detector->collision_free_step_size(cloths.mesh.vertices, to, {0.0, 1.0});
        ContactConstraints constraints;
        detector->find_contacts(between(cloths.mesh.vertices, to, fraction), fraction, constraints);
        REQUIRE(constraints.obstacle.front() == 0);
        REQUIRE(constraints.obstacle.back() == -1);
        CHECK(std::is_sorted(constraints.obstacle.rbegin(), constraints.obstacle.rend()));
        if (clamp < 0.0) {
            first = constraints;
            clamp = fraction;
        }
        CHECK(same_constraints(constraints, first));
        CHECK(fraction == clamp);
    }
}

TEST_CASE("contacts of edges begin with a depth linear in the angle between them, and only settle while they last") {
    const double h = 0.005;
    // The lower triangle hangs from its edge, the upper one stands on its edge, turned about a vertical axis.
    const auto at = [&](double degrees, double gap) {
        const double angle = degrees * std::numbers::pi / 180.0;
        const Vec3 along = 0.02 * Vec3(std::cos(angle), 0, std::sin(angle)), middle(0, gap, 0);
        return std::vector<Vec3>{{-0.02, 0, 0}, {0.02, 0, 0}, {0, -0.04, 0}, middle - along, middle + along, {0, 0.04 + gap, 0}};
    };
    Cloths cloths;
    const std::vector<Vec3> crossing = at(10.0, 0.8 * h);
    cloths.add({.vertices = {crossing.begin(), crossing.begin() + 3}, .triangles = {{0, 1, 2}}}, h);
    cloths.add({.vertices = {crossing.begin() + 3, crossing.end()}, .triangles = {{0, 1, 2}}}, h);
    // m, by how much two edges are nearer than where their contact begins.
    const auto depth_at = [&](ContactDetector& detector, const std::vector<Vec3>& x) {
        detector.update_candidates(x, x);
        ContactConstraints constraints;
        detector.find_contacts(x, 0.0, constraints);
        double depth = 0.0;
        for (std::size_t i = 0; i < constraints.size(); ++i) {
            if (constraints.feature[i] == 2) depth += constraints.thickness[i] - constraints.distance[i];
        }
        return depth;
    };
    const auto lasting = detector_for(cloths, backends()[0]);
    CHECK(depth_at(*lasting, at(10.0, 0.8 * h)) == Approx(0.2 * h));
    // While a step is solved a contact keeps its first activation distance.
    ContactConstraints constraints;
    lasting->find_contacts(at(2.5, 0.3 * h), 0.0, constraints);
    const auto first_of_edges = std::ranges::find(constraints.feature, 2) - constraints.feature.begin();
    REQUIRE(std::ranges::count(constraints.feature, 2) == 1);
    CHECK(constraints.thickness[first_of_edges] == Approx(h));  // at this angle it would begin with less than half of that
    CHECK(depth_at(*lasting, at(0.5, 0.2 * h)) == 0.0);         // nearly parallel edges have contacts at their ends
    double before = 0.0;
    for (double degrees = 0.5; degrees < 6.0; degrees += 0.02) {
        const std::vector<Vec3> x = at(degrees, 0.2 * h);
        const double now = depth_at(*detector_for(cloths, backends()[0]), x);
        CHECK(now >= before);
        CHECK(now - before < 0.025 * h);  // h in the 1.7 degrees between a sine of 0.03 and 0.06; each 0.012 h
        before = now;
    }
    CHECK(before == Approx(0.8 * h));
    // As the edges turn to and fro, a contact that lasts has the smallest depth with which a step began.
    double smallest = depth_at(*lasting, at(5.0, 0.2 * h));
    CHECK(smallest == Approx(0.8 * h));
    for (const double degrees : {3.0, 2.8, 3.5, 2.6, 6.0, 2.5, 10.0}) {
        const std::vector<Vec3> x = at(degrees, 0.2 * h);
        smallest = std::min(smallest, depth_at(*detector_for(cloths, backends()[0]), x));
        CHECK(depth_at(*lasting, x) == Approx(smallest));
    }
    CHECK(depth_at(*lasting, at(10.0, 1.2 * h)) == 0.0);
    CHECK(depth_at(*lasting, at(10.0, 0.2 * h)) == Approx(0.8 * h));
}

TEST_CASE("edges over a valley whose slopes are sewn to them are in contact once they are near") {
    // The slopes lie nearer to the upper edge than the valley's ground, but its ends are sewn to them.
    const auto constraints_at = [](double height, bool sewn) {
        Cloths cloths;
        cloths.add({.vertices = {{0, 0, -5}, {0, 0, 5}, {-0.2, 0.1, 0}, {0.2, 0.1, 0}}, .triangles = {{0, 2, 1}, {0, 1, 3}}},
                   0.6);
        cloths.add({.vertices = {{-0.2, height, 0}, {0.2, height, 0}, {0, height + 1.0, 0}}, .triangles = {{0, 1, 2}}}, 0.6);
        const std::vector<Stitch> stitches{{.vertex = 4, .from = 2, .to = 2}, {.vertex = 5, .from = 3, .to = 3}};
        const ContactConstraints constraints = constraints_where_sewn(cloths, sewn ? stitches : std::vector<Stitch>{});
        long of_edges = 0;
        for (std::size_t i = 0; i < constraints.size(); ++i) {
            if (constraints.feature[i] != 2) continue;
            ++of_edges;
            if (sewn) CHECK(constraints.distance[i] == Approx(height));
            if (sewn) CHECK(std::abs(constraints.direction[i].y()) == Approx(1.0));
        }
        return of_edges;
    };
    CHECK(constraints_at(0.03, true) == 1);
    CHECK(constraints_at(0.09, true) == 0);
    CHECK(constraints_at(0.03, false) > 1);
}

TEST_CASE("sides of a closed seam with other vertices are not in contact along it, one that folds over the other is") {
    // Of the lower panel 1 is the middle of a side, over the upper panel's edge from 5 to 6, which are sewn beside it.
    const auto constraints_at = [](bool sewn, double lift_of_fold) {
        Cloths cloths;
        const Vec3 up(0.0, 1e-3, 0.0), fold(0.0, lift_of_fold, lift_of_fold > 0.0 ? 1.3 : 0.0);
        cloths.add({.vertices = {up, Vec3(1, 0, 0) + up, Vec3(2, 0, 0) + up, Vec3(0.5, 0, -1) + fold, Vec3(1.5, 0, -1) + fold},
                    .triangles = {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}}},
                   0.4);
        cloths.add({.vertices = {{0.5, 0, 0}, {1.5, 0, 0}, {1, 0, 1}}, .triangles = {{0, 2, 1}}}, 0.4);
        const std::vector<Stitch> stitches{{5, 0, 1, 0.5}, {6, 1, 2, 0.5}};
        const ContactConstraints constraints = constraints_where_sewn(cloths, sewn ? stitches : std::vector<Stitch>{});
        return constraints.size();
    };
    CHECK(constraints_at(false, 0.0) > 0);
    CHECK(constraints_at(true, 0.0) == 0);
    CHECK(constraints_at(true, 0.05) > 0);
}

TEST_CASE("contacts that join while a step is solved are gone in the next") {
    // A vertex above a flat sheet, which then dips under it so that its closest point leaves the face.
    Random random(3);
    const Cloths cloths = sheet_stack(2, 6, 0.04, 0.05, random);
    const auto detector = detector_for(cloths, backends()[0]);
    const auto& x = cloths.mesh.vertices;
    ContactConstraints near, shifted, fresh;
    detector->update_candidates(x, x);
    detector->find_contacts(x, 0.0, near);
    std::vector<Vec3> aside = x;
    for (std::size_t i = 36; i < aside.size(); ++i) aside[i] += Vec3(0.02, 0.0, 0.015);
    detector->find_contacts(aside, 0.0, shifted);
    detector->update_candidates(aside, aside);
    detector->find_contacts(aside, 0.0, fresh);
    CHECK(shifted.size() > fresh.size());
}

TEST_CASE("a start where cloth crosses or touches cloth is reported with both triangles") {
    Cloths cloths;
    cloths.add(make_grid(1, 1, 3, 3), 0.01, false);
    cloths.add(moved(make_grid(1, 1, 3, 3), {0, 0.1, 0}), 0.01);
    cloths.add(moved(make_grid(1, 1, 3, 3), {0, 0.2, 0}), 0.01);
    const auto detector = detector_for(cloths, backends()[0]);
    std::vector<Vec3> x = cloths.mesh.vertices;
    CHECK_FALSE(detector->check_start(x).any());
    x[4].y() = 5.0;  // through both, but this cloth meets none
    CHECK_FALSE(detector->check_start(x).any());
    x[9 + 4] += Vec3(0.01, 0.2, 0.013);
    const StartFault fault = detector->check_start(x);
    REQUIRE(fault.between_cloths());
    CHECK(fault.obstacle == -1);
    CHECK(fault.intersecting_pairs > 0);
    CHECK((fault.cloth_triangle >= 8 && fault.cloth_triangle < 16));
    CHECK((fault.other_cloth_triangle >= 16 && fault.other_cloth_triangle < 24));
    x[9 + 4].y() = 0.2;
    const StartFault touching = detector->check_start(x);
    CHECK(touching.between_cloths());
    CHECK(touching.intersecting_pairs == 0);
}

}  // namespace percale::test::self_contact_detection_test
