#include "tests/bench/peers/bullet_sheet.h"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/bench_unit.h"

namespace percale::test {
namespace {

constexpr double structural = 1000.0;  // N/m

/// Bullet's springs with a constant for each link instead of two for all: T = k (l - l0), k taken from the link's material.
/// Damping is Bullet's own, along the spring.
class LinkSprings : public btDeformableMassSpringForce {
public:
    explicit LinkSprings(btScalar damping) : btDeformableMassSpringForce(structural, damping, true) {}

    void addScaledElasticForce(btScalar scale, TVStack& force) override {
        for_each_link([&](const btSoftBody::Link& link) {
            const btSoftBody::Node &a = *link.m_n[0], &b = *link.m_n[1];
            const btVector3 x = a.m_q - b.m_q;
            const btScalar length = x.length();
            if (length <= SIMD_EPSILON) return;
            const btVector3 f = x * (scale * link.m_material->m_kLST * (length - link.m_rl) / length);
            force[a.index] -= f;
            force[b.index] += f;
        });
    }

    /// df = -k (d d^T + (1 - l0/l) (I - d d^T)) (dx_a - dx_b), exact: Bullet's own Hessian is not made definite either.
    void addScaledElasticForceDifferential(btScalar scale, const TVStack& dx, TVStack& df) override {
        for_each_link([&](const btSoftBody::Link& link) {
            const btSoftBody::Node &a = *link.m_n[0], &b = *link.m_n[1];
            const btVector3 x = a.m_q - b.m_q;
            const btScalar squared = x.length2();
            if (squared <= SIMD_EPSILON * SIMD_EPSILON) return;
            const btVector3 change = dx[a.index] - dx[b.index];
            const btScalar slack = link.m_rl / btSqrt(squared);
            const btVector3 f =
                scale * link.m_material->m_kLST * ((1.0 - slack) * change + slack * (x.dot(change) / squared) * x);
            df[a.index] -= f;
            df[b.index] += f;
        });
    }

    double totalElasticEnergy(btScalar) override {
        double energy = 0.0;
        for_each_link([&](const btSoftBody::Link& link) {
            const double stretch = (link.m_n[0]->m_q - link.m_n[1]->m_q).length() - link.m_rl;
            energy += 0.5 * link.m_material->m_kLST * stretch * stretch;
        });
        return energy;
    }

private:
    template <class Visit>
    void for_each_link(Visit&& visit) const {
        for (int body = 0; body < m_softBodies.size(); ++body) {
            const btSoftBody& sheet = *m_softBodies[body];
            if (!sheet.isActive()) continue;
            for (int k = 0; k < sheet.m_links.size(); ++k) visit(sheet.m_links[k]);
        }
    }
};

/// A material of Bullet for each spring constant.
btSoftBody::Material* material_of(btSoftBody& sheet, double stiffness) {
    for (int k = 0; k < sheet.m_materials.size(); ++k) {
        if (sheet.m_materials[k]->m_kLST == stiffness) return sheet.m_materials[k];
    }
    btSoftBody::Material* material = sheet.appendMaterial();
    material->m_kLST = stiffness;
    return material;
}

/// The flat sheet with its springs; masses by quarter cells at 0.2 kg/m^2, two neighbouring corners without a mass, which pins
/// them.
std::unique_ptr<btSoftBody> make_sheet(int n, btSoftBodyWorldInfo& info) {
    std::vector<btVector3> places;
    std::vector<btScalar> masses;
    const auto half_at_border = [n](int i) { return i == 0 || i == n - 1 ? 0.5 : 1.0; };
    for (int i = 0; i < n * n; ++i) {
        places.emplace_back(-0.5 + (i % n) / (n - 1.0), 0.0, -0.5 + (i / n) / (n - 1.0));
        masses.push_back(0.2 / ((n - 1.0) * (n - 1.0)) * half_at_border(i % n) * half_at_border(i / n));
    }
    masses[0] = masses[static_cast<std::size_t>(n) - 1] = 0.0;
    auto sheet = std::make_unique<btSoftBody>(&info, n * n, places.data(), masses.data());
    for (const PlainSpring& s : plain_springs(n)) sheet->appendLink(s.a, s.b, material_of(*sheet, s.stiffness), false);
    sheet->setActivationState(DISABLE_DEACTIVATION);
    return sheet;
}

}  // namespace

struct BulletSheet::World {
    btSoftBodyRigidBodyCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btDeformableBodySolver solver;
    btDeformableMultiBodyConstraintSolver constraints;
    btDeformableMultiBodyDynamicsWorld world;
    btDeformableGravityForce gravity{btVector3(0.0, -9.81, 0.0)};
    LinkSprings springs{0.1};
    std::unique_ptr<btSoftBody> sheet;
    double time_step;

    World(int n, double dt, BulletForces forces)
        : world(&dispatcher, &broadphase, &constraints, &configuration, &solver), time_step(dt) {
        constraints.setDeformableSolver(&solver);
        world.setGravity(gravity.m_gravity);
        world.setImplicit(forces == BulletForces::implicit);
        // Conjugate gradient preconditioned by the mass; the solver for contacts with multipliers, Bullet's default, has no
        // preconditioner for implicit forces and then leaves the sheet where it is.
        world.setUseProjection(true);
        sheet = make_sheet(n, world.getWorldInfo());
        world.addSoftBody(sheet.get());
        world.addForce(sheet.get(), &springs);
        world.addForce(sheet.get(), &gravity);
    }
    ~World() {
        world.removeSoftBodyForce(sheet.get());
        world.removeSoftBody(sheet.get());
    }
};

BulletSheet::BulletSheet(int n, double time_step, BulletForces forces) : world_(std::make_unique<World>(n, time_step, forces)) {}

BulletSheet::~BulletSheet() = default;

void BulletSheet::step() { world_->world.stepSimulation(world_->time_step, 1, world_->time_step); }

double BulletSheet::largest_strain() const {
    double largest = 0.0;
    const btSoftBody& sheet = *world_->sheet;
    for (int k = 0; k < sheet.m_links.size(); ++k) {
        const btSoftBody::Link& link = sheet.m_links[k];
        const double strain = (link.m_n[0]->m_x - link.m_n[1]->m_x).length() / link.m_rl - 1.0;
        if (!std::isfinite(strain)) return std::numeric_limits<double>::infinity();
        if (link.m_material->m_kLST == structural) largest = std::max(largest, strain);
    }
    return largest;
}

double BulletSheet::lowest() const {
    double lowest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < world_->sheet->m_nodes.size(); ++i) lowest = std::min<double>(lowest, world_->sheet->m_nodes[i].m_x.y());
    return lowest;
}

std::vector<Vec3> BulletSheet::positions() const {
    std::vector<Vec3> positions;
    for (int i = 0; i < world_->sheet->m_nodes.size(); ++i) {
        const btVector3& x = world_->sheet->m_nodes[i].m_x;
        positions.emplace_back(x.x(), x.y(), x.z());
    }
    return positions;
}

}  // namespace percale::test
