// A gripper pulls a cloth over the edge of a table until it hangs free, and feels the force: first friction, at the end the
// weight. Prints the force along the way. Exit code 1 with a text where something fails.
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <vector>

#include "percale/detectors.h"
#include "percale/percale.h"

namespace {

constexpr double dt = 1.0 / 120.0, speed = 0.25;  // s, m/s
constexpr int columns = 19, rows = 13;

percale::Vec3 momentum(const percale::Simulation& simulation, percale::ClothId cloth) {
    percale::Vec3 sum = percale::Vec3::Zero();
    for (int i = 0; i < columns * rows; ++i) sum += simulation.masses(cloth)[i] * simulation.velocities(cloth)[i];
    return sum;
}

/// Fingers that hold vertices of a cloth and move them along.
struct Gripper {
    percale::ClothId cloth;
    std::vector<int> vertices;
    std::vector<percale::Vec3> grasp;  // m, where they were taken

    void close(percale::Simulation& simulation) {
        for (const int vertex : vertices) {
            grasp.push_back(simulation.positions(cloth)[vertex]);
            simulation.pin(cloth, vertex);
        }
    }
    void move_to(percale::Simulation& simulation, const percale::Vec3& way) const {
        for (std::size_t i = 0; i < vertices.size(); ++i) simulation.move_pin(cloth, vertices[i], grasp[i] + way);
    }
};

}  // namespace

int main() try {
    percale::Simulation simulation({.time_step = dt, .newton_tolerance = 1e-8}, percale::make_brute_force_detector());
    const percale::ObstacleId table = simulation.add_obstacle(
        percale::make_box({1.0, 0.1, 0.8}), {.translation = {0.0, -0.05, 0.0}}, {.friction = 0.3, .name = "table"});
    const percale::ClothId cloth =
        simulation.add_cloth(percale::make_grid(0.6, 0.4, columns, rows), {.springs = {.shear = 300.0, .bend = 2.0}},
                             {.translation = {0.0, 0.005, 0.0}});
    const auto step = [&] {
        const percale::StepReport report = simulation.step();
        if (!report.ok()) throw std::runtime_error(report.explanation());
    };
    for (int n = 0; n < 60; ++n) step();  // it lies down
    Gripper gripper{.cloth = cloth, .vertices = {}, .grasp = {}};
    for (int row = 4; row < 9; ++row) gripper.vertices.push_back(row * columns + columns - 1);
    gripper.close(simulation);
    const percale::Vec3 weight(0.0, -0.2 * 0.6 * 0.4 * 9.81, 0.0);  // N
    percale::Vec3 felt = percale::Vec3::Zero();                     // N s, since the last line
    for (int n = 1; n <= 480; ++n) {
        const percale::Vec3 before = momentum(simulation, cloth);
        const double way = speed * n * dt < 1.0 ? speed * n * dt : 1.0;  // m
        gripper.move_to(simulation, {way, 0.0, 0.0});
        step();
        // Newton's law for the cloth: dp/dt = gripper + weight + table.
        felt += momentum(simulation, cloth) - before - dt * weight + dt * simulation.force_on(table);
        if (n % 60 != 0) continue;
        std::printf("%.2f m: pulls %.3f N, lifts %.3f N, the table carries %.3f N\n", way, felt.x() / (60 * dt),
                    felt.y() / (60 * dt), 0.0 - simulation.force_on(table).y());
        felt.setZero();
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "gripper: %s\n", error.what());
    return 1;
}
