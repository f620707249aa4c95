#include <Eigen/Geometry>

#include "percale/mesh.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::pose_test {

TEST_CASE("A pose scales, then rotates, then translates") {
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        Pose pose = random.pose(3.0);
        pose.scale = random.decades(1e-3, 1e3);
        const Vec3 point = random.point(2.0);
        const Rotation& q = pose.rotation;
        const Vec3 expected = pose.translation + Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix() * (pose.scale * point);
        CHECK((transform(pose, point) - expected).norm() <= 1e-14 * (3.0 + expected.norm()));
    }
}

TEST_CASE("A pose without rotation or scale keeps every bit of a translation") {
    Random random(2);
    for (int i = 0; i < 50; ++i) {
        const Vec3 shift = random.point(1.0), point = random.point(1.0);
        CHECK(transform(Pose{.translation = shift}, point) == shift + point);
        CHECK(transform(Pose{}, point) == point);
    }
}

TEST_CASE("Transforming a list gives the bits of transforming each point") {
    Random random(3);
    const Pose pose = random.pose(1.0);
    const std::vector<Vec3> points = random_points(random, 20, 1.0);
    const std::vector<Vec3> images = transform(pose, points);
    REQUIRE(images.size() == points.size());
    for (std::size_t i = 0; i < points.size(); ++i) CHECK(images[i] == transform(pose, points[i]));
}

TEST_CASE("Half a turn about y reverses x and z") {
    const Pose pose{.translation = Vec3::Zero(), .rotation = {0.0, 0.0, 1.0, 0.0}, .scale = 2.0};
    CHECK((transform(pose, Vec3(1.0, 2.0, 3.0)) - Vec3(-2.0, 4.0, -6.0)).norm() < 1e-15);
}

TEST_CASE("The product of two rotations turns as one after the other") {
    Random random(4);
    for (int i = 0; i < 50; ++i) {
        const Pose first{.rotation = random.pose(1.0).rotation}, second{.rotation = random.pose(1.0).rotation};
        const Vec3 point = random.point(1.0);
        const Pose both{.rotation = product(second.rotation, first.rotation)};
        CHECK((transform(both, point) - transform(second, transform(first, point))).norm() < 1e-14);
    }
}

TEST_CASE("Between two poses a body moves straight and turns evenly, by the shorter way") {
    Random random(5);
    for (int i = 0; i < 50; ++i) {
        const Pose from = random.pose(2.0);
        Pose to = random.pose(2.0);
        if (i % 2 == 1) to.rotation = {-to.rotation.w, -to.rotation.x, -to.rotation.y, -to.rotation.z};  // the same rotation
        const double angle = angle_between(from.rotation, to.rotation), share = 0.1 + 0.016 * i;
        const Pose middle = interpolate(from, to, share);
        CHECK(angle <= 3.14159265358979324);
        CHECK((middle.translation - from.translation - share * (to.translation - from.translation)).norm() < 1e-14);
        CHECK(angle_between(from.rotation, middle.rotation) == Approx(share * angle).epsilon(1e-6));
        CHECK(angle_between(middle.rotation, to.rotation) == Approx((1.0 - share) * angle).epsilon(1e-6));
    }
    const Rotation still = random.pose(1.0).rotation;
    CHECK(angle_between(still, interpolate({.rotation = still}, {.rotation = still}, 0.5).rotation) < 1e-7);
}

}  // namespace percale::test::pose_test
