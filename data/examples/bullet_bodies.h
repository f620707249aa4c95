#pragma once

#include <btBulletDynamicsCommon.h>

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>
#include <vector>

#include "percale/percale.h"

// Rigid bodies of a Bullet world (double precision) as obstacles of a Percale simulation. Copy it into your host.

/// Both are stepped here, and only here. Bullet moves the bodies along a step, the cloth meets them there, and what contact gave
/// the cloth (Simulation::impulse_on) is taken from the bodies as the next step begins: momentum is kept, as far as the cloth's
/// solver goes and without kinetic damping (5 % of what is exchanged may be missing at the default tolerance; 1e-10 of it at
/// newton_tolerance = 1e-10). Bodies feel contact a step late. That is stable while a body is not much lighter than the cloth it
/// touches, and dt^2 k is less than its mass, k being the stiffness with which that cloth holds it (N/m). Measured: a box on
/// 0.012 kg of a trampoline comes to rest at 0.01 kg, and is thrown off at 0.003 kg.
class BulletBodies {
public:
    /// World and simulation must outlive this.
    BulletBodies(btDynamicsWorld& world, percale::Simulation& simulation) : world_(world), simulation_(simulation) {
        simulation_.keep_impulses();
    }

    /// `mesh`: the body's surface in its own axes, the origin in its centre of mass. The body must be in the world, and stay.
    percale::ObstacleId add(btRigidBody& body, const percale::TriangleMesh& mesh, double friction, const std::string& name) {
        body.setActivationState(DISABLE_DEACTIVATION);  // Bullet does not see what the cloth presses it with
        const percale::ObstacleId obstacle = simulation_.add_obstacle(mesh, pose_of(body), {.friction = friction, .name = name});
        bodies_.push_back({.body = &body, .obstacle = obstacle});
        return obstacle;
    }

    /// Advances both by dt (s). Throws what Simulation::step does, and std::runtime_error where the cloth cannot follow; the
    /// bodies have then moved.
    void step(double dt) {
        if (!started_) simulation_.prepare();  // a repair of the start is no motion
        started_ = true;
        for (Body& body : bodies_) {
            body.body->applyCentralImpulse(vector_of(body.impulse));
            body.body->applyTorqueImpulse(vector_of(body.turn));
            body.impulse = body.turn = percale::Vec3::Zero();
        }
        world_.stepSimulation(dt, 0);
        simulation_.set_time_step(dt);
        for (Body& body : bodies_) simulation_.move_obstacle(body.obstacle, pose_of(*body.body));
        const percale::StepReport report = simulation_.step();
        if (!report.ok()) throw std::runtime_error(report.explanation());
        for (Body& body : bodies_) {
            body.impulse = simulation_.impulse_on(body.obstacle);
            body.turn = simulation_.angular_impulse_on(body.obstacle, place_of(body));
        }
    }

    /// What the cloth gave all bodies in the last step, N s: their velocities have it from the next step on.
    percale::Vec3 impulse() const {
        percale::Vec3 sum = percale::Vec3::Zero();
        for (const Body& body : bodies_) sum += body.impulse;
        return sum;
    }
    /// The same of angular momentum about the origin of the world, N m s.
    percale::Vec3 turn() const {
        percale::Vec3 sum = percale::Vec3::Zero();
        for (const Body& body : bodies_) sum += body.turn + place_of(body).cross(body.impulse);
        return sum;
    }

private:
    struct Body {
        btRigidBody* body;
        percale::ObstacleId obstacle;
        percale::Vec3 impulse = percale::Vec3::Zero(), turn = percale::Vec3::Zero();  // N s, N m s about the body's centre
    };

    static btVector3 vector_of(const percale::Vec3& x) { return {x.x(), x.y(), x.z()}; }

    static percale::Pose pose_of(const btRigidBody& body) {
        const btVector3& x = body.getCenterOfMassPosition();
        const btQuaternion q = body.getOrientation().normalized();
        return {.translation = {x.x(), x.y(), x.z()}, .rotation = {q.w(), q.x(), q.y(), q.z()}};
    }

    percale::Vec3 place_of(const Body& body) const { return simulation_.obstacle_pose(body.obstacle).translation; }

    btDynamicsWorld& world_;
    percale::Simulation& simulation_;
    std::vector<Body> bodies_;
    bool started_ = false;
};

/// A Bullet world with gravity and what it needs, in the order in which it is destroyed.
struct BulletWorld {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};

    explicit BulletWorld(const btVector3& gravity) { world.setGravity(gravity); }
};

/// A body of that shape in a world, which it leaves when it is destroyed.
class BulletBody {
public:
    /// mass: kg; place: m. `shape` must outlive it.
    BulletBody(BulletWorld& in, btCollisionShape& shape, double mass, const btVector3& place) : world_(in.world) {
        btVector3 inertia;
        shape.calculateLocalInertia(mass, inertia);
        body_.setMassProps(mass, inertia);
        body_.setCollisionShape(&shape);
        body_.setCenterOfMassTransform(btTransform(btQuaternion::getIdentity(), place));
        world_.addRigidBody(&body_);
    }
    ~BulletBody() { world_.removeRigidBody(&body_); }
    BulletBody(const BulletBody&) = delete;
    BulletBody& operator=(const BulletBody&) = delete;

    btRigidBody& operator*() { return body_; }
    btRigidBody* operator->() { return &body_; }

private:
    btDynamicsWorld& world_;
    btRigidBody body_{{0.0, nullptr, nullptr}};
};
