#include "engine/forces/spring_loss.h"

#include <cmath>

#include "engine/forces/springs.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::spring_loss_test {
namespace {

constexpr double dt = 0.01;

/// Random springs that move from one random state to another.
struct MovingSprings {
    static constexpr int count = 20;
    ClothModel model;
    Vec3Arrays start, end, velocities;

    MovingSprings() {
        Random random(6);
        const std::vector<double> masses(count, 0.1);
        model = linked_masses(masses, random_links(random, count, 60));
        start = to_vec3_arrays(random_points(random, count, 1.0));
        end = to_vec3_arrays(random_points(random, count, 1.0));
        velocities = to_vec3_arrays(random_points(random, count, 3.0));
    }

    SpringMove move(const Vec3Arrays& at, DampingForm form) const {
        return {.start = start, .end = end, .positions = at, .velocities = velocities, .form = form, .dt = dt};
    }

    /// Work of the spring forces at a state over the move, J.
    double given(const Vec3Arrays& at, DampingForm form) const {
        StepSprings springs;
        set_step_springs(compute, {model.adjacency, start, form, dt}, springs);
        SpringTerms terms;
        Vec3Arrays forces;
        forces.resize(count);
        evaluate_springs(compute, springs, {at, velocities, dt}, false, forces, terms);
        double sum = 0.0;
        for (int i = 0; i < count; ++i) sum += forces.at(i).dot(end.at(i) - start.at(i));
        return sum;
    }
};

}  // namespace

TEST_CASE("The work that springs take over a move is their gain of energy and their loss") {
    const MovingSprings moving;
    const double gain = elastic_energy(moving.model.springs, moving.end) - elastic_energy(moving.model.springs, moving.start);
    for (const DampingForm form : {DampingForm::length_rate, DampingForm::velocity}) {
        // The length rate acts along the direction at the end.
        const Vec3Arrays& at = form == DampingForm::velocity ? moving.start : moving.end;
        const SpringLoss loss = spring_loss(moving.model.springs, moving.move(at, form));
        CHECK(-moving.given(at, form) == Approx(gain + loss.integrator + loss.material).epsilon(1e-12));
    }
}

TEST_CASE("A spring stretched along its line loses dt kd r^2, and the scheme half of ks times the square of the change") {
    const double stiffness = 30.0, damping = 0.7, change = 0.2;
    const ClothModel model = linked_masses({1.0, 1.0}, {{0, 1, 1.0, stiffness, damping}});
    const Vec3Arrays start = to_vec3_arrays({Vec3(1.1, 0, 0), Vec3::Zero()}),
                     end = to_vec3_arrays({Vec3(1.1 + change, 0, 0), Vec3::Zero()});
    const Vec3Arrays still = to_vec3_arrays({Vec3::Zero(), Vec3::Zero()});
    for (const Vec3Arrays* at : {&start, &end}) {
        const SpringLoss loss = spring_loss(model.springs, {start, end, *at, still, DampingForm::length_rate, dt});
        CHECK(loss.material == Approx(damping * change * change / dt).epsilon(1e-12));
        CHECK(loss.integrator == Approx((at == &end ? 0.5 : -0.5) * stiffness * change * change).epsilon(1e-12));
    }
}

TEST_CASE("A spring that turns without a change of length loses nothing to its damping") {
    const ClothModel model = linked_masses({1.0, 1.0}, {{0, 1, 0.8, 30.0, 0.7}});
    const Vec3Arrays start = to_vec3_arrays({Vec3(1, 0, 0), Vec3::Zero()}),
                     end = to_vec3_arrays({Vec3(0, 0.6, 0.8), Vec3::Zero()});
    const Vec3Arrays turning = to_vec3_arrays({Vec3(0, 5, 0), Vec3::Zero()});
    CHECK(spring_loss(model.springs, {start, end, end, turning, DampingForm::length_rate, dt}).material == 0.0);
    CHECK(spring_loss(model.springs, {start, end, start, turning, DampingForm::velocity, dt}).material == 0.0);
}

TEST_CASE("The dissipated power is that of the damping forces") {
    MovingSprings moving;
    for (double& stiffness : moving.model.springs.stiffness) stiffness = 0.0;
    finish_model(moving.model);
    moving.end = moving.start;
    add_scaled(moving.end, 1.0, moving.velocities);
    const double power =
        spring_loss(moving.model.springs, {moving.start, moving.end, moving.start, moving.velocities, DampingForm::velocity, dt})
            .material /
        dt;
    CHECK(power > 0.0);
    CHECK(-moving.given(moving.start, DampingForm::velocity) == Approx(power).epsilon(1e-12));
}

}  // namespace percale::test::spring_loss_test
