// Error against CPU time with contact: several scenes, steps and stopping rules of the solver, each from several disturbed
// starts, so that the remaining error does not depend on one run. The observables of an ensemble are compared with those of the
// finest step.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "percale/simulation.h"
#include "scenes/common/whole_file.h"
#include "scenes/report/plot_svg.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/scenes/contact_precision_scenes.h"

namespace {

using namespace percale;
using test::ContactScene;
using test::Figures;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int frames_per_second = 30;
constexpr double simulated_s = 1.0;

/// The observables of each frame; SI units.
constexpr int observable_count = 6;
constexpr const char* observable_names[observable_count] = {"height", "lowest", "aside", "kinetic", "elastic", "force"};
using Observables = std::array<double, observable_count>;

/// A stopping rule of the solver.
struct Rule {
    std::string name;
    Scheme scheme = Scheme::backward_euler;
    double newton_error_ratio = 1.0;
    int iterations = 50;
};

/// The mean over an ensemble in each frame, its standard error, and its cost.
struct Ensemble {
    std::vector<Observables> mean, deviation;
    double cpu_s = 0.0, largest_strain = 0.0, weight = 0.0;  // s, of structural springs in the frames, N
    long newton = 0;
    int steps = 0, dropped = 0;
    std::string failure;
};

/// Sums over the vertices of all cloths; SI units.
struct Totals {
    double mass = 0.0, lowest = infinity;
    Vec3 moment = Vec3::Zero(), momentum = Vec3::Zero();  // of masses; `force` is made of differences of momentum
};

Totals totals_of(const Simulation& simulation) {
    Totals totals;
    for (int cloth = 0; cloth < simulation.cloth_count(); ++cloth) {
        const auto positions = simulation.positions({cloth}), velocities = simulation.velocities({cloth});
        const auto masses = simulation.masses({cloth});
        for (std::size_t i = 0; i < masses.size(); ++i) {
            totals.mass += masses[i];
            totals.moment += masses[i] * positions[i];
            totals.momentum += masses[i] * velocities[i];
            totals.lowest = std::min(totals.lowest, positions[i].y());
        }
    }
    return totals;
}

Observables observe(const Simulation& simulation, const Totals& totals, double force) {
    const Vec3 centre = totals.moment / totals.mass;
    const StepEnergy energy = simulation.energy();
    return {centre.y(), totals.lowest, std::hypot(centre.x(), centre.z()), energy.kinetic, energy.elastic, force};
}

struct Task {
    const ContactScene* kind = nullptr;
    int n = 0;
    int steps_per_second = 0;
    Rule rule;
};

void run_one(const Task& task, int start, std::vector<Observables>& frames, Ensemble& ensemble) {
    const StepSettings settings{.time_step = 1.0 / task.steps_per_second,
                                .scheme = task.rule.scheme,
                                .newton_error_ratio = task.rule.newton_error_ratio,
                                .newton_iterations = task.rule.iterations,
                                .measure = StepMeasures::none};
    Simulation simulation = task.kind->make(task.n, settings, start);
    const int between = task.steps_per_second / frames_per_second;
    Totals last = totals_of(simulation);
    ensemble.weight = 9.81 * last.mass;
    const int count = static_cast<int>(std::lround(simulated_s * task.steps_per_second));
    for (int i = 1; i <= count; ++i) {
        if (task.kind->drive) task.kind->drive(simulation, i * settings.time_step);
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
        const Totals now = totals_of(simulation);
        const double force = (now.momentum - last.momentum).y() * frames_per_second + ensemble.weight;
        frames.push_back(observe(simulation, now, force));
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

/// The scales of the errors: the largest displacement of a length, the larger range of both energies, the weight.
Observables scales_of(const Ensemble& reference) {
    const double length = std::max({range_of(reference, 0), range_of(reference, 1), range_of(reference, 2)});
    const double energy = std::max(range_of(reference, 3), range_of(reference, 4));
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
    std::vector<std::string> scenes;
    std::vector<int> sizes = {33, 65};
    std::vector<int> steps = {30, 60, 120, 240, 480};
    std::vector<double> ratios = {0.1, 0.25, 0.5, 1.0, 2.0, 4.0};
    std::vector<double> tr_ratios;
    bool linearised = false;
    int starts = 8;
    int finest = 960;
    std::string svg;
};

std::vector<Rule> rules_of(const Options& options) {
    std::vector<Rule> rules;
    char name[64];
    for (const double ratio : options.ratios) {
        std::snprintf(name, sizeof name, "R %g", ratio);
        rules.push_back({.name = name, .newton_error_ratio = ratio});
    }
    for (const double ratio : options.tr_ratios) {
        std::snprintf(name, sizeof name, "tr_bdf2 R %g", ratio);
        rules.push_back({.name = name, .scheme = Scheme::tr_bdf2, .newton_error_ratio = ratio});
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
    std::printf("%-11s %4d %-6s %-14s %8.3f %8.4f %7.4f %6.2f %5d %6.3f  ", row["scene"].get<std::string>().c_str(),
                row["n"].get<int>(), row["step"].get<std::string>().c_str(), row["rule"].get<std::string>().c_str(),
                row["cpu_s"].get<double>(), row["error"].get<double>(), row["noise"].get<double>(),
                row["newton_a_step"].get<double>(), row["dropped"].get<int>(), row["strain"].get<double>());
    for (const char* name : observable_names) std::printf(" %7.4f", row[name].get<double>());
    std::printf("\n");
    std::fflush(stdout);
}

void measure_scene(const ContactScene& kind, int n, const Options& options, Figures& rows) {
    const Ensemble reference =
        run_ensemble({&kind, n, options.finest, {.name = "reference", .newton_error_ratio = 0.1}}, options.starts);
    if (!reference.failure.empty()) throw std::runtime_error(kind.name + ": the reference failed: " + reference.failure);
    const double noise = together(errors_of(reference.deviation, scales_of(reference)));
    std::vector<Figures> own, failed;
    for (const int steps : options.steps) {
        for (const Rule& rule : rules_of(options)) {
            const Task task{&kind, n, steps, rule};
            const Ensemble run = run_ensemble(task, options.starts);
            if (!run.failure.empty()) {
                std::printf("%-11s %4d 1/%d %s: %s\n", kind.name.c_str(), n, steps, rule.name.c_str(), run.failure.c_str());
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

Figures measure(const Options& options, const std::vector<ContactScene>& kinds) {
    std::printf("%-11s %4s %-6s %-14s %8s %8s %7s %6s %5s %6s  ", "scene", "N", "step", "rule", "CPU s", "error", "noise",
                "newton", "drop", "strain");
    for (const char* name : observable_names) std::printf(" %7s", name);
    std::printf("\n");
    Figures rows = Figures::array();
    for (const int n : options.sizes)
        for (const ContactScene& kind : kinds)
            if (std::find(options.scenes.begin(), options.scenes.end(), kind.name) != options.scenes.end())
                measure_scene(kind, n, options, rows);
    if (!options.svg.empty()) scenes::write_whole_file(options.svg, scenes::plot_svg(plot_of(rows, options.sizes.back())));
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Error of observables against CPU time, by step and stopping rule, in scenes with contact.",
                 "percale_contact_precision");
    const std::vector<ContactScene> kinds = percale::test::contact_scenes();
    Options options;
    for (const ContactScene& kind : kinds) options.scenes.push_back(kind.name);
    const CLI::Validator in_frames(
        [](const std::string& text) {
            const int rate = std::atoi(text.c_str());
            return rate > 0 && rate % frames_per_second == 0 ? "" : text + " is no multiple of 30";
        },
        "a multiple of 30");
    app.add_option("--scenes", options.scenes, "names of scenes; scan only where that is installed")
        ->capture_default_str()
        ->check(CLI::IsMember(options.scenes));
    app.add_option("--sizes", options.sizes, "vertices along a side")->capture_default_str()->check(CLI::Range(9, 257));
    app.add_option("--steps", options.steps, "steps a second")->capture_default_str()->check(in_frames);
    app.add_option("--ratios", options.ratios, "StepSettings::newton_error_ratio of backward Euler, R")->capture_default_str();
    app.add_option("--tr-bdf2", options.tr_ratios, "and of TR-BDF2");
    app.add_flag("--linearised", options.linearised, "backward Euler with one iteration, too");
    app.add_option("--starts", options.starts, "disturbed starts of each row")->capture_default_str()->check(CLI::Range(1, 64));
    app.add_option("--finest", options.finest, "steps a second of the reference")->capture_default_str()->check(in_frames);
    app.add_option("--svg", options.svg, "draws error against CPU time of the last size to this file");
    return percale::test::run_bench(app, argc, argv, [&] { return measure(options, kinds); });
}
