// Prints how time and memory grow with the number of vertices: a sheet hanging from two corners (or a garment from its top), from
// a thousand vertices to a quarter of a million, its first steps of 1/60 s. Each size runs in a process of its own, so that its
// peak of memory is known.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "percale/detectors.h"
#include "percale/simulation.h"
#include "tests/bench/bench_report.h"
#include "tests/support/bench_meshes.h"
#include "tests/support/bench_unit.h"

namespace {

using percale::TriangleMesh;
using percale::Vec3;
using percale::test::Figures;

/// The cost of one size; the child passes it to its parent as bytes.
struct Cost {
    double vertices = 0.0, ms = 0.0, least_ms = 0.0, prepare_ms = 0.0, newton = 0.0, linear = 0.0, bytes = 0.0;
    percale::StepStatus status = percale::StepStatus::ok;
    bool is_ok = false;
};

/// Peak of this process's memory so far, bytes.
double peak_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

struct MeshChoice {
    std::string kind;
    bool shuffle = false, self_contact = false;
};

/// A mesh of about n x n vertices.
TriangleMesh mesh_of(const std::string& kind, int n) {
    if (kind == "irregular") return percale::test::irregular_sheet(1.0, n * n);
    if (kind == "skirt") return percale::test::tube_skirt(n * n);
    if (kind == "shirt") return percale::test::t_shirt(n * n);
    return percale::make_grid(1.0, 1.0, n, n);
}

/// A sheet held by two corners, or a garment held by the two vertices nearest to the ends of its upper edge.
percale::Simulation make_scene(const MeshChoice& choice, int n) {
    TriangleMesh mesh = mesh_of(choice.kind, n);
    if (choice.shuffle) mesh = percale::test::shuffled(mesh);
    percale::Fabric fabric = percale::test::bench_fabric();
    if (!mesh.is_grid()) fabric.springs.shear = 0.0;
    fabric.self_contact = choice.self_contact;
    Vec3 low = mesh.vertices[0], high = low;
    for (const Vec3& x : mesh.vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    percale::Simulation simulation({}, percale::make_fcl_detector());
    const percale::ClothId cloth = simulation.add_cloth(mesh, fabric);
    simulation.pin(cloth, percale::test::nearest_vertex(mesh, Vec3(low.x(), high.y(), low.z())));
    simulation.pin(cloth, percale::test::nearest_vertex(mesh, Vec3(high.x(), high.y(), low.z())));
    return simulation;
}

void take_steps(percale::Simulation& simulation, int steps, Cost& cost) {
    double total = 0.0;
    cost.least_ms = 1e300;
    for (int i = 0; i < steps; ++i) {
        const double start = percale::test::cpu_seconds();
        const percale::StepReport report = simulation.step();
        const double ms = 1e3 * (percale::test::cpu_seconds() - start);
        cost.status = report.status;
        if (!report.ok()) return;
        total += ms;
        cost.least_ms = std::min(cost.least_ms, ms);
        cost.newton += static_cast<double>(report.newton_iterations) / steps;
        cost.linear += static_cast<double>(report.linear_iterations) / steps;
    }
    cost.ms = total / steps;
    cost.is_ok = true;
}

Cost run(const MeshChoice& choice, int n, int steps) {
    Cost cost;
    const double before = peak_bytes(), start = percale::test::cpu_seconds();
    percale::Simulation simulation = make_scene(choice, n);
    simulation.prepare();
    cost.prepare_ms = 1e3 * (percale::test::cpu_seconds() - start);
    cost.vertices = static_cast<double>(simulation.positions({0}).size());
    take_steps(simulation, steps, cost);
    cost.bytes = peak_bytes() - before;
    return cost;
}

/// `run` in a child process. Throws if the child died or a step failed.
Cost run_apart(const MeshChoice& choice, int n, int steps) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe to a child process");
    std::fflush(stdout);
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no child process");
    if (child == 0) {
        const Cost cost = run(choice, n, steps);
        _exit(write(ends[1], &cost, sizeof cost) == sizeof cost ? 0 : 1);
    }
    close(ends[1]);
    Cost cost;
    const bool whole = read(ends[0], &cost, sizeof cost) == sizeof cost;
    close(ends[0]);
    waitpid(child, nullptr, 0);
    if (!whole) throw std::runtime_error("N = " + std::to_string(n) + ": the measuring process died");
    if (!cost.is_ok) throw std::runtime_error("N = " + std::to_string(n) + ": a step ended as " + status_word(cost.status));
    return cost;
}

/// Slope of the least-squares line through (log x, log y): the exponent p of y = c x^p.
double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y) {
    const double count = static_cast<double>(x.size());
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double a = std::log(x[i]), b = std::log(y[i]);
        sx += a;
        sy += b;
        sxx += a * a;
        sxy += a * b;
    }
    return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

Figures row(const Cost& cost) {
    std::printf("%8.0f %10.2f %10.2f %12.3f %10.2f %7.1f %8.1f %8.0f\n", cost.vertices, cost.ms, cost.least_ms,
                1e3 * cost.ms / cost.vertices, cost.prepare_ms, cost.newton, cost.linear, cost.bytes / cost.vertices);
    return {{"vertices", cost.vertices},
            {"ms", cost.ms},
            {"least_ms", cost.least_ms},
            {"prepare_ms", cost.prepare_ms},
            {"newton", cost.newton},
            {"linear", cost.linear},
            {"bytes_per_vertex", cost.bytes / cost.vertices}};
}

Figures measure(const MeshChoice& choice, int largest, int steps) {
    std::printf("%8s %10s %10s %12s %10s %7s %8s %8s\n", "vertices", "ms/step", "least", "us/vertex", "prepare", "newton",
                "linear", "B/vertex");
    Figures rows = Figures::array();
    std::vector<double> vertices, ms;
    for (const int n : {33, 65, 129, 257, 513}) {
        if (n > largest) break;
        const Cost cost = run_apart(choice, n, steps);
        rows.push_back(row(cost));
        vertices.push_back(cost.vertices);
        ms.push_back(cost.ms);
    }
    Figures figures{{"mesh", choice.kind},
                    {"shuffled", choice.shuffle},
                    {"self_contact", choice.self_contact},
                    {"steps", steps},
                    {"rows", rows}};
    if (ms.size() > 1) {
        figures["exponent"] = fitted_exponent(vertices, ms);
        std::printf("time grows with the number of vertices to the power %.3f\n", figures["exponent"].get<double>());
    }
    return figures;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("How time and memory of a step grow with the number of vertices.", "percale_growth");
    int largest = 257, steps = 5;
    MeshChoice choice{.kind = "grid"};
    app.add_option("--largest", largest, "largest N of 33, 65, 129, 257, 513")->capture_default_str()->check(CLI::Range(33, 513));
    app.add_option("--steps", steps, "steps of each size")->capture_default_str()->check(CLI::Range(1, 100000));
    app.add_option("--mesh", choice.kind, "grid, irregular, skirt or shirt")
        ->capture_default_str()
        ->check(CLI::IsMember({"grid", "irregular", "skirt", "shirt"}));
    app.add_flag("--shuffle", choice.shuffle, "number the vertices at random (a grid becomes a free mesh)");
    app.add_flag("--self-contact", choice.self_contact, "the cloth meets itself");
    return percale::test::run_bench(app, argc, argv, [&] { return measure(choice, largest, steps); });
}
