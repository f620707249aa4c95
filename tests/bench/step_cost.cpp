// Prints what a 1/60 s step costs on the scenes S1 (sheet hanging from two corners), S2 (sheet onto a sphere) and S3 (sheet
// onto a bunny scan, if there is one), by stage, in ms and in machine units U: one pass of a plain scalar force loop over an
// array of spring structs on the same machine in the same run. Usage: percale_step_cost [seconds simulated, default 2]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "percale/detectors.h"
#include "percale/simulation.h"
#include "scenes/mesh_import.h"
#include "tests/support/cpu_time.h"
#include "tests/support/real_meshes.h"

namespace {

using percale::Vec3;

struct PlainSpring {
    int a, b;
    double rest, stiffness, damping;
};

/// The springs of an N x N grid of 1 m as a plain list: structural, shear, bend.
std::vector<PlainSpring> plain_springs(int n) {
    std::vector<PlainSpring> springs;
    const double h = 1.0 / (n - 1);
    const int families[6][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 0}, {0, 2}};
    const double stiffness[6] = {1000, 1000, 500, 500, 10, 10};
    for (int family = 0; family < 6; ++family) {
        const auto [dx, dy] = families[family];
        for (int y = 0; y + dy < n; ++y) {
            for (int x = std::max(0, -dx); x < n - std::max(0, dx); ++x) {
                springs.push_back({y * n + x, (y + dy) * n + x + dx, h * std::hypot(dx, dy), stiffness[family], 0.1});
            }
        }
    }
    return springs;
}

/// CPU milliseconds of one pass, the least of many.
double machine_unit(int n) {
    const std::vector<PlainSpring> springs = plain_springs(n);
    std::vector<Vec3> positions, velocities(static_cast<std::size_t>(n) * n, Vec3(0.1, 0.2, 0.3)), forces(velocities.size());
    for (int i = 0; i < n * n; ++i) positions.emplace_back(1.01 * (i % n) / (n - 1), 0.0, 1.02 * (i / n) / (n - 1));
    double least = 1e300, sink = 0.0;
    for (int pass = 0; pass < 200; ++pass) {
        const double start = percale::test::cpu_seconds();
        std::fill(forces.begin(), forces.end(), Vec3(0, -9.81, 0));
        for (const PlainSpring& s : springs) {
            const Vec3 x = positions[s.a] - positions[s.b];
            const double length = x.norm();
            const Vec3 d = x / length;
            const Vec3 f = -(s.stiffness * (length - s.rest) + s.damping * (velocities[s.a] - velocities[s.b]).dot(d)) * d;
            forces[s.a] += f;
            forces[s.b] -= f;
        }
        least = std::min(least, percale::test::cpu_seconds() - start);
        sink += forces[static_cast<std::size_t>(pass)].x();
    }
    if (!std::isfinite(sink)) std::puts("the plain loop is broken");
    return 1e3 * least;
}

percale::Simulation make_scene(int n, const percale::TriangleMesh* body, double drop) {
    percale::Fabric fabric;
    fabric.springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0};
    percale::Simulation simulation({}, body ? percale::make_fcl_detector() : nullptr);
    const percale::ClothId cloth =
        simulation.add_cloth(percale::make_grid(1.0, 1.0, n, n), fabric, {.translation = {0.0, drop, 0.0}});
    if (body) {
        simulation.add_obstacle(*body);
    } else {
        simulation.pin(cloth, 0);
        simulation.pin(cloth, n - 1);
    }
    return simulation;
}

void report(const char* name, int n, percale::Simulation simulation, double seconds) {
    const int steps = static_cast<int>(std::lround(60.0 * seconds));
    percale::StageTimes stages;
    long newton = 0, linear = 0;
    double strain = 0.0;
    simulation.prepare();
    const double start = percale::test::cpu_seconds();
    for (int i = 0; i < steps; ++i) {
        const percale::StepReport step = simulation.step();
        if (!step.ok()) {
            step.explain(stdout);
            return;
        }
        stages += step.stages;
        newton += step.newton_iterations;
        linear += step.linear_iterations;
        strain = std::max(strain, step.largest_strain);
    }
    const double ms = 1e3 * (percale::test::cpu_seconds() - start) / steps, per = 1e3 / steps;
    std::printf("%-3s %4d %8.2f %7.0f  %7.2f %8.2f %6.2f %6.2f %7.2f %6.2f %8.2f  %6.1f %7.0f %7.1f\n", name, n, ms,
                ms / machine_unit(n), per * stages.refresh, per * stages.evaluate, per * stages.force, per * stages.setup,
                per * stages.solve, per * stages.cut, per * stages.measure, static_cast<double>(newton) / steps,
                static_cast<double>(linear) / steps, 100.0 * strain);
}

/// The bunny scan half a metre high, centred; no triangles where it is absent.
percale::TriangleMesh bunny() {
    const std::filesystem::path file = percale::test::real_mesh_folder() / "bunny00.off";
    if (!std::filesystem::exists(file)) return {};
    percale::TriangleMesh mesh = percale::scenes::import_mesh(file.string());
    Vec3 low = mesh.vertices[0], high = low;
    for (const Vec3& x : mesh.vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    for (Vec3& x : mesh.vertices) x = (x - 0.5 * (low + high)) * (0.5 / (high - low).maxCoeff());
    return mesh;
}

}  // namespace

int main(int argc, char** argv) {
    const double seconds = argc > 1 ? std::atof(argv[1]) : 2.0;
    if (!(seconds > 0.0)) {
        std::fprintf(stderr, "usage: percale_step_cost [seconds simulated > 0]\n");
        return 2;
    }
    const percale::TriangleMesh ball = percale::make_sphere(0.25, 4), scan = bunny();
    std::printf("%-3s %4s %8s %7s  %7s %8s %6s %6s %7s %6s %8s  %6s %7s %7s\n", "", "N", "ms/step", "U", "refresh", "evaluate",
                "force", "setup", "solve", "cut", "measure", "newton", "linear", "strain%");
    for (const int n : {33, 65}) {
        report("S1", n, make_scene(n, nullptr, 0.0), seconds);
        report("S2", n, make_scene(n, &ball, 0.6), seconds);
        if (!scan.triangles.empty()) report("S3", n, make_scene(n, &scan, 0.6), seconds);
    }
    if (scan.triangles.empty()) std::puts("S3 left out: no bunny00.off (PERCALE_REAL_MESHES names its folder)");
    return 0;
}
