#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

// time_step = "auto": the error at the end against the requested error per second.

namespace percale::test::adaptive_steps_test {
namespace {

constexpr double duration = 0.5;

struct Run {
    std::vector<Vec3> positions;
    int parts = 0, rejected = 0;
};

Run run(Simulation& simulation, ClothId cloth, double time_step) {
    Run result;
    for (int n = 0; n < std::lround(duration / time_step); ++n) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        CHECK(report.smallest_dt <= report.largest_dt);
        result.parts += report.parts;
        result.rejected += report.rejected;
    }
    CHECK(simulation.time() == Approx(duration).epsilon(1e-12));
    result.positions = copy(simulation.positions(cloth));
    return result;
}

/// A sheet held at two corners.
Run hanging_sheet(const StepSettings& settings) {
    constexpr int side = 33;
    Simulation simulation(settings);
    const ClothId cloth = simulation.add_cloth(make_grid(1.0, 1.0, side, side), sheet_fabric());
    simulation.pin(cloth, 0);
    simulation.pin(cloth, side - 1);
    return run(simulation, cloth, settings.time_step);
}

/// A sheet held all round and stretched by a tenth, bulging.
Run taut_sheet(const StepSettings& settings) {
    constexpr int side = 9;
    Simulation simulation(settings);
    const TriangleMesh grid = make_grid(1.0, 1.0, side, side);
    const ClothId cloth = simulation.add_cloth(grid, sheet_fabric());
    std::vector<Vec3> places;
    for (const Vec3& x : grid.vertices) {
        const double bulge = std::cos(std::numbers::pi * x.x()) * std::cos(std::numbers::pi * x.z());
        places.emplace_back(1.1 * x.x(), 0.1 * bulge, 1.1 * x.z());
    }
    simulation.set_positions(cloth, places);
    for (int i = 0; i < side * side; ++i) {
        const int column = i % side, row = i / side;
        if (column % (side - 1) == 0 || row % (side - 1) == 0) simulation.pin(cloth, i);
    }
    return run(simulation, cloth, settings.time_step);
}

/// A sheet that slides down a slope of 20 degrees, beginning where contact carries it.
Run sliding_sheet(const StepSettings& settings) {
    const double angle = std::numbers::pi / 9.0;
    const Pose tilt{.translation = Vec3::Zero(), .rotation = {std::cos(0.5 * angle), 0.0, 0.0, -std::sin(0.5 * angle)}};
    Simulation simulation(settings, std::make_unique<PlaneDetector>());
    TriangleMesh grid = make_grid(0.2, 0.2, 5, 5);
    for (Vec3& x : grid.vertices) x = transform(tilt, Vec3(x + Vec3(0, 0.005 * (1.0 - std::sqrt(std::cos(angle) / 1500.0)), 0)));
    const ClothId cloth = simulation.add_cloth(grid, sheet_fabric());
    simulation.add_obstacle(make_plane(1.0), tilt, {.friction = 0.2});
    return run(simulation, cloth, settings.time_step);
}

double rms_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Errors over the requested ones.
void check_errors(const char* name, Run (*scene)(const StepSettings&), const std::vector<Vec3>& exact,
                  const std::vector<double>& tolerances) {
    std::printf("%-16s", name);
    for (const double tolerance : tolerances) {
        const Run result = scene({.adaptive = true, .tolerance = tolerance, .scheme = Scheme::tr_bdf2});
        const double ratio = rms_difference(result.positions, exact) / (tolerance * duration);
        std::printf("  %.0e: %.2f (%d steps, %d rejected)", tolerance, ratio, result.parts, result.rejected);
        CAPTURE(name, tolerance, ratio);
        CHECK(ratio < 3.0);
    }
    std::printf("\n");
}

}  // namespace

TEST_CASE("Adaptive steps pass an impact, however small the requested error is") {
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        StepSettings settings{.adaptive = true, .tolerance = tolerance, .scheme = Scheme::tr_bdf2};
        Simulation simulation(settings, std::make_unique<PlaneDetector>());
        simulation.add_obstacle(make_plane(1.0));
        const ClothId cloth = simulation.add_cloth(make_grid(0.3, 0.3, 5, 5), sheet_fabric(), {.translation = Vec3(0, 0.1, 0)});
        const Run impact = run(simulation, cloth, settings.time_step);
        CAPTURE(tolerance, impact.parts);
        CHECK(impact.parts < 20000);
        for (const Vec3& x : impact.positions) CHECK((x.y() > 0.0 && x.y() < 0.05));
    }
}

TEST_CASE("The error of adaptive TR-BDF2 is at most three times the requested one", "[law]") {
    const StepSettings fine{.time_step = 1e-4, .scheme = Scheme::rk4};
    check_errors("hanging sheet", hanging_sheet, hanging_sheet(fine).positions, {1e-2, 1e-3});
    check_errors("taut sheet", taut_sheet, taut_sheet(fine).positions, {1e-2, 1e-3, 1e-4});
}

TEST_CASE("Adaptive TR-BDF2 slides like steps a hundred times more exact", "[law]") {
    const Run exact = sliding_sheet({.adaptive = true, .tolerance = 1e-6, .scheme = Scheme::tr_bdf2});
    check_errors("sliding sheet", sliding_sheet, exact.positions, {1e-2, 1e-3});
}

}  // namespace percale::test::adaptive_steps_test
