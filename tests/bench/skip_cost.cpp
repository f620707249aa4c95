// Prints the saving by skips: whole scenes as planned and with step.skip = false, in turn, and the distance of their ends.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "scenes/format/scene_file.h"
#include "scenes/run/run_scene.h"
#include "tests/bench/bench_report.h"

namespace {

using percale::test::Figures;
using namespace percale::scenes;

struct Ended {
    double cpu_s = std::numeric_limits<double>::infinity();
    std::vector<percale::Vec3> positions;  // m, of all cloths
    std::vector<percale::Skip> skipped;
};

/// Throws if the run does not finish. Keeps the smaller of two times.
void run(const std::string& file, bool skip, Ended& ended) {
    const std::vector<Override> overrides{{"step.skip", skip ? "true" : "false"}};
    BuiltScene built = build_scene(load_scene(file, overrides));
    RunResult result = run_scene(built);
    if (result.status != RunStatus::finished) throw std::runtime_error(file + ": " + result.reason);
    ended.cpu_s = std::min(ended.cpu_s, result.totals.cpu_s);
    ended.skipped = std::move(result.plan.skipped);
    ended.positions.clear();
    for (const percale::ClothId cloth : built.cloths) {
        const auto view = built.simulation.positions(cloth);
        ended.positions.insert(ended.positions.end(), view.begin(), view.end());
    }
}

double largest_difference(const Ended& one, const Ended& other) {
    double largest = 0.0;
    for (std::size_t i = 0; i < one.positions.size(); ++i) {
        largest = std::max(largest, (one.positions[i] - other.positions[i]).norm());
    }
    return largest;
}

Figures compare(const std::string& file, int rounds) {
    Ended planned, everything;
    for (int round = 0; round < rounds; ++round) {
        run(file, true, planned);
        run(file, false, everything);
    }
    const double ratio = everything.cpu_s / planned.cpu_s, apart = largest_difference(planned, everything);
    const std::string name = std::filesystem::path(file).stem().string();
    std::printf("%-28s %9.3f %9.3f %7.2f %10.1e  %zu\n", name.c_str(), planned.cpu_s, everything.cpu_s, ratio, apart,
                planned.skipped.size());
    std::fflush(stdout);
    Figures skips = Figures::array();
    for (const percale::Skip& skip : planned.skipped) skips.push_back(skip.what);
    return {{"scene", name},  {"cpu_s", planned.cpu_s},        {"no_skip_cpu_s", everything.cpu_s},
            {"ratio", ratio}, {"largest_difference_m", apart}, {"skipped", skips}};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What leaving out what a scene does not need saves.", "percale_skip_cost");
    std::vector<std::string> files;
    for (const char* name : {"hang", "tablecloth_on_sphere", "sheet_on_spikes", "sheet_through_sphere"}) {
        files.push_back(std::string(PERCALE_DATA_DIR) + "/scenes/" + name + ".toml");
    }
    int rounds = 2;
    app.add_option("scenes", files, "scene files; four shipped ones if none is named")->check(CLI::ExistingFile);
    app.add_option("--rounds", rounds, "runs of each, of which the fastest counts")
        ->capture_default_str()
        ->check(CLI::Range(1, 100));
    return percale::test::run_bench(app, argc, argv, [&] {
        std::printf("%-28s %9s %9s %7s %10s  %s\n", "", "CPU s", "no skip", "ratio", "apart m", "skips");
        Figures rows = Figures::array();
        for (const std::string& file : files) rows.push_back(compare(file, rounds));
        return rows;
    });
}
