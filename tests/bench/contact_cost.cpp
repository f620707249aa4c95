// Prints the cost of the contact search by part, in force evaluations F of the same cloth in the same run: a sheet of 101 x 101
// vertices far from the bunny scan, draped over it, and snug around it with every vertex within 10 mm. Beside each stands the
// target, where there is one.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/forces/springs.h"
#include "engine/forces/total_force.h"
#include "engine/model/cloth_model.h"
#include "percale/detectors.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/scenes/bench_scenes.h"
#include "tests/support/bench_unit.h"

namespace {

using percale::ContactConstraints;
using percale::Vec3;
using percale::test::Figures;
using Positions = std::vector<Vec3>;

constexpr int side = 101;  // vertices
constexpr double thickness = 5e-3;

/// One force evaluation of the sheet.
class Forces {
public:
    Forces() {
        percale::append_cloth(model_, percale::make_grid(1.0, 1.0, side, side), percale::test::bench_fabric(), "sheet");
        percale::finish_model(model_);
        model_.adjacency = percale::make_adjacency(model_.springs, model_.vertex_count(), percale::SpringLayout::best);
        const percale::test::PlainSheet plain(side);
        for (auto* vectors : {&positions_, &velocities_}) vectors->resize(side * side);
        percale::copy_in(plain.positions, positions_);
        percale::copy_in(plain.velocities, velocities_);
        percale::set_step_springs(compute_, {model_.adjacency, positions_, percale::DampingForm::length_rate, 1.0 / 60.0},
                                  springs_);
    }
    void evaluate() {
        percale::evaluate_forces({.compute = &compute_,
                                  .model = &model_,
                                  .springs = &springs_,
                                  .positions = &positions_,
                                  .velocities = &velocities_,
                                  .gravity = Vec3(0.0, -9.81, 0.0),
                                  .dt = 1.0 / 60.0,
                                  .with_matrix = false},
                                 forces_);
    }

private:
    percale::Compute compute_{.kernels = &percale::best_kernels()};
    percale::ClothModel model_;
    percale::StepSprings springs_;
    percale::Vec3Arrays positions_, velocities_;
    percale::Forces forces_;
};

/// A sheet that has fallen onto the scan for a second.
Positions draped(const percale::TriangleMesh& scan) {
    percale::Simulation simulation = percale::test::make_sheet_scene(side, &scan, 0.35);
    for (int i = 0; i < 60; ++i) {
        const percale::StepReport step = simulation.step();
        if (!step.ok()) throw std::runtime_error(step.explanation());
    }
    const auto positions = simulation.positions(percale::ClothId{0});
    return {positions.begin(), positions.end()};
}

/// Every vertex at 4 to 10 mm from the nearest vertex of the scan, on the way to it.
Positions snug(Positions x, const percale::TriangleMesh& scan) {
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto farther = [&](const Vec3& a, const Vec3& b) { return (a - x[i]).squaredNorm() < (b - x[i]).squaredNorm(); };
        const Vec3 nearest = *std::min_element(scan.vertices.begin(), scan.vertices.end(), farther);
        const double height = 4e-3 + 6e-3 * (0.5 + 0.5 * std::sin(0.37 * static_cast<double>(i)));
        x[i] = nearest + height * (x[i] - nearest).normalized();
    }
    return x;
}

Positions shifted(const Positions& x, double size, double every = 0.0) {
    Positions result = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double phase = static_cast<double>(i);
        result[i] += size * Vec3(std::sin(phase), 1.0 + std::cos(1.7 * phase), std::sin(2.3 * phase)) + Vec3(0.0, every, 0.0);
    }
    return result;
}

/// Seconds of each part at one place of the cloth.
struct Parts {
    double force = 0.0, kept = 0.0, rebuild = 0.0, first = 0.0, evaluate = 0.0, cut = 0.0;
    std::size_t constraints = 0;
};

Parts measure_parts(const percale::TriangleMesh& scan, const Positions& x, int rounds) {
    Forces forces;
    const auto detector = percale::make_fcl_detector();
    const percale::TriangleMesh sheet = percale::make_grid(1.0, 1.0, side, side);
    detector->set_cloth(sheet.triangles, std::vector<double>(x.size(), thickness));
    detector->add_obstacle(scan, {}, 0.3);
    // A hundredth of a millimetre is the move of a late Newton iteration; 2 cm leaves every box.
    const Positions near = shifted(x, 1e-5), away = shifted(x, 0.0, 0.02);
    ContactConstraints constraints;
    Parts parts;
    const std::vector<double> seconds = percale::test::min_seconds(
        rounds, {[&] { forces.evaluate(); }, [&] { detector->update_candidates(away, away); },
                 [&] { detector->update_candidates(x, near); }, [&] { detector->find_contacts(near, 1.0, constraints); },
                 [&] { detector->update_candidates(x, near); }, [&] { detector->find_contacts(x, 1.0, constraints); },
                 [&] { detector->find_contacts(near, 1.0, constraints); },
                 [&] {
                     detector->collision_free_step_size(near, x, {1.0, 1.0});
                 }});
    parts.constraints = constraints.size();
    parts.force = seconds[0];
    parts.rebuild = seconds[2];
    parts.first = seconds[3];
    parts.kept = seconds[4];
    parts.evaluate = std::min(seconds[5], seconds[6]);
    parts.cut = seconds[7];
    return parts;
}

struct Target {
    const char* state;
    double kept, rebuild, evaluate;  // F, 0 = none
};

Figures report(const Target& target, const Parts& parts) {
    const double unit = parts.force;
    Figures constraints = Figures::array();
    const auto line = [&](const char* part, double seconds, double limit) {
        std::printf("%-7s %-18s %9.3f %9.2f", target.state, part, 1e3 * seconds, seconds / unit);
        if (limit > 0.0) std::printf(" %9.2f", limit);
        std::printf("\n");
        constraints.push_back(
            {{"state", target.state}, {"part", part}, {"ms", 1e3 * seconds}, {"force_evaluations", seconds / unit}});
        if (limit > 0.0) constraints.back()["target"] = limit;
    };
    line("force evaluation", unit, 0.0);
    line("lists kept", parts.kept, target.kept);
    line("lists rebuilt", parts.rebuild, target.rebuild);
    line("first evaluation", parts.first, 0.0);
    line("evaluation", parts.evaluate, target.evaluate);
    line("cut", parts.cut, target.kept);
    std::printf("%-7s %-18s %9zu\n", target.state, "contacts", parts.constraints);
    return constraints;
}

Figures measure(int rounds) {
    const percale::TriangleMesh scan = percale::test::bunny_scan();
    if (scan.triangles.empty()) throw std::runtime_error("no bunny00.off (PERCALE_REAL_MESHES names its folder)");
    std::printf("a sheet of %d vertices and a scan of %zu triangles; F = one force evaluation\n", side * side,
                scan.triangles.size());
    std::printf("%-7s %-18s %9s %9s %9s\n", "", "", "ms", "F", "target");
    const Positions rest = draped(scan);
    const Target targets[] = {{"far", 0.03, 0.0, 0.03}, {"draped", 0.0, 20.0, 0.25}, {"snug", 0.0, 75.0, 0.75}};
    const Positions places[] = {shifted(rest, 0.0, 2.0), rest, snug(rest, scan)};
    Figures all = Figures::array();
    for (int i = 0; i < 3; ++i) {
        for (Figures& constraint : report(targets[i], measure_parts(scan, places[i], rounds)))
            all.push_back(std::move(constraint));
    }
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What contact search costs by part, in force evaluations.", "percale_contact_cost");
    int rounds = 50;
    app.add_option("rounds", rounds, "rounds, of which the least counts")->capture_default_str()->check(CLI::Range(1, 100000));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(rounds); });
}
