// Bullet's deformable body beside Percale on the sheet that hangs from two corners, in one run: both take the same steps of 1/60
// s in turn, then Bullet alone is given smaller and smaller steps until it survives. A run survives if it stays finite and every
// structural spring below 100 % strain; the cost of 1/60 s is that of all steps it takes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "percale/simulation.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/peers/bullet_sheet.h"
#include "tests/support/bench_unit.h"

namespace {

using percale::test::BulletForces;
using percale::test::BulletSheet;
using percale::test::Figures;

constexpr double frame = 1.0 / 60.0;  // s
constexpr double torn = 1.0;          // strain

/// Cost and results of one engine's run so far.
struct Run {
    double dt = frame;
    std::function<void()> step;
    std::function<double()> largest_strain;
    std::vector<double> seconds = {};  // CPU, of each step
    double strain = 0.0;
    bool cut_short = false;  // by the CPU time allowed

    bool survives() const { return strain < torn; }
    std::size_t steps() const { return seconds.size(); }
    double spent() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }
    /// Mean CPU ms of the first `count` steps, at least 1 of them.
    double mean_ms(std::size_t count) const {
        return 1e3 * std::accumulate(seconds.begin(), seconds.begin() + static_cast<std::ptrdiff_t>(count), 0.0) /
               static_cast<double>(count);
    }
    /// CPU ms of 1/60 s.
    double frame_ms() const { return mean_ms(steps()) * frame / dt; }
};

/// One step, its CPU time and its strain added.
void advance(Run& run) {
    const double start = percale::test::cpu_seconds();
    run.step();
    run.seconds.push_back(percale::test::cpu_seconds() - start);
    run.strain = std::max(run.strain, run.largest_strain());
}

/// A repeated run counts with the faster time of each step.
void keep_faster(const Run& again, Run& kept) {
    const std::vector<double> before = std::exchange(kept.seconds, again.seconds);
    kept.strain = again.strain;
    for (std::size_t i = 0; i < std::min(before.size(), kept.seconds.size()); ++i) {
        kept.seconds[i] = std::min(before[i], kept.seconds[i]);
    }
}

/// Percale with default settings at 1/60 s.
struct PercaleSheet {
    percale::Simulation simulation{percale::StepSettings{}};
    percale::StepReport report;

    explicit PercaleSheet(int n) {
        const percale::ClothId cloth = simulation.add_cloth(percale::make_grid(1.0, 1.0, n, n), percale::test::bench_fabric());
        simulation.pin(cloth, 0);
        simulation.pin(cloth, n - 1);
        simulation.prepare();
    }
    void step() { report = simulation.step(); }
    double largest_strain() const {
        if (!report.ok()) throw std::runtime_error(report.explanation());
        return simulation.largest_strain();
    }
};

template <class Sheet>
Run run_of(Sheet& sheet, double dt) {
    return {.dt = dt, .step = [&sheet] { sheet.step(); }, .largest_strain = [&sheet] { return sheet.largest_strain(); }};
}

Figures row(int n, const std::string& engine, const Run& run, double ratio) {
    const double simulated = static_cast<double>(run.steps()) * run.dt;
    std::printf("%4d  %-16s 1/%-6.0f %6zu %9.2f %10.2f %8.1f  %6.2f %10.1f  %s\n", n, engine.c_str(), 1.0 / run.dt, run.steps(),
                run.mean_ms(run.steps()), run.frame_ms(), ratio, simulated, 100.0 * run.strain,
                !run.survives() ? "blows up"
                : run.cut_short ? "survives so far"
                                : "survives");
    std::fflush(stdout);
    Figures figures{{"n", n},
                    {"engine", engine},
                    {"time_step", run.dt},
                    {"steps", run.steps()},
                    {"mean_ms", run.mean_ms(run.steps())},
                    {"frame_ms", run.frame_ms()},
                    {"times_percale", ratio},
                    {"seconds_simulated", simulated},
                    {"survives", run.survives()},
                    {"cut_short", run.cut_short}};
    // JSON has no infinity.
    figures["largest_strain"] = std::isfinite(run.strain) ? Figures(run.strain) : Figures(nullptr);
    return figures;
}

struct Limits {
    double simulated;  // s, at most
    double budget;     // CPU s, at most, of one run
    double smallest;   // s, time step
};

/// One round: steps of 1/60 s in turn until Bullet blows up (after that its solver gives up early and costs little), Percale
/// then alone to the end.
void take_turns(const Limits& limits, Run& bullet, Run& percale) {
    const int steps = std::max(1, static_cast<int>(std::lround(limits.simulated / frame)));
    for (int i = 0; i < steps; ++i) {
        if (bullet.survives() && bullet.spent() < limits.budget) advance(bullet);
        advance(percale);
    }
}

/// Two rounds; the ratio is that of the steps both took. Returns Percale's ms a step over the whole run.
double pair_up(int n, const Limits& limits, Figures& rows) {
    Run bullet, percale;
    for (int round = 0; round < 2; ++round) {
        BulletSheet bullet_sheet(n, frame, BulletForces::implicit);
        PercaleSheet percale_sheet(n);
        Run bullet_round = run_of(bullet_sheet, frame), percale_round = run_of(percale_sheet, frame);
        take_turns(limits, bullet_round, percale_round);
        keep_faster(bullet_round, bullet);
        keep_faster(percale_round, percale);
    }
    rows.push_back(row(n, "Percale", percale, 1.0));
    rows.push_back(row(n, "Bullet implicit", bullet, bullet.frame_ms() / percale.mean_ms(bullet.steps())));
    return percale.frame_ms();
}

/// Until it tears, the time is over or the budget spent.
Run survive(int n, double dt, BulletForces forces, const Limits& limits) {
    BulletSheet sheet(n, dt, forces);
    Run run = run_of(sheet, dt);
    const int steps = std::max(1, static_cast<int>(std::lround(limits.simulated / dt)));
    for (int i = 0; i < steps && run.survives() && !run.cut_short; ++i) {
        advance(run);
        run.cut_short = i + 1 < steps && run.spent() > limits.budget;
    }
    return run;
}

/// Halves the step, from 1/120 s on, until Bullet survives; every trial is a row.
void find_survivor(int n, BulletForces forces, const Limits& limits, double percale_frame_ms, Figures& rows) {
    const std::string name = forces == BulletForces::implicit ? "Bullet implicit" : "Bullet explicit";
    for (double dt = 0.5 * frame; dt >= limits.smallest; dt *= 0.5) {
        const Run run = survive(n, dt, forces, limits);
        rows.push_back(row(n, name, run, run.frame_ms() / percale_frame_ms));
        if (run.survives()) return;
    }
}

Figures measure(int largest, const Limits& limits) {
    std::printf("%4s  %-16s %-8s %6s %9s %10s %8s  %6s %10s\n", "N", "engine", "step s", "steps", "ms a step", "ms a frame",
                "ratio", "s", "strain %");
    Figures rows = Figures::array();
    for (const int n : {33, 65, 129}) {
        if (n > largest) break;
        const double percale = pair_up(n, limits, rows);
        find_survivor(n, BulletForces::implicit, limits, percale, rows);
        find_survivor(n, BulletForces::explicit_, limits, percale, rows);
    }
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Bullet's deformable body beside Percale on a sheet hanging from two corners.", "percale_bench_bullet");
    int largest = 129;
    Limits limits{.simulated = 0.5, .budget = 30.0, .smallest = 1e-5};
    app.add_option("--largest", largest, "largest N of 33, 65, 129")->capture_default_str()->check(CLI::Range(33, 129));
    app.add_option("--seconds", limits.simulated, "seconds a run must survive")
        ->capture_default_str()
        ->check(CLI::Range(0.01, 100.0));
    app.add_option("--budget", limits.budget, "CPU seconds after which a run ends as it is")
        ->capture_default_str()
        ->check(CLI::Range(0.1, 1e5));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(largest, limits); });
}
