// Error against CPU time on the sheet that hangs from two corners: every scheme of Percale, a plain scalar Runge-Kutta and
// Bullet's deformable body, in one run. The error is the root of the mean square over vertices against the plain Runge-Kutta
// with a step of 1e-5 s; the time is that of the measuring thread, the shortest of the rounds.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "percale/options.h"
#include "percale/simulation.h"
#include "scenes/common/whole_file.h"
#include "scenes/report/plot_svg.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/peers/plain_rk4.h"
#ifdef PERCALE_HAS_BULLET_SOFT_BODY
#include "tests/bench/peers/bullet_sheet.h"
#endif

namespace {

using namespace percale;
using test::Figures;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Task {
    int n;            // vertices a side
    double duration;  // s
};

/// Settings and results of one run.
struct Row {
    std::string engine, setting;
    int steps = 0;
    std::function<std::vector<Vec3>(int steps)> run;  // from the start to the end
    double error = infinity;                          // m; infinity: diverged
    double seconds = infinity;                        // CPU
};

double rms_between(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(a.size()));
}

std::vector<Vec3> run_plain(const Task& task, int steps) {
    test::PlainRk4 sheet(task.n);
    for (int i = 0; i < steps; ++i) sheet.step(task.duration / steps);
    return sheet.positions();
}

std::vector<Vec3> run_percale(const Task& task, Scheme scheme, int steps) {
    Simulation simulation({.time_step = task.duration / steps, .scheme = scheme, .measure = StepMeasures::none});
    const ClothId cloth = simulation.add_cloth(make_grid(1.0, 1.0, task.n, task.n), test::bench_fabric());
    simulation.pin(cloth, 0);
    simulation.pin(cloth, task.n - 1);
    for (int i = 0; i < steps; ++i)
        if (!simulation.step().ok()) return {};
    const auto positions = simulation.positions(cloth);
    return {positions.begin(), positions.end()};
}

#ifdef PERCALE_HAS_BULLET_SOFT_BODY
std::vector<Vec3> run_bullet(const Task& task, test::BulletForces forces, int steps) {
    test::BulletSheet sheet(task.n, task.duration / steps, forces);
    for (int i = 0; i < steps; ++i) sheet.step();
    return sheet.positions();
}
#endif

std::vector<std::string_view> scheme_words() {
    for (const Option<StepSettings>& option : step_options())
        if (option.key == "scheme") return {option.choices.begin(), option.choices.end()};
    return {};
}

/// Steps of 1/60 s halved `first` to `last` times, and for schemes of few evaluations a step the sixths between.
std::vector<int> step_counts(double duration, int first, int last, int between) {
    std::vector<int> counts;
    for (int k = first * between; k <= last * between; ++k)
        counts.push_back(static_cast<int>(std::lround(duration * 60.0 * std::pow(2.0, static_cast<double>(k) / between))));
    return counts;
}

bool is_explicit(std::string_view scheme) {
    return scheme == "rk4" || scheme == "symplectic_euler" || scheme == "forward_euler" || scheme == "midpoint";
}

void add_percale(const Task& task, std::vector<Row>& rows) {
    const std::vector<std::string_view> words = scheme_words();
    for (std::size_t k = 0; k < words.size(); ++k) {
        if (words[k] == "auto") continue;
        const Scheme scheme = static_cast<Scheme>(k);
        const auto counts = is_explicit(words[k]) ? step_counts(task.duration, 5, 8, 6) : step_counts(task.duration, 0, 6, 1);
        for (const int steps : counts)
            rows.push_back(
                {"Percale", std::string(words[k]), steps, [task, scheme](int n) { return run_percale(task, scheme, n); }});
    }
}

void add_plain(const Task& task, std::vector<Row>& rows) {
    for (const int steps : step_counts(task.duration, 5, 8, 6))
        rows.push_back({"plain loop", "rk4", steps, [task](int n) { return run_plain(task, n); }});
}

void add_bullet(const Task& task, std::vector<Row>& rows) {
#ifdef PERCALE_HAS_BULLET_SOFT_BODY
    for (const int steps : step_counts(task.duration, 2, 5, 1))
        rows.push_back(
            {"Bullet", "implicit", steps, [task](int n) { return run_bullet(task, test::BulletForces::implicit, n); }});
    for (const int steps : step_counts(task.duration, 5, 7, 1))
        rows.push_back(
            {"Bullet", "explicit", steps, [task](int n) { return run_bullet(task, test::BulletForces::explicit_, n); }});
#else
    static_cast<void>(task);
    static_cast<void>(rows);
#endif
}

/// One round of a row: its time, and in the first round its error. A run that left the room, ten metres around, has diverged.
void measure(Row& row, const std::vector<Vec3>& reference) {
    const double start = test::cpu_seconds();
    const std::vector<Vec3> end = row.run(row.steps);
    const double seconds = test::cpu_seconds() - start;
    const double error = end.empty() ? infinity : rms_between(end, reference);
    row.error = error < 10.0 ? error : infinity;
    row.seconds = std::min(row.seconds, seconds);
}

Figures figures_of(const Row& row, const Task& task) {
    return {{"engine", row.engine},
            {"setting", row.setting},
            {"time_step", task.duration / row.steps},
            {"error_m", std::isfinite(row.error) ? Figures(row.error) : Figures(nullptr)},
            {"cpu_s", row.seconds}};
}

void print_rows(const std::vector<Row>& rows, const Task& task) {
    std::printf("%-11s %-18s %12s %10s %10s\n", "engine", "setting", "step s", "error m", "CPU s");
    for (const Row& row : rows) {
        if (!std::isfinite(row.error)) continue;
        std::printf("%-11s %-18s %12.4g %10.2e %10.4g\n", row.engine.c_str(), row.setting.c_str(), task.duration / row.steps,
                    row.error, row.seconds);
    }
}

const Row* cheapest(const std::vector<Row>& rows, const std::string& engine, double error) {
    const Row* best = nullptr;
    for (const Row& row : rows)
        if (row.engine == engine && row.error <= error && (!best || row.seconds < best->seconds)) best = &row;
    return best;
}

/// The row of an engine with a setting that has the smallest error; of equals the cheaper one.
const Row* most_accurate(const std::vector<Row>& rows, const std::string& engine, const std::string& setting) {
    const Row* best = nullptr;
    for (const Row& row : rows)
        if (row.engine == engine && row.setting == setting && std::isfinite(row.error) && (!best || row.error < best->error))
            best = &row;
    return best;
}

Figures compare_with_plain(const std::vector<Row>& rows, const Task& task) {
    Figures ratios = Figures::array();
    std::printf("\nwithin m    cheapest of Percale                    CPU s   plain rk4 s   plain / Percale (wanted >= 3)\n");
    for (int power = -2; power >= -8; --power) {
        const double error = std::pow(10.0, power);
        const Row *ours = cheapest(rows, "Percale", error), *plain = cheapest(rows, "plain loop", error);
        if (!ours || !plain) continue;
        std::printf("1e%-8d  %-18s %10.4g s   %8.4f  %8.4f at %.4g s  %6.2f\n", power, ours->setting.c_str(),
                    task.duration / ours->steps, ours->seconds, plain->seconds, task.duration / plain->steps,
                    plain->seconds / ours->seconds);
        ratios.push_back({{"error_m", error},
                          {"percale", figures_of(*ours, task)},
                          {"plain", figures_of(*plain, task)},
                          {"plain_over_percale", plain->seconds / ours->seconds}});
    }
    return ratios;
}

Figures compare_with_bullet(const std::vector<Row>& rows, const Task& task) {
    Figures ratios = Figures::array();
    const Row* ours = cheapest(rows, "Percale", 1e-6);
    for (const char* setting : {"implicit", "explicit"}) {
        const Row* bullet = most_accurate(rows, "Bullet", setting);
        if (!ours || !bullet) continue;
        std::printf("Bullet %s, %.2e m, takes %.1f times as long as Percale for 1e-6 m (wanted >= 4)\n", setting, bullet->error,
                    bullet->seconds / ours->seconds);
        ratios.push_back({{"bullet", figures_of(*bullet, task)},
                          {"percale", figures_of(*ours, task)},
                          {"bullet_over_percale", bullet->seconds / ours->seconds}});
    }
    return ratios;
}

scenes::Plot plot_of(const std::vector<Row>& rows, const Task& task, double uncertainty) {
    char label[64];
    std::snprintf(label, sizeof label, "CPU time of %g s, s", task.duration);
    scenes::Plot plot{
        .title = "a sheet of " + std::to_string(task.n) + " x " + std::to_string(task.n) + " hanging from two corners",
        .x_label = label,
        .y_label = "error, rms over vertices, m",
        .series = {},
        .floor = uncertainty,
        .floor_label = "reference"};
    for (const Row& row : rows) {
        const std::string name = row.engine == "Percale" ? row.setting : row.engine + ", " + row.setting;
        if (plot.series.empty() || plot.series.back().name != name) plot.series.push_back({name, {}});
        plot.series.back().points.push_back({row.seconds, row.error, name + ", " + std::to_string(row.steps) + " steps"});
    }
    std::erase_if(plot.series, [](const scenes::PlotSeries& series) {
        return std::none_of(series.points.begin(), series.points.end(),
                            [](const scenes::PlotPoint& point) { return std::isfinite(point.y); });
    });
    return plot;
}

Figures measure_all(const Task& task, int rounds, const std::string& svg) {
    const int finest = static_cast<int>(std::lround(task.duration / 1e-5));
    const std::vector<Vec3> reference = run_plain(task, finest);
    const double uncertainty = rms_between(run_plain(task, finest / 2), reference) / 15.0;
    std::printf("reference: plain rk4 at 1e-5 s, known to %.1e m\n", uncertainty);
    std::vector<Row> rows;
    add_percale(task, rows);
    add_plain(task, rows);
    add_bullet(task, rows);
    for (int round = 0; round < rounds; ++round)
        for (Row& row : rows) measure(row, reference);
    print_rows(rows, task);
    Figures figures{{"n", task.n}, {"duration", task.duration}, {"reference_uncertainty_m", uncertainty}};
    for (const Row& row : rows) figures["rows"].push_back(figures_of(row, task));
    if (!svg.empty()) scenes::write_whole_file(svg, scenes::plot_svg(plot_of(rows, task, uncertainty)));
    figures["against_plain"] = compare_with_plain(rows, task);
    figures["against_bullet"] = compare_with_bullet(rows, task);
    return figures;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Error against CPU time on the hanging sheet, beside a plain Runge-Kutta and Bullet.", "percale_work_precision");
    Task task{.n = 33, .duration = 0.5};
    int rounds = 3;
    std::string svg;
    app.add_option("--vertices", task.n, "vertices a side")->capture_default_str()->check(CLI::Range(3, 129));
    app.add_option("--rounds", rounds, "runs of each, of which the fastest counts")
        ->capture_default_str()
        ->check(CLI::Range(1, 100));
    app.add_option("--svg", svg, "also draw the diagram into this file");
    return test::run_bench(app, argc, argv, [&] { return measure_all(task, rounds, svg); });
}
