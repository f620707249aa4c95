// Prints the cost of a 1/60 s step on the scenes S1 (sheet hanging from two corners), S2 (sheet onto a sphere), S3 (sheet onto a
// bunny scan, if there is one) and S4 (the same while the scan breathes: every vertex moves in every step), by stage, in ms and
// in machine units U: one pass of a plain scalar force loop over an array of spring structs on the same machine in the same run.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/bench/bench_report.h"
#include "tests/bench/scenes/bench_scenes.h"
#include "tests/support/bench_unit.h"

namespace {

using percale::test::Figures;
using percale::test::make_sheet_scene;

/// Sums over the steps of one run.
struct Cost {
    int steps = 0;
    double seconds = 0.0, strain = 0.0;
    long newton = 0, linear = 0;
    percale::StageTimes stages;
};

/// A body whose every vertex moves: it swells and shrinks by 2 % once a second, and bends as it does.
class Breathing {
public:
    explicit Breathing(const percale::TriangleMesh& mesh) : at_rest_(mesh.vertices), now_(mesh.vertices) {}

    std::span<const percale::Vec3> at(double time) {
        const double swell = 0.02 * std::sin(2.0 * std::numbers::pi * time);
        for (std::size_t i = 0; i < now_.size(); ++i) now_[i] = (1.0 + swell * (1.0 + at_rest_[i].y())) * at_rest_[i];
        return now_;
    }

private:
    std::vector<percale::Vec3> at_rest_, now_;
};

/// Throws if a step fails.
Cost run(percale::Simulation& simulation, int steps, Breathing* body) {
    Cost cost;
    cost.steps = steps;
    simulation.prepare();
    for (int i = 0; i < steps; ++i) {
        const std::span<const percale::Vec3> shape = body ? body->at((i + 1) / 60.0) : std::span<const percale::Vec3>();
        const double start = percale::test::cpu_seconds();
        if (body) simulation.deform_obstacle({0}, shape);
        const percale::StepReport step = simulation.step();
        cost.seconds += percale::test::cpu_seconds() - start;
        if (!step.ok()) throw std::runtime_error(step.explanation());
        cost.stages += step.stages;
        cost.newton += step.newton_iterations;
        cost.linear += step.linear_iterations;
        cost.strain = std::max(cost.strain, step.largest_strain);
    }
    return cost;
}

/// Sheet and body of a scene.
struct Bench {
    const char* scene;
    int n;
    const percale::TriangleMesh* obstacle = nullptr;
    bool breathes = false;
};

Figures figures_of(const Bench& bench, const Cost& cost) {
    const double ms = 1e3 * cost.seconds / cost.steps, per = 1e3 / cost.steps;
    const percale::StageTimes& stages = cost.stages;
    const double other =
        ms - per * percale::test::total(stages);  // includes the cost of a deforming body: setting its shape, refitting its tree
    Figures row = {{"scene", bench.scene},
                   {"n", bench.n},
                   {"ms", ms},
                   {"units", ms / percale::test::machine_unit(bench.n)},
                   {"refresh_ms", per * stages.refresh},
                   {"evaluate_ms", per * stages.evaluate},
                   {"force_ms", per * stages.force},
                   {"setup_ms", per * stages.setup},
                   {"solve_ms", per * stages.solve},
                   {"cut_ms", per * stages.cut},
                   {"measure_ms", per * stages.measure},
                   {"other_ms", other},
                   {"newton", static_cast<double>(cost.newton) / cost.steps},
                   {"linear", static_cast<double>(cost.linear) / cost.steps},
                   {"largest_strain", cost.strain}};
    if (bench.obstacle) {
        const auto triangles = static_cast<double>(bench.obstacle->triangles.size());
        row["refresh_and_other_ns_a_triangle"] = 1e6 * (per * stages.refresh + other) / triangles;
    }
    return row;
}

Figures report(const Bench& bench, percale::Simulation simulation, double seconds) {
    const int steps = std::max(1, static_cast<int>(std::lround(60.0 * seconds)));
    std::optional<Breathing> body;
    if (bench.breathes) body.emplace(*bench.obstacle);
    const Figures row = figures_of(bench, run(simulation, steps, body ? &*body : nullptr));
    const auto value = [&row](const char* key) { return row[key].get<double>(); };
    std::printf("%-3s %4d %8.2f %7.0f  %7.2f %8.2f %6.2f %6.2f %7.2f %6.2f %8.2f %6.2f  %6.1f %7.0f %7.1f\n", bench.scene,
                bench.n, value("ms"), value("units"), value("refresh_ms"), value("evaluate_ms"), value("force_ms"),
                value("setup_ms"), value("solve_ms"), value("cut_ms"), value("measure_ms"), value("other_ms"), value("newton"),
                value("linear"), 100.0 * value("largest_strain"));
    std::fflush(stdout);
    return row;
}

struct Wanted {
    std::vector<int> sizes{33, 65};
    std::vector<std::string> scenes{"S1", "S2", "S3", "S4"};
    double seconds = 2.0;
    percale::StepSettings settings{.measure = percale::StepMeasures::all};

    bool has(const char* scene) const { return std::find(scenes.begin(), scenes.end(), scene) != scenes.end(); }
};

Figures measure(const Wanted& wanted) {
    const percale::TriangleMesh ball = percale::make_sphere(0.25, 4), scan = percale::test::bunny_scan();
    std::printf("%-3s %4s %8s %7s  %7s %8s %6s %6s %7s %6s %8s %6s  %6s %7s %7s\n", "", "N", "ms/step", "U", "refresh",
                "evaluate", "force", "setup", "solve", "cut", "measure", "other", "newton", "linear", "strain%");
    Figures rows = Figures::array();
    const bool scanned = !scan.triangles.empty();
    for (const int n : wanted.sizes) {
        const auto add = [&](const Bench& bench, double height) {
            if (!wanted.has(bench.scene)) return;
            rows.push_back(
                report(bench, make_sheet_scene(n, bench.obstacle, height, wanted.settings, bench.breathes), wanted.seconds));
        };
        add({"S1", n}, 0.0);
        add({"S2", n, &ball}, 0.6);
        if (!scanned) continue;
        add({"S3", n, &scan}, 0.6);
        add({"S4", n, &scan, true}, 0.6);
    }
    if (!scanned && (wanted.has("S3") || wanted.has("S4")))
        std::puts("S3 and S4 left out: no bunny00.off (PERCALE_REAL_MESHES names its folder)");
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What a 1/60 s step costs on four scenes, by stage.", "percale_step_cost");
    Wanted wanted;
    app.add_option("seconds", wanted.seconds, "seconds simulated")->capture_default_str()->check(CLI::Range(1e-3, 1e4));
    app.add_option("--sizes", wanted.sizes, "vertices along a side")->capture_default_str()->check(CLI::Range(2, 2049));
    app.add_option("--scenes", wanted.scenes, "which of them")
        ->capture_default_str()
        ->check(CLI::IsMember({"S1", "S2", "S3", "S4"}));
    const std::map<std::string, percale::ContactResponse> responses{{"penalty", percale::ContactResponse::penalty},
                                                                    {"projection", percale::ContactResponse::projection}};
    app.add_option("--response", wanted.settings.contact_response, "contact response")
        ->transform(CLI::CheckedTransformer(responses));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(wanted); });
}
