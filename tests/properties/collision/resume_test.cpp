#include <cmath>

#include "percale/detectors.h"
#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/resumable.h"

// Runs with obstacles and cloth against cloth, saved in the middle and resumed, on every tree.
namespace percale::test::resume_test {
namespace {

Fabric towel(bool self_contact = false) {
    return {.thickness = 0.01,
            .self_contact = self_contact,
            .friction = 0.3,
            .springs = {.structural = 300.0, .shear = 150.0, .bend = 3.0},
            .spring_damping = 0.05};
}

Simulation over_ball(const StepSettings& settings, const Backend& backend, const TriangleMesh& sheet) {
    Simulation simulation(settings, backend.make_detector());
    Fabric fabric = towel();
    if (!sheet.is_grid()) fabric.springs.shear = 0.0;
    simulation.add_cloth(sheet, fabric, {.translation = {0.02, 0.22, 0.01}});
    simulation.add_obstacle(make_sphere(0.2, 2), {}, {.friction = 0.4, .name = "ball"});
    simulation.add_obstacle(make_box({0.1, 0.1, 0.1}), {.translation = {0.4, 0.1, 0}}, {.friction = 0.2, .name = "box"});
    return simulation;
}

/// The ball rises, stands, turns and stands again; the box comes from far.
void move_ball(Simulation& simulation, int step) {
    const double rise = 0.003 * std::min(step, 10), turn = 0.05 * std::max(0, std::min(step, 25) - 15);
    simulation.move_obstacle({0}, {.translation = {0, rise, 0}, .rotation = {std::cos(turn / 2), 0, std::sin(turn / 2), 0}});
    if (step >= 12 && step < 20) simulation.move_obstacle({1}, {.translation = {0.4 - 0.01 * (step - 11), 0.1, 0}});
}

TriangleMesh free_sheet(int count) {
    TriangleMesh mesh = make_grid(0.5, 0.5, count, count);
    mesh.grid_columns = mesh.grid_rows = 0;
    return mesh;
}

std::vector<Resumable> obstacle_runs(const Backend& backend) {
    const TriangleMesh grid = make_grid(0.5, 0.5, 8, 8);
    const auto still = [](Simulation&, int) {};
    const StepSettings penalty{.measure = StepMeasures::ledger};
    const StepSettings projection{.contact_response = ContactResponse::projection, .measure = StepMeasures::ledger};
    const StepSettings adaptive{.adaptive = true, .tolerance = 1e-2, .scheme = Scheme::tr_bdf2, .measure = StepMeasures::all};
    const auto over = [&](const StepSettings& settings, const TriangleMesh& sheet) {
        return [=] { return over_ball(settings, backend, sheet); };
    };
    std::vector<Resumable> runs = {{"moving ball, penalty", over(penalty, grid), move_ball, 30},
                                   {"moving ball, projection", over(projection, grid), move_ball, 30}};
    if (backend.make_detector != backends().front().make_detector) return runs;
    runs.push_back({"still ball, penalty", over(penalty, grid), still, 30});
    runs.push_back({"still ball, projection", over(projection, grid), still, 30});
    runs.push_back({"moving ball, free mesh", over(penalty, free_sheet(8)), move_ball, 30});
    runs.push_back({"moving ball, nothing skipped", over({.skip = false}, grid), move_ball, 30});
    runs.push_back(
        {"moving ball, tr_bdf2", over({.scheme = Scheme::tr_bdf2, .measure = StepMeasures::all}, grid), move_ball, 30});
    runs.push_back({"moving ball, adaptive", over(adaptive, grid), move_ball, 24});
    return runs;
}

Simulation stack(const StepSettings& settings, const Backend& backend) {
    Simulation simulation(settings, backend.make_detector());
    simulation.add_cloth(make_grid(0.3, 0.3, 6, 6), towel(true), {.translation = {0, 0.012, 0}}, "lower");
    const Pose turned{.translation = {0.01, 0.03, 0.02}, .rotation = {std::cos(0.2), 0, std::sin(0.2), 0}};
    simulation.add_cloth(make_grid(0.3, 0.3, 6, 6), towel(true), turned, "upper");
    simulation.add_obstacle(make_box({0.2, 0.1, 0.2}), {.translation = {0, -0.05, 0}}, {.friction = 0.4, .name = "block"});
    return simulation;
}

std::vector<Resumable> stack_runs(const Backend& backend) {
    const StepSettings penalty{.measure = StepMeasures::all};
    const StepSettings projection{.contact_response = ContactResponse::projection, .measure = StepMeasures::all};
    return {{"stack, penalty", [=] { return stack(penalty, backend); }},
            {"stack, projection", [=] { return stack(projection, backend); }}};
}

}  // namespace

TEST_CASE("A resumed run over obstacles makes the same steps in every bit, on every tree", "[slow]") {
    for (const Backend& backend : backends()) {
        for (const Resumable& run : obstacle_runs(backend)) {
            CAPTURE(run.name, backend.name);
            CHECK(first_difference(run, {1, 13, 22}) == -1);
        }
    }
}

TEST_CASE("A resumed run of cloth on cloth makes the same steps in every bit, on every tree", "[slow]") {
    for (const Backend& backend : backends()) {
        for (const Resumable& run : stack_runs(backend)) {
            CAPTURE(run.name, backend.name);
            CHECK(first_difference(run, {1, 9, 20}) == -1);
        }
    }
}

TEST_CASE("A state saved on one tree is resumed on another") {
    Simulation first = over_ball({}, backends().front(), make_grid(0.5, 0.5, 9, 9));
    for (int n = 0; n < 20; ++n) first.step();
    Simulation second = over_ball({}, backends().back(), make_grid(0.5, 0.5, 9, 9));
    second.restore(first.save());
    for (int n = 0; n < 20; ++n) CHECK(first.step().contact_hash == second.step().contact_hash);
    CHECK(first.state_hash() == second.state_hash());
}

TEST_CASE("Cloth that was moved out of an obstacle before the start reports so where it is resumed") {
    const auto make = [] {
        Simulation simulation({.measure = StepMeasures::all}, make_brute_force_detector());
        simulation.add_cloth(make_grid(0.3, 0.3, 6, 6), towel(), {.translation = {0, 0.03, 0}}, "sheet");
        simulation.add_obstacle(make_box({0.1, 0.1, 0.1}), {}, {.friction = 0.4, .name = "block"});
        return simulation;
    };
    const Resumable run{"repaired", make, [](Simulation&, int) {}, 20};
    CHECK(first_difference(run, {0, 1, 10}) == -1);
    Simulation first = make(), second = make();
    first.step();
    second.restore(first.save());
    REQUIRE(second.start_repair().size() == first.start_repair().size());
    REQUIRE(first.start_repair().size() == 1);
    CHECK(second.start_repair()[0].vertices_moved == first.start_repair()[0].vertices_moved);
    CHECK(second.start_repair()[0].obstacle_name == "block");
}

}  // namespace percale::test::resume_test
