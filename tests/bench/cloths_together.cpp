// Prints the cost of cloths in one simulation beside as many simulations of one cloth each: sheets that fall on a sphere each,
// too far apart to meet each other, frame by frame in turn.
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "percale/detectors.h"
#include "percale/simulation.h"
#include "tests/bench/bench_report.h"
#include "tests/support/bench_unit.h"

namespace {

using percale::Simulation;
using percale::StepReport;
using percale::test::Figures;

struct Wanted {
    int cloths = 10, count = 33, frames = 60;
};

void add_draped_sheet(Simulation& simulation, int number, const Wanted& wanted, bool self_contact) {
    percale::Fabric fabric = percale::test::bench_fabric();
    fabric.thickness = 0.005;
    fabric.self_contact = self_contact;
    const double x = 3.0 * number, off = 0.01 * (number % 10);  // each falls differently
    simulation.add_cloth(percale::make_grid(0.8, 0.8, wanted.count, wanted.count), fabric,
                         {.translation = {x + off, 0.32 + off, 0.3 * off}});
    simulation.add_obstacle(percale::make_sphere(0.3, 4), {.translation = {x, 0, 0}}, {.friction = 0.4});
}

/// Total cost of some simulations.
class Total {
public:
    void step(Simulation& simulation) {
        const double start = percale::test::cpu_seconds();
        const StepReport report = simulation.step();
        seconds_ += percale::test::cpu_seconds() - start;
        if (!report.ok()) throw std::runtime_error(report.explanation());
        newton_ += static_cast<double>(report.newton_iterations);
        stages_ += report.stages;
    }
    double per_frame(double seconds, const Wanted& wanted) const { return 1e3 * seconds / wanted.frames; }

    Figures row(const char* name, bool self_contact, int simulations, const Wanted& wanted) const {
        const double newton = newton_ / (wanted.frames * simulations);
        const std::vector<double> ms{per_frame(seconds_, wanted),         per_frame(stages_.refresh, wanted),
                                     per_frame(stages_.evaluate, wanted), per_frame(stages_.force, wanted),
                                     per_frame(stages_.solve, wanted),    per_frame(stages_.cut, wanted)};
        std::printf("%-16s %-5s %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f %8.2f\n", name, self_contact ? "yes" : "no", newton, ms[0],
                    ms[1], ms[2], ms[3], ms[4], ms[5]);
        return {{"run", name},         {"self_contact", self_contact}, {"newton", newton},  {"ms_a_frame", ms[0]},
                {"refresh_ms", ms[1]}, {"evaluate_ms", ms[2]},         {"force_ms", ms[3]}, {"solve_ms", ms[4]},
                {"cut_ms", ms[5]}};
    }

private:
    double seconds_ = 0.0, newton_ = 0.0;
    percale::StageTimes stages_;
};

void measure(const Wanted& wanted, bool self_contact, Figures& rows) {
    std::vector<Simulation> apart;
    Simulation together({}, percale::make_fcl_detector());
    for (int n = 0; n < wanted.cloths; ++n) {
        add_draped_sheet(apart.emplace_back(percale::StepSettings{}, percale::make_fcl_detector()), n, wanted, self_contact);
        add_draped_sheet(together, n, wanted, self_contact);
    }
    Total of_each, of_all;
    for (int frame = 0; frame < wanted.frames; ++frame) {
        for (Simulation& simulation : apart) of_each.step(simulation);
        of_all.step(together);
    }
    rows.push_back(of_each.row("simulation each", self_contact, wanted.cloths, wanted));
    rows.push_back(of_all.row("one simulation", self_contact, 1, wanted));
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What cloths cost in one simulation beside as many simulations.", "percale_cloths_together");
    Wanted wanted;
    app.add_option("--cloths", wanted.cloths, "how many")->capture_default_str()->check(CLI::Range(1, 1000));
    app.add_option("--count", wanted.count, "vertices along an edge of each")->capture_default_str()->check(CLI::Range(2, 513));
    app.add_option("--frames", wanted.frames, "of 1/60 s")->capture_default_str()->check(CLI::Range(1, 100000));
    return percale::test::run_bench(app, argc, argv, [&] {
        std::printf("%-16s %-5s %8s %8s %8s %8s %8s %8s %8s\n", "", "self", "newton", "ms/frame", "refresh", "evaluate", "force",
                    "solve", "cut");
        Figures rows = Figures::array();
        for (const bool self_contact : {false, true}) measure(wanted, self_contact, rows);
        return rows;
    });
}
