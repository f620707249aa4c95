#include "engine/solve/rigid_mode_correction.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::rigid_mode_correction_test {
namespace {

/// Bodies of two masses each, of 1 and 2, 3 and 4 kg and so on, and a residual.
struct Bodies {
    static constexpr int count = 4;
    SolverScene scene;
    BodyStates states;
    Vec3Arrays residual, direction;
    RigidModeCorrection rigid_modes;

    Bodies() {
        std::vector<double> mass;
        std::vector<Link> links;
        for (int b = 0; b < count; ++b) {
            mass.insert(mass.end(), {2.0 * b + 1.0, 2.0 * b + 2.0});
            links.push_back({2 * b, 2 * b + 1, 1.0, 10.0, 0.0});
        }
        ClothModel model = linked_masses(mass, links);
        model.cloths.clear();
        for (int b = 0; b < count; ++b)
            model.cloths.push_back({.name = "pair", .first = 2 * b, .count = 2, .mass = 4.0 * b + 3.0});
        finish_model(model);
        Random random(3);
        scene = solver_scene(std::move(model), random_points(random, 2 * count, 1.0), {});
        states.start(scene.model);
        residual = to_vec3_arrays(random_points(random, 2 * count, 1.0));
        direction = to_vec3_arrays(random_points(random, 2 * count, 1.0));
    }

    static CoupledBlock against_obstacle(int vertex) { return {{vertex, vertex ^ 1, -1, -1}, {0.3, 0.7, 0, 0}, {}}; }
    static CoupledBlock between(int first, int second) { return {{first, second, -1, -1}, {1, -1, 0, 0}, {}}; }

    std::vector<int> open(const std::vector<CoupledBlock>& blocks, const OuterBlocks& outer = {}) {
        rigid_modes.find(scene, states, {{}, blocks}, outer);
        std::vector<int> found;
        rigid_modes.for_each_open(scene.model, [&](const Body& body) { found.push_back(body.first / 2); });
        return found;
    }

    /// sum m dv + sum r over some bodies.
    Vec3 missing(const std::vector<int>& bodies) const {
        Vec3 sum = Vec3::Zero();
        for (const int b : bodies) {
            for (const int i : {2 * b, 2 * b + 1}) sum += scene.model.mass[i] * direction.at(i) + residual.at(i);
        }
        return sum;
    }
};

}  // namespace

TEST_CASE("The translation of a body without contact, or in contact only with itself, is known") {
    Bodies bodies;
    CHECK(bodies.open({}).empty());
    CHECK(bodies.open({Bodies::between(0, 1), Bodies::between(7, 6)}).empty());
    CHECK(bodies.missing({2}).norm() > 0.1);
    bodies.rigid_modes.correct(bodies.scene.model, bodies.residual, bodies.direction);
    for (int b = 0; b < Bodies::count; ++b) CHECK(bodies.missing({b}).norm() < 1e-12);
}

TEST_CASE("The common translation of bodies in contact with each other is known, in whatever order they are found") {
    Bodies bodies;
    CHECK(bodies.open({Bodies::between(6, 3), Bodies::between(4, 7)}) == std::vector{1, 2, 3});
    const Vec3 relative = bodies.direction.at(2) - bodies.direction.at(7);
    bodies.rigid_modes.correct(bodies.scene.model, bodies.residual, bodies.direction);
    CHECK(bodies.missing({0}).norm() < 1e-12);
    CHECK(bodies.missing({1, 2, 3}).norm() < 1e-12);
    CHECK(bodies.missing({1}).norm() > 0.1);
    CHECK((bodies.direction.at(2) - bodies.direction.at(7) - relative).norm() < 1e-12);
}

TEST_CASE("Groups that meet later become one, also through contacts of two edges") {
    Bodies bodies;
    const CoupledBlock edges{{1, 0, 4, 5}, {0.5, 0.5, -0.25, -0.75}, {}};
    CHECK(bodies.open({Bodies::between(0, 2), Bodies::between(6, 5), edges}) == std::vector{0, 1, 2, 3});
    bodies.rigid_modes.correct(bodies.scene.model, bodies.residual, bodies.direction);
    CHECK(bodies.missing({0, 1, 2, 3}).norm() < 1e-12);
    CHECK(bodies.open({}).empty());
}

TEST_CASE("An outer block joins its bodies, and holds them where it acts on their translation") {
    Bodies bodies;
    OuterBlocks outer;
    const OuterBlocks::NewBlock block = outer.add(3);
    const Vec3 g(0.3, -0.1, 0.7);
    for (int k = 0; k < 3; ++k) block.vertex[k] = 2 * k;
    block.gradient[0] = 0.4 * g;
    block.gradient[1] = 0.6 * g;
    block.gradient[2] = -g;
    CHECK(bodies.open({}, outer) == std::vector{0, 1, 2});
    bodies.rigid_modes.correct(bodies.scene.model, bodies.residual, bodies.direction);
    CHECK(bodies.missing({0, 1, 2}).norm() < 1e-12);
    CHECK(bodies.missing({0}).norm() > 0.1);
    block.gradient[2] = -0.5 * g;
    const Vec3Arrays before = bodies.direction;
    CHECK(bodies.open({}, outer) == std::vector{0, 1, 2});
    bodies.rigid_modes.correct(bodies.scene.model, bodies.residual, bodies.direction);
    for (int i = 0; i < 6; ++i) CHECK(bodies.direction.at(i) == before.at(i));
    CHECK(bodies.missing({3}).norm() < 1e-12);
}

TEST_CASE("An obstacle holds bodies in contact with it and bodies in contact with those") {
    Bodies bodies;
    CHECK(bodies.open({Bodies::between(2, 5), Bodies::against_obstacle(4)}) == std::vector{1, 2});
    CHECK(bodies.open({Bodies::against_obstacle(4), Bodies::between(2, 5)}) == std::vector{1, 2});
    const Vec3Arrays before = bodies.direction;
    bodies.rigid_modes.correct(bodies.scene.model, bodies.residual, bodies.direction);
    for (const int i : {2, 3, 4, 5}) CHECK(bodies.direction.at(i) == before.at(i));
    CHECK(bodies.missing({0}).norm() < 1e-12);
    CHECK(bodies.missing({3}).norm() < 1e-12);
}

TEST_CASE("Pinned or settled bodies move by their own equations, and hold bodies in contact with them") {
    Bodies bodies;
    bodies.scene.pin(0);
    bodies.states.mark(bodies.scene.model, [](const Body& body) { return body.first == 2; });
    bodies.states.settle_small();
    CHECK(bodies.open({}).empty());
    CHECK(bodies.open({Bodies::between(1, 4), Bodies::between(3, 6)}) == std::vector{2, 3});
    const Vec3Arrays before = bodies.direction;
    bodies.rigid_modes.correct(bodies.scene.model, bodies.residual, bodies.direction);
    CHECK(same_bits(bodies.direction, before));
}

TEST_CASE("In wind no translation is known") {
    Bodies bodies;
    std::vector<CoupledBlock> drag;
    for (int i = 0; i < 2 * Bodies::count; ++i) drag.push_back({{i, -1, -1, -1}, {1, 0, 0, 0}, {}});
    CHECK(bodies.open(drag) == std::vector{0, 1, 2, 3});
    const Vec3Arrays before = bodies.direction;
    bodies.rigid_modes.correct(bodies.scene.model, bodies.residual, bodies.direction);
    CHECK(same_bits(bodies.direction, before));
}

}  // namespace percale::test::rigid_mode_correction_test
