// Prints how near a step with default settings comes to the solution of its equations, and in how many iterations: from the same
// state the step is made once more with newton_tolerance = 1e-8, and the distance of the two results is compared with the error
// of backward Euler in that step, about dt/2 |v_new - v_old|.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/bench_report.h"
#include "tests/bench/scenes/bench_scenes.h"

namespace {

using percale::Simulation;
using percale::StepReport;
using percale::StepStatus;
using percale::Vec3;
using percale::test::Figures;

constexpr double reference_tolerance = 1e-8;
constexpr percale::ClothId cloth{0};

/// Root of the mean of |a - b|^2 over the mass.
double distance(std::span<const Vec3> a, std::span<const Vec3> b, std::span<const double> masses) {
    double sum = 0.0, mass = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += masses[i] * (a[i] - b[i]).squaredNorm();
        mass += masses[i];
    }
    return std::sqrt(sum / mass);
}

/// Mean and largest of a number of values, and the time of the largest, s.
struct Spread {
    double sum = 0.0, worst = 0.0, worst_at = 0.0;
    int count = 0;

    void add(double value, double time) {
        if (value > worst) worst_at = time;
        worst = std::max(worst, value);
        sum += value;
        ++count;
    }
    double mean() const { return count > 0 ? sum / count : 0.0; }
};

struct Accuracy {
    Spread newton, linear;           // of every step
    Spread reference_newton;         // of the repeated steps
    Spread distance, share;          // m; ratio to the time error
    int split = 0, unconverged = 0;  // left out: the step was halved; its twin was, or did not reach 1e-8
};

std::vector<Vec3> copy(std::span<const Vec3> values) { return {values.begin(), values.end()}; }

/// One step of `simulation`, and of its twin from the same state.
StepReport compare_step(Simulation& simulation, Simulation& twin, Accuracy& accuracy) {
    const std::vector<Vec3> positions = copy(simulation.positions(cloth)), before = copy(simulation.velocities(cloth));
    // Both start without stick anchors, which are internal to a simulation.
    for (Simulation* one : {&simulation, &twin}) one->set_positions(cloth, positions);
    twin.set_velocities(cloth, before);
    const StepReport report = simulation.step(), reference = twin.step();
    if (!report.ok() || report.slept || reference.slept) return report;
    if (report.halvings > 0) {
        ++accuracy.split;
    } else if (reference.status != StepStatus::ok) {
        ++accuracy.unconverged;
    } else {
        const std::span<const double> masses = simulation.masses(cloth);
        const double error = distance(simulation.positions(cloth), twin.positions(cloth), masses);
        const double time_error = 0.5 * report.dt * distance(simulation.velocities(cloth), before, masses);
        accuracy.reference_newton.add(reference.newton_iterations, report.time);
        accuracy.distance.add(error, report.time);
        accuracy.share.add(error / time_error, report.time);
    }
    return report;
}

/// Throws where a step with default settings fails.
Accuracy run(Simulation& simulation, Simulation& twin, int steps, int every) {
    Accuracy accuracy;
    for (int i = 1; i <= steps; ++i) {
        const StepReport report = i % every == 0 ? compare_step(simulation, twin, accuracy) : simulation.step();
        if (!report.ok()) throw std::runtime_error(report.explanation());
        if (report.slept) continue;
        accuracy.newton.add(report.newton_iterations, report.time);
        accuracy.linear.add(report.linear_iterations, report.time);
    }
    return accuracy;
}

/// Duration and frequency of the measurements.
struct Wish {
    double seconds = 2.0;
    int every = 10;
};

/// What is measured: a sheet hanging or on a body.
struct Case {
    const char* name;
    int n;
    const percale::TriangleMesh* body;
    double rate;  // steps a second
};

Figures figures_of(const Case& what, const Accuracy& accuracy) {
    return {{"scene", what.name},
            {"n", what.n},
            {"rate", what.rate},
            {"compared", accuracy.share.count},
            {"split", accuracy.split},
            {"unconverged", accuracy.unconverged},
            {"newton", accuracy.newton.mean()},
            {"newton_worst", accuracy.newton.worst},
            {"linear", accuracy.linear.mean()},
            {"newton_reference", accuracy.reference_newton.mean()},
            {"distance", accuracy.distance.mean()},
            {"distance_worst", accuracy.distance.worst},
            {"share", accuracy.share.mean()},
            {"share_worst", accuracy.share.worst},
            {"share_worst_at", accuracy.share.worst_at}};
}

Figures report(const Case& what, const Wish& wish) {
    const double height = what.body ? 0.6 : 0.0;
    percale::StepSettings settings{.time_step = 1.0 / what.rate};
    Simulation simulation = percale::test::make_sheet_scene(what.n, what.body, height, settings);
    settings.newton_tolerance = reference_tolerance;
    settings.newton_iterations = 1000;
    Simulation twin = percale::test::make_sheet_scene(what.n, what.body, height, settings);
    const int steps = std::max(1, static_cast<int>(std::lround(what.rate * wish.seconds)));
    const Accuracy a = run(simulation, twin, steps, wish.every);
    std::printf("%-7s %4d %6.0f %6.2f %6.0f %7.1f %8.1f %9d %5d %8d %10.1e %10.1e %8.3f %8.3f %6.2f\n", what.name, what.n,
                what.rate, a.newton.mean(), a.newton.worst, a.linear.mean(), a.reference_newton.mean(), a.share.count, a.split,
                a.unconverged, a.distance.mean(), a.distance.worst, a.share.mean(), a.share.worst, a.share.worst_at);
    std::fflush(stdout);
    return figures_of(what, a);
}

Figures measure(int largest, int largest_on_body, const Wish& wish) {
    percale::TriangleMesh body = percale::test::bunny_scan();
    const bool scan = !body.triangles.empty();
    if (!scan) body = percale::make_sphere(0.25, 4);
    std::printf("%-7s %4s %6s %6s %6s %7s %8s %9s %5s %8s %10s %10s %8s %8s %6s\n", "", "N", "1/dt", "newton", "worst", "linear",
                "to 1e-8", "compared", "split", "unconv.", "distance", "worst m", "share", "worst", "at s");
    Figures rows = Figures::array();
    for (const double rate : {60.0, 240.0}) {
        for (const int n : {33, 65, 129, 257}) {
            if (n <= largest) rows.push_back(report({"hanging", n, nullptr, rate}, wish));
        }
        for (const int n : {33, 65, 129}) {
            if (n <= largest_on_body) rows.push_back(report({scan ? "bunny" : "sphere", n, &body, rate}, wish));
        }
    }
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "How near steps with default settings come to the solution of their equations, beside the error of the time step.",
        "percale_newton_accuracy");
    int largest = 129, largest_on_body = 65;
    Wish wish;
    app.add_option("--largest", largest, "largest N of the hanging sheets 33, 65, 129, 257; 0: none")
        ->capture_default_str()
        ->check(CLI::Range(0, 257));
    app.add_option("--largest-on-body", largest_on_body, "likewise of the sheets 33, 65, 129 that fall on a body")
        ->capture_default_str()
        ->check(CLI::Range(0, 129));
    app.add_option("--seconds", wish.seconds, "seconds simulated")->capture_default_str()->check(CLI::Range(1e-3, 1e4));
    app.add_option("--every", wish.every, "compares each step of this number")
        ->capture_default_str()
        ->check(CLI::Range(1, 100000));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(largest, largest_on_body, wish); });
}
