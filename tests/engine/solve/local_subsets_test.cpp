#include "engine/solve/local_subsets.h"

#include <algorithm>
#include <numeric>

#include "tests/support/catch.h"
#include "tests/support/one_stage.h"
#include "tests/support/plane_scenes.h"

namespace percale::test::local_subsets_test {
namespace {

constexpr double h = 0.005;  // the sheet's thickness
constexpr int side = 15, middle = side * (side / 2) + side / 2;

/// A sheet that has come to rest on a plane.
SolverScene resting_sheet() {
    SolverScene scene = sheet_on_plane(0.0, 0.5, 0.8 * h, {}, side);
    run(scene, 60);
    return scene;
}

/// The first point of the stage, changed by `change(i)`, m/s.
template <class Change>
StageSearch start_of(OneStage& one, const ImplicitStage& stage, const Change& change) {
    StageSearch search(stage, one.warm_start, one.scene);
    search.evaluate();
    NewtonSpace& space = search.space;
    space.bodies.start(stage.scene.model);
    for (int i = 0; i < side * side; ++i) space.direction.velocity.set(i, change(i));
    search.go(1.0);
    std::swap(space.current, space.trial);
    return search;
}

bool relax(StageSearch& search) {
    NewtonSpace& space = search.space;
    const TimeError error = time_error_of(search.equations.stage());
    return solve_subsets(search.equations, {error, space.bodies, space.system, space.direction, space.time}, space.subsets,
                         space.current, space.trial);
}

Vec3 shove_middle(int i) { return i == middle ? Vec3(0.3, -0.05, 0.0) : Vec3(Vec3::Zero()); }

double residual_square(const SolverScene& scene, const std::vector<int>& vertices) {
    double sum = 0.0;
    for (const int v : vertices) sum += square_at(scene.newton.current.residual, v) / scene.model.mass[v];
    return sum;
}

std::vector<int> all_vertices() {
    std::vector<int> all(side * side);
    std::iota(all.begin(), all.end(), 0);
    return all;
}

}  // namespace

TEST_CASE("The residual of a few vertices is solved with all others held") {
    OneStage one(resting_sheet());
    const ImplicitStage stage = one.stage();
    StageSearch search = start_of(one, stage, shove_middle);
    const Vec3Arrays before = one.scene.newton.current.positions;
    const double square = residual_square(one.scene, all_vertices());
    REQUIRE(relax(search));
    const std::vector<int>& subset = one.scene.newton.subsets.vertices;
    CHECK(subset.size() < 60);
    CHECK(std::count(subset.begin(), subset.end(), middle) == 1);
    CHECK(residual_square(one.scene, subset) < 0.01 * square);
    for (int i = 0; i < side * side; ++i) {
        const bool held = std::count(subset.begin(), subset.end(), i) == 0;
        if (held) REQUIRE(one.scene.newton.current.positions.at(i) == before.at(i));
    }
}

TEST_CASE("Prescribed vertices beside a subset do not belong to it") {
    OneStage one(resting_sheet());
    one.scene.pin(middle + 1);
    const ImplicitStage stage = one.stage();
    StageSearch search = start_of(one, stage, shove_middle);
    REQUIRE(relax(search));
    const std::vector<int>& subset = one.scene.newton.subsets.vertices;
    CHECK(std::count(subset.begin(), subset.end(), middle - 1) == 1);
    CHECK(std::count(subset.begin(), subset.end(), middle + 1) == 0);
}

TEST_CASE("Settled bodies are ignored") {
    OneStage one(resting_sheet());
    const ImplicitStage stage = one.stage();
    StageSearch search = start_of(one, stage, shove_middle);
    one.scene.newton.bodies.mark(stage.scene.model, [](const Body&) { return true; });
    one.scene.newton.bodies.settle_small();
    CHECK_FALSE(relax(search));
    one.scene.newton.bodies.start(stage.scene.model);
    CHECK(relax(search));
}

TEST_CASE("Nothing is done where the residual is spread") {
    OneStage one(resting_sheet());
    const ImplicitStage stage = one.stage();
    Random random(3);
    const auto shake = [&](int) { return Vec3(random.number(-0.1, 0.1), 0.0, random.number(-0.1, 0.1)); };
    StageSearch search = start_of(one, stage, shake);
    const Vec3Arrays before = one.scene.newton.current.positions;
    REQUIRE(one.scene.newton.current.constraints.size() > 0);
    CHECK_FALSE(relax(search));
    for (int i = 0; i < side * side; ++i) REQUIRE(one.scene.newton.current.positions.at(i) == before.at(i));
}

TEST_CASE("Nothing is done without contact") {
    OneStage one(resting_sheet());
    const ImplicitStage stage = one.stage();
    StageSearch search = start_of(one, stage, shove_middle);
    one.scene.newton.current.constraints.clear();
    CHECK_FALSE(relax(search));
}

TEST_CASE("Solves look for subsets from their ninth iteration on, shorter ones never") {
    SolverScene scene = sheet_on_plane(0.0, 0.5, 0.05, {}, side);
    Random random(5);
    for (int i = 0; i < side * side; ++i) scene.state.velocities.set(i, Vec3(3.0, -10.0, 0.0) + random.point(5.0));
    bool looked = false;
    for (int n = 0; n < 60 && !looked; ++n) {
        const NewtonReport report = scene.step_implicit();
        CAPTURE(n, report.newton_iterations);
        looked = !scene.newton.subsets.order.empty();
        REQUIRE((!looked || report.newton_iterations >= 8));
        REQUIRE((looked || report.newton_iterations <= 8));
    }
    CHECK(looked);
}

}  // namespace percale::test::local_subsets_test
