// Error against CPU time with contact: several scenes, steps and stopping rules of the solver, each from several disturbed
// starts, so that the remaining error does not depend on one run. The observables of an ensemble are compared with those of the
// finest step.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "data/generators/mannequin.h"
#include "data/generators/poncho.h"
#include "percale/detectors.h"
#include "percale/simulation.h"
#include "scenes/common/whole_file.h"
#include "scenes/report/plot_svg.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/bench_scenes.h"
#include "tests/support/bench_unit.h"

namespace {

using namespace percale;
using test::Figures;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int frames_per_second = 30;

/// The observables of each frame; SI units.
constexpr int observable_count = 6;
constexpr const char* observable_names[observable_count] = {"height", "lowest", "aside", "kinetic", "elastic", "force"};
using Observables = std::array<double, observable_count>;
using Placement = Eigen::Isometry3d;

/// A stopping rule of the solver.
struct Rule {
    std::string name;
    Scheme scheme = Scheme::backward_euler;
    double share = 0.25;
    int iterations = 50;
};

/// A scene of the table, without step and rule.
struct SceneKind {
    std::string name;
    double seconds = 1.0;
    std::function<Simulation(int n, const StepSettings& settings, const Placement& disturbed)> make;
};

/// The mean over an ensemble in each frame, its standard error, and its cost.
struct Ensemble {
    std::vector<Observables> mean, deviation;
    double cpu_s = 0.0, largest_strain = 0.0, weight = 0.0;  // s, of structural springs in the frames, N
    long newton = 0;
    int steps = 0, dropped = 0;
    std::string failure;
};

Placement moved(double x, double y, double z) { return Placement(Eigen::Translation3d(x, y, z)); }

Placement turned(double angle, const Vec3& axis) { return Placement(Eigen::AngleAxisd(angle, axis.normalized())); }

TriangleMesh placed(TriangleMesh mesh, const Placement& placement) {
    for (Vec3& x : mesh.vertices) x = placement * x;
    return mesh;
}

/// One of the disturbed starts: a few millimetres and degrees off.
Placement disturbed_start(int number) {
    std::mt19937 random(static_cast<unsigned>(number) + 1);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    const double x = part(random), y = part(random), z = part(random), angle = part(random), tilt = part(random);
    return moved(0.01 * x, 0.002 * y, 0.01 * z) * turned(0.1 * angle, {0.05 * tilt, 1.0, 0.05});
}

Simulation make_scene(const TriangleMesh& cloth, const Fabric& fabric, const TriangleMesh& body, const StepSettings& settings) {
    Simulation simulation(settings, make_fcl_detector());
    simulation.add_cloth(cloth, fabric);
    simulation.add_obstacle(body);
    return simulation;
}

Simulation make_drop(int n, const TriangleMesh& body, const StepSettings& settings, const Placement& disturbed) {
    return make_scene(placed(make_grid(1.0, 1.0, n, n), disturbed * moved(0.0, 0.45, 0.0)), test::bench_fabric(), body, settings);
}

/// A sheet laid just above a slope of 25 degrees, with a friction of 0.3: it slides.
Simulation make_slide(int n, const StepSettings& settings, const Placement& disturbed) {
    const Placement slope = turned(-25.0 * std::numbers::pi / 180.0, Vec3::UnitZ());
    const Vec3 offset = disturbed.translation();
    const TriangleMesh sheet = placed(make_grid(0.5, 0.5, n, n), slope * moved(offset.x(), 0.0052, offset.z()));
    return make_scene(sheet, test::bench_fabric(), placed(make_plane(5.0), slope), settings);
}

Simulation make_poncho_scene(int n, const StepSettings& settings, const Placement& disturbed) {
    const Fabric felt{.area_density = 0.25, .springs = {.structural = 500.0, .shear = 0.0, .bend = 5.0}, .spring_damping = 1.0};
    static const TriangleMesh body = scenes::make_mannequin(0.015);
    const TriangleMesh poncho = scenes::make_poncho({.edge_length = n > 40 ? 0.018 : 0.036});
    return make_scene(placed(poncho, moved(0.0, 1.53, 0.0) * disturbed), felt, body, settings);
}

/// A sheet lowered onto the floor, where it folds on itself.
Simulation make_fold(int n, const StepSettings& settings, const Placement& disturbed) {
    Fabric fabric = test::bench_fabric();
    fabric.self_contact = true;
    const Placement upright = moved(0.0, 0.52, 0.0) * disturbed * turned(0.5 * std::numbers::pi, Vec3::UnitX());
    return make_scene(placed(make_grid(0.4, 1.0, (2 * n) / 5, n), upright), fabric, make_plane(2.0), settings);
}

std::vector<SceneKind> all_scenes() {
    static const TriangleMesh ball = make_sphere(0.25, 4), bunny = test::bunny_scan();
    std::vector<SceneKind> kinds;
    const auto drop = [](const TriangleMesh& body) {
        return [&body](int n, const StepSettings& s, const Placement& p) { return make_drop(n, body, s, p); };
    };
    kinds.push_back({"sphere", 1.0, drop(ball)});
    if (!bunny.triangles.empty()) kinds.push_back({"scan", 1.0, drop(bunny)});
    kinds.push_back({"incline", 1.0, make_slide});
    kinds.push_back({"poncho", 1.0, make_poncho_scene});
    kinds.push_back({"fold", 1.0, make_fold});
    return kinds;
}

/// Momentum, kg m/s; `force` is made of its differences.
Vec3 momentum(const Simulation& simulation, ClothId cloth) {
    const auto velocities = simulation.velocities(cloth);
    const auto masses = simulation.masses(cloth);
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < masses.size(); ++i) sum += masses[i] * velocities[i];
    return sum;
}

Observables observe(const Simulation& simulation, ClothId cloth, double contact_force) {
    const auto positions = simulation.positions(cloth);
    const auto masses = simulation.masses(cloth);
    Vec3 centre = Vec3::Zero();
    double mass = 0.0, lowest = infinity;
    for (std::size_t i = 0; i < masses.size(); ++i) {
        centre += masses[i] * positions[i];
        mass += masses[i];
        lowest = std::min(lowest, positions[i].y());
    }
    centre /= mass;
    const StepEnergy energy = simulation.energy();
    return {centre.y(), lowest, std::hypot(centre.x(), centre.z()), energy.kinetic, energy.elastic, contact_force};
}

struct Task {
    const SceneKind* kind = nullptr;
    int n = 0;
    int steps_per_second = 0;
    Rule rule;
};

void run_one(const Task& task, int start, std::vector<Observables>& frames, Ensemble& ensemble) {
    const StepSettings settings{.time_step = 1.0 / task.steps_per_second,
                                .scheme = task.rule.scheme,
                                .newton_error_ratio = task.rule.share,
                                .newton_iterations = task.rule.iterations,
                                .measure = StepMeasures::none};
    Simulation simulation = task.kind->make(task.n, settings, disturbed_start(start));
    const ClothId cloth{0};
    const int between = task.steps_per_second / frames_per_second;
    const auto masses = simulation.masses(cloth);
    double mass = 0.0;
    for (const double m : masses) mass += m;
    ensemble.weight = 9.81 * mass;
    Vec3 last = momentum(simulation, cloth);
    const int count = static_cast<int>(std::lround(task.kind->seconds * task.steps_per_second));
    for (int i = 1; i <= count; ++i) {
        const StepReport report = simulation.step();
        ensemble.cpu_s += report.cpu_s;
        ensemble.newton += report.newton_iterations;
        ensemble.dropped += report.dropped.total();
        ++ensemble.steps;
        if (!report.ok()) {
            ensemble.failure = report.explanation();
            return;
        }
        if (i % between != 0) continue;
        ensemble.largest_strain = std::max(ensemble.largest_strain, simulation.largest_strain());
        const Vec3 now = momentum(simulation, cloth);
        frames.push_back(observe(simulation, cloth, (now - last).y() * frames_per_second + ensemble.weight));
        last = now;
    }
}

Ensemble run_ensemble(const Task& task, int starts) {
    Ensemble ensemble;
    std::vector<std::vector<Observables>> all(starts);
    for (int k = 0; k < starts && ensemble.failure.empty(); ++k) run_one(task, k, all[k], ensemble);
    if (!ensemble.failure.empty()) return ensemble;
    const std::size_t frames = all[0].size();
    ensemble.mean.assign(frames, {});
    ensemble.deviation.assign(frames, {});
    for (std::size_t f = 0; f < frames; ++f) {
        for (int o = 0; o < observable_count; ++o) {
            double sum = 0.0, squares = 0.0;
            for (const auto& run : all) sum += run[f][o];
            const double mean = sum / starts;
            for (const auto& run : all) squares += (run[f][o] - mean) * (run[f][o] - mean);
            ensemble.mean[f][o] = mean;
            ensemble.deviation[f][o] = starts > 1 ? std::sqrt(squares / (starts - 1.0) / starts) : 0.0;
        }
    }
    ensemble.cpu_s /= starts;
    return ensemble;
}

double range_of(const Ensemble& ensemble, int observable) {
    double low = infinity, high = -infinity;
    for (const Observables& frame : ensemble.mean) {
        low = std::min(low, frame[observable]);
        high = std::max(high, frame[observable]);
    }
    return high - low;
}

/// The scales of the errors: the largest displacement of a length, the range of the kinetic energy, the weight.
Observables scales_of(const Ensemble& reference) {
    const double length = std::max({range_of(reference, 0), range_of(reference, 1), range_of(reference, 2)});
    const double energy = range_of(reference, 3);
    return {length, length, length, energy, energy, reference.weight};
}

/// Root of the mean square over frames, over scales.
Observables errors_of(const std::vector<Observables>& difference, const Observables& scales) {
    Observables errors;
    for (int o = 0; o < observable_count; ++o) {
        double sum = 0.0;
        for (const Observables& frame : difference) sum += frame[o] * frame[o];
        errors[o] = std::sqrt(sum / static_cast<double>(difference.size())) / scales[o];
    }
    return errors;
}

double together(const Observables& errors) {
    double sum = 0.0;
    for (const double error : errors) sum += error * error;
    return std::sqrt(sum / observable_count);
}

std::vector<Observables> difference(const Ensemble& a, const Ensemble& b) {
    std::vector<Observables> frames(a.mean.size());
    for (std::size_t f = 0; f < frames.size(); ++f)
        for (int o = 0; o < observable_count; ++o) frames[f][o] = a.mean[f][o] - b.mean[f][o];
    return frames;
}

struct Options {
    std::vector<std::string> scenes = {"sphere", "scan", "incline", "poncho", "fold"};
    std::vector<int> sizes = {33, 65};
    std::vector<int> steps = {30, 60, 120, 240, 480};
    std::vector<double> shares = {0.1, 0.25, 0.5, 1.0, 2.0, 4.0};
    std::vector<double> tr_shares;
    bool linearised = false;
    int starts = 8;
    int finest = 960;
    std::string svg;
};

std::vector<Rule> rules_of(const Options& options) {
    std::vector<Rule> rules;
    char name[64];
    for (const double share : options.shares) {
        std::snprintf(name, sizeof name, "share %g", share);
        rules.push_back({.name = name, .share = share});
    }
    for (const double share : options.tr_shares) {
        std::snprintf(name, sizeof name, "tr_bdf2 %g", share);
        rules.push_back({.name = name, .scheme = Scheme::tr_bdf2, .share = share});
    }
    if (options.linearised) rules.push_back({.name = "linearised", .iterations = 1});
    return rules;
}

/// Marks rows where no other row of the scene is both cheaper and closer.
void mark_front(std::vector<Figures>& rows) {
    for (Figures& row : rows) {
        const auto beats = [&](const Figures& other) {
            return other["cpu_s"].get<double>() < row["cpu_s"].get<double>() &&
                   other["error"].get<double>() < row["error"].get<double>();
        };
        row["front"] = std::none_of(rows.begin(), rows.end(), beats) ? "*" : "";
    }
}

Figures row_of(const Task& task, const Ensemble& run, const Ensemble& reference, double noise) {
    const Observables scales = scales_of(reference), errors = errors_of(difference(run, reference), scales);
    Figures row{{"scene", task.kind->name},
                {"n", task.n},
                {"step", "1/" + std::to_string(task.steps_per_second)},
                {"rule", task.rule.name},
                {"cpu_s", run.cpu_s},
                {"error", together(errors)},
                {"noise", noise},
                {"newton_a_step", static_cast<double>(run.newton) / run.steps},
                {"dropped", run.dropped},
                {"strain", run.largest_strain}};
    for (int o = 0; o < observable_count; ++o) row[observable_names[o]] = errors[o];
    return row;
}

/// For the rows of one size: a line for each scene and rule, a point for each step.
scenes::Plot plot_of(const Figures& rows, int n) {
    scenes::Plot plot{.title = "scenes with contact, sheets of " + std::to_string(n) + " vertices a side",
                      .x_label = "CPU time of 1 s, s",
                      .y_label = "error of observables, over their scales",
                      .series = {}};
    std::map<std::string, std::size_t> places;
    for (const Figures& row : rows) {
        if (row["n"] != n || !row.contains("error")) continue;
        const std::string rule = row["rule"], name = row["scene"].get<std::string>() + ", " + rule;
        if (places.emplace(name, plot.series.size()).second) plot.series.push_back({name, {}});
        plot.series[places[name]].points.push_back({row["cpu_s"], row["error"], name + ", " + row["step"].get<std::string>()});
    }
    return plot;
}

void print_row(const Figures& row) {
    std::printf("%-8s %4d %-6s %-12s %8.3f %8.4f %7.4f %6.2f %5d %6.3f  ", row["scene"].get<std::string>().c_str(),
                row["n"].get<int>(), row["step"].get<std::string>().c_str(), row["rule"].get<std::string>().c_str(),
                row["cpu_s"].get<double>(), row["error"].get<double>(), row["noise"].get<double>(),
                row["newton_a_step"].get<double>(), row["dropped"].get<int>(), row["strain"].get<double>());
    for (const char* name : observable_names) std::printf(" %7.4f", row[name].get<double>());
    std::printf("\n");
    std::fflush(stdout);
}

void measure_scene(const SceneKind& kind, int n, const Options& options, Figures& rows) {
    const Ensemble reference = run_ensemble({&kind, n, options.finest, {.name = "reference", .share = 0.1}}, options.starts);
    if (!reference.failure.empty()) throw std::runtime_error(kind.name + ": the reference failed: " + reference.failure);
    const double noise = together(errors_of(reference.deviation, scales_of(reference)));
    std::vector<Figures> own, failed;
    for (const int steps : options.steps) {
        for (const Rule& rule : rules_of(options)) {
            const Task task{&kind, n, steps, rule};
            const Ensemble run = run_ensemble(task, options.starts);
            if (!run.failure.empty()) {
                std::printf("%-8s %4d 1/%d %s: %s\n", kind.name.c_str(), n, steps, rule.name.c_str(), run.failure.c_str());
                failed.push_back({{"scene", kind.name},
                                  {"n", n},
                                  {"step", "1/" + std::to_string(steps)},
                                  {"rule", rule.name},
                                  {"failure", run.failure}});
                continue;
            }
            own.push_back(row_of(task, run, reference, noise));
            print_row(own.back());
        }
    }
    mark_front(own);
    std::printf("front of %s, N = %d:", kind.name.c_str(), n);
    for (const Figures& row : own)
        if (row["front"] == "*")
            std::printf("  %s %s", row["step"].get<std::string>().c_str(), row["rule"].get<std::string>().c_str());
    std::printf("\n");
    for (const auto& list : {own, failed})
        for (const Figures& row : list) rows.push_back(row);
}

Figures measure(const Options& options) {
    std::printf("%-8s %4s %-6s %-12s %8s %8s %7s %6s %5s %6s  ", "scene", "N", "step", "rule", "CPU s", "error", "noise",
                "newton", "drop", "strain");
    for (const char* name : observable_names) std::printf(" %7s", name);
    std::printf("\n");
    Figures rows = Figures::array();
    const std::vector<SceneKind> kinds = all_scenes();
    for (const int n : options.sizes)
        for (const SceneKind& kind : kinds)
            if (std::find(options.scenes.begin(), options.scenes.end(), kind.name) != options.scenes.end())
                measure_scene(kind, n, options, rows);
    if (!options.svg.empty()) scenes::write_whole_file(options.svg, scenes::plot_svg(plot_of(rows, options.sizes.back())));
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Error of observables against CPU time, by step and stopping rule, in scenes with contact.",
                 "percale_contact_precision");
    Options options;
    const CLI::Validator in_frames(
        [](const std::string& text) {
            const int rate = std::atoi(text.c_str());
            return rate > 0 && rate % frames_per_second == 0 ? "" : text + " is no multiple of 30";
        },
        "a multiple of 30");
    app.add_option("--scenes", options.scenes, "sphere, scan, incline, poncho, fold")
        ->capture_default_str()
        ->check(CLI::IsMember(options.scenes));
    app.add_option("--sizes", options.sizes, "vertices along a side")->capture_default_str()->check(CLI::Range(9, 257));
    app.add_option("--steps", options.steps, "steps a second")->capture_default_str()->check(in_frames);
    app.add_option("--shares", options.shares, "StepSettings::newton_share of backward Euler")->capture_default_str();
    app.add_option("--tr-bdf2", options.tr_shares, "and of TR-BDF2");
    app.add_flag("--linearised", options.linearised, "backward Euler with one iteration, too");
    app.add_option("--starts", options.starts, "disturbed starts of each row")->capture_default_str()->check(CLI::Range(1, 64));
    app.add_option("--finest", options.finest, "steps a second of the reference")->capture_default_str()->check(in_frames);
    app.add_option("--svg", options.svg, "draws error against CPU time of the last size to this file");
    return percale::test::run_bench(app, argc, argv, [&] { return measure(options); });
}
