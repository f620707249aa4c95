// Prints the cost of a rollback: a scene is run to a time, then save, restore and step are timed there, and a round of a host
// that undoes some steps and makes them again: restore, then a step and a save each. CPU time of the calling thread, the
// smallest of several rounds.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "scenes/format/scene_file.h"
#include "scenes/run/run_scene.h"
#include "tests/bench/bench_report.h"
#include "tests/support/cpu_time.h"

namespace {

using percale::test::Figures;
using namespace percale::scenes;

/// Smallest of several times, s.
class Least {
public:
    template <class Work>
    void time(Work work) {
        const double start = percale::test::cpu_seconds();
        work();
        seconds_ = std::min(seconds_, percale::test::cpu_seconds() - start);
    }
    double us() const { return 1e6 * seconds_; }

private:
    double seconds_ = std::numeric_limits<double>::infinity();
};

struct Wanted {
    std::string until;  // s, as written in a scene file
    int rounds = 0, depth = 0;
};

/// Throws if the run does not finish, a step fails, or repeated steps end in another state.
Figures measure(const std::string& file, const Wanted& wanted) {
    const std::vector<Override> overrides{{"duration", wanted.until}, {"step.threads", "1"}, {"step.measure", "none"}};
    BuiltScene built = build_scene(load_scene(file, overrides));
    const RunResult result = run_scene(built);
    if (result.status != RunStatus::finished) throw std::runtime_error(file + ": " + result.reason);
    percale::Simulation& simulation = built.simulation;
    std::size_t vertices = 0;
    for (const percale::ClothId cloth : built.cloths) vertices += simulation.positions(cloth).size();
    const std::vector<std::byte> start = simulation.save();
    std::map<std::string, Least> least;
    std::uint64_t first_hash = 0;
    for (int round = 0; round < wanted.rounds; ++round) {
        std::vector<std::byte> saved;
        least["save"].time([&] { saved = simulation.save(); });
        least["restore"].time([&] { simulation.restore(start); });
        const auto step = [&] {
            const percale::StepReport report = simulation.step();
            if (!report.ok()) throw std::runtime_error(report.explanation());
        };
        least["step"].time(step);
        least["next step"].time(step);
        least["rollback"].time([&] {
            simulation.restore(start);
            for (int n = 0; n < wanted.depth; ++n) {
                step();
                saved = simulation.save();
            }
        });
        if (round == 0) first_hash = simulation.state_hash();
        if (simulation.state_hash() != first_hash) throw std::runtime_error(file + ": steps made again end elsewhere");
        simulation.restore(start);
    }
    const std::string name = std::filesystem::path(file).stem().string();
    const double per = 1e-3 * static_cast<double>(vertices), both = least["save"].us() + least["restore"].us();
    std::printf("%-24s %8zu %9zu %8.0f %8.0f %9.0f %9.0f %10.1f %10.1f %9.3f\n", name.c_str(), vertices, start.size(),
                least["save"].us(), least["restore"].us(), least["step"].us(), least["next step"].us(),
                1e-3 * least["rollback"].us(), both / per, both / least["next step"].us());
    std::fflush(stdout);
    return {{"scene", name},
            {"vertices", vertices},
            {"bytes", start.size()},
            {"save_us", least["save"].us()},
            {"restore_us", least["restore"].us()},
            {"step_us", least["step"].us()},
            {"next_step_us", least["next step"].us()},
            {"rollback_ms", 1e-3 * least["rollback"].us()},
            {"save_and_restore_us_per_1000_vertices", both / per},
            {"share_of_a_step", both / least["next step"].us()}};
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What saving and restoring costs beside a step.", "percale_rollback_cost");
    std::vector<std::string> files;
    for (const char* name : {"poncho_on_mannequin", "tablecloth_on_sphere", "swinging_sheet", "two_sheets_on_spikes"}) {
        files.push_back(std::string(PERCALE_DATA_DIR) + "/scenes/" + name + ".toml");
    }
    Wanted wanted{"0.8", 20, 7};
    app.add_option("scenes", files, "scene files; four shipped ones if none is named")->check(CLI::ExistingFile);
    app.add_option("--until", wanted.until, "s, where each is measured")->capture_default_str();
    app.add_option("--rounds", wanted.rounds, "of which the fastest counts")->capture_default_str()->check(CLI::Range(1, 1000));
    app.add_option("--depth", wanted.depth, "steps taken back and made again")->capture_default_str()->check(CLI::Range(1, 100));
    return percale::test::run_bench(app, argc, argv, [&] {
        std::printf("%-24s %8s %9s %8s %8s %9s %9s %10s %10s %9s\n", "", "vertices", "bytes", "save us", "restore", "step after",
                    "next step", "all ms", "us/1000 v", "of a step");
        Figures rows = Figures::array();
        for (const std::string& file : files) rows.push_back(measure(file, wanted));
        return rows;
    });
}
