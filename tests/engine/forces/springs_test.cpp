#include "engine/forces/springs.h"

#include <Eigen/Dense>
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/forces/spring_jacobians.h"

namespace percale::test::springs_test {
namespace {

constexpr double dt = 1.0 / 60.0;

/// Force, energy and matrix of one spring between vertices 0 and 1 in a state.
struct Evaluated {
    double energy;
    Vec3 force;  // on vertex 0
    SpringBlock block;
};

struct OneSpring {
    ClothModel model;
    Vec3Arrays positions, velocities;

    OneSpring(const Vec3& x, const Vec3& v, const Link& link)
        : model(linked_masses({1.0, 1.0}, {link})),
          positions(to_vec3_arrays({x, Vec3::Zero()})),
          velocities(to_vec3_arrays({v, Vec3::Zero()})) {}

    Evaluated evaluate(DampingForm form = DampingForm::velocity) const {
        StepSprings springs;
        set_step_springs(compute, {model.adjacency, positions, form, dt}, springs);
        SpringTerms terms;
        Vec3Arrays forces;
        forces.resize(2);
        const double energy = evaluate_springs(compute, springs, {positions, velocities, dt}, true, forces, terms);
        CHECK(forces.at(1) == -forces.at(0));
        return {energy, forces.at(0), spring_block(model.adjacency, terms, 0)};
    }
};

Eigen::Matrix3d matrix_of(const SpringBlock& block) {
    return block.a * Eigen::Matrix3d::Identity() + block.w * block.w.transpose();
}

/// -ks (l - l0) d - kd (v . d) d
Vec3 damped_spring_force(const Vec3& x, const Vec3& v, const Link& link) {
    const Vec3 d = x.normalized();
    return -(link.stiffness * (x.norm() - link.rest_length) + link.damping * v.dot(d)) * d;
}

Eigen::Vector3d eigenvalues(const Eigen::Matrix3d& m) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues();
}

struct RandomNetwork {
    ClothModel model;
    Vec3Arrays positions, velocities;
    explicit RandomNetwork(unsigned seed, int count = 21) {
        Random random(seed);
        model = linked_masses(random_masses(random, count), random_links(random, count, 4 * count));
        positions = to_vec3_arrays(random_points(random, count, 0.7));
        velocities = to_vec3_arrays(random_points(random, count, 1.0));
    }
    Vec3Arrays forces(const StepSprings& springs) const {
        SpringTerms terms;
        Vec3Arrays result;
        result.resize(model.vertex_count());
        evaluate_springs(compute, springs, {positions, velocities, dt}, false, result, terms);
        return result;
    }
    double potential(const StepSprings& springs, const Vec3Arrays& at) const {
        SpringTerms terms;
        Vec3Arrays forces = at;
        return evaluate_springs(compute, springs, {at, velocities, dt}, false, forces, terms);
    }
};

}  // namespace

TEST_CASE("A spring pulls with ks times its stretch and kd times its rate of stretching") {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Vec3 x = random.point(1.0), v = random.point(2.0);
        const Link link{0, 1, random.number(0.1, 2.0), random.decades(1.0, 1e5), random.number(0.0, 5.0)};
        const Vec3 expected = damped_spring_force(x, v, link);
        CHECK((OneSpring(x, v, link).evaluate().force - expected).norm() <= 1e-12 * expected.norm() + 1e-12);
    }
}

TEST_CASE("Spring forces are minus the gradient of the elastic energy") {
    RandomNetwork network(2);
    network.velocities.resize(network.model.vertex_count());
    StepSprings springs;
    set_step_springs(compute, {network.model.adjacency, network.positions, DampingForm::velocity, dt}, springs);
    const Vec3Arrays forces = network.forces(springs);
    for (int i = 0; i < network.model.vertex_count(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3Arrays ahead = network.positions, behind = network.positions;
            ahead.add(i, 1e-6 * Vec3::Unit(axis));
            behind.add(i, -1e-6 * Vec3::Unit(axis));
            const double slope =
                (elastic_energy(network.model.springs, ahead) - elastic_energy(network.model.springs, behind)) / 2e-6;
            CHECK(slope == Approx(-forces.at(i)[axis]).epsilon(1e-6).margin(1e-3));
        }
    }
}

TEST_CASE("Damping as a length rate is an exact potential of the end positions") {
    RandomNetwork network(3);
    StepSprings springs;
    set_step_springs(compute, {network.model.adjacency, network.positions, DampingForm::length_rate, dt}, springs);
    const Vec3Arrays start = network.positions;
    Random random(4);
    for (int i = 0; i < network.model.vertex_count(); ++i) network.positions.add(i, random.point(0.05));
    const Vec3Arrays forces = network.forces(springs);
    for (int i = 0; i < network.model.vertex_count(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3Arrays ahead = network.positions, behind = network.positions;
            ahead.add(i, 1e-6 * Vec3::Unit(axis));
            behind.add(i, -1e-6 * Vec3::Unit(axis));
            const double slope = (network.potential(springs, ahead) - network.potential(springs, behind)) / 2e-6;
            CHECK(slope == Approx(-forces.at(i)[axis]).epsilon(1e-6).margin(1e-3));
        }
    }
}

TEST_CASE("Damping as a length rate pulls with ks (l - l0) + kd (l - l_n)/dt") {
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        const Vec3 start = random.unit() * random.number(0.2, 1.5), moved = start + random.point(0.05);
        const Link link{0, 1, random.number(0.2, 1.5), random.decades(1.0, 1e4), random.number(0.0, 2.0)};
        OneSpring spring(start, random.point(1.0), link);
        StepSprings springs;
        set_step_springs(compute, {spring.model.adjacency, spring.positions, DampingForm::length_rate, dt}, springs);
        spring.positions.set(0, moved);
        SpringTerms terms;
        Vec3Arrays forces;
        forces.resize(2);
        evaluate_springs(compute, springs, {spring.positions, spring.velocities, dt}, false, forces, terms);
        const double tension =
            link.stiffness * (moved.norm() - link.rest_length) + link.damping * (moved.norm() - start.norm()) / dt;
        CHECK((forces.at(0) + tension * moved.normalized()).norm() <= 1e-11 * (std::abs(tension) + link.stiffness));
    }
}

TEST_CASE("Exact spring Jacobians agree with finite differences, damping included") {
    Random random(7);
    for (int i = 0; i < 50; ++i) {
        const Vec3 x = random.unit() * random.number(0.3, 2.0), v = random.point(3.0);
        const Link link{0, 1, random.number(0.1, 2.0), random.decades(1.0, 1e4), random.number(0.0, 50.0)};
        const SpringJacobians jacobians = spring_jacobians(x, v, link.rest_length, link.stiffness, link.damping);
        Eigen::Matrix3d by_position, by_velocity;
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 e = 1e-6 * Vec3::Unit(axis);
            by_position.col(axis) = (damped_spring_force(x + e, v, link) - damped_spring_force(x - e, v, link)) / 2e-6;
            by_velocity.col(axis) = (damped_spring_force(x, v + e, link) - damped_spring_force(x, v - e, link)) / 2e-6;
        }
        CHECK((jacobians.by_position - by_position).norm() <= 1e-7 * (by_position.norm() + link.stiffness));
        CHECK((jacobians.by_velocity - by_velocity).norm() <= 1e-7 * (by_velocity.norm() + link.stiffness));
    }
}

TEST_CASE("Where a spring is stretched its matrix is exactly -dt^2 Jq - dt Jv") {
    Random random(8);
    for (int i = 0; i < 100; ++i) {
        const double l = random.number(0.3, 2.0);
        const Vec3 x = l * random.unit();
        // A velocity along the spring: damping then leaves Jq symmetric. It shortens the spring, but less than tension allows.
        const Link link{0, 1, random.number(0.3, 0.99) * l, random.decades(1.0, 1e4), random.number(0.0, 2.0)};
        const double tension = link.stiffness * (l - link.rest_length);
        const Vec3 v = -random.number(0.0, 0.9) * tension / std::max(link.damping, 1.0) * x / l;
        const SpringJacobians exact = spring_jacobians(x, v, link.rest_length, link.stiffness, link.damping);
        const Eigen::Matrix3d expected = -dt * dt * exact.by_position - dt * exact.by_velocity;
        // Blocks are held in single precision.
        CHECK((matrix_of(OneSpring(x, v, link).evaluate().block) - expected).norm() <= 1e-6 * expected.norm());
    }
}

TEST_CASE("A spring's matrix is positive semidefinite in every state and stiff along the spring") {
    Random random(9);
    int compressed = 0, capped = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3 x = random.unit() * random.decades(1e-6, 10.0), v = random.unit() * random.decades(1e-3, 1e3);
        const Link link{0, 1, random.number(0.1, 2.0), random.decades(1.0, 1e6), random.number(0.0, 5.0)};
        const Evaluated spring = OneSpring(x, v, link).evaluate();
        const Eigen::Matrix3d matrix = matrix_of(spring.block);
        const double along = dt * dt * link.stiffness + dt * link.damping;
        const Vec3 d = x.normalized();
        CHECK(eigenvalues(matrix)[0] >= -1e-14 * along);
        CHECK(eigenvalues(matrix)[2] <= along * (1.0 + 1e-6));
        CHECK((matrix * d - along * d).norm() <= 1e-6 * along);
        const double tension = -spring.force.dot(d);
        if (tension < 0.0) CHECK(spring.block.a == 0.0);
        compressed += tension < 0.0;
        capped += spring.block.a == static_cast<double>(static_cast<float>(along));
    }
    CHECK(compressed > 50);
    CHECK(capped > 20);
}

TEST_CASE("A spring of no length exerts no force and is stiff in every direction") {
    const Link link{0, 1, 0.5, 300.0, 2.0};
    for (const DampingForm form : {DampingForm::velocity, DampingForm::length_rate}) {
        const Evaluated spring = OneSpring(Vec3::Zero(), Vec3(1, 2, 3), link).evaluate(form);
        const double along = dt * dt * link.stiffness + dt * link.damping;
        CHECK(spring.force == Vec3::Zero());
        CHECK((matrix_of(spring.block) - along * Eigen::Matrix3d::Identity()).norm() <= 1e-6 * along);
    }
}

TEST_CASE("Forces and energy have the same bits with and without a matrix, which is unchanged unless requested") {
    for (const DampingForm form : {DampingForm::velocity, DampingForm::length_rate}) {
        const RandomNetwork network(13, 40);
        const Adjacency& adjacency = network.model.adjacency;
        StepSprings springs;
        set_step_springs(compute, {adjacency, network.positions, form, dt}, springs);
        SpringTerms terms;
        Vec3Arrays with, without;
        for (auto* forces : {&with, &without}) forces->resize(40);
        const double energy = evaluate_springs(compute, springs, {network.positions, network.velocities, dt}, true, with, terms);
        const SpringBlock before = spring_block(adjacency, terms, 7);
        CHECK(evaluate_springs(compute, springs, {network.positions, network.velocities, dt}, false, without, terms) == energy);
        CHECK(same_bits(with, without));
        evaluate_springs(compute, springs, {network.velocities, network.positions, dt}, false, without, terms);
        CHECK(spring_block(adjacency, terms, 7).w == before.w);
    }
}

TEST_CASE("The potential is the sum of 1/2 k (l - l_rest)^2, damping as a length rate included") {
    const RandomNetwork network(14, 33);
    const SpringNetwork& list = network.model.springs;
    for (const DampingForm form : {DampingForm::velocity, DampingForm::length_rate}) {
        StepSprings springs;
        set_step_springs(compute, {network.model.adjacency, network.positions, form, dt}, springs);
        double expected = 0.0;
        for (int k = 0; k < list.size(); ++k) {
            const double before = (network.positions.at(list.first[k]) - network.positions.at(list.second[k])).norm();
            const double after = (network.velocities.at(list.first[k]) - network.velocities.at(list.second[k])).norm();
            const double ks = list.stiffness[k], kr = form == DampingForm::velocity ? 0.0 : list.damping[k] / dt;
            const double rest = (ks * list.rest_length[k] + kr * before) / (ks + kr);
            expected += 0.5 * (ks + kr) * (after - rest) * (after - rest);
        }
        CHECK(network.potential(springs, network.velocities) == Approx(expected).epsilon(1e-12));
        if (form == DampingForm::velocity) {
            CHECK(elastic_energy(list, network.velocities) == Approx(expected).epsilon(1e-12));
        }
    }
}

TEST_CASE("Springs exert no net force and no net torque") {
    for (const DampingForm form : {DampingForm::velocity, DampingForm::length_rate}) {
        const RandomNetwork network(10, 40);
        StepSprings springs;
        set_step_springs(compute, {network.model.adjacency, network.positions, form, dt}, springs);
        const Vec3Arrays forces = network.forces(springs);
        Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
        double size = 0.0;
        for (int i = 0; i < 40; ++i) {
            sum += forces.at(i);
            torque += network.positions.at(i).cross(forces.at(i));
            size += forces.at(i).norm();
        }
        CHECK(sum.norm() <= 1e-13 * size);
        CHECK(torque.norm() <= 1e-13 * size);
    }
}

TEST_CASE("Forces are added to earlier values, each vertex getting the sum over its springs") {
    const RandomNetwork network(11, 29);
    const SpringNetwork& list = network.model.springs;
    StepSprings springs;
    set_step_springs(compute, {network.model.adjacency, network.positions, DampingForm::velocity, dt}, springs);
    std::vector<Vec3> expected(29, Vec3(1.0, 2.0, 3.0));
    double size = 0.0;
    for (int k = 0; k < list.size(); ++k) {
        const int i = list.first[k], j = list.second[k];
        const Link link{0, 1, list.rest_length[k], list.stiffness[k], list.damping[k]};
        const Vec3 x = network.positions.at(i) - network.positions.at(j), v = network.velocities.at(i) - network.velocities.at(j);
        const Vec3 force = damped_spring_force(x, v, link);
        expected[i] += force;
        expected[j] -= force;
        size += force.norm();
    }
    SpringTerms terms;
    Vec3Arrays forces = to_vec3_arrays(std::vector<Vec3>(29, Vec3(1.0, 2.0, 3.0)));
    evaluate_springs(compute, springs, {network.positions, network.velocities, dt}, false, forces, terms);
    CHECK(largest_difference(to_points(forces, 29), expected) <= 1e-13 * size);
}

TEST_CASE("Damping acts along springs only: a rigid motion is undamped, while ether drag would stop it") {
    RandomNetwork network(12);
    const Vec3 spin(0.7, -1.1, 2.0), drift(1.0, 2.0, 3.0);
    double drag_power = 0.0;
    for (int i = 0; i < network.model.vertex_count(); ++i) network.velocities.set(i, drift + spin.cross(network.positions.at(i)));
    SpringNetwork& list = network.model.springs;
    for (int k = 0; k < list.size(); ++k) {
        list.stiffness[k] = 0.0;
        const Vec3 v = network.velocities.at(list.first[k]) - network.velocities.at(list.second[k]);
        drag_power -= list.damping[k] * v.squaredNorm();
    }
    finish_model(network.model);
    StepSprings springs;
    set_step_springs(compute, {network.model.adjacency, network.positions, DampingForm::velocity, dt}, springs);
    const Vec3Arrays forces = network.forces(springs);
    double power = 0.0;
    for (int i = 0; i < network.model.vertex_count(); ++i) {
        CHECK(forces.at(i).norm() < 1e-13);
        power += forces.at(i).dot(network.velocities.at(i));
    }
    CHECK(drag_power < -10.0);
    CHECK(std::abs(power) < 1e-12);
}

TEST_CASE("The largest strain is that of structural springs, and zero if none is stretched") {
    ClothModel model = linked_masses({1, 1, 1}, {{0, 1, 1.0, 1.0, 0.0}, {1, 2, 2.0, 1.0, 0.0}, {0, 2, 0.1, 1.0, 0.0}});
    model.springs.kind[2] = SpringKind::bend;
    CHECK(largest_strain(model.springs, to_vec3_arrays({{0, 0, 0}, {1.25, 0, 0}, {1.25, 2.2, 0}})) ==
          Approx(0.25).epsilon(1e-14));
    CHECK(largest_strain(model.springs, to_vec3_arrays({{0, 0, 0}, {0.5, 0, 0}, {0.5, 1.0, 0}})) == 0.0);
}

TEST_CASE("A spring longer than a billion billion metres has diverged") {
    const Link link{0, 1, 1.0, 100.0, 0.1};
    for (const double length : {1e17, 0.99e18}) {
        const Evaluated large = OneSpring(Vec3(0.0, length, 0.0), Vec3::Zero(), link).evaluate();
        CHECK(large.force.y() == Approx(-100.0 * length));
    }
    for (const double length : {1.01e18, 1e200}) {
        StepSprings springs;
        const ClothModel model = linked_masses({1.0, 1.0}, {link});
        const Vec3Arrays places = to_vec3_arrays({Vec3(0.0, length, 0.0), Vec3::Zero()}),
                         velocities = to_vec3_arrays({Vec3::Zero(), Vec3::Zero()});
        set_step_springs(compute, {model.adjacency, places, DampingForm::velocity, dt}, springs);
        Vec3Arrays forces = velocities;
        SpringTerms terms;
        CHECK(std::isnan(evaluate_springs(compute, springs, {places, velocities, dt}, true, forces, terms)));
        CHECK(std::isnan(forces.at(0).y()));
    }
}

}  // namespace percale::test::springs_test
