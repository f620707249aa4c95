#include "engine/contact/foreseen_rows.h"

#include "engine/solve/direction.h"
#include "tests/support/plane_scenes.h"

namespace percale::test::foreseen_rows_test {
namespace {

constexpr double thickness = 0.005;  // m, of the sheet

/// A stage of a flat sheet above a plane; its first point is where the stage begins.
struct Landing {
    SolverScene scene;
    ContactMemory memory;
    std::unique_ptr<ImplicitStage> stage;
    std::unique_ptr<StageEquations> equations;

    Landing(double height, const StepSettings& settings) : scene(sheet_on_plane(0.0, 0.0, height, settings)) {
        scene.before = scene.state;
        set_euler_base(scene.before, scene.settings.time_step, scene.base);
        stage = std::make_unique<ImplicitStage>(
            ImplicitStage{.scene = scene, .base = scene.base, .start = scene.before, .targets = scene.targets});
        equations = std::make_unique<StageEquations>(*stage, memory, scene.newton, scene.stages);
        equations->predict();
        equations->evaluate(scene.newton.current);
    }
    /// space.trial: the whole of a direction.
    void go(const Vec3& direction) {
        scene.newton.direction.resize(scene.model.vertex_count());
        for (int i = 0; i < scene.model.vertex_count(); ++i) scene.newton.direction.set(i, direction);
        equations->aim(1.0);
        equations->evaluate(scene.newton.trial);
    }
    double foresee(ForeseenRows& found) {
        const NewtonSpace& space = scene.newton;
        const StagePoint& trial = space.trial;
        return foresee_rows(space.current.contact.blocks,
                            {trial.rows, trial.row_forces, space.current.positions, space.direction, stage->base.h}, found);
    }
    double largest_residual() const {
        double largest = 0.0;
        for (int i = 0; i < scene.model.vertex_count(); ++i)
            largest = std::max(largest, scene.newton.trial.residual.at(i).norm());
        return largest;
    }
};

}  // namespace

TEST_CASE("Rows that a move comes upon are found with what they would pull with at its start") {
    Landing landing(1.1 * thickness, {.time_step = 0.01});
    landing.go(Vec3(0.0, -0.4 * thickness / 0.01, 0.0));  // to 0.7 of the thickness
    const NewtonSpace& space = landing.scene.newton;
    REQUIRE(space.current.rows.size() == 0);
    REQUIRE(space.trial.rows.size() == 16);
    ForeseenRows found;
    const double slope = landing.foresee(found);
    REQUIRE(found.blocks.size() == 16);
    REQUIRE(found.impulses.size() == 16);
    double expected = 0.0;
    for (std::size_t row = 0; row < 16; ++row) {
        const RowForce& force = space.trial.row_forces[row];
        CHECK(force.normal == Approx(0.3 * thickness * force.stiffness).epsilon(1e-9));
        CHECK(found.blocks[row].k[3] == Approx(0.01 * 0.01 * force.stiffness).epsilon(1e-9));
        CHECK((found.impulses[row] - Vec3(0.0, -0.01 * 0.1 * thickness * force.stiffness, 0.0)).norm() < 1e-9 * force.stiffness);
        expected += 0.01 * force.normal * 0.4 * thickness / 0.01;
    }
    CHECK(slope == Approx(expected).epsilon(1e-9));
}

TEST_CASE("Rows that push from the start on are not foreseen") {
    Landing landing(0.9 * thickness, {.time_step = 0.01});
    landing.go(Vec3(0.0, -0.1 * thickness / 0.01, 0.0));
    REQUIRE(landing.scene.newton.trial.rows.size() == 16);
    ForeseenRows found;
    CHECK(landing.foresee(found) == 0.0);
    CHECK(found.impulses.empty());
    CHECK(found.blocks.size() == landing.scene.newton.current.contact.blocks.size());
}

TEST_CASE("With foreseen rows in the matrix one direction ends where they hold the sheet") {
    // Gravity moves it by 1 mm, into the thickness.
    Landing landing(1.05 * thickness, {.time_step = 0.01});
    NewtonSpace& space = landing.scene.newton;
    const SolveTarget exact{.relative_residual = 1e-12};
    const auto residual_after = [&](const ForeseenRows* foreseen) {
        newton_direction(*landing.equations, exact, foreseen);
        landing.equations->aim(1.0);
        landing.equations->evaluate(space.trial);
        return landing.largest_residual();
    };
    const double passed_over = residual_after(nullptr);
    ForeseenRows found;
    landing.foresee(found);
    REQUIRE(found.impulses.size() == 16);
    CHECK(residual_after(&found) < 1e-9 * passed_over);
}

TEST_CASE("The limit of iterations counts directions that were found anew") {
    for (const int limit : {1, 2, 3}) {
        SolverScene scene = sheet_on_plane(0.0, 0.3, 1.2 * thickness, {.newton_iterations = limit});
        for (int n = 0; n < 20; ++n) CHECK(scene.step_implicit().newton_iterations <= limit);
    }
}

}  // namespace percale::test::foreseen_rows_test
