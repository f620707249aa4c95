#include "engine/forces/total_force.h"

#include "engine/forces/gravity.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::total_force_test {
namespace {

/// A crumpled moving sheet and its step springs.
struct Crumpled {
    ClothModel model = cloth_model(make_grid(1.0, 1.0, 6, 5), sheet_fabric());
    Vec3Arrays positions, velocities;
    StepSprings springs;
    ForceInput input;

    Crumpled() {
        Random random(3);
        std::vector<Vec3> places = make_grid(1.0, 1.0, 6, 5).vertices;
        for (Vec3& x : places) x += random.point(0.05);
        positions = to_vec3_arrays(places);
        velocities = to_vec3_arrays(random_points(random, 30, 1.0));
        set_step_springs(compute, {model.adjacency, positions, DampingForm::velocity, 0.01}, springs);
        input = {.compute = &compute,
                 .model = &model,
                 .springs = &springs,
                 .positions = &positions,
                 .velocities = &velocities,
                 .gravity = Vec3(1.0, -9.81, 0.0),
                 .dt = 0.01,
                 .with_matrix = true};
    }
};

}  // namespace

TEST_CASE("The total force is gravity and springs, the potential the sum of theirs") {
    const Crumpled sheet;
    Forces forces;
    evaluate_forces(sheet.input, forces);
    Vec3Arrays expected;
    expected.resize(30);
    set_gravity_forces(compute, sheet.model.mass, sheet.input.gravity, expected);
    SpringTerms terms;
    const double springs =
        evaluate_springs(compute, sheet.springs, {sheet.positions, sheet.velocities, 0.01}, true, expected, terms);
    CHECK(same_bits(forces.total, expected));
    CHECK(forces.potential ==
          Approx(springs + gravity_energy(compute, sheet.model.mass, sheet.input.gravity, sheet.positions)).epsilon(1e-14));
    for (int k = 0; k < sheet.model.springs.size(); ++k) {
        const SpringBlock block = spring_block(sheet.model.adjacency, forces.spring_terms, k);
        const SpringBlock alone = spring_block(sheet.model.adjacency, terms, k);
        CHECK((block.a == alone.a && block.w == alone.w));
    }
}

TEST_CASE("Evaluating twice gives the same bits") {
    const Crumpled sheet;
    Forces once, twice;
    evaluate_forces(sheet.input, once);
    evaluate_forces(sheet.input, twice);
    evaluate_forces(sheet.input, twice);
    CHECK(same_bits(once.total, twice.total));
    CHECK(once.potential == twice.potential);
}

}  // namespace percale::test::total_force_test
