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

FrictionContact friction_contact_of(const Vec3& friction_limit, double stick_threshold, const Vec3& slip) {
    FrictionContact contact;
    contact.vertex = contact.obstacle = 0;
    contact.friction_limit = friction_limit;
    contact.stick_threshold = stick_threshold;
    contact.slip = slip;
    return contact;
}

}  // namespace

TEST_CASE("The motion of an obstacle moves its points along the straight lines between two poses") {
    Random random(3);
    for (int trial = 0; trial < 50; ++trial) {
        const Pose start = random_pose(random, 1.7), end = random_pose(random, 1.7);
        const Vec3 point = random.point(2.0);
        const double fraction = random.number(0.0, 0.9);
        const Vec3 from = transform(start, point), to = transform(end, point);
        const ObstacleMotion obstacle_displacement = obstacle_motion(start, end, fraction);
        CHECK((obstacle_displacement.turn * (from + fraction * (to - from)) + obstacle_displacement.shift - (to - from)).norm() <
              1e-12);
    }
    const Pose pose = random_pose(random, 1.0);
    const ObstacleMotion none = obstacle_motion(pose, pose, 0.5);
    CHECK((none.turn.norm() == 0.0 && none.shift.norm() == 0.0));
}

TEST_CASE("A vertex without a stick anchor slips from its start position, along the surface, relative to the obstacle") {
    const Vec3Arrays positions = to_vec3_arrays({Vec3(0, 0, 0), Vec3(1, 0.5, 0)});
    const std::vector<ObstacleMotion> obstacle_motions = {{}, {.turn = Eigen::Matrix3d::Zero(), .shift = Vec3(0.4, 0.1, 0.0)}};
    const FrictionStart start{
        .positions = &positions, .fraction = 0.25, .stick_anchors = {}, .obstacle_motions = obstacle_motions};
    FrictionContact contact = friction_contact_of(Vec3(0, 3, 0), 0.01, Vec3::Zero());
    contact.vertex = contact.obstacle = 1;
    set_slip(start, Vec3(1.5, 0.7, 0.2), 0.75, contact);
    CHECK((contact.slip - Vec3(0.5 - 0.2, 0.0, 0.2)).norm() < 1e-15);
    CHECK((contact.obstacle_displacement - Vec3(0.4, 0.1, 0.0)).norm() < 1e-15);
    CHECK_FALSE(contact.had_anchor);
}

TEST_CASE("A stick anchor is found by vertex and obstacle and adds to the slip") {
    const Vec3Arrays positions = to_vec3_arrays({Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)});
    const std::vector<StickAnchor> stick_anchors = {
        {0, 2, Vec3(1, 0, 0)}, {1, 0, Vec3(2, 0, 0)}, {1, 3, Vec3(3, 0, 0)}, {2, 1, Vec3(4, 0, 0)}};
    const FrictionStart start{.positions = &positions, .fraction = 0.0, .stick_anchors = stick_anchors, .obstacle_motions = {}};
    for (int vertex = 0; vertex < 3; ++vertex) {
        for (int obstacle = 0; obstacle < 4; ++obstacle) {
            FrictionContact contact = friction_contact_of(Vec3(0, 1, 0), 0.01, Vec3::Zero());
            contact.vertex = vertex;
            contact.obstacle = obstacle;
            set_slip(start, Vec3(0, 5, 0.5), 1.0, contact);
            double stretch = 0.0;
            for (const StickAnchor& stick_anchor : stick_anchors)
                stretch += stick_anchor.vertex == vertex && stick_anchor.obstacle == obstacle ? stick_anchor.stretch.x() : 0.0;
            CAPTURE(vertex, obstacle);
            CHECK((contact.slip - Vec3(stretch, 0.0, 0.5)).norm() < 1e-14);
            CHECK(contact.had_anchor == (stretch > 0.0));
        }
    }
}

TEST_CASE("There is one friction contact for each vertex and obstacle, found again until it is cleared") {
    FrictionContacts friction_contacts;
    friction_contacts.clear(4);
    friction_contacts.get(2, 5).stick_threshold = 1.0;
    friction_contacts.get(2, 6).stick_threshold = 2.0;
    friction_contacts.get(0, 5).stick_threshold = 3.0;
    friction_contacts.get(2, 5).stick_threshold += 10.0;
    REQUIRE(friction_contacts.all.size() == 3);
    CHECK(friction_contacts.find(2, 5)->stick_threshold == 11.0);
    CHECK(friction_contacts.find(2, 6)->stick_threshold == 2.0);
    CHECK(friction_contacts.find(0, 5)->stick_threshold == 3.0);
    CHECK(friction_contacts.find(0, 6) == nullptr);
    CHECK(friction_contacts.find(1, 5) == nullptr);
    CHECK(friction_contacts.find(100, 5) == nullptr);
    friction_contacts.clear(4);
    CHECK(friction_contacts.find(2, 5) == nullptr);
    CHECK(friction_contacts.all.empty());
}

TEST_CASE("Stick anchors are kept by sticking contacts, dragged along by sliding ones, and sorted") {
    FrictionContacts friction_contacts;
    friction_contacts.all = {friction_contact_of(Vec3(0, 1, 0), 1e-4, Vec3(0.5e-4, 0, 0)),
                             friction_contact_of(Vec3(0, 1, 0), 1e-4, Vec3(0, 0, -0.3)),
                             friction_contact_of(Vec3(0, 1, 0), 1e-4, Vec3(0, 0, 1e-4))};
    friction_contacts.all[0].vertex = 8;
    friction_contacts.all[1].vertex = friction_contacts.all[2].vertex = 3;
    friction_contacts.all[1].obstacle = 1;
    std::vector<StickAnchor> stick_anchors = {{77, 7, Vec3(1, 1, 1)}};
    set_stick_anchors(friction_contacts, stick_anchors);
    REQUIRE(stick_anchors.size() == 3);
    CHECK((stick_anchors[0].vertex == 3 && stick_anchors[0].obstacle == 0 && stick_anchors[1].obstacle == 1 &&
           stick_anchors[2].vertex == 8));
    CHECK((stick_anchors[0].stretch - Vec3(0, 0, 1e-4)).norm() < 1e-18);
    CHECK((stick_anchors[1].stretch - Vec3(0, 0, -1e-4)).norm() < 1e-18);
    CHECK(stick_anchors[2].stretch == Vec3(0.5e-4, 0, 0));
}

}  // namespace percale::test::friction_test
