// Prints the cost of a 1/60 s step of three scenes beside another engine's, in turns on one thread: a sheet that hangs from two
// corners, that falls onto a sphere, and onto the bunny scan, if there is one. The other engine is any program that is called
//     PROGRAM hang|sphere|bunny N 1/60 SECONDS OUT.obj
// with the obstacle's OBJ file named by the environment variable OBST, that writes 30 frames a second, OUT.frames/f0001.obj and
// on, and prints ms_per_step=... (CPU time of stepping) and maxstrain=... (1 is twice the length).
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenes/meshes/mesh_import.h"
#include "scenes/meshes/obj_file.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/scenes/bench_scenes.h"
#include "tests/support/cpu_time.h"

namespace {

namespace fs = std::filesystem;
using percale::test::Figures;

struct Wanted {
    std::string peer;
    std::vector<std::string> scenes{"hang", "sphere", "bunny"};
    std::vector<int> sizes{33, 65};
    double seconds = 2.0;
    int turns = 3;
};

struct Place {
    std::string name;
    percale::TriangleMesh body;  // no triangles where nothing is in the way
};

/// Figures of one run: the shortest time of all turns, the rest of the last one.
struct Run {
    double ms = std::numeric_limits<double>::infinity();  // CPU time a step
    double strain = 0.0;
    int frames = 0, bad = 0;
    bool finite = true;
};

bool is_finite(const percale::TriangleMesh& mesh) {
    return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [](const percale::Vec3& x) { return x.allFinite(); });
}

void judge(const percale::TriangleMesh& sheet, const percale::TriangleMesh& body, Run& run) {
    ++run.frames;
    run.finite = run.finite && is_finite(sheet);
    if (body.triangles.empty() || !run.finite) return;
    run.bad += percale::test::is_crossed(sheet, body) ? 1 : 0;
}

Run run_percale(const Place& place, int n, double seconds) {
    const bool hangs = place.body.triangles.empty();
    const percale::StepSettings settings{.measure = percale::StepMeasures::none};
    percale::Simulation simulation =
        percale::test::make_sheet_scene(n, hangs ? nullptr : &place.body, hangs ? 0.0 : 0.6, settings);
    percale::TriangleMesh sheet = percale::make_grid(1.0, 1.0, n, n);
    simulation.prepare();
    Run run{.ms = 0.0};
    const int steps = static_cast<int>(std::lround(60.0 * seconds));
    for (int i = 0; i < steps; ++i) {
        const double start = percale::test::cpu_seconds();
        const percale::StepReport step = simulation.step();
        run.ms += 1e3 * (percale::test::cpu_seconds() - start) / steps;
        if (!step.ok()) throw std::runtime_error(step.explanation());
        run.strain = std::max(run.strain, simulation.largest_strain());
        if (i % 2 == 0) continue;
        const auto positions = simulation.positions(percale::ClothId{0});
        sheet.vertices.assign(positions.begin(), positions.end());
        judge(sheet, place.body, run);
    }
    return run;
}

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

/// The number behind `key` in the output of a peer; a run that diverged may print nan.
double number_behind(const std::string& text, const std::string& key) {
    const std::size_t at = text.rfind(key);
    if (at == std::string::npos) throw std::runtime_error("the peer printed no " + key + "...");
    return std::strtod(text.c_str() + at + key.size(), nullptr);
}

std::string printed_by(const std::string& command) {
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) throw std::runtime_error("cannot start " + command);
    std::string text;
    std::array<char, 4096> part{};
    while (std::fgets(part.data(), part.size(), pipe)) text += part.data();
    if (pclose(pipe) != 0) throw std::runtime_error("failed: " + command);
    return text;
}

Run run_peer(const Wanted& wanted, const Place& place, int n, const fs::path& folder) {
    const fs::path out = folder / "out.obj", frames = folder / "out.frames";
    fs::remove_all(frames);
    const std::string text =
        printed_by("OBST=" + quoted((folder / (place.name + ".obj")).string()) + " " + quoted(wanted.peer) + " " + place.name +
                   " " + std::to_string(n) + " 1/60 " + std::to_string(wanted.seconds) + " " + quoted(out.string()));
    Run run{.ms = number_behind(text, "ms_per_step="), .strain = number_behind(text, "maxstrain=")};
    for (int i = 1; i <= static_cast<int>(std::lround(30.0 * wanted.seconds)); ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "f%04d.obj", i);
        if (!fs::exists(frames / name)) break;
        judge(percale::scenes::import_mesh((frames / name).string()), place.body, run);
    }
    run.finite = run.finite && std::isfinite(run.strain);
    return run;
}

/// The last run, with the time of the shorter of two.
Run shorter(const Run& last, const Run& before) {
    Run run = last;
    run.ms = std::min(last.ms, before.ms);
    return run;
}

Figures compare(const Wanted& wanted, const Place& place, int n, const fs::path& folder) {
    Run ours, peer;
    for (int turn = 0; turn < wanted.turns; ++turn) {
        peer = shorter(run_peer(wanted, place, n, folder), peer);
        ours = shorter(run_percale(place, n, wanted.seconds), ours);
    }
    std::printf("%-7s %4d  %8.2f %7.1f %6d%s  %8.2f %7.1f %6d  %6.2f\n", place.name.c_str(), n, peer.ms, 100.0 * peer.strain,
                peer.bad, peer.finite ? " " : "*", ours.ms, 100.0 * ours.strain, ours.bad, ours.ms / peer.ms);
    std::fflush(stdout);
    return {{"scene", place.name},
            {"n", n},
            {"peer_ms", peer.ms},
            {"peer_strain", peer.strain},
            {"peer_bad_frames", peer.bad},
            {"peer_finite", peer.finite},
            {"percale_ms", ours.ms},
            {"percale_strain", ours.strain},
            {"percale_bad_frames", ours.bad},
            {"ratio", ours.ms / peer.ms}};
}

Figures measure(const Wanted& wanted) {
    const fs::path folder = fs::temp_directory_path() / ("percale_peer_" + std::to_string(getpid()));
    fs::create_directories(folder);
    std::vector<Place> places;
    for (const std::string& scene : wanted.scenes) {
        Place place{.name = scene, .body = {}};
        if (scene == "sphere") place.body = percale::make_sphere(0.25, 4);
        if (scene == "bunny") place.body = percale::test::bunny_scan();
        if (scene == "bunny" && place.body.triangles.empty()) {
            std::puts("bunny left out: no bunny00.off (PERCALE_REAL_MESHES names its folder)");
            continue;
        }
        percale::scenes::write_obj((folder / (scene + ".obj")).string(), place.body.vertices, place.body.triangles);
        places.push_back(std::move(place));
    }
    std::printf("%-7s %4s  %8s %7s %6s   %8s %7s %6s  %6s\n", "", "N", "peer ms", "strain%", "bad", "Percale", "strain%", "bad",
                "ratio");
    Figures rows = Figures::array();
    for (const Place& place : places) {
        for (const int n : wanted.sizes) rows.push_back(compare(wanted, place, n, folder));
    }
    fs::remove_all(folder);
    std::puts("*: the peer's sheet did not stay finite");
    return rows;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("What a 1/60 s step costs beside another engine's program, in turns.", "percale_peer_steps");
    Wanted wanted;
    app.add_option("--peer", wanted.peer, "the other engine's program")->required()->check(CLI::ExistingFile);
    app.add_option("--scenes", wanted.scenes, "which of them")
        ->capture_default_str()
        ->check(CLI::IsMember({"hang", "sphere", "bunny"}));
    app.add_option("--sizes", wanted.sizes, "vertices along a side")->capture_default_str()->check(CLI::Range(2, 1025));
    app.add_option("--seconds", wanted.seconds, "seconds simulated")->capture_default_str()->check(CLI::Range(0.1, 1e3));
    app.add_option("--turns", wanted.turns, "runs of each, the least time counts")
        ->capture_default_str()
        ->check(CLI::Range(1, 100));
    return percale::test::run_bench(app, argc, argv, [&] { return measure(wanted); });
}
