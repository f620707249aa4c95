#include <bullet_bodies.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "percale/certify.h"
#include "percale/detectors.h"
#include "tests/support/catch.h"

namespace percale::test::bullet_world_test {

// Bodies of a Bullet world and cloth, as data/examples/bullet_bodies.h couples them.

namespace {

constexpr double dt = 1.0 / 240.0, g = 9.81, sheet_mass = 0.3;  // s, m/s^2, kg

Vec3 vec3(const btVector3& x) { return {x.x(), x.y(), x.z()}; }

/// A sheet of 1 m^2 that a box and a ball hit.
struct Flight {
    btBoxShape box_shape{{0.1, 0.1, 0.1}};
    btSphereShape ball_shape{0.08};
    BulletWorld world;
    BulletBody box{world, box_shape, 2.0, {0.2, 0.16, 0.05}}, ball{world, ball_shape, 0.5, {-0.25, 0.12, -0.1}};
    Simulation simulation;
    TriangleMesh sheet = make_grid(1.0, 1.0, 17, 17), box_mesh = make_box({0.2, 0.2, 0.2}), ball_mesh = make_sphere(0.08, 2);
    ClothId cloth;
    BulletBodies bodies;
    ObstacleId box_number, ball_number;

    Flight(const Vec3& gravity, double friction, Scheme scheme = Scheme::backward_euler)
        : world({gravity.x(), gravity.y(), gravity.z()}),
          simulation({.scheme = scheme, .newton_tolerance = 1e-10, .gravity = gravity}, make_bullet_detector()),
          cloth(simulation.add_cloth(sheet, {.area_density = sheet_mass,
                                             .thickness = 0.01,
                                             .springs = {.structural = 2000.0, .shear = 1000.0, .bend = 5.0},
                                             .spring_damping = 4.0})),
          bodies(world.world, simulation),
          box_number(bodies.add(*box, box_mesh, friction, "box")),
          ball_number(bodies.add(*ball, ball_mesh, friction, "ball")) {
        box->setLinearVelocity({0.3, -2.0, 0.1});
        box->setAngularVelocity({1.0, 2.0, 3.0});
        ball->setLinearVelocity({-0.2, -3.0, 0.5});
    }

    /// N s, with what the bodies are still to get.
    Vec3 momentum() {
        Vec3 sum = bodies.impulse();
        for (int i = 0; i < 289; ++i) sum += simulation.masses(cloth)[i] * simulation.velocities(cloth)[i];
        for (const btRigidBody* body : {&*box, &*ball}) sum += vec3(body->getLinearVelocity()) / body->getInvMass();
        return sum;
    }

    /// About the origin, N m s, likewise.
    Vec3 angular_momentum() {
        Vec3 sum = bodies.turn();
        for (int i = 0; i < 289; ++i) {
            sum += simulation.masses(cloth)[i] * simulation.positions(cloth)[i].cross(simulation.velocities(cloth)[i]);
        }
        for (const btRigidBody* body : {&*box, &*ball}) {
            sum += vec3(body->getCenterOfMassPosition()).cross(vec3(body->getLinearVelocity())) / body->getInvMass();
            sum += vec3(body->getInvInertiaTensorWorld().inverse() * body->getAngularVelocity());
        }
        return sum;
    }

    bool nothing_crosses() const {
        TriangleMesh cloth_now = sheet, box_now = box_mesh, ball_now = ball_mesh;
        cloth_now.vertices.assign(simulation.positions(cloth).begin(), simulation.positions(cloth).end());
        box_now.vertices = transform(simulation.obstacle_pose(box_number), box_mesh.vertices);
        ball_now.vertices = transform(simulation.obstacle_pose(ball_number), ball_mesh.vertices);
        return certify(cloth_now, box_now, 0.0).clean() && certify(cloth_now, ball_now, 0.0).clean();
    }
};

}  // namespace

TEST_CASE("Momentum of two bodies and the free sheet they hit is what gravity gives, to 1e-6 of what they exchange") {
    struct Way {
        double friction;
        Scheme scheme;
    };
    for (const auto& [friction, scheme] :
         {Way{0.0, Scheme::backward_euler}, Way{0.5, Scheme::backward_euler}, Way{0.5, Scheme::tr_bdf2}}) {
        const Vec3 gravity(0.0, -g, 0.0);
        Flight flight(gravity, friction, scheme);
        const Vec3 start = flight.momentum();
        double exchanged = 0.0, error = 0.0;
        for (int n = 1; n <= 120; ++n) {
            flight.bodies.step(dt);
            exchanged += flight.bodies.impulse().norm();
            error = std::max(error, (flight.momentum() - start - (2.5 + sheet_mass) * n * dt * gravity).norm());
            if (n % 10 == 0) CHECK(flight.nothing_crosses());
        }
        CAPTURE(friction, static_cast<int>(scheme), exchanged, error);
        CHECK(exchanged > 0.5);
        CHECK(error < 1e-6 * exchanged);
    }
}

TEST_CASE("Without gravity bodies and sheet keep their angular momentum but for what the schemes lose") {
    Flight flight(Vec3::Zero(), 0.5);
    const Vec3 start = flight.angular_momentum();
    const Vec3 box_start = vec3(flight.box->getAngularVelocity());
    for (int n = 0; n < 120; ++n) flight.bodies.step(dt);
    CAPTURE(start.transpose(), flight.angular_momentum().transpose());
    CHECK((vec3(flight.box->getAngularVelocity()) - box_start).norm() > 1.0);  // rad/s, by the sheet
    CHECK((flight.angular_momentum() - start).norm() < 0.01 * start.norm());
}

TEST_CASE("A box dropped askew on a trampoline comes to rest level, carried by its weight, the pins carry both") {
    BulletWorld world({0.0, -g, 0.0});
    btBoxShape shape({0.15, 0.05, 0.1});
    BulletBody box(world, shape, 2.0, {0.03, 0.4, -0.02});
    box->setCenterOfMassTransform(btTransform(btQuaternion({1.0, 0.0, 2.0}, 0.3), {0.03, 0.4, -0.02}));
    Simulation simulation({.newton_tolerance = 1e-10}, make_bullet_detector());
    const TriangleMesh sheet = make_grid(1.0, 1.0, 13, 13), mesh = make_box({0.3, 0.1, 0.2});
    const ClothId cloth = simulation.add_cloth(sheet, {.area_density = sheet_mass,
                                                       .thickness = 0.01,
                                                       .springs = {.structural = 2000.0, .shear = 1000.0, .bend = 5.0},
                                                       .spring_damping = 40.0});
    for (int i = 0; i < 169; ++i) {
        if (i % 13 == 0 || i % 13 == 12 || i / 13 == 0 || i / 13 == 12) simulation.pin(cloth, i);
    }
    BulletBodies bodies(world.world, simulation);
    const ObstacleId number = bodies.add(*box, mesh, 0.5, "box");
    const auto momentum = [&] {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 169; ++i) sum += simulation.masses(cloth)[i] * simulation.velocities(cloth)[i];
        return sum;
    };
    Vec3 pins = Vec3::Zero();  // N s in the last step, from the momentum of the cloth
    for (int n = 0; n < 1920; ++n) {
        const Vec3 before = momentum();
        bodies.step(dt);
        pins = momentum() - before + bodies.impulse() + sheet_mass * dt * Vec3(0.0, g, 0.0);
        if (n % 40 != 0) continue;
        TriangleMesh cloth_now = sheet, box_now = mesh;
        cloth_now.vertices.assign(simulation.positions(cloth).begin(), simulation.positions(cloth).end());
        box_now.vertices = transform(simulation.obstacle_pose(number), mesh.vertices);
        CHECK(certify(cloth_now, box_now, 0.0).clean());
    }
    CAPTURE(pins.transpose() / dt, vec3(box->getLinearVelocity()).transpose());
    CHECK(box->getLinearVelocity().length() < 1e-6);
    CHECK(box->getAngularVelocity().length() < 1e-6);
    CHECK((simulation.force_on(number) - Vec3(0.0, 2.0 * g, 0.0)).norm() < 1e-6 * 2.0 * g);
    CHECK((pins / dt - Vec3(0.0, (2.0 + sheet_mass) * g, 0.0)).norm() < 1e-6 * 2.3 * g);
    CHECK(box->getWorldTransform().getBasis()[1][1] > 0.99);
}

}  // namespace percale::test::bullet_world_test
