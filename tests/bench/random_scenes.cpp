// Runs scenes drawn at random, each step of each certified, and prints which were not clear of their obstacles. The exit code is
// 1 if one was not.
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/bench_report.h"
#include "tests/support/collision/random_scenes.h"
#include "tests/support/cpu_time.h"

namespace {

using percale::test::Figures;
using percale::test::RandomOutcome;
using percale::test::RandomScene;

struct Options {
    unsigned seed = 1;
    int scenes = 200;
    int only = -1;
};

/// Counts of some scenes.
struct Tally {
    int scenes = 0, touched = 0, blocked = 0, blocked_free = 0, bad = 0;
    long steps = 0, second_frames = 0;  // frames that the second checker has seen
    double cpu_s = 0.0;

    void add(const RandomScene& scene, const RandomOutcome& outcome) {
        ++scenes;
        touched += outcome.result.totals.contacts_most > 0 ? 1 : 0;
        blocked += outcome.blocked() ? 1 : 0;
        blocked_free += outcome.blocked() && !scene.pinned ? 1 : 0;
        bad += outcome.good() ? 0 : 1;
        steps += outcome.result.totals.steps;
        second_frames += outcome.second_frames;
        cpu_s += outcome.result.totals.cpu_s;
    }
    Figures figures(const std::string& kind) const {
        return {{"kind", kind},
                {"scenes", scenes},
                {"touched", touched},
                {"blocked", blocked},
                {"blocked_free", blocked_free},
                {"bad", bad},
                {"steps", steps},
                {"second_frames", second_frames},
                {"cpu_s", cpu_s}};
    }
    void print(const std::string& kind) const {
        std::printf("%-14s %6d %7d %7d %8d %4d %8ld %8.2f\n", kind.c_str(), scenes, touched, blocked, blocked_free, bad, steps,
                    cpu_s);
    }
};

void print_one(int index, const RandomScene& scene, const RandomOutcome& outcome) {
    std::printf("scene %d: %s: %d crossings, %.3g m deep, %d states not finite, %s", index, scene.description.c_str(),
                outcome.crossings, outcome.deepest, outcome.not_finite, percale::scenes::status_word(outcome.result.status));
    if (!outcome.result.reason.empty()) std::printf(": %s", outcome.result.reason.c_str());
    std::printf("\n");
    std::fflush(stdout);
}

Figures sweep(const Options& options, bool& good) {
    std::map<std::string, Tally> tallies;
    const double start = percale::test::cpu_seconds();
    const int first = std::max(0, options.only), end = options.only < 0 ? options.scenes : options.only + 1;
    for (int index = first; index < end; ++index) {
        RandomScene scene = percale::test::make_random_scene(options.seed, index);
        const RandomOutcome outcome = percale::test::run_random_scene(scene);
        if (options.only >= 0 || !outcome.good() || outcome.blocked()) print_one(index, scene, outcome);
        std::vector<std::string> kinds = {scene.obstacle, scene.motion, scene.cloth, "all"};
        if (scene.built.cloths.size() > 1) kinds.push_back("two cloths");
        for (const std::string& kind : kinds) tallies[kind].add(scene, outcome);
        good = good && outcome.good();
    }
    Figures rows = Figures::array();
    std::printf("%-14s %6s %7s %7s %8s %4s %8s %8s\n", "", "scenes", "touched", "blocked", "unpinned", "bad", "steps", "CPU s");
    for (const auto& [kind, tally] : tallies) {
        tally.print(kind);
        rows.push_back(tally.figures(kind));
    }
    std::printf("%.1f CPU s with certificates\n", percale::test::cpu_seconds() - start);
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Scenes drawn at random, every step certified.", "percale_random_scenes");
    Options options;
    bool good = true;
    app.add_option("--scenes", options.scenes, "how many")->capture_default_str()->check(CLI::Range(1, 1000000));
    app.add_option("--seed", options.seed, "of the scenes")->capture_default_str();
    app.add_option("--only", options.only, "run one scene alone, by its number")->check(CLI::Range(0, 1000000));
    const int code = percale::test::run_bench(app, argc, argv, [&] { return sweep(options, good); });
    return code != 0 || good ? code : 1;
}
