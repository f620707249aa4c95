#pragma once

#include <btBulletDynamicsCommon.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "percale/percale.h"

// Rigid bodies of a Bullet world (double precision) as obstacles of a Percale simulation. Copy it into your host.

/// Both are stepped here, and only here. Bullet moves the bodies along a step, the cloth meets them there, and what contact gave
/// the cloth is taken from the bodies as the next step begins: momentum is kept, as far as the cloth's solver goes (5 % of what
/// is exchanged may be missing at the default tolerance; 1e-10 of it at newton_tolerance = 1e-10). Needs backward Euler without
/// kinetic damping. There m (v - v0) = dt f(x1) with v = (x1 - x0)/dt, so that the force on a vertex at the end, ContactLoad,
/// times dt is the impulse of the whole step; impacts then change v to v1, which is m (v1 - v) more. Between cloths with
/// self_contact impacts do so, too: that of a vertex that touches a body at the same time goes to the body.
/// Bodies feel contact a step late. That is stable while a body is not much lighter than the cloth it touches, and dt^2 k is less
/// than its mass, k being the stiffness with which that cloth holds it (N/m). Measured: a box on 0.012 kg of a trampoline comes
/// to rest at 0.01 kg, and is thrown off at 0.003 kg.
class BulletBodies {
public:
    /// World and simulation must outlive this; `cloths`: all that the bodies may touch.
    BulletBodies(btDynamicsWorld& world, percale::Simulation& simulation, std::vector<percale::ClothId> cloths)
        : world_(world), simulation_(simulation), cloths_(std::move(cloths)) {}

    /// `mesh`: the body's surface in its own axes, the origin in its centre of mass. The body must be in the world, and stay.
    percale::ObstacleId add(btRigidBody& body, const percale::TriangleMesh& mesh, double friction, const std::string& name) {
        body.setActivationState(DISABLE_DEACTIVATION);  // Bullet does not see what the cloth presses it with
        const percale::Pose pose = pose_of(body);
        const percale::ObstacleId obstacle = simulation_.add_obstacle(mesh, pose, {.friction = friction, .name = name});
        bodies_.push_back({.body = &body, .obstacle = obstacle, .from = pose, .to = pose});
        return obstacle;
    }

    /// Advances both by dt (s). Throws percale::SceneError before anything moves where the scheme is another one, and
    /// std::runtime_error where the cloth cannot follow; the bodies have then moved.
    void step(double dt) {
        if (!started_) start();
        for (Body& body : bodies_) {
            body.body->applyCentralImpulse(vector_of(body.impulse));
            body.body->applyTorqueImpulse(vector_of(body.turn));
            body.impulse = body.turn = percale::Vec3::Zero();
        }
        world_.stepSimulation(dt, 0);
        for (Body& body : bodies_) body.to = pose_of(*body.body);
        advance(dt, 0.0, 1.0);
        for (Body& body : bodies_) body.from = body.to;
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
        for (const Body& body : bodies_) sum += body.turn + body.to.translation.cross(body.impulse);
        return sum;
    }
    int halved_steps() const { return halved_steps_; }
    /// Lengths that even halving could not make in one piece: of these the impulse is not exact.
    int inexact_steps() const { return inexact_steps_; }

private:
    struct Body {
        btRigidBody* body;
        percale::ObstacleId obstacle;
        percale::Pose from, to;                                                       // of this step
        percale::Vec3 impulse = percale::Vec3::Zero(), turn = percale::Vec3::Zero();  // N s, N m s about the body's centre
    };
    using Positions = std::vector<percale::Vec3>;

    static btVector3 vector_of(const percale::Vec3& x) { return {x.x(), x.y(), x.z()}; }

    static percale::Pose pose_of(const btRigidBody& body) {
        const btVector3& x = body.getCenterOfMassPosition();
        const btQuaternion q = body.getOrientation().normalized();
        return {.translation = {x.x(), x.y(), x.z()}, .rotation = {q.w(), q.x(), q.y(), q.z()}};
    }

    void start() {
        const percale::ScenePlan plan = simulation_.plan();
        if (plan.scheme != percale::Scheme::backward_euler) {
            throw percale::SceneError("BulletBodies", "scheme " + plan.scheme_word + ", bodies need backward_euler");
        }
        simulation_.prepare();  // a repair of the start is no motion
        started_ = true;
    }

    /// The part of the step between two shares of it. Percale divides what it cannot solve at once, and then tells the force at
    /// the end of the last piece alone: such a part is taken back and made in halves, so that each piece's force is seen.
    void advance(double dt, double begin, double end) {
        const std::vector<std::byte> saved = simulation_.save();
        std::vector<Positions> before;
        for (const percale::ClothId cloth : cloths_) {
            before.emplace_back(simulation_.positions(cloth).begin(), simulation_.positions(cloth).end());
        }
        simulation_.set_time_step(dt);
        for (const Body& body : bodies_) simulation_.move_obstacle(body.obstacle, interpolate(body.from, body.to, end));
        const percale::StepReport report = simulation_.step();
        const bool in_one_piece = report.ok() && report.parts == 1 && report.halvings == 0;
        if (!in_one_piece && end - begin > 1.0 / 64.0) {
            simulation_.restore(saved);
            ++halved_steps_;
            advance(0.5 * dt, begin, 0.5 * (begin + end));
            return advance(0.5 * dt, 0.5 * (begin + end), end);
        }
        if (!report.ok()) throw std::runtime_error(report.explanation());
        if (!in_one_piece) ++inexact_steps_;
        for (std::size_t i = 0; i < cloths_.size(); ++i) take_from_bodies(cloths_[i], before[i], dt);
    }

    /// Several obstacles at one vertex share its impact by what they press it with.
    void take_from_bodies(percale::ClothId cloth, const Positions& before, double dt) {
        const std::vector<percale::ContactLoad> loads = simulation_.contact_loads(cloth);
        const auto masses = simulation_.masses(cloth);
        const auto positions = simulation_.positions(cloth), velocities = simulation_.velocities(cloth);
        std::vector<double> press(before.size(), 0.0);
        for (const percale::ContactLoad& load : loads) press[load.vertex] += load.normal.norm();
        for (const percale::ContactLoad& load : loads) {
            const int i = load.vertex;
            const percale::Vec3 impact = masses[i] * (velocities[i] - (positions[i] - before[i]) / dt);
            const double share = press[i] > 0.0 ? load.normal.norm() / press[i] : 0.0;
            give(load, -(dt * load.force() + share * impact));
        }
    }

    void give(const percale::ContactLoad& load, const percale::Vec3& impulse) {
        for (Body& body : bodies_) {
            if (body.obstacle.index != load.obstacle) continue;
            const percale::Vec3 arm = load.cloth_point - simulation_.obstacle_pose(body.obstacle).translation;
            body.impulse += impulse;
            body.turn += arm.cross(impulse);
        }
    }

    btDynamicsWorld& world_;
    percale::Simulation& simulation_;
    std::vector<percale::ClothId> cloths_;
    std::vector<Body> bodies_;
    int inexact_steps_ = 0, halved_steps_ = 0;
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
