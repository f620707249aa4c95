#include <percale/detectors.h>
#include <percale/percale.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <utility>

namespace {

constexpr double radius = 0.3;  // m

/// Drops a cloth on a ball for half a second; gives the state's hash, or 0 if a step failed or a vertex is inside the ball.
std::uint64_t drape(std::unique_ptr<percale::ContactDetector> detector) {
    const percale::Fabric cotton{
        .area_density = 0.2, .thickness = 0.01, .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0}};
    percale::Simulation simulation({.time_step = 1.0 / 60.0}, std::move(detector));
    const percale::ClothId cloth =
        simulation.add_cloth(percale::make_grid(0.6, 0.6, 13, 13), cotton, {.translation = {0.0, 0.32, 0.0}});
    simulation.add_obstacle(percale::make_sphere(radius, 3));

    for (int frame = 0; frame < 30; ++frame) {
        const percale::StepReport report = simulation.step();
        if (!report.ok()) return report.explain(stderr), 0;
    }
    double lowest = 1.0, nearest = 1.0;
    for (const percale::Vec3& x : simulation.positions(cloth)) {
        nearest = std::min(nearest, x.norm());
        lowest = std::min(lowest, x.y());
    }
    std::printf("nearest to the ball's centre %g m, lowest vertex at %g m\n", nearest, lowest);
    const double flat_facets = 0.99;  // the ball is a polyhedron: its faces lie a little inside the sphere
    return nearest > flat_facets * radius && lowest < 0.3 ? simulation.state_hash() : 0;
}

}  // namespace

int main() {
    const std::uint64_t fcl = drape(percale::make_fcl_detector());
    const std::uint64_t brute_force = drape(percale::make_brute_force_detector());
    return fcl != 0 && fcl == brute_force ? 0 : 1;
}
