#include "engine/contact/friction.h"

#include <cmath>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::friction_test {
namespace {

Rotation turned(const Vec3& axis, double angle) {
    const Vec3 v = std::sin(0.5 * angle) * axis;
    return {std::cos(0.5 * angle), v.x(), v.y(), v.z()};
}

Pose random_pose(Random& random, double scale) {
    const Vec3 axis = random.unit();
    const double angle = random.number(-1.0, 1.0);
    return {.translation = random.point(1.0), .rotation = turned(axis, angle), .scale = scale};
}

Touch touch_of(const Vec3& press, double reach, const Vec3& slip) {
    Touch touch;
    touch.vertex = touch.obstacle = 0;
    touch.press = press;
    touch.reach = reach;
    touch.slip = slip;
    return touch;
}

}  // namespace

TEST_CASE("An obstacle's flow carries its points along the straight lines between two poses") {
    Random random(3);
    for (int trial = 0; trial < 50; ++trial) {
        const Pose start = random_pose(random, 1.7), end = random_pose(random, 1.7);
        const Vec3 point = random.point(2.0);
        const double fraction = random.number(0.0, 0.9);
        const Vec3 from = transform(start, point), to = transform(end, point);
        const ObstacleFlow flow = obstacle_flow(start, end, fraction);
        CHECK((flow.turn * (from + fraction * (to - from)) + flow.shift - (to - from)).norm() < 1e-12);
    }
    const Pose pose = random_pose(random, 1.0);
    const ObstacleFlow none = obstacle_flow(pose, pose, 0.5);
    CHECK((none.turn.norm() == 0.0 && none.shift.norm() == 0.0));
}

TEST_CASE("A vertex that held nothing slips from where it was, along the surface, with the obstacle's motion taken off") {
    const Vectors positions = to_vectors({Vec3(0, 0, 0), Vec3(1, 0.5, 0)});
    const std::vector<ObstacleFlow> flows = {{}, {.turn = Eigen::Matrix3d::Zero(), .shift = Vec3(0.4, 0.1, 0.0)}};
    const FrictionStart start{.positions = &positions, .fraction = 0.25, .grips = {}, .flows = flows};
    Touch touch = touch_of(Vec3(0, 3, 0), 0.01, Vec3::Zero());
    touch.vertex = touch.obstacle = 1;
    set_slip(start, Vec3(1.5, 0.7, 0.2), 0.75, touch);
    CHECK((touch.slip - Vec3(0.5 - 0.2, 0.0, 0.2)).norm() < 1e-15);
    CHECK((touch.flow - Vec3(0.4, 0.1, 0.0)).norm() < 1e-15);
    CHECK_FALSE(touch.old);
}

TEST_CASE("A grip is found by vertex and obstacle and adds to the slip") {
    const Vectors positions = to_vectors({Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)});
    const std::vector<Grip> grips = {{0, 2, Vec3(1, 0, 0)}, {1, 0, Vec3(2, 0, 0)}, {1, 3, Vec3(3, 0, 0)}, {2, 1, Vec3(4, 0, 0)}};
    const FrictionStart start{.positions = &positions, .fraction = 0.0, .grips = grips, .flows = {}};
    for (int vertex = 0; vertex < 3; ++vertex) {
        for (int obstacle = 0; obstacle < 4; ++obstacle) {
            Touch touch = touch_of(Vec3(0, 1, 0), 0.01, Vec3::Zero());
            touch.vertex = vertex;
            touch.obstacle = obstacle;
            set_slip(start, Vec3(0, 5, 0.5), 1.0, touch);
            double stretch = 0.0;
            for (const Grip& grip : grips) stretch += grip.vertex == vertex && grip.obstacle == obstacle ? grip.stretch.x() : 0.0;
            CAPTURE(vertex, obstacle);
            CHECK((touch.slip - Vec3(stretch, 0.0, 0.5)).norm() < 1e-14);
            CHECK(touch.old == (stretch > 0.0));
        }
    }
}

TEST_CASE("Friction is a spring up to the reach and at its limit beyond, against the slip") {
    const Vec3 along = Vec3(3, 0, 4) / 5.0, press(0, 2, 0);
    for (const double share : {0.0, 0.1, 0.99, 1.0, 1.01, 300.0}) {
        const Vec3 force = friction_force(touch_of(press, 1e-4, share * 1e-4 * along));
        CAPTURE(share);
        CHECK((force + 2.0 * std::min(share, 1.0) * along).norm() < 1e-12);
    }
}

TEST_CASE("Touches are one a vertex and obstacle and are found again until they are cleared") {
    Touches touches;
    touches.clear(4);
    touches.get(2, 5).reach = 1.0;
    touches.get(2, 6).reach = 2.0;
    touches.get(0, 5).reach = 3.0;
    touches.get(2, 5).reach += 10.0;
    REQUIRE(touches.all.size() == 3);
    CHECK(touches.find(2, 5)->reach == 11.0);
    CHECK(touches.find(2, 6)->reach == 2.0);
    CHECK(touches.find(0, 5)->reach == 3.0);
    CHECK(touches.find(0, 6) == nullptr);
    CHECK(touches.find(1, 5) == nullptr);
    CHECK(touches.find(100, 5) == nullptr);
    touches.clear(4);
    CHECK(touches.find(2, 5) == nullptr);
    CHECK(touches.all.empty());
}

TEST_CASE("Grips keep what sticks, drag along what slides, and are sorted") {
    Touches touches;
    touches.all = {touch_of(Vec3(0, 1, 0), 1e-4, Vec3(0.5e-4, 0, 0)), touch_of(Vec3(0, 1, 0), 1e-4, Vec3(0, 0, -0.3)),
                   touch_of(Vec3(0, 1, 0), 1e-4, Vec3(0, 0, 1e-4))};
    touches.all[0].vertex = 8;
    touches.all[1].vertex = touches.all[2].vertex = 3;
    touches.all[1].obstacle = 1;
    std::vector<Grip> grips = {{77, 7, Vec3(1, 1, 1)}};
    set_grips(touches, grips);
    REQUIRE(grips.size() == 3);
    CHECK((grips[0].vertex == 3 && grips[0].obstacle == 0 && grips[1].obstacle == 1 && grips[2].vertex == 8));
    CHECK((grips[0].stretch - Vec3(0, 0, 1e-4)).norm() < 1e-18);
    CHECK((grips[1].stretch - Vec3(0, 0, -1e-4)).norm() < 1e-18);
    CHECK(grips[2].stretch == Vec3(0.5e-4, 0, 0));
}

TEST_CASE("What friction between cloths holds is found again by row, and goes no farther than the reach") {
    Random random(7);
    const double mu = 0.4, h = 0.005, normal = 3.0;
    ContactRows rows;
    for (int row = 0; row < 40; ++row) {
        rows.vertex.push_back({row, row + 50, row + 51, -1});
        rows.weight.push_back({1.0, -0.3, -0.7, 0.0});
        rows.direction.push_back(random.unit());
        rows.thickness.push_back(h);
        rows.friction.push_back(mu);
        rows.obstacle.push_back(-1);
        rows.feature.push_back(1);
    }
    const Vectors start = to_vectors(random_points(random, 100, 1.0));
    Vectors end = start;
    for (int i = 0; i < 100; ++i) end.set(i, end.at(i) + random.point(5e-5));
    const FrictionStart first{.positions = &start};
    std::vector<Rub> rubs;
    const std::vector<RowForce> forces(40, {.normal = normal});
    for (int row = 0; row < 40; ++row) rubs.push_back(rub_of(first, rows, row, normal, end));
    ContactMultipliers held;
    set_held(rows, rubs, forces, held);
    CHECK(held.size() == 40);
    // The next stage begins where this one ended. It presses otherwise.
    const FrictionStart next{.positions = &end, .held = &held};
    int slid = 0;
    for (int row = 0; row < 40; ++row) {
        const Rub before = rubs[row], after = rub_of(next, rows, row, 2.0 * normal, end);
        const double reach = 0.01 * h, length = before.slip.norm();
        CHECK(before.reach == Approx(reach));
        CHECK(std::abs(before.slip.dot(rows.direction[row])) < 1e-15);
        CHECK((before.slip - before.moved).norm() == 0.0);
        CHECK(friction_force(before).norm() == Approx(mu * normal * std::min(1.0, length / reach)));
        CHECK((after.slip - std::min(1.0, reach / length) * before.slip).norm() < 1e-12 * reach);
        CHECK(after.moved.norm() == 0.0);
        CHECK(after.press == Approx(2.0 * mu * normal));
        slid += length > reach;
    }
    CHECK((slid > 5 && slid < 35));
    // Of another row nothing is held.
    rows.vertex[0][0] = 49;
    CHECK(rub_of(next, rows, 0, normal, end).slip.norm() == 0.0);
}

}  // namespace percale::test::friction_test
