#include "engine/contact/penalty.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "engine/contact/contact_stiffness.h"
#include "engine/tolerances.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::penalty_test {
namespace {

constexpr double h = 0.005;

Eigen::Matrix3d full(const std::array<double, 6>& k) {
    Eigen::Matrix3d m;
    m << k[0], k[1], k[2], k[1], k[3], k[4], k[2], k[4], k[5];
    return m;
}

/// Constraints on a few vertices, with the data of their step.
struct FrictionContact {
    std::vector<double> mass, modulus, length;
    ContactConstraints constraints;
    ContactStep step;
    Vec3Arrays start_positions, positions, forces;
    FrictionStart start;
    ContactTerms terms;
    std::vector<ConstraintForce> constraint_forces;

    explicit FrictionContact(int vertices, double mass_each = 0.01)
        : mass(vertices, mass_each), modulus(vertices, 20.0), length(vertices, 0.01) {
        for (auto* vectors : {&start_positions, &positions, &forces}) vectors->resize(vertices);
        step = {.dt = 1.0 / 60.0, .obstacle_rate = 60.0, .gravity = 9.81};
    }

    void add_constraint(const std::array<int, 4>& vertex, const std::array<double, 4>& weight, const Vec3& direction,
                        double distance) {
        constraints.vertex.push_back(vertex);
        constraints.weight.push_back(weight);
        constraints.direction.push_back(direction);
        constraints.obstacle_point.push_back(Vec3::Zero());
        constraints.obstacle_displacement.push_back(Vec3::Zero());
        constraints.distance.push_back(distance);
        constraints.thickness.push_back(h);
        constraints.friction.push_back(0.0);
        constraints.mollifier.push_back(1.0);
        constraints.obstacle.push_back(0);
        constraints.feature.push_back(0);
    }

    void add_point(const Vec3& direction, double distance, double friction = 0.0) {
        add_constraint({0, -1, -1, -1}, {1, 0, 0, 0}, direction, distance);
        constraints.friction.back() = friction;
    }

    void evaluate() {
        step.mass = &mass;
        step.modulus = &modulus;
        step.length = &length;
        start.positions = &start_positions;
        step.friction = &start;
        forces.resize(static_cast<int>(mass.size()));
        add_contact(constraints, step, positions, forces, terms, constraint_forces);
    }
};

/// The friction on a single point with the normal force of its constraint.
struct Friction {
    double normal_force;
    Vec3 force;
    Eigen::Matrix3d block;  // kg
};

Friction friction_of(FrictionContact& contact) {
    contact.evaluate();
    const Vec3 n = contact.constraints.direction[0];
    const double normal = contact.constraint_forces[0].normal;
    REQUIRE(contact.terms.blocks.size() == 2);
    return {normal, contact.forces.at(0) - normal * n, full(contact.terms.blocks[1].k)};
}

double smallest_eigenvalue(const Eigen::Matrix3d& m) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace

TEST_CASE("The mollifier of a constraint scales its force and its matrix") {
    FrictionContact whole(1), part(1);
    for (FrictionContact* contact : {&whole, &part}) contact->add_point(Vec3(0, 1, 0), 0.8 * h);
    part.constraints.mollifier = {0.25};
    whole.evaluate();
    part.evaluate();
    CHECK(part.forces.at(0).y() == Approx(0.25 * whole.forces.at(0).y()));
    CHECK(part.terms.blocks.at(0).k[3] == Approx(0.25 * whole.terms.blocks.at(0).k[3]));
    CHECK(part.terms.energy == Approx(0.25 * whole.terms.energy));
}

TEST_CASE("The matrix of a vertex over flat cloth is as stiff as its force, however many faces and edges share it") {
    for (const int faces : {1, 2, 4}) {
        CAPTURE(faces);
        // Vertex 0 is over an edge or corner: faces count 1, the edges between them -1; below it, cloth that nothing is
        // subtracted from.
        FrictionContact contact(5);
        const Vec3 up(0, 1, 0);
        for (int k = 0; k < 2 * faces - 1; ++k) {
            contact.add_constraint({0, 1, 2, 3}, {1.0, -0.2, -0.3, -0.5}, up, 0.8 * h);
            contact.constraints.mollifier.back() = k < faces ? 1.0 : -1.0;
        }
        contact.add_constraint({0, 4, -1, -1}, {1.0, -1.0, 0.0, 0.0}, -up, 0.9 * h);
        for (int& obstacle : contact.constraints.obstacle) obstacle = -1;
        contact.evaluate();
        double above = 0.0;
        const auto& blocks = contact.terms.blocks;
        REQUIRE(blocks.size() == static_cast<std::size_t>(faces) + 1);
        for (int k = 0; k < faces; ++k) above += blocks[k].k[3];
        const double dt = contact.step.dt;
        CHECK(above == Approx(dt * dt * contact.constraint_forces.front().stiffness));
        CHECK(blocks.back().k[3] == Approx(dt * dt * contact.constraint_forces.back().stiffness));
    }
}

TEST_CASE("A constraint's stiffness is that of its vertices by weight, of two cloths in series, whatever the step is") {
    FrictionContact contact(4);
    contact.modulus = {5.0, 8.0, 3.0, 7.0};
    contact.mass = {0.1, 0.3, 0.2, 0.5};
    contact.length = {0.01, 0.02, 0.04, 0.03};
    const Vec3 n = Vec3(1.0, 2.0, -2.0) / 3.0;
    const auto force = [](const ContactStiffness& k) { return Approx(contact_potential(0.8 * h, h, k).slope).epsilon(1e-12); };
    for (const double dt : {1e-4, 1.0 / 60.0}) {
        contact.step.dt = dt;
        contact.constraints.clear();
        contact.add_constraint({0, 1, 2, -1}, {0.2, 0.5, 0.3, 0.0}, n, 0.8 * h);
        contact.evaluate();
        CHECK(contact.constraint_forces[0].normal == force(contact_stiffness({0.23 * 9.81, 5.9, 0.024}, h)));
        contact.constraints.clear();
        contact.add_constraint({0, 1, 2, 3}, {1.0, -0.2, -0.5, -0.3}, n, 0.8 * h);
        contact.constraints.obstacle[0] = -1;
        contact.evaluate();
        const ContactStiffness one = contact_stiffness({0.1 * 9.81, 5.0, 0.01}, h),
                               other = contact_stiffness({0.31 * 9.81, 5.2, 0.033}, h);
        CHECK(contact.constraint_forces[0].normal == force(in_series(one, other)));
    }
}

TEST_CASE("A constraint that is subtracted has the opposite force, energy and friction, and no matrix") {
    FrictionContact counted(4), subtracted(4);
    for (FrictionContact* contact : {&counted, &subtracted}) {
        contact->add_constraint({0, 1, 2, 3}, {1.0, -0.25, -0.25, -0.5}, Vec3(0, 1, 0), 0.8 * h);
        contact->constraints.obstacle[0] = -1;
        contact->constraints.friction[0] = 0.4;
        contact->positions.set(0, Vec3(1e-3, 0, 0));
    }
    subtracted.constraints.mollifier[0] = -1.0;
    counted.evaluate();
    subtracted.evaluate();
    for (int i = 0; i < 4; ++i) CHECK((counted.forces.at(i) + subtracted.forces.at(i)).norm() < 1e-15);
    CHECK(counted.forces.at(0).x() < 0.0);
    CHECK(subtracted.terms.energy == -counted.terms.energy);
    CHECK(subtracted.terms.blocks.empty());
}

TEST_CASE("A constraint's force is distributed by its weights and its energy counted once") {
    FrictionContact contact(4);
    const Vec3 n = Vec3(2.0, 1.0, 2.0) / 3.0;
    contact.add_constraint({3, 0, 2, -1}, {0.5, 0.3, 0.2, 0.0}, n, 0.7 * h);
    contact.add_constraint({1, -1, -1, -1}, {1.0, 0.0, 0.0, 0.0}, -n, 0.3 * h);
    contact.evaluate();
    const ContactStiffness stiffness = contact_stiffness({0.01 * 9.81, 20.0, 0.01}, h);
    const ContactPotential first = contact_potential(0.7 * h, h, stiffness), second = contact_potential(0.3 * h, h, stiffness);
    CHECK((contact.forces.at(3) - 0.5 * first.slope * n).norm() < 1e-14 * first.slope);
    CHECK((contact.forces.at(0) - 0.3 * first.slope * n).norm() < 1e-14 * first.slope);
    CHECK((contact.forces.at(2) - 0.2 * first.slope * n).norm() < 1e-14 * first.slope);
    CHECK((contact.forces.at(1) + second.slope * n).norm() < 1e-14 * second.slope);
    CHECK(contact.terms.energy == Approx(first.energy + second.energy).epsilon(1e-13));
    REQUIRE(contact.terms.blocks.size() == 2);
    CHECK(contact.terms.blocks[0].vertex == contact.constraints.vertex[0]);
    const Eigen::Matrix3d block = full(contact.terms.blocks[1].k);
    CHECK((block - contact.step.dt * contact.step.dt * second.curvature * n * n.transpose()).norm() < 1e-12 * block.norm());
}

TEST_CASE("Contact adds to the given forces and forgets the last call's terms") {
    FrictionContact contact(1);
    contact.add_point(Vec3(0, 1, 0), 0.6 * h);
    contact.evaluate();
    const double once = contact.forces.at(0).y(), energy = contact.terms.energy;
    add_contact(contact.constraints, contact.step, contact.positions, contact.forces, contact.terms, contact.constraint_forces);
    CHECK(contact.forces.at(0).y() == 2.0 * once);
    CHECK(contact.terms.energy == energy);
    CHECK(contact.terms.blocks.size() == 1);
}

TEST_CASE("Without friction a constraint pushes along its direction only") {
    Random random(6);
    FrictionContact contact(1);
    const Vec3 n = random.unit();
    contact.add_point(n, 0.6 * h);
    contact.positions.set(0, Vec3(0.3, 0.1, -2.0));
    contact.evaluate();
    CHECK(contact.terms.friction_contacts.all.empty());
    CHECK(contact.terms.blocks.size() == 1);
    CHECK((contact.forces.at(0) - n * n.dot(contact.forces.at(0))).norm() < 1e-14 * contact.forces.at(0).norm());
}

TEST_CASE("Friction opposes the slip over the step and stays below mu N") {
    Random random(7);
    for (int trial = 0; trial < 500; ++trial) {
        FrictionContact contact(1, random.decades(1e-4, 1e-1));
        const double mu = random.number(0.05, 2.0);
        const Vec3 n = random.unit();
        contact.add_point(n, random.number(0.1, 0.99) * h, mu);
        const std::vector<ObstacleMotion> obstacle_motions = {{.turn = Eigen::Matrix3d::Zero(), .shift = random.point(0.01)}};
        contact.start.obstacle_motions = obstacle_motions;
        contact.step.fraction = 1.0;
        const Vec3 way = random.unit() * random.decades(1e-7, 1e-1);
        contact.positions.set(0, way);
        const Vec3 relative = way - obstacle_motions[0].shift, slip = relative - n * n.dot(relative);
        const Friction friction = friction_of(contact);
        CAPTURE(trial, slip.norm());
        CHECK(friction.force.norm() <= mu * friction.normal_force * (1.0 + 1e-10));
        CHECK(std::abs(friction.force.dot(n)) <= 1e-10 * friction.normal_force);
        CHECK(friction.force.dot(slip) <= -(1.0 - 1e-6) * friction.force.norm() * slip.norm());
        CHECK(smallest_eigenvalue(friction.block) >= -1e-10 * friction.block.norm());
        if (slip.norm() > stick_threshold_ratio * h)
            CHECK(friction.force.norm() == Approx(mu * friction.normal_force).epsilon(1e-8));
    }
}

TEST_CASE("Within the stick threshold friction is a spring whose matrix is its stiffness") {
    FrictionContact contact(1);
    contact.add_point(Vec3(0, 1, 0), 0.7 * h, 0.4);
    for (const double ratio : {0.0, 0.01, 0.5, 0.999}) {
        contact.positions.set(0, Vec3(ratio * stick_threshold_ratio * h, 0.3, 0.0));
        const Friction friction = friction_of(contact);
        const double limit = 0.4 * friction.normal_force;
        CHECK(friction.force.x() == Approx(-limit * ratio).epsilon(1e-9).margin(1e-15));
        const double entry = contact.step.dt * contact.step.dt * limit / (stick_threshold_ratio * h);
        CHECK((friction.block - Eigen::Vector3d(entry, 0.0, entry).asDiagonal().toDenseMatrix()).norm() < 1e-12 * entry);
    }
}

TEST_CASE("The matrix leaves a sliding vertex free along its slip direction") {
    FrictionContact contact(1, 0.01);
    contact.add_point(Vec3(0, 1, 0), 0.999 * h, 0.3);
    contact.positions.set(0, Vec3(0.03, -0.002, 0.04));
    const Friction friction = friction_of(contact);
    const Vec3 slip = Vec3(0.6, 0.0, 0.8), across = Vec3(0.8, 0.0, -0.6);
    const double size = friction.block.norm();
    CHECK((friction.block * slip).norm() < 1e-10 * size);
    CHECK((friction.block * Vec3(0, 1, 0)).norm() < 1e-10 * size);
    const double limit = 0.3 * friction.normal_force;
    CHECK((friction.block * across - contact.step.dt * contact.step.dt * limit / 0.05 * across).norm() < 1e-10 * size);
}

TEST_CASE("The matrix holds a vertex that turns back, as long as it stays there, and lets it slide when it slips on") {
    FrictionContact contact(1);
    contact.add_point(Vec3(0, 1, 0), 0.999 * h, 0.3);
    const auto free_direction = [&](double slip) {
        contact.positions.set(0, Vec3(slip, 0.0, 0.0));
        return friction_of(contact).block(0, 0) < 1e-20;
    };
    REQUIRE(free_direction(0.02));
    FrictionContacts before = contact.terms.friction_contacts;
    contact.step.previous = &before;
    CHECK(free_direction(0.01));
    CHECK_FALSE(free_direction(-0.01));
    before = contact.terms.friction_contacts;
    CHECK_FALSE(free_direction(-0.01));
    CHECK(free_direction(-0.011));
}

TEST_CASE("At the first evaluation a vertex sticks if friction can stop it within the step") {
    FrictionContact contact(1, 0.01);
    contact.add_point(Vec3(0, 1, 0), 0.9 * h, 0.3);
    contact.positions.set(0, Vec3(1e-6, 0.0, 0.0));
    const double stopped = contact.step.dt * contact.step.dt * 0.3 * friction_of(contact).normal_force / 0.01;
    REQUIRE(stopped > 2.0 * stick_threshold_ratio * h);
    for (const double ratio : {0.9, 1.1}) {
        contact.positions.set(0, Vec3(ratio * stopped, 0.0, 0.0));
        CHECK((friction_of(contact).block(0, 0) > 0.0) == (ratio < 1.0));
    }
    // An old contact beyond the stick threshold has been sliding.
    const std::vector<StickAnchor> stick_anchors = {{0, 0, Vec3(stick_threshold_ratio * h, 0.0, 0.0)}};
    contact.start.stick_anchors = stick_anchors;
    contact.positions.set(0, Vec3(0.5 * stopped, 0.0, 0.0));
    CHECK(friction_of(contact).block(0, 0) < 1e-20);
}

TEST_CASE("Constraints with one obstacle add to one friction limit, those with two have one each") {
    FrictionContact contact(2);
    contact.add_constraint({0, 1, -1, -1}, {0.25, 0.75, 0, 0}, Vec3(0, 1, 0), 0.8 * h);
    contact.add_constraint({0, -1, -1, -1}, {1, 0, 0, 0}, Vec3(1, 0, 0), 0.9 * h);
    contact.constraints.friction = {0.5, 0.5};
    contact.evaluate();
    const double first = contact.constraint_forces[0].normal, second = contact.constraint_forces[1].normal;
    REQUIRE(contact.terms.friction_contacts.all.size() == 2);
    CHECK((contact.terms.friction_contacts.find(0, 0)->friction_limit - 0.5 * Vec3(second, 0.25 * first, 0.0)).norm() <
          1e-12 * first);
    CHECK((contact.terms.friction_contacts.find(1, 0)->friction_limit - 0.5 * Vec3(0.0, 0.75 * first, 0.0)).norm() <
          1e-12 * first);
    contact.constraints.obstacle = {0, 1};
    contact.evaluate();
    REQUIRE(contact.terms.friction_contacts.all.size() == 3);
    CHECK((contact.terms.friction_contacts.find(0, 1)->friction_limit - 0.5 * Vec3(second, 0.0, 0.0)).norm() < 1e-12 * first);
}

TEST_CASE("Both sides of a gap add to the friction limit of a vertex") {
    FrictionContact contact(1);
    contact.add_point(Vec3(0, 1, 0), 0.7 * h, 0.5);
    contact.add_point(Vec3(0, -1, 0), 0.7 * h, 0.5);
    contact.evaluate();
    const double force = contact.constraint_forces[0].normal;
    CHECK(contact.terms.friction_contacts.find(0, 0)->friction_limit.norm() == Approx(force).epsilon(1e-12));
}

TEST_CASE("Over a valley friction is that of what presses less what is subtracted, in whatever order they come") {
    const double opening = GENERATE(2.0, 1.0), turn = GENERATE(0.0, 0.05, -0.05);  // rad, of the normals apart: wide, and steep
    const auto normal = [&](double angle) { return Vec3(std::sin(angle + turn), std::cos(angle + turn), 0.0); };
    for (const bool subtracted_first : {false, true}) {
        FrictionContact contact(1);
        const auto add_valley_edge = [&] {
            contact.add_point(normal(0.0), 0.8 * h, 0.5);
            contact.constraints.mollifier.back() = -1.0;
        };
        if (subtracted_first) add_valley_edge();
        contact.add_point(normal(0.5 * (std::acos(-1.0) - opening)), 0.7 * h, 0.5);
        contact.add_point(normal(-0.5 * (std::acos(-1.0) - opening)), 0.7 * h, 0.5);
        if (!subtracted_first) add_valley_edge();
        contact.evaluate();
        double added = 0.0, sum = 0.0;
        for (const ConstraintForce& force : contact.constraint_forces) {
            added += std::max(force.normal, 0.0);
            sum += force.normal;
        }
        FrictionContact without(1);
        without.add_point(normal(0.5 * (std::acos(-1.0) - opening)), 0.7 * h, 0.5);
        without.add_point(normal(-0.5 * (std::acos(-1.0) - opening)), 0.7 * h, 0.5);
        without.evaluate();
        const Vec3 limit = contact.terms.friction_contacts.find(0, 0)->friction_limit,
                   unreduced = without.terms.friction_contacts.find(0, 0)->friction_limit;
        CHECK((limit - sum / added * unreduced).norm() < 1e-12 * unreduced.norm());
    }
}

TEST_CASE("The power of an obstacle is its force times its velocity, friction included") {
    FrictionContact contact(1);
    contact.add_point(Vec3(0, 1, 0), 0.6 * h);
    contact.constraints.obstacle_displacement[0] = Vec3(0.1, 0.002, 0.0);
    contact.evaluate();
    const double push = contact.forces.at(0).y();
    CHECK(contact.terms.obstacle_power == Approx(push * 0.002 * 60.0).epsilon(1e-12));
    contact.constraints.friction[0] = 0.5;
    const std::vector<ObstacleMotion> obstacle_motions = {{.turn = Eigen::Matrix3d::Zero(), .shift = Vec3(0.1, 0.002, 0.0)}};
    contact.start.obstacle_motions = obstacle_motions;
    contact.step.fraction = 1.0;
    contact.evaluate();
    CHECK(contact.forces.at(0).x() == Approx(0.5 * push).epsilon(1e-12));
    CHECK(contact.terms.obstacle_power == Approx((push * 0.002 + 0.5 * push * 0.1) * 60.0).epsilon(1e-12));
}

TEST_CASE("Between cloths forces cancel") {
    Random random(11);
    FrictionContact contact(4);
    for (const std::array<double, 4>& weight : {std::array{1.0, -0.2, -0.5, -0.3}, std::array{0.4, 0.6, -0.9, -0.1}}) {
        contact.constraints.clear();
        contact.add_constraint({0, 1, 2, 3}, weight, random.unit(), 0.6 * h);
        contact.constraints.obstacle[0] = -1;
        contact.constraints.friction[0] = 0.4;
        for (int i = 0; i < 4; ++i) contact.positions.set(i, contact.step.dt * random.point(2.0));
        contact.evaluate();
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 4; ++i) sum += contact.forces.at(i);
        CHECK(sum.norm() < 1e-13 * contact.forces.at(0).norm());
        CHECK(contact.terms.obstacle_power == 0.0);
    }
}

TEST_CASE("Friction between cloths opposes their relative velocity and ignores a common one") {
    FrictionContact contact(4);
    const Vec3 n(0, 1, 0), common(3.0, 0.7, -2.0);
    contact.add_constraint({0, 1, 2, 3}, {1.0, -0.25, -0.25, -0.5}, n, 0.8 * h);
    contact.constraints.obstacle[0] = -1;
    contact.constraints.friction[0] = 0.4;
    const FrictionContacts nothing_before;
    for (const bool first : {false, true}) {
        contact.step.previous = first ? nullptr : &nothing_before;
        for (int i = 0; i < 4; ++i) contact.positions.set(i, contact.step.dt * common);
        contact.evaluate();
        const double normal = contact.forces.at(0).y();
        CHECK((contact.forces.at(0) - normal * n).norm() < 1e-12 * normal);
        contact.positions.set(0, contact.step.dt * (common + Vec3(0.5, 0.1, 0.0)));
        contact.evaluate();
        const Vec3 friction = contact.forces.at(0) - normal * n;
        CHECK((friction - Vec3(-0.4 * normal, 0, 0)).norm() < 1e-12 * normal);
        CHECK((contact.forces.at(3) + 0.5 * contact.forces.at(0)).norm() < 1e-12 * normal);
    }
}

}  // namespace percale::test::penalty_test
