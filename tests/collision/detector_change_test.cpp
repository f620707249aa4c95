#include <algorithm>

#include "collision/detector.h"
#include "tests/support/catch.h"
#include "tests/support/collision/scenes.h"
#include "tests/support/random.h"
#include "tests/support/saved_bytes.h"

namespace percale::test::detector_change_test {

// Obstacles that are taken out, and friction that changes, between steps.

namespace {

const std::vector<Vec3> places = {{0, 0.01, 0}, {0.42, 0, 0.05}, {-0.4, 0, 0}};

/// A sheet above a ball and two boxes, without the one of number `without`.
Steps sheet_on_three(const Backend& backend, int without = -1, const Vec3& away = Vec3::Zero()) {
    const TriangleMesh meshes[] = {make_sphere(0.25, 2), make_box({0.3, 0.5, 0.3}), make_box({0.25, 0.5, 0.2})};
    Steps steps{.cloth = make_grid(1.1, 0.6, 23, 13), .obstacles = {}, .detector = backend.make_detector()};
    for (Vec3& x : steps.cloth.vertices) x.y() += 0.37;
    steps.detector->set_cloth(steps.cloth.triangles, std::vector<double>(steps.cloth.vertices.size(), sheet_thickness));
    for (int k = 0; k < 3; ++k) {
        if (k == without) continue;
        const Pose pose{.translation = places[k] + (k == 1 ? away : Vec3(Vec3::Zero()))};
        steps.obstacles.push_back({.mesh = meshes[k], .start = pose, .end = pose});
        steps.detector->add_obstacle(meshes[k], pose, 0.1 * (k + 1));
    }
    return steps;
}

/// Cloth that sinks and is clamped; the constraints at the start, half-way and at the end.
struct SinkingStep {
    ContactConstraints constraints[3];
    double safe = 0.0;

    SinkingStep(ContactDetector& detector, std::vector<Vec3>& at, Random random) {
        std::vector<Vec3> to;
        for (const Vec3& x : at) to.push_back(x + Vec3(0, -0.02, 0) + random.point(0.002));
        detector.update_candidates(at, to);
        detector.find_contacts(at, 0.0, constraints[0]);
        safe = detector.collision_free_step_size(at, to, {0.0, 1.0});
        detector.find_contacts(between(at, to, 0.5 * safe), 1.0, constraints[1]);
        at = between(at, to, safe);
        detector.find_contacts(at, 1.0, constraints[2]);
    }
    bool operator==(const SinkingStep& other) const {
        return safe == other.safe && same_constraints(constraints[0], other.constraints[0]) &&
               same_constraints(constraints[1], other.constraints[1]) && same_constraints(constraints[2], other.constraints[2]);
    }
    void replace_obstacle(int number, int other) {
        for (ContactConstraints& of : constraints) std::ranges::replace(of.obstacle, number, other);
    }
    std::size_t contacts() const { return constraints[0].size() + constraints[1].size() + constraints[2].size(); }
};

ContactConstraints without_obstacle(const ContactConstraints& all, int obstacle) {
    ContactConstraints left;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all.obstacle[i] == obstacle) continue;
        left.vertex.push_back(all.vertex[i]);
        left.weight.push_back(all.weight[i]);
        left.direction.push_back(all.direction[i]);
        left.obstacle_point.push_back(all.obstacle_point[i]);
        left.obstacle_displacement.push_back(all.obstacle_displacement[i]);
        left.distance.push_back(all.distance[i]);
        left.thickness.push_back(all.thickness[i]);
        left.friction.push_back(all.friction[i]);
        left.mollifier.push_back(all.mollifier[i]);
        left.obstacle.push_back(all.obstacle[i] > obstacle ? all.obstacle[i] - 1 : all.obstacle[i]);
        left.feature.push_back(all.feature[i]);
    }
    return left;
}

}  // namespace

TEST_CASE("a far obstacle that is taken out leaves the constraints and clamps of a scene without it, on any tree") {
    for (const Backend& backend : backends()) {
        CAPTURE(backend.name);
        Steps had = sheet_on_three(backend, -1, {0, -9, 0}), never = sheet_on_three(backend, 1);
        std::vector<Vec3> one = had.cloth.vertices, other = one;
        std::size_t contacts = 0;
        for (int n = 0; n < 24; ++n) {
            if (n == 12) had.detector->remove_obstacle(1);
            SinkingStep step(*had.detector, one, Random(n)), same(*never.detector, other, Random(n));
            if (n < 12) step.replace_obstacle(2, 1);
            REQUIRE(step == same);
            contacts += step.contacts();
        }
        CHECK(contacts > 500);
        // It counts for nothing in a saved state, either.
        CHECK(saved_by(*had.detector) == saved_by(*never.detector));
    }
}

TEST_CASE("every constraint of an obstacle that is taken out goes, the others stay in every bit, persistent contacts included") {
    for (const Backend& backend : backends()) {
        for (const int gone : {0, 1, 2}) {
            CAPTURE(backend.name, gone);
            Steps steps = sheet_on_three(backend);
            std::vector<Vec3> at = steps.cloth.vertices;
            for (int n = 0; n < 16; ++n) SinkingStep(*steps.detector, at, Random(n));
            ContactConstraints before, after;
            steps.detector->find_contacts(at, 1.0, before);
            steps.detector->remove_obstacle(gone);
            steps.detector->find_contacts(at, 1.0, after);
            CHECK(std::ranges::count(before.obstacle, gone) > 20);
            CHECK(after.size() > 20);
            CHECK(same_constraints(after, without_obstacle(before, gone)));
            const StartFault fault = steps.detector->check_start(std::vector<Vec3>(steps.cloth.vertices));
            CHECK_FALSE(fault.any());
        }
    }
}

TEST_CASE("cloth may go through where an obstacle was, but through no other") {
    for (const Backend& backend : backends()) {
        CAPTURE(backend.name);
        Steps steps = sheet_on_three(backend);
        std::vector<Vec3> at = steps.cloth.vertices;
        for (int n = 0; n < 16; ++n) SinkingStep(*steps.detector, at, Random(n));
        Steps patch = sheet_on_three(backend);
        const auto below = [&](double x) {  // a sheet of the size of one obstacle
            std::vector<Vec3> sheet = steps.cloth.vertices;
            for (Vec3& p : sheet) p = Vec3(x + 0.1 * p.x(), p.y(), 0.1 * p.z());
            return sheet;
        };
        for (const int gone : {2, 1}) {
            const std::vector<Vec3> from = below(places[gone].x());
            std::vector<Vec3> to = from;
            for (Vec3& p : to) p.y() -= 1.0;
            CHECK(patch.detector->collision_free_step_size(from, to, {0.0, 1.0}) < 0.5);
            patch.detector->remove_obstacle(gone);
            CHECK(patch.detector->collision_free_step_size(from, to, {0.0, 1.0}) == 1.0);
            const std::vector<Vec3> other = below(places[0].x());
            to = other;
            for (Vec3& p : to) p.y() -= 1.0;
            CHECK(patch.detector->collision_free_step_size(other, to, {0.0, 1.0}) < 0.5);
        }
        patch.detector->remove_obstacle(0);
        ContactConstraints constraints;
        patch.detector->update_candidates(at, at);
        patch.detector->find_contacts(at, 1.0, constraints);
        CHECK(constraints.size() == 0);
        CHECK(patch.detector->smallest_distance() == infinity);
        CHECK(patch.detector->add_obstacle(make_box({0.1, 0.1, 0.1}), {}, 0.3) == 0);
    }
}

TEST_CASE("friction that was changed is that of all later constraints of the obstacle, and nothing else changes") {
    for (const Backend& backend : backends()) {
        CAPTURE(backend.name);
        Steps steps = sheet_on_three(backend);
        std::vector<Vec3> at = steps.cloth.vertices;
        for (int n = 0; n < 16; ++n) SinkingStep(*steps.detector, at, Random(n));
        ContactConstraints before, after;
        steps.detector->find_contacts(at, 1.0, before);
        steps.detector->set_friction(1, 0.77);
        steps.detector->find_contacts(at, 1.0, after);
        REQUIRE(std::ranges::count(before.obstacle, 1) > 20);
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (before.obstacle[i] == 1) before.friction[i] = 0.77;
        }
        CHECK(same_constraints(after, before));
    }
}

}  // namespace percale::test::detector_change_test
