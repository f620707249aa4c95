#include "engine/contact/contact_law.h"

#include <cmath>

#include "engine/contact/penalty.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::contact_law_test {
namespace {

constexpr double h = 0.005, dt = 1.0 / 120.0, rate = 60.0;

/// Vertices that end a move in contact with a moving obstacle or with each other.
struct Touching {
    static constexpr int count = 8;
    std::vector<double> mass = std::vector<double>(count, 0.01);
    std::vector<double> modulus = std::vector<double>(count, 20.0), length = std::vector<double>(count, 0.01);
    ContactConstraints constraints;
    Vec3Arrays start, end, forces;
    std::vector<ObstacleMotion> obstacle_motions;
    std::vector<StickAnchor> stick_anchors;
    ClothAnchors anchors;
    ContactTerms terms;
    std::vector<ConstraintForce> constraint_forces;

    explicit Touching(unsigned seed) {
        Random random(seed);
        std::vector<ClothAnchor> anchors_left;
        start = to_vec3_arrays(random_points(random, count, 2e-4));
        end = to_vec3_arrays(random_points(random, count, 2e-4));
        forces.resize(count);
        obstacle_motions = {{.shift = random.point(2e-4)}};
        for (int i = 0; i < count; i += 2) stick_anchors.push_back({i, 0, random.point(3e-5)});
        for (int i = 0; i < count; ++i) add_constraint(random, {i, (i + 3) % count, -1, -1}, {0.3, 0.7, 0.0, 0.0}, 0);
        for (int i = 0; i < 4; ++i) {
            add_constraint(random, {i, i + 4, -1, -1}, {1.0, -1.0, 0.0, 0.0}, -1);
            if (i % 2 == 0) {
                anchors_left.push_back({.vertex = constraints.vertex.back(),
                                        .weight = constraints.weight.back(),
                                        .normal = constraints.direction.back(),
                                        .stretch = random.point(3e-5)});
            }
        }
        anchors.set(anchors_left);
    }

    void add_constraint(Random& random, const std::array<int, 4>& vertex, const std::array<double, 4>& weight, int obstacle) {
        constraints.vertex.push_back(vertex);
        constraints.weight.push_back(weight);
        constraints.direction.push_back(random.unit());
        constraints.obstacle_point.push_back(Vec3::Zero());
        constraints.obstacle_displacement.push_back(obstacle < 0 ? Vec3(Vec3::Zero()) : obstacle_motions[0].shift);
        constraints.distance.push_back(random.number(0.2, 0.95) * h);
        constraints.thickness.push_back(h);
        constraints.friction.push_back(0.4);
        constraints.mollifier.push_back(1.0);
        constraints.obstacle.push_back(obstacle);
        constraints.feature.push_back(0);
    }

    ContactMove move() const {
        return {.constraints = constraints,
                .terms = terms,
                .constraint_forces = constraint_forces,
                .start = start,
                .end = end,
                .dt = dt,
                .obstacle_rate = rate};
    }

    ContactLoss loss() {
        const FrictionStart friction{.positions = &start,
                                     .fraction = 0.5,
                                     .stick_anchors = stick_anchors,
                                     .obstacle_motions = obstacle_motions,
                                     .cloth_anchors = &anchors};
        add_contact(constraints,
                    {.dt = dt,
                     .obstacle_rate = rate,
                     .fraction = 0.5 + dt * rate,
                     .mass = &mass,
                     .gravity = 9.81,
                     .modulus = &modulus,
                     .length = &length,
                     .friction = &friction},
                    end, forces, terms, constraint_forces);
        return PenaltyContact().loss(move(), 0.0);
    }
};

}  // namespace

TEST_CASE("The energy that contact takes from a move is its stored energy, its losses and the work of obstacles") {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        Touching touching(seed);
        const ContactLoss loss = touching.loss();
        double given = 0.0;
        for (int i = 0; i < Touching::count; ++i) {
            given += touching.forces.at(i).dot(touching.end.at(i) - touching.start.at(i));
        }
        const double springs =
            stick_energy(touching.terms.friction_contacts) + stick_energy(touching.terms.cloth_friction_contacts);
        const double energy = touching.terms.energy + springs;
        const double work = dt * touching.terms.obstacle_power;
        CAPTURE(seed, given, energy, work);
        CHECK(work - given == Approx(energy + loss.contact + loss.friction + loss.integrator).epsilon(1e-10));
        CHECK(loss.friction > 0.0);
        CHECK(loss.integrator > 0.0);
        CHECK(loss.contact <= 0.0);  // energy that the constraints of the end would have stored at the start
    }
}

TEST_CASE("A friction contact that slides steadily loses the friction force times its path") {
    const double friction_limit = 2.0, stick_threshold = 5e-5, path = 3e-4;
    Touching touching(1);
    touching.constraints.clear();
    touching.start.set(0, Vec3::Zero());
    touching.end.set(0, Vec3(path, 0, 0));
    FrictionContact friction_contact;
    friction_contact.vertex = friction_contact.obstacle = 0;
    friction_contact.friction_limit = Vec3(0, friction_limit, 0);
    friction_contact.stick_threshold = stick_threshold;
    friction_contact.slip = Vec3(stick_threshold + path, 0, 0);
    touching.terms.friction_contacts.all = {friction_contact};
    const ContactLoss loss = PenaltyContact().loss(touching.move(), 0.0);
    CHECK(loss.friction == Approx(friction_limit * path).epsilon(1e-12));
    CHECK(std::abs(loss.integrator) < 1e-15);
    CHECK(-loss.contact == Approx(0.5 * friction_limit * stick_threshold).epsilon(1e-12));
    CHECK(stick_energy(touching.terms.friction_contacts) == Approx(0.5 * friction_limit * stick_threshold).epsilon(1e-12));
}

TEST_CASE("A constraint is moved back by the displacement of the cloth relative to the obstacle") {
    Touching touching(2);
    const Vec3 here = relative_move(touching.move(), 0);
    const auto [i, j, unused_a, unused_b] = touching.constraints.vertex[0];
    const Vec3 cloth = 0.3 * (touching.end.at(i) - touching.start.at(i)) + 0.7 * (touching.end.at(j) - touching.start.at(j));
    CHECK((here - (cloth - dt * rate * touching.obstacle_motions[0].shift)).norm() < 1e-18);
}

}  // namespace percale::test::contact_law_test
