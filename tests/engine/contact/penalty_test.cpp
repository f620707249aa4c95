#include "engine/contact/penalty.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

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

/// Rows against a few vertices with what a step knows of them.
struct Touch {
    std::vector<double> mass;
    DiagonalBlocks diagonal;
    ContactRows rows;
    ContactStep step;
    Vectors start_positions, positions, forces;
    FrictionStart start;
    ContactTerms terms;
    std::vector<RowForce> row_forces;

    explicit Touch(int vertices, double mass_each = 0.01) : mass(vertices, mass_each) {
        diagonal.resize(vertices);
        for (const int entry : {0, 3, 5}) set_diagonal(entry, std::vector<double>(vertices, mass_each));
        for (auto* vectors : {&start_positions, &positions, &forces}) vectors->resize(vertices);
        step = {.dt = 1.0 / 60.0, .obstacle_rate = 60.0, .gravity = Vec3(0, -9.81, 0)};
    }

    void set_diagonal(int entry, const std::vector<double>& values) {
        std::copy(values.begin(), values.end(), diagonal.data.begin() + static_cast<std::ptrdiff_t>(entry * diagonal.padded));
    }

    void add_row(const std::array<int, 4>& vertex, const std::array<double, 4>& weight, const Vec3& direction, double distance) {
        rows.vertex.push_back(vertex);
        rows.weight.push_back(weight);
        rows.direction.push_back(direction);
        rows.obstacle_point.push_back(Vec3::Zero());
        rows.obstacle_displacement.push_back(Vec3::Zero());
        rows.distance.push_back(distance);
        rows.thickness.push_back(h);
        rows.friction.push_back(0.0);
        rows.share.push_back(1.0);
        rows.obstacle.push_back(0);
        rows.feature.push_back(0);
    }

    void add_point(const Vec3& direction, double distance, double friction = 0.0) {
        add_row({0, -1, -1, -1}, {1, 0, 0, 0}, direction, distance);
        rows.friction.back() = friction;
    }

    void evaluate() {
        step.mass = &mass;
        step.diagonal = &diagonal;
        start.positions = &start_positions;
        step.friction = &start;
        forces.resize(static_cast<int>(mass.size()));
        add_contact(rows, step, positions, forces, terms, row_forces);
    }
};

/// The friction on a single point that presses with the normal force the row gives.
struct Friction {
    double normal_force;
    Vec3 force;
    Eigen::Matrix3d block;  // kg
};

Friction friction_of(Touch& touch) {
    touch.evaluate();
    const Vec3 n = touch.rows.direction[0];
    const ContactPotential potential = contact_potential(touch.rows.distance[0], h, touch.terms.largest_stiffness);
    REQUIRE(touch.terms.blocks.size() == 2);
    return {potential.slope, touch.forces.at(0) - potential.slope * n, full(touch.terms.blocks[1].k)};
}

double smallest_eigenvalue(const Eigen::Matrix3d& m) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace

TEST_CASE("A row that shares its contact with others takes its share of force and matrix") {
    Touch whole(1), part(1);
    for (Touch* touch : {&whole, &part}) touch->add_point(Vec3(0, 1, 0), 0.8 * h);
    part.rows.share = {0.25};
    whole.evaluate();
    part.evaluate();
    CHECK(part.forces.at(0).y() == Approx(0.25 * whole.forces.at(0).y()));
    CHECK(part.terms.blocks.at(0).k[3] == Approx(0.25 * whole.terms.blocks.at(0).k[3]));
    CHECK(part.terms.energy == Approx(0.25 * whole.terms.energy));
}

TEST_CASE("A row's stiffness is half of its share of the step matrix") {
    Touch touch(3, 0.01);
    touch.set_diagonal(0, {5.0, 6.0, 7.0});
    touch.set_diagonal(1, {1.0, -1.0, 0.5});
    touch.set_diagonal(2, {0.2, 0.3, -0.4});
    touch.set_diagonal(3, {4.0, 8.0, 9.0});
    touch.set_diagonal(4, {0.6, 0.1, 0.7});
    touch.set_diagonal(5, {3.0, 2.0, 5.0});
    const Vec3 n = Vec3(1.0, 2.0, -2.0) / 3.0;
    touch.add_row({0, 1, 2, -1}, {0.2, 0.5, 0.3, 0.0}, n, 0.8 * h);
    touch.evaluate();
    double inertia = 0.0;
    for (int i = 0; i < 3; ++i) {
        std::array<double, 6> block;
        for (int e = 0; e < 6; ++e) block[e] = touch.diagonal[e][i];
        inertia += touch.rows.weight[0][i] * n.dot(full(block) * n);
    }
    CHECK(touch.terms.largest_stiffness == Approx(0.5 * inertia * 3600.0).epsilon(1e-13));
}

TEST_CASE("A row is stiff enough to carry its weight at three quarters of the thickness") {
    Touch touch(1, 0.01);
    touch.step.dt = 1.0;  // so long that inertia asks for next to nothing
    touch.add_point(Vec3(0, 1, 0), 0.75 * h);
    touch.evaluate();
    CHECK(touch.terms.largest_stiffness == Approx(4.0 * 0.01 * 9.81 / h).epsilon(1e-13));
    CHECK(touch.forces.at(0).y() == Approx(0.01 * 9.81).epsilon(1e-12));
}

TEST_CASE("A row is stiff enough to carry at three quarters of the thickness what taut cloth presses with") {
    Touch touch(2);
    Vectors load;
    load.resize(2);
    for (const int vertex : {0, 1}) load.set(vertex, Vec3(7.0, -3.0, 0.0));
    touch.step.load = &load;
    touch.add_row({0, 1, -1, -1}, {0.5, 0.5, 0.0, 0.0}, Vec3(0, 1, 0), 0.75 * h);
    touch.evaluate();
    for (const int vertex : {0, 1}) CHECK(touch.forces.at(vertex).y() == Approx(3.0).epsilon(1e-12));
}

TEST_CASE("A row's force is spread by its weights and its energy counted once") {
    Touch touch(4);
    const Vec3 n = Vec3(2.0, 1.0, 2.0) / 3.0;
    touch.add_row({3, 0, 2, -1}, {0.5, 0.3, 0.2, 0.0}, n, 0.7 * h);
    touch.add_row({1, -1, -1, -1}, {1.0, 0.0, 0.0, 0.0}, -n, 0.3 * h);
    touch.evaluate();
    const ContactPotential first = contact_potential(0.7 * h, h, touch.terms.largest_stiffness);
    const ContactPotential second = contact_potential(0.3 * h, h, touch.terms.largest_stiffness);
    CHECK((touch.forces.at(3) - 0.5 * first.slope * n).norm() < 1e-14 * first.slope);
    CHECK((touch.forces.at(0) - 0.3 * first.slope * n).norm() < 1e-14 * first.slope);
    CHECK((touch.forces.at(2) - 0.2 * first.slope * n).norm() < 1e-14 * first.slope);
    CHECK((touch.forces.at(1) + second.slope * n).norm() < 1e-14 * second.slope);
    CHECK(touch.terms.energy == Approx(first.energy + second.energy).epsilon(1e-13));
    REQUIRE(touch.terms.blocks.size() == 2);
    CHECK(touch.terms.blocks[0].vertex == touch.rows.vertex[0]);
    const Eigen::Matrix3d block = full(touch.terms.blocks[1].k);
    CHECK((block - touch.step.dt * touch.step.dt * second.curvature * n * n.transpose()).norm() < 1e-12 * block.norm());
}

TEST_CASE("Contact adds to the forces that are there and forgets the last call's terms") {
    Touch touch(1);
    touch.add_point(Vec3(0, 1, 0), 0.6 * h);
    touch.evaluate();
    const double once = touch.forces.at(0).y(), energy = touch.terms.energy;
    add_contact(touch.rows, touch.step, touch.positions, touch.forces, touch.terms, touch.row_forces);
    CHECK(touch.forces.at(0).y() == 2.0 * once);
    CHECK(touch.terms.energy == energy);
    CHECK(touch.terms.blocks.size() == 1);
}

TEST_CASE("Without friction a row pushes along its direction only") {
    Random random(6);
    Touch touch(1);
    const Vec3 n = random.unit();
    touch.add_point(n, 0.6 * h);
    touch.positions.set(0, Vec3(0.3, 0.1, -2.0));
    touch.evaluate();
    CHECK(touch.terms.touches.all.empty());
    CHECK(touch.terms.blocks.size() == 1);
    CHECK((touch.forces.at(0) - n * n.dot(touch.forces.at(0))).norm() < 1e-14 * touch.forces.at(0).norm());
}

TEST_CASE("Friction opposes the slip over the step and stays below mu N") {
    Random random(7);
    for (int trial = 0; trial < 500; ++trial) {
        Touch touch(1, random.decades(1e-4, 1e-1));
        const double mu = random.number(0.05, 2.0);
        const Vec3 n = random.unit();
        touch.add_point(n, random.number(0.1, 0.99) * h, mu);
        const std::vector<ObstacleFlow> flows = {{.turn = Eigen::Matrix3d::Zero(), .shift = random.point(0.01)}};
        touch.start.flows = flows;
        touch.step.fraction = 1.0;
        const Vec3 way = random.unit() * random.decades(1e-7, 1e-1);
        touch.positions.set(0, way);
        const Vec3 relative = way - flows[0].shift, slip = relative - n * n.dot(relative);
        const Friction friction = friction_of(touch);
        CAPTURE(trial, slip.norm());
        CHECK(friction.force.norm() <= mu * friction.normal_force * (1.0 + 1e-10));
        CHECK(std::abs(friction.force.dot(n)) <= 1e-10 * friction.normal_force);
        CHECK(friction.force.dot(slip) <= -(1.0 - 1e-6) * friction.force.norm() * slip.norm());
        CHECK(smallest_eigenvalue(friction.block) >= -1e-10 * friction.block.norm());
        if (slip.norm() > stick_reach_share * h) CHECK(friction.force.norm() == Approx(mu * friction.normal_force).epsilon(1e-8));
    }
}

TEST_CASE("Within the reach friction is a spring whose matrix is its stiffness") {
    Touch touch(1);
    touch.add_point(Vec3(0, 1, 0), 0.7 * h, 0.4);
    for (const double share : {0.0, 0.01, 0.5, 0.999}) {
        touch.positions.set(0, Vec3(share * stick_reach_share * h, 0.3, 0.0));
        const Friction friction = friction_of(touch);
        const double limit = 0.4 * friction.normal_force;
        CHECK(friction.force.x() == Approx(-limit * share).epsilon(1e-9).margin(1e-15));
        const double entry = touch.step.dt * touch.step.dt * limit / (stick_reach_share * h);
        CHECK((friction.block - Eigen::Vector3d(entry, 0.0, entry).asDiagonal().toDenseMatrix()).norm() < 1e-12 * entry);
    }
}

TEST_CASE("A sliding vertex leaves its direction free in the matrix") {
    Touch touch(1, 0.01);
    touch.add_point(Vec3(0, 1, 0), 0.999 * h, 0.3);
    touch.positions.set(0, Vec3(0.03, -0.002, 0.04));
    const Friction friction = friction_of(touch);
    const Vec3 slip = Vec3(0.6, 0.0, 0.8), across = Vec3(0.8, 0.0, -0.6);
    const double size = friction.block.norm();
    CHECK((friction.block * slip).norm() < 1e-10 * size);
    CHECK((friction.block * Vec3(0, 1, 0)).norm() < 1e-10 * size);
    const double limit = 0.3 * friction.normal_force;
    CHECK((friction.block * across - touch.step.dt * touch.step.dt * limit / 0.05 * across).norm() < 1e-10 * size);
}

TEST_CASE("The matrix holds a vertex that turns back, as long as it stays there, and lets it slide when it slips on") {
    Touch touch(1);
    touch.add_point(Vec3(0, 1, 0), 0.999 * h, 0.3);
    const auto free_direction = [&](double slip) {
        touch.positions.set(0, Vec3(slip, 0.0, 0.0));
        return friction_of(touch).block(0, 0) < 1e-20;
    };
    REQUIRE(free_direction(0.02));
    Touches before = touch.terms.touches;
    touch.step.previous = &before;
    CHECK(free_direction(0.01));
    CHECK_FALSE(free_direction(-0.01));
    before = touch.terms.touches;
    CHECK_FALSE(free_direction(-0.01));
    CHECK(free_direction(-0.011));
}

TEST_CASE("At first sight a vertex is held if friction can stop it within the step") {
    Touch touch(1, 0.01);
    touch.add_point(Vec3(0, 1, 0), 0.9 * h, 0.3);
    touch.positions.set(0, Vec3(1e-6, 0.0, 0.0));
    const double stopped = touch.step.dt * touch.step.dt * 0.3 * friction_of(touch).normal_force / 0.01;
    REQUIRE(stopped > 2.0 * stick_reach_share * h);
    for (const double share : {0.9, 1.1}) {
        touch.positions.set(0, Vec3(share * stopped, 0.0, 0.0));
        CHECK((friction_of(touch).block(0, 0) > 0.0) == (share < 1.0));
    }
    // What held on before and is beyond the reach has been sliding.
    const std::vector<Grip> grips = {{0, 0, Vec3(stick_reach_share * h, 0.0, 0.0)}};
    touch.start.grips = grips;
    touch.positions.set(0, Vec3(0.5 * stopped, 0.0, 0.0));
    CHECK(friction_of(touch).block(0, 0) < 1e-20);
}

TEST_CASE("Rows of one obstacle press a vertex together, those of two apart") {
    Touch touch(2);
    touch.add_row({0, 1, -1, -1}, {0.25, 0.75, 0, 0}, Vec3(0, 1, 0), 0.8 * h);
    touch.add_row({0, -1, -1, -1}, {1, 0, 0, 0}, Vec3(1, 0, 0), 0.9 * h);
    touch.rows.friction = {0.5, 0.5};
    touch.evaluate();
    const double first = contact_potential(0.8 * h, h, touch.terms.largest_stiffness).slope;
    const double second = contact_potential(0.9 * h, h, touch.terms.largest_stiffness).slope;
    REQUIRE(touch.terms.touches.all.size() == 2);
    CHECK((touch.terms.touches.find(0, 0)->press - 0.5 * Vec3(second, 0.25 * first, 0.0)).norm() < 1e-12 * first);
    CHECK((touch.terms.touches.find(1, 0)->press - 0.5 * Vec3(0.0, 0.75 * first, 0.0)).norm() < 1e-12 * first);
    touch.rows.obstacle = {0, 1};
    touch.evaluate();
    REQUIRE(touch.terms.touches.all.size() == 3);
    CHECK((touch.terms.touches.find(0, 1)->press - 0.5 * Vec3(second, 0.0, 0.0)).norm() < 1e-12 * first);
}

TEST_CASE("Both sides of a gap press a vertex") {
    Touch touch(1);
    touch.add_point(Vec3(0, 1, 0), 0.7 * h, 0.5);
    touch.add_point(Vec3(0, -1, 0), 0.7 * h, 0.5);
    touch.evaluate();
    const double force = contact_potential(0.7 * h, h, touch.terms.largest_stiffness).slope;
    CHECK(touch.terms.touches.find(0, 0)->press.norm() == Approx(force).epsilon(1e-12));
}

TEST_CASE("The power of an obstacle is its force times its velocity, friction included") {
    Touch touch(1);
    touch.add_point(Vec3(0, 1, 0), 0.6 * h);
    touch.rows.obstacle_displacement[0] = Vec3(0.1, 0.002, 0.0);
    touch.evaluate();
    const double push = touch.forces.at(0).y();
    CHECK(touch.terms.obstacle_power == Approx(push * 0.002 * 60.0).epsilon(1e-12));
    touch.rows.friction[0] = 0.5;
    const std::vector<ObstacleFlow> flows = {{.turn = Eigen::Matrix3d::Zero(), .shift = Vec3(0.1, 0.002, 0.0)}};
    touch.start.flows = flows;
    touch.step.fraction = 1.0;
    touch.evaluate();
    CHECK(touch.forces.at(0).x() == Approx(0.5 * push).epsilon(1e-12));
    CHECK(touch.terms.obstacle_power == Approx((push * 0.002 + 0.5 * push * 0.1) * 60.0).epsilon(1e-12));
}

TEST_CASE("Between cloths the stiffness is that of both sides in series, and forces cancel") {
    Random random(11);
    Touch touch(4);
    const std::array<double, 4> a{5.0, 8.0, 3.0, 7.0};
    for (const int entry : {0, 3, 5}) touch.set_diagonal(entry, {a.begin(), a.end()});
    for (const std::array<double, 4>& weight : {std::array{1.0, -0.2, -0.5, -0.3}, std::array{0.4, 0.6, -0.9, -0.1}}) {
        touch.rows.clear();
        touch.add_row({0, 1, 2, 3}, weight, random.unit(), 0.6 * h);
        touch.rows.obstacle[0] = -1;
        touch.rows.friction[0] = 0.4;
        for (int i = 0; i < 4; ++i) touch.positions.set(i, touch.step.dt * random.point(2.0));
        touch.evaluate();
        double compliance = 0.0;
        for (int k = 0; k < 4; ++k) compliance += weight[k] * weight[k] / a[k];
        CHECK(touch.terms.largest_stiffness == Approx(0.5 * 3600.0 / compliance).epsilon(1e-12));
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 4; ++i) sum += touch.forces.at(i);
        CHECK(sum.norm() < 1e-13 * touch.forces.at(0).norm());
        CHECK(touch.terms.obstacle_power == 0.0);
    }
}

TEST_CASE("Friction between cloths opposes their relative velocity and knows no common one") {
    Touch touch(4);
    const Vec3 n(0, 1, 0), common(3.0, 0.7, -2.0);
    touch.add_row({0, 1, 2, 3}, {1.0, -0.25, -0.25, -0.5}, n, 0.8 * h);
    touch.rows.obstacle[0] = -1;
    touch.rows.friction[0] = 0.4;
    const Touches nothing_before;
    for (const bool first : {false, true}) {
        touch.step.previous = first ? nullptr : &nothing_before;
        for (int i = 0; i < 4; ++i) touch.positions.set(i, touch.step.dt * common);
        touch.evaluate();
        const double normal = touch.forces.at(0).y();
        CHECK((touch.forces.at(0) - normal * n).norm() < 1e-12 * normal);
        touch.positions.set(0, touch.step.dt * (common + Vec3(0.5, 0.1, 0.0)));
        touch.evaluate();
        const Vec3 friction = touch.forces.at(0) - normal * n;
        CHECK((friction - Vec3(-0.4 * normal, 0, 0)).norm() < 1e-12 * normal);
        CHECK((touch.forces.at(3) + 0.5 * touch.forces.at(0)).norm() < 1e-12 * normal);
    }
}

TEST_CASE("In a shorter step the masses make no stiffer contact than in the step that they are made for, springs do") {
    Touch touch(1);
    touch.add_point(Vec3(0, 1, 0), 0.7 * h);
    touch.step.gravity = Vec3::Zero();
    const auto stiffness_of = [&](double dt, double stiffness_dt, double elastic) {
        touch.step.dt = dt;
        touch.step.stiffness_dt = stiffness_dt;
        for (const int entry : {0, 3, 5}) touch.set_diagonal(entry, {0.01 + dt * dt * elastic});
        touch.evaluate();
        return touch.terms.largest_stiffness;
    };
    CHECK(stiffness_of(1e-3, 0.0, 0.0) == Approx(0.5 * 0.01 / 1e-6));
    CHECK(stiffness_of(1e-3, 1e-2, 0.0) == Approx(0.5 * 0.01 / 1e-4));
    CHECK(stiffness_of(1e-3, 1e-2, 300.0) == Approx(0.5 * (0.01 / 1e-4 + 300.0)));
    CHECK(stiffness_of(1e-2, 1e-3, 300.0) == Approx(0.5 * (0.01 / 1e-4 + 300.0)));
}

TEST_CASE("An obstacle that moves makes contact no stiffer than its speed asks for, however short the span") {
    Touch touch(1);
    touch.add_point(Vec3(0, 1, 0), 0.7 * h);
    touch.step.gravity = Vec3::Zero();
    touch.step.obstacle_rate = 100.0;  // steps of 0.01 s
    touch.step.stiffness_dt = 1e-2;
    const auto stiffness_of = [&](double dt, double moved) {
        touch.rows.obstacle_displacement[0] = Vec3(0, moved, 0);
        touch.step.dt = dt;
        for (const int entry : {0, 3, 5}) touch.set_diagonal(entry, {0.01});
        touch.evaluate();
        return touch.terms.largest_stiffness;
    };
    const double at_speed = 0.5 * 0.01 * std::pow(100.0 * 0.5 * h / (h / 12.0), 2);  // half the thickness in a step
    for (const double dt : {1e-5, 1e-7}) CHECK(stiffness_of(dt, 0.5 * h) == Approx(at_speed));
    CHECK(stiffness_of(1e-7, -0.5 * h) == Approx(at_speed));
    CHECK(stiffness_of(5e-3, 0.5 * h) == Approx(0.5 * 0.01 / 25e-6));
    CHECK(stiffness_of(1e-2, 0.5 * h) == Approx(0.5 * 0.01 / 1e-4));
    CHECK(stiffness_of(1e-7, 0.0) == Approx(0.5 * 0.01 / 1e-4));
}

}  // namespace percale::test::penalty_test
