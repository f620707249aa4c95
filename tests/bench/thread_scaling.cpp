// Prints the wall time of a 1/60 s step by number of threads: a sheet that hangs, one that falls onto a sphere, one onto a bunny
// scan, if there is one. The numbers of threads take turns; the shortest time counts. Reports whether all ended in the same
// state.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/bench_report.h"
#include "tests/bench/scenes/bench_scenes.h"

namespace {

using percale::test::Figures;
using namespace percale;

/// Sums over the steps of one run.
struct Run {
    double wall_s = 0.0, cpu_s = 0.0;
    StageTimes stages;
    long newton = 0;
    std::uint64_t end = 0;  // state hash
};

/// Throws if a step fails.
Run run(Simulation simulation, int steps) {
    Run made;
    simulation.prepare();
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps; ++i) {
        const StepReport step = simulation.step();
        if (!step.ok()) throw std::runtime_error(step.explanation());
        made.stages += step.stages;
        made.cpu_s += step.cpu_s;
        made.newton += step.newton_iterations;
    }
    made.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    made.end = simulation.state_hash();
    return made;
}

struct Wanted {
    std::vector<int> sizes{65, 129};
    std::vector<int> threads{1, 2};
    std::vector<std::string> scenes{"hang", "sphere", "bunny"};
    double seconds = 1.0;
    int turns = 3;
};

void print_row(const Figures& row) {
    const auto value = [&row](const char* key) { return row[key].get<double>(); };
    std::printf("%-7s %4d %7d %9.3f %8.2f %9.3f  %7.2f %8.2f %6.2f %6.2f %7.2f %6.2f %6.2f  %5.1f  %s\n",
                row["scene"].get<std::string>().c_str(), row["n"].get<int>(), row["threads"].get<int>(), value("wall_ms"),
                value("speed_up"), value("cpu_ms"), value("refresh_ms"), value("evaluate_ms"), value("force_ms"),
                value("setup_ms"), value("solve_ms"), value("cut_ms"), value("other_ms"), value("newton"),
                row["same_state"].get<bool>() ? "yes" : "NO");
    std::fflush(stdout);
}

/// Adds one row for each number of threads. Stages are of the calling thread, which waits for the others without sleeping.
void add_rows(const Wanted& wanted, const std::string& scene, int n, const TriangleMesh* body, Figures& rows) {
    const int steps = std::max(1, static_cast<int>(std::lround(60.0 * wanted.seconds)));
    std::vector<std::optional<Run>> best(wanted.threads.size());
    std::vector<bool> same(best.size(), true);
    std::optional<std::uint64_t> end;  // of the first run, which all others must equal
    for (int turn = 0; turn < wanted.turns; ++turn) {
        for (std::size_t k = 0; k < best.size(); ++k) {
            const StepSettings settings{.threads = wanted.threads[k]};
            Run made = run(test::make_sheet_scene(n, body, body ? 0.6 : 0.0, settings), steps);
            if (!end) end = made.end;
            same[k] = same[k] && made.end == *end;
            if (!best[k] || made.wall_s < best[k]->wall_s) best[k] = made;
        }
    }
    const double per = 1e3 / steps;
    for (std::size_t k = 0; k < best.size(); ++k) {
        const StageTimes& stages = best[k]->stages;
        rows.push_back({{"scene", scene},
                        {"n", n},
                        {"threads", wanted.threads[k]},
                        {"wall_ms", per * best[k]->wall_s},
                        {"speed_up", best[0]->wall_s / best[k]->wall_s},
                        {"cpu_ms", per * best[k]->cpu_s},
                        {"refresh_ms", per * stages.refresh},
                        {"evaluate_ms", per * stages.evaluate},
                        {"force_ms", per * stages.force},
                        {"setup_ms", per * stages.setup},
                        {"solve_ms", per * stages.solve},
                        {"cut_ms", per * stages.cut},
                        {"other_ms", per * (best[k]->wall_s - test::total(stages) + stages.measure)},
                        {"newton", static_cast<double>(best[k]->newton) / steps},
                        {"same_state", static_cast<bool>(same[k])}});
        print_row(rows.back());
    }
}

Figures measure(const Wanted& wanted) {
    const TriangleMesh ball = make_sphere(0.25, 4), scan = test::bunny_scan();
    std::printf("%-7s %4s %7s %9s %8s %9s  %7s %8s %6s %6s %7s %6s %6s  %5s  %s\n", "", "N", "threads", "ms/step", "speed-up",
                "CPU ms", "refresh", "evaluate", "force", "setup", "solve", "cut", "other", "newton", "same");
    Figures rows = Figures::array();
    for (const std::string& scene : wanted.scenes) {
        const TriangleMesh* body = scene == "sphere" ? &ball : scene == "bunny" ? &scan : nullptr;
        if (body && body->triangles.empty()) {
            std::puts("bunny left out: no bunny00.off (PERCALE_REAL_MESHES names its folder)");
            continue;
        }
        for (const int n : wanted.sizes) add_rows(wanted, scene, n, body, rows);
    }
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("The wall time of a 1/60 s step by number of threads.", "percale_thread_scaling");
    Wanted wanted;
    app.add_option("seconds", wanted.seconds, "seconds simulated")->capture_default_str()->check(CLI::Range(1e-3, 1e4));
    app.add_option("--sizes", wanted.sizes, "vertices along a side")->capture_default_str()->check(CLI::Range(2, 2049));
    app.add_option("--threads", wanted.threads, "the first is what others are compared with")
        ->capture_default_str()
        ->check(CLI::Range(1, 64));
    app.add_option("--scenes", wanted.scenes, "which of them")
        ->capture_default_str()
        ->check(CLI::IsMember({"hang", "sphere", "bunny"}));
    app.add_option("--turns", wanted.turns, "runs of each")->capture_default_str()->check(CLI::Range(1, 100));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(wanted); });
}
