// Prints the cost of a jump: the mannequin under its settled poncho, and two pins of the poncho with it, moved far in one step;
// the same by teleport; and the step after either.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "scenes/format/scene_file.h"
#include "scenes/run/run_scene.h"
#include "tests/bench/bench_report.h"
#include "tests/support/cpu_time.h"

namespace {

using percale::test::Figures;
using namespace percale;

/// The poncho at rest on the mannequin, held at its two ends.
class Settled {
public:
    Settled()
        : built_(scenes::build_scene(scenes::load_scene(std::string(PERCALE_DATA_DIR) + "/scenes/poncho_on_mannequin.toml"))) {
        for (int n = 0; n < 60; ++n) {
            const StepReport report = simulation().step();
            if (!report.ok()) throw std::runtime_error(report.explanation());
        }
        const auto x = simulation().positions(cloth());
        const auto [left, right] = std::ranges::minmax_element(x, {}, [](const Vec3& p) { return p.x(); });
        for (const auto end : {left, right}) {
            pins_.push_back(static_cast<int>(end - x.begin()));
            simulation().pin(cloth(), pins_.back());
        }
        state_ = simulation().save();
    }

    Simulation& simulation() { return built_.simulation; }
    ClothId cloth() const { return built_.cloths[0]; }
    void rewind() { simulation().restore(state_); }

    /// The next step moves the body and the pins there.
    void aim(const Vec3& by) {
        Pose pose = simulation().obstacle_pose(built_.obstacles[0]);
        pose.translation += by;
        simulation().move_obstacle(built_.obstacles[0], pose);
        for (const int pin : pins_) simulation().move_pin(cloth(), pin, simulation().positions(cloth())[pin] + by);
    }

    void teleport(const Vec3& by) { simulation().teleport(built_.cloths, built_.obstacles, {.translation = by}); }

private:
    scenes::BuiltScene built_;
    std::vector<int> pins_;
    std::vector<std::byte> state_;
};

struct Cost {
    double cpu_s = 0.0;
    StepReport report;
};

Cost timed_step(Simulation& simulation) {
    const double start = test::cpu_seconds();
    Cost cost;
    cost.report = simulation.step();
    cost.cpu_s = test::cpu_seconds() - start;
    return cost;
}

Figures row(const std::string& how, double distance, double jump_s, const Cost& jump, const Cost& after) {
    std::printf("%-10s %8.2f %10.3f %14s %10.3f %8d\n", how.c_str(), distance, jump_s, status_word(jump.report.status),
                after.cpu_s, after.report.newton_iterations);
    std::fflush(stdout);
    return {{"how", how},
            {"distance_m", distance},
            {"jump_cpu_s", jump_s},
            {"status", status_word(jump.report.status)},
            {"next_step_cpu_s", after.cpu_s},
            {"next_step_newton", after.report.newton_iterations}};
}

Figures measure(const std::vector<double>& distances) {
    Settled settled;
    std::printf("%-10s %8s %10s %14s %10s %8s\n", "", "m", "CPU s", "status", "next step", "Newton");
    Figures rows = Figures::array();
    for (const double distance : distances) {
        const Vec3 by(distance, 0.0, 0.0);
        settled.rewind();
        settled.aim(by);
        const Cost jump = timed_step(settled.simulation());
        if (!jump.report.ok()) settled.rewind();
        rows.push_back(row("one step", distance, jump.cpu_s, jump, timed_step(settled.simulation())));
        settled.rewind();
        const double start = test::cpu_seconds();
        settled.teleport(by);
        const double taken = test::cpu_seconds() - start;
        const Cost next = timed_step(settled.simulation());
        rows.push_back(row("teleport", distance, taken, next, next));
    }
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What a jump of a body with its cloth costs.", "percale_far_motion");
    std::vector<double> distances = {0.01, 0.1, 1.0, 5.0, 50.0};
    app.add_option("distances", distances, "m")->check(CLI::Range(0.0, 1000.0));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(distances); });
}
