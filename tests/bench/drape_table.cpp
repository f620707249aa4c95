// Prints how a sheet of 1 m drapes over a sphere and over body scans: frames with an intersection, when it came to rest or how
// fast it still moves, and what it costs, for several sizes, detectors and contact responses.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "percale/detectors.h"
#include "percale/options.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/scenes/bench_scenes.h"
#include "tests/support/bench_unit.h"

namespace {

using percale::test::Figures;

struct Options {
    std::vector<int> sizes = {33, 65, 129};
    std::vector<std::string> bodies = {"sphere",        "bunny00.off",          "man.off",
                                       "armadillo.off", "refined_elephant.off", "fandisk.off"};
    std::vector<std::string> detectors = {"fcl", "bullet"};
    std::vector<std::string> responses;
    double seconds = 2.0;
};

const percale::Option<percale::StepSettings>& response_option() {
    const auto options = percale::step_options();
    return *std::find_if(options.begin(), options.end(), [](const auto& option) { return option.key == "contact_response"; });
}

std::vector<std::string> all_responses() {
    const auto words = response_option().choices;
    return {words.begin(), words.end()};
}

percale::StepSettings settings_with(const std::string& response) {
    const auto words = response_option().choices;
    percale::StepSettings settings{.measure = percale::StepMeasures::all};
    response_option().set_choice(settings, static_cast<int>(std::find(words.begin(), words.end(), response) - words.begin()));
    return settings;
}

/// One cell of the table.
struct Case {
    std::string body, detector, response;
    int n = 0;
};

/// The result of a run.
struct Drape {
    int steps = 0, frames = 0, bad = 0;
    std::optional<double> rest_at;  // s
    double rms_speed = 0.0;         // m/s, at the end
    double strain = 0.0, cpu_s = 0.0;
    percale::StageTimes stages;
    std::string failure;
};

bool frame_is_bad(const percale::Simulation& simulation, percale::ClothId cloth, percale::TriangleMesh sheet,
                  const percale::TriangleMesh& body) {
    const auto positions = simulation.positions(cloth);
    sheet.vertices.assign(positions.begin(), positions.end());
    return percale::test::is_crossed(sheet, body);
}

double rms_speed(const percale::Simulation& simulation, percale::ClothId cloth) {
    double sum = 0.0;
    const auto velocities = simulation.velocities(cloth);
    for (const percale::Vec3& v : velocities) sum += v.squaredNorm();
    return std::sqrt(sum / static_cast<double>(velocities.size()));
}

Drape drape(const Case& wish, const percale::TriangleMesh& body, double seconds) {
    percale::Simulation simulation(settings_with(wish.response),
                                   wish.detector == "fcl" ? percale::make_fcl_detector() : percale::make_bullet_detector());
    const percale::TriangleMesh sheet = percale::make_grid(1.0, 1.0, wish.n, wish.n);
    const percale::ClothId cloth = simulation.add_cloth(sheet, percale::test::bench_fabric(), {.translation = {0.0, 0.6, 0.0}});
    simulation.add_obstacle(body);
    Drape result;
    for (int i = 0; i < static_cast<int>(std::lround(60.0 * seconds)); ++i) {
        const percale::StepReport step = simulation.step();
        result.cpu_s += step.cpu_s;
        result.stages += step.stages;
        if (!step.ok()) {
            result.failure = step.explanation();
            break;
        }
        ++result.steps;
        result.strain = std::max(result.strain, step.largest_strain);
        if (step.slept && !result.rest_at) result.rest_at = step.time;
        if (i % 2 == 0) continue;
        ++result.frames;
        result.bad += frame_is_bad(simulation, cloth, sheet, body) ? 1 : 0;
    }
    result.rms_speed = rms_speed(simulation, cloth);
    return result;
}

Figures figures_of(const Case& wish, const Drape& result) {
    const double per = result.steps > 0 ? 1e3 / result.steps : 0.0, ms = per * result.cpu_s;
    const percale::StageTimes& t = result.stages;
    Figures row{{"body", wish.body},
                {"n", wish.n},
                {"detector", wish.detector},
                {"response", wish.response},
                {"frames", result.frames},
                {"bad_frames", result.bad},
                {"rms_speed", result.rms_speed},
                {"largest_strain", result.strain},
                {"cpu_s_per_s", 60.0 * ms / 1e3},
                {"ms", ms},
                {"units", ms / percale::test::machine_unit(wish.n)}};
    row["rest_at_s"] = result.rest_at ? Figures(*result.rest_at) : Figures(nullptr);
    row["stages_ms"] = {{"refresh", per * t.refresh}, {"evaluate", per * t.evaluate}, {"force", per * t.force},
                        {"setup", per * t.setup},     {"solve", per * t.solve},       {"cut", per * t.cut},
                        {"measure", per * t.measure}};
    if (!result.failure.empty()) row["failure"] = result.failure;
    return row;
}

void print_row(const Figures& row) {
    const auto word = [&row](const char* key) { return row[key].get<std::string>(); };
    const auto stage = [&row](const char* key) { return row["stages_ms"][key].get<double>(); };
    char rest[32] = "";
    if (row["rest_at_s"].is_null())
        std::snprintf(rest, sizeof rest, "%.1f mm/s", 1e3 * row["rms_speed"].get<double>());
    else
        std::snprintf(rest, sizeof rest, "at %.2f s", row["rest_at_s"].get<double>());
    std::printf("%-20s %4d %-6s %-10s %3d/%-3d %12s %7.1f %8.3f %8.2f %6.0f  %7.2f %8.2f %6.2f %6.2f %7.2f %6.2f %7.2f\n",
                word("body").c_str(), row["n"].get<int>(), word("detector").c_str(), word("response").c_str(),
                row["bad_frames"].get<int>(), row["frames"].get<int>(), rest, 100.0 * row["largest_strain"].get<double>(),
                row["cpu_s_per_s"].get<double>(), row["ms"].get<double>(), row["units"].get<double>(), stage("refresh"),
                stage("evaluate"), stage("force"), stage("setup"), stage("solve"), stage("cut"), stage("measure"));
    if (row.contains("failure")) std::printf("  %s\n", word("failure").c_str());
    std::fflush(stdout);
}

/// All rows of one body.
void measure_body(const std::string& name, const Options& options, Figures& rows) {
    const percale::TriangleMesh body = name == "sphere" ? percale::make_sphere(0.25, 4) : percale::test::body_scan(name);
    if (body.triangles.empty()) {
        std::printf("%s left out: it is not there (PERCALE_REAL_MESHES)\n", name.c_str());
        return;
    }
    for (const int n : options.sizes)
        for (const std::string& detector : options.detectors)
            for (const std::string& response : options.responses) {
                const Case wish{name, detector, response, n};
                rows.push_back(figures_of(wish, drape(wish, body, options.seconds)));
                print_row(rows.back());
            }
}

Figures measure(const Options& options) {
    std::printf("%-20s %4s %-6s %-10s %7s %12s %7s %8s %8s %6s  %7s %8s %6s %6s %7s %6s %7s\n", "", "N", "tree", "response",
                "bad", "rest, speed", "strain%", "CPU s/s", "ms/step", "U", "refresh", "evaluate", "force", "setup", "solve",
                "cut", "measure");
    Figures rows = Figures::array();
    for (const std::string& name : options.bodies) measure_body(name, options, rows);
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("A sheet draping over a sphere and body scans: bad frames, rest, cost.", "percale_drape_table");
    Options options;
    options.responses = all_responses();
    app.add_option("--sizes", options.sizes, "vertices along a side")->capture_default_str()->check(CLI::Range(2, 1025));
    app.add_option("--meshes", options.bodies, "sphere, or OFF files of PERCALE_REAL_MESHES")->capture_default_str();
    app.add_option("--detectors", options.detectors, "fcl, bullet")
        ->capture_default_str()
        ->check(CLI::IsMember({"fcl", "bullet"}));
    app.add_option("--responses", options.responses, "contact responses")
        ->capture_default_str()
        ->check(CLI::IsMember(all_responses()));
    app.add_option("--seconds", options.seconds, "seconds simulated")->capture_default_str()->check(CLI::Range(1e-2, 1e4));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(options); });
}
