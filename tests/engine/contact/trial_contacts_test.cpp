#include "engine/contact/trial_contacts.h"

#include <memory>

#include "tests/support/one_stage.h"
#include "tests/support/plane_scenes.h"

namespace percale::test::trial_contacts_test {
namespace {

constexpr double thickness = 0.005;  // m, of the sheet

/// A stage of a flat sheet above a plane; its first point is where the stage begins.
struct Landing {
    SolverScene scene;
    ContactWarmStart warm_start;
    std::unique_ptr<ImplicitStage> stage;
    std::unique_ptr<StageSearch> search;

    Landing(double height, const StepSettings& settings) : scene(sheet_on_plane(0.0, 0.0, height, settings)) {
        scene.before = scene.state;
        set_euler_base(scene.before, scene.settings.time_step, scene.base);
        stage = std::make_unique<ImplicitStage>(
            ImplicitStage{.scene = scene, .base = scene.base, .start = scene.before, .targets = scene.targets});
        search = std::make_unique<StageSearch>(*stage, warm_start, scene);
        search->evaluate();
    }
    /// space.trial is a full step along the direction.
    void go(const Vec3& direction) {
        Vec3Arrays& velocity = scene.newton.direction.velocity;
        velocity.resize(scene.model.vertex_count());
        for (int i = 0; i < scene.model.vertex_count(); ++i) velocity.set(i, direction);
        search->go(1.0);
    }
    double find(TrialContacts& found) {
        const NewtonSpace& space = scene.newton;
        const StagePoint& trial = space.trial;
        return find_trial_contacts(
            space.current.contact.blocks,
            {trial.constraints, trial.constraint_forces, space.current.positions, space.direction.velocity, stage->base.h},
            found);
    }
    double largest_residual() const {
        double largest = 0.0;
        for (int i = 0; i < scene.model.vertex_count(); ++i)
            largest = std::max(largest, scene.newton.trial.residual.at(i).norm());
        return largest;
    }
};

}  // namespace

TEST_CASE("Trial contacts of a move are found with the impulse by which they would pull at its start") {
    Landing landing(1.1 * thickness, {.time_step = 0.01});
    landing.go(Vec3(0.0, -0.4 * thickness / 0.01, 0.0));  // to 0.7 of the thickness
    const NewtonSpace& space = landing.scene.newton;
    REQUIRE(space.current.constraints.size() == 0);
    REQUIRE(space.trial.constraints.size() == 16);
    TrialContacts found;
    const double slope = landing.find(found);
    REQUIRE(found.blocks.size() == 16);
    REQUIRE(found.impulses.size() == 16);
    double expected = 0.0;
    for (std::size_t constraint = 0; constraint < 16; ++constraint) {
        const ConstraintForce& force = space.trial.constraint_forces[constraint];
        const double reach = force.normal / force.stiffness;  // of the tangent, from where the move ends
        CHECK(reach > 0.05 * thickness);
        CHECK(reach < 0.2 * thickness);
        CHECK(found.blocks[constraint].k[3] == Approx(0.01 * 0.01 * force.stiffness).epsilon(1e-9));
        CHECK((found.impulses[constraint] - Vec3(0.0, -0.01 * (0.4 * thickness - reach) * force.stiffness, 0.0)).norm() <
              1e-9 * force.stiffness);
        expected += 0.01 * force.normal * 0.4 * thickness / 0.01;
    }
    CHECK(slope == Approx(expected).epsilon(1e-9));
}

TEST_CASE("Constraints that push from the start on are no trial contacts") {
    Landing landing(0.9 * thickness, {.time_step = 0.01});
    landing.go(Vec3(0.0, -0.1 * thickness / 0.01, 0.0));
    REQUIRE(landing.scene.newton.trial.constraints.size() == 16);
    TrialContacts found;
    CHECK(landing.find(found) == 0.0);
    CHECK(found.impulses.empty());
    CHECK(found.blocks.size() == landing.scene.newton.current.contact.blocks.size());
}

TEST_CASE("With trial contacts in the matrix one direction ends where they hold the sheet") {
    // Gravity moves it by 1 mm, into the thickness.
    Landing landing(1.05 * thickness, {.time_step = 0.01});
    NewtonSpace& space = landing.scene.newton;
    const SolveTarget exact{.relative_residual = 1e-12};
    const auto residual_after = [&](const TrialContacts* trial_contacts) {
        space.system.find_direction(landing.search->equations, space.current, {space.bodies, exact, trial_contacts},
                                    space.direction);
        landing.search->go(1.0);
        return landing.largest_residual();
    };
    const double passed_over = residual_after(nullptr);
    TrialContacts found;
    landing.find(found);
    REQUIRE(found.impulses.size() == 16);
    CHECK(residual_after(&found) < 0.5 * passed_over);
}

TEST_CASE("The limit of iterations counts directions that are computed again with trial contacts") {
    for (const int limit : {1, 2, 3}) {
        SolverScene scene = sheet_on_plane(0.0, 0.3, 1.2 * thickness, {.newton_iterations = limit});
        for (int n = 0; n < 20; ++n) CHECK(scene.step_implicit().newton_iterations <= limit);
    }
}

}  // namespace percale::test::trial_contacts_test
