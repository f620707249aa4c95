// Prints the cost of limiting strain: a soft sheet that hangs from two corners, free, with a strain limit, and with springs so
// stiff that they keep to the limit by themselves.
#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>

#include "percale/simulation.h"
#include "tests/bench/bench_report.h"
#include "tests/support/cpu_time.h"

namespace {

using percale::test::Figures;
using namespace percale;

struct Sheet {
    std::string name;
    double stiffness;             // N/m, of moduli
    std::optional<double> limit;  // strain
};

struct Cost {
    double cpu_s = std::numeric_limits<double>::infinity();
    double strain = 0.0, median_strain = 0.0;  // of the largest strain of each step
    int newton = 0, linear = 0;
};

/// 3 s in steps of 1/60 s.
Cost hang(const Sheet& sheet, int n) {
    constexpr int steps = 180;
    Simulation simulation({.measure = StepMeasures::all});
    Fabric fabric{.area_density = 0.3};
    fabric.stretch_stiffness = {sheet.stiffness, sheet.stiffness};
    fabric.damping_time = 1e-3;
    fabric.strain_limit = sheet.limit;
    const ClothId cloth = simulation.add_cloth(make_grid(1.0, 1.0, n, n), fabric);
    simulation.pin(cloth, 0);
    simulation.pin(cloth, n - 1);
    Cost cost;
    std::vector<double> strains;
    const double start = test::cpu_seconds();
    for (int k = 0; k < steps; ++k) {
        const StepReport report = simulation.step();
        if (!report.ok()) throw std::runtime_error(report.explanation());
        strains.push_back(report.largest_strain);
        cost.newton += report.newton_iterations;
        cost.linear += report.linear_iterations;
    }
    cost.cpu_s = test::cpu_seconds() - start;
    std::ranges::sort(strains);
    cost.strain = strains.back();
    cost.median_strain = strains[steps / 2];
    return cost;
}

Figures measure(int n, double limit) {
    const Sheet sheets[] = {
        {"free", 50.0, {}}, {"limited", 50.0, limit}, {"stiff", 50.0 * 0.8 / limit, {}}, {"stiffer", 50.0 * 4.0 / limit, {}}};
    std::printf("%-10s %8s %8s %8s %8s %8s %8s\n", "", "N/m", "CPU s", "Newton", "linear", "most %", "median %");
    Figures rows = Figures::array();
    for (const Sheet& sheet : sheets) {
        Cost cost;
        for (int round = 0; round < 2; ++round) {
            const double before = cost.cpu_s;
            cost = hang(sheet, n);
            cost.cpu_s = std::min(cost.cpu_s, before);
        }
        std::printf("%-10s %8.0f %8.3f %8d %8d %8.1f %8.1f\n", sheet.name.c_str(), sheet.stiffness, cost.cpu_s, cost.newton,
                    cost.linear, 100.0 * cost.strain, 100.0 * cost.median_strain);
        rows.push_back({{"sheet", sheet.name},
                        {"stiffness_n_per_m", sheet.stiffness},
                        {"cpu_s", cost.cpu_s},
                        {"newton", cost.newton},
                        {"linear", cost.linear},
                        {"largest_strain", cost.strain},
                        {"median_strain", cost.median_strain}});
    }
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What a strain limit costs beside stiff cloth.", "percale_strain_limit");
    int n = 65;
    double limit = 0.05;
    app.add_option("--vertices", n, "along each side")->capture_default_str()->check(CLI::Range(5, 257));
    app.add_option("--limit", limit, "strain")->capture_default_str()->check(CLI::Range(0.001, 1.0));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(n, limit); });
}
