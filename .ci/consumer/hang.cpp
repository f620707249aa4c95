#include <percale/percale.h>

#include <cstdio>

#include "engine/mesh.h"

// A towel held at two corners falls for a second: the corners stay, the middle sinks below them but not further than the cloth is
// long.
int main() {
    const host::Mesh held;
    const percale::Fabric towel{.area_density = 0.2, .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0}};
    percale::Simulation simulation({.time_step = 1.0 / 60.0});
    const percale::ClothId cloth = simulation.add_cloth(percale::make_grid(1.0, 1.0, 9, 9), towel);
    const int corners[] = {0, 8};
    for (int i = 0; i < held.corners; ++i) simulation.pin(cloth, corners[i]);

    for (int frame = 0; frame < 60; ++frame) {
        const percale::StepReport report = simulation.step();
        if (!report.ok()) return report.explain(stderr), 1;
    }
    const percale::Vec3 corner = simulation.positions(cloth)[0], free_corner = simulation.positions(cloth)[80];
    const bool corner_stayed = (corner - percale::Vec3(-0.5, 0.0, -0.5)).norm() == 0.0;
    const bool fell = free_corner.y() < -0.1 && free_corner.y() > -1.6;
    std::printf("pinned corner %g %g %g, free corner at height %g\n", corner.x(), corner.y(), corner.z(), free_corner.y());
    return corner_stayed && fell ? 0 : 1;
}
