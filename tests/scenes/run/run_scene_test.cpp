#include "run/run_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "format/scene_file.h"
#include "meshes/obj_file.h"
#include "percale/certify.h"
#include "percale/error.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::run_scene_test {
namespace {

constexpr double g = 9.81;

Scene scene_of(const std::string& text, const std::vector<Override>& overrides = {}) {
    return parse_scene(text, "test.toml", overrides);
}

struct Recorded {
    RunResult result;
    std::vector<Frame> frames;
    std::vector<StepReport> steps;
    std::vector<std::uint64_t> hashes;
};

Recorded record(const Scene& scene) {
    Recorded recorded;
    BuiltScene built = build_scene(scene);
    RunHooks hooks;
    hooks.frame = [&](const Frame& frame) { recorded.frames.push_back(frame); };
    hooks.step = [&](const StepReport& report, const Simulation& simulation) {
        recorded.steps.push_back(report);
        recorded.hashes.push_back(simulation.state_hash());
    };
    recorded.result = run_scene(built, hooks);
    return recorded;
}

}  // namespace

TEST_CASE("adaptive steps end at every frame and every event, and at the scene's end") {
    // Frames at multiples of 1/43 s, an event between them, an end beside them.
    const std::string event =
        "[[event]]\ntime = 0.0537\nmove = { cloth = \"sheet\", vertices = [0], to = [0.0, 0.01, 0.0], over = 0.02 }\n";
    const Recorded recorded = record(scene_of(sheet_on_box() + event, {{"step.time_step", "auto"},
                                                                       {"step.tolerance", "0.01"},
                                                                       {"duration", "0.11"},
                                                                       {"cloth.sheet.pin", "[0]"},
                                                                       {"output.fps", "43"}}));
    REQUIRE(recorded.result.status == RunStatus::finished);
    REQUIRE(recorded.frames.size() == 5);
    for (const Frame& frame : recorded.frames) CHECK(frame.time == Approx(frame.index / 43.0).epsilon(1e-12));
    CHECK(recorded.result.totals.simulated_s == Approx(0.11).epsilon(1e-12));
    bool at_event = false;
    int parts = 0, rejected = 0;
    for (const StepReport& report : recorded.steps) {
        at_event = at_event || std::abs(report.time - 0.0537) < 1e-12;
        parts += report.parts;
        rejected += report.rejected + report.halvings;
        CHECK(report.dt <= 1.0 / 60.0 + 1e-12);
    }
    CHECK(at_event);
    CHECK(recorded.result.totals.steps == parts);
    CHECK(recorded.result.totals.rejected_steps == rejected);
    CHECK(recorded.result.totals.smallest_step_s < recorded.result.totals.largest_step_s);
    CHECK(recorded.result.measures.intersections == 0);
}

TEST_CASE("a run whose last step is longer covers its duration") {
    const Recorded recorded = record(scene_of(falling_sheet(), {{"step.time_step", "0.0333333"}}));
    CHECK(recorded.result.status == RunStatus::finished);
    CHECK(recorded.steps.size() == 3);
    CHECK(recorded.result.totals.simulated_s == Approx(0.1).epsilon(1e-12));
}

TEST_CASE("a run covers its duration, the last step shortened") {
    const Recorded recorded = record(scene_of(falling_sheet(), {{"step.time_step", "0.03"}}));
    REQUIRE(recorded.steps.size() == 4);
    CHECK(recorded.steps[2].dt == Approx(0.03));
    CHECK(recorded.steps[3].dt == Approx(0.01));
    CHECK(recorded.result.status == RunStatus::finished);
    CHECK(recorded.result.totals.steps == 4);
    CHECK(recorded.result.totals.simulated_s == Approx(0.1));
    CHECK(recorded.result.totals.smallest_step_s == Approx(0.01));
    CHECK(recorded.result.totals.largest_step_s == Approx(0.03));
}

TEST_CASE("a falling sheet shows the sums that symplectic Euler gives in every frame") {
    // v_n = -n g dt, y_n = y_0 - g dt^2 n (n + 1)/2
    const double dt = 0.01;
    const Recorded recorded = record(scene_of(falling_sheet(), {{"step.measure", "all"}}));
    REQUIRE(recorded.frames.size() == 6);
    for (const Frame& frame : recorded.frames) {
        const double n = 2.0 * frame.index;
        CHECK(frame.time == Approx(n * dt));
        for (const Vec3& x : frame.cloths[0].vertices) CHECK(x.y() == Approx(2.0 - g * dt * dt * n * (n + 1.0) / 2.0));
    }
    CHECK(recorded.result.measures.speed_at_end == Approx(10.0 * g * dt));
    CHECK(recorded.result.measures.rms_speed_at_end == Approx(10.0 * g * dt));
    CHECK(recorded.result.measures.lowest_vertex == Approx(2.0 - 55.0 * g * dt * dt));
    CHECK(recorded.result.measures.energy_gain < 1e-12);
    const double mass = 0.2 * 0.3 * 0.3;
    CHECK(recorded.result.totals.energy.kinetic == Approx(0.5 * mass * 100.0 * g * g * dt * dt));
}

TEST_CASE("frame k follows the first step that ends at or after k / fps") {
    const Recorded recorded = record(scene_of(falling_sheet(), {{"output.fps", "30"}}));
    REQUIRE(recorded.frames.size() == 4);
    CHECK(recorded.frames[1].time == Approx(0.04));
    CHECK(recorded.frames[2].time == Approx(0.07));
    CHECK(recorded.frames[3].time == Approx(0.10));
}

TEST_CASE("where frames come faster than steps a state is shown several times") {
    const Recorded recorded = record(scene_of(falling_sheet(), {{"output.fps", "200"}}));
    REQUIRE(recorded.frames.size() == 21);
    for (std::size_t i = 0; i < recorded.frames.size(); ++i) CHECK(recorded.frames[i].index == static_cast<int>(i));
    CHECK(recorded.frames[1].cloths[0].vertices == recorded.frames[2].cloths[0].vertices);
    CHECK(recorded.frames[2].cloths[0].vertices != recorded.frames[3].cloths[0].vertices);
}

TEST_CASE("an event that turns gravity round is no energy gain") {
    const std::string event = "\n[[event]]\ntime = 0.05\ngravity = [0.0, 90.0, 0.0]\n";
    const Recorded recorded = record(scene_of(falling_sheet() + event, {{"step.measure", "all"}}));
    CHECK(recorded.result.measures.energy_gain < 1e-9);
    CHECK(recorded.steps.back().energy.gravity < recorded.steps.front().energy.gravity);
}

TEST_CASE("totals are the sums and extremes of the steps") {
    const Recorded recorded = record(scene_of(sheet_on_box(), {{"step.measure", "all"}}));
    long newton = 0, linear = 0;
    int most = 0;
    double work = 0.0;
    for (const StepReport& report : recorded.steps) {
        newton += report.newton_iterations;
        linear += report.linear_iterations;
        most = std::max(most, report.contacts);
        work += report.energy.work;
    }
    const RunTotals& totals = recorded.result.totals;
    CHECK(totals.newton_iterations == newton);
    CHECK(totals.linear_iterations == linear);
    CHECK(totals.contacts_most == most);
    CHECK(most > 0);
    CHECK(totals.energy.work == Approx(work));
    CHECK(totals.energy.kinetic == recorded.steps.back().energy.kinetic);
    CHECK(totals.cpu_s > 0.0);
    CHECK(totals.wall_s >= 0.5 * totals.cpu_s);
}

TEST_CASE("each frame carries the certificate of exactly the meshes it shows") {
    const Recorded recorded = record(scene_of(sheet_on_box()));
    REQUIRE(recorded.frames.size() == 7);
    for (const Frame& frame : recorded.frames) {
        const Certificate certificate = certify(frame.cloths[0], frame.obstacles[0], 0.02);
        CHECK(frame.check.intersections == static_cast<int>(certificate.pairs.size()));
        CHECK(frame.check.smallest_distance == certificate.smallest_distance);
        CHECK(frame.check.clean());
    }
    CHECK(recorded.result.measures.intersections == 0);
    CHECK(recorded.frames[0].check.smallest_distance == Approx(0.015));
    CHECK(recorded.result.measures.smallest_distance < 0.006);
    CHECK(recorded.result.measures.smallest_distance > 0.0);
    CHECK(recorded.result.measures.worst_frame > 0);
}

TEST_CASE("an obstacle is shown where the simulation has it") {
    const std::string motion =
        "motion = [ { time = 0.0, translation = [0.0, -0.25, 0.0] }, { time = 0.2, translation = [0.1, -0.25, 0.0] } ]\n[output]";
    std::string text = sheet_on_box();
    text.replace(text.find("[output]"), 8, motion);
    const Recorded recorded = record(scene_of(text));
    REQUIRE(recorded.frames.size() == 7);
    const auto x = [&](std::size_t frame) { return recorded.frames[frame].obstacles[0].vertices[0].x(); };
    CHECK(x(3) - x(0) == Approx(0.05));
    CHECK(x(6) - x(0) == Approx(0.1));
}

TEST_CASE("without an obstacle nothing is certified and nothing is near") {
    const Recorded recorded = record(scene_of(falling_sheet()));
    CHECK(recorded.result.measures.intersections == 0);
    CHECK(recorded.result.measures.worst_frame == -1);
    CHECK(std::isinf(recorded.result.measures.smallest_distance));
}

TEST_CASE("a pin that is dragged through an obstacle ends the run as failed, with the reason") {
    std::string text = sheet_on_box();
    text.insert(text.find("[[obstacle]]"), "pin = [0]\n");
    text += "\n[[event]]\ntime = 0.0\nmove = { cloth = \"sheet\", vertices = [0], to = [0.0, -0.2, 0.0], over = 0.1 }\n";
    const Recorded recorded = record(scene_of(text));
    CHECK(recorded.result.status == RunStatus::failed);
    CHECK_FALSE(recorded.result.reason.empty());
    CHECK(recorded.result.reason == recorded.steps.back().explanation());
    CHECK(recorded.result.totals.steps == static_cast<int>(recorded.steps.size()) - 1);
    CHECK(recorded.result.measures.intersections == 0);
}

TEST_CASE("the same scene gives the same bits in every step") {
    const Recorded first = record(scene_of(sheet_on_box())), second = record(scene_of(sheet_on_box()));
    CHECK(first.hashes == second.hashes);
    CHECK(first.hashes.front() != first.hashes.back());
}

TEST_CASE("a run matches the frame it ended with, and differs from the start by its fall") {
    const TestFolder folder;
    const std::string expect = "\n[expect]\nmatches = { file = \"reference.obj\", within = 1e-3 }\n";
    const Recorded first = record(scene_of(falling_sheet()));
    const auto matched = [&](const TriangleMesh& reference) {
        write_obj(folder.path("reference.obj"), reference.vertices, reference.triangles);
        return record(parse_scene(falling_sheet() + expect, folder.path("test.toml"))).result.measures.matches;
    };
    CHECK(matched(first.frames.back().cloths[0]) == 0.0);
    CHECK(matched(first.frames.front().cloths[0]).value() == Approx(55.0 * g * 1e-4));
}

TEST_CASE("a reference that is missing or of another size is refused before anything begins") {
    const TestFolder folder;
    const std::string expect = "\n[expect]\nmatches = { file = \"reference.obj\", within = 1e-3 }\n";
    BuiltScene built = build_scene(parse_scene(falling_sheet() + expect, folder.path("test.toml")));
    bool begun = false;
    RunHooks hooks;
    hooks.begin = [&] { begun = true; };
    CHECK_THROWS_WITH(run_scene(built, hooks), Catch::StartsWith(folder.path("test.toml") + ":20:1: matches: ") &&
                                                   Catch::EndsWith("reference.obj: no such file"));
    const TriangleMesh small = make_grid(1.0, 1.0, 3, 3);
    write_obj(folder.path("reference.obj"), small.vertices, small.triangles);
    CHECK_THROWS_WITH(run_scene(built, hooks), Catch::Contains("has 9 vertices") && Catch::Contains("16"));
    CHECK_FALSE(begun);
}

TEST_CASE("a run's ledger is the sum of its steps and closes") {
    const Recorded plain = record(scene_of(sheet_on_box(), {{"step.measure", "all"}}));
    const Recorded ledger = record(scene_of(sheet_on_box(), {{"step.measure", "ledger"}}));
    CHECK(ledger.hashes == plain.hashes);
    CHECK(std::isnan(plain.result.totals.energy.dissipated()));
    const StepEnergy& energy = ledger.result.totals.energy;
    double friction = 0.0, integrator = 0.0;
    for (const StepReport& report : ledger.steps) {
        friction += report.energy.dissipated_friction;
        integrator += report.energy.dissipated_integrator;
    }
    CHECK(energy.dissipated_friction == friction);
    CHECK(energy.dissipated_integrator == integrator);
    CHECK(energy.dissipated_integrator > 0.0);
    CHECK(energy.closure() < 1e-11);
}

TEST_CASE("what steps do not measure is left open, and the rest is the same bit for bit") {
    const Recorded all = record(scene_of(sheet_on_box(), {{"step.measure", "all"}}));
    const Recorded none = record(scene_of(sheet_on_box(), {{"step.measure", "none"}}));
    CHECK(std::isnan(none.result.measures.largest_strain));
    CHECK(std::isnan(none.result.measures.energy_gain));
    CHECK(std::isnan(none.result.totals.energy.total()));
    const std::map<std::string, double> values = measure_values(none.result.measures);
    CHECK_FALSE((values.contains("largest_strain") || values.contains("energy_gain")));
    CHECK(values.at("speed_at_end") == all.result.measures.speed_at_end);
    CHECK(values.at("smallest_distance") == all.result.measures.smallest_distance);
    CHECK(none.hashes == all.hashes);
    for (std::size_t i = 0; i < all.steps.size(); ++i) CHECK(none.steps[i].contact_hash == all.steps[i].contact_hash);
}

TEST_CASE("left to itself a run measures the states of its frames and of its end, and no other step") {
    // A frame after every third step, and none at the end, which is after the eleventh.
    const std::vector<Override> timing = {{"output.fps", "20"}, {"duration", "0.18333333333333332"}};
    std::vector<Override> measured = timing;
    measured.push_back({"step.measure", "all"});
    const Recorded run = record(scene_of(sheet_on_box(), timing)), all = record(scene_of(sheet_on_box(), measured));
    REQUIRE(run.steps.size() == 11);
    REQUIRE(run.frames.size() == 4);
    CHECK(run.hashes == all.hashes);
    double strain = 0.0;
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
        CAPTURE(i);
        const StepReport &report = run.steps[i], &whole = all.steps[i];
        const bool frame = (i + 1) % 3 == 0;
        CHECK((std::isnan(report.energy.work) && std::isnan(report.energy.dissipated())));
        for (const double figure : {report.energy.total(), report.largest_strain, report.largest_speed})
            CHECK(std::isfinite(figure) == frame);
        if (!frame) continue;
        CHECK(report.energy.total() == whole.energy.total());
        CHECK(report.largest_strain == whole.largest_strain);
        CHECK(report.largest_speed == whole.largest_speed);
        strain = std::max(strain, whole.largest_strain);
    }
    CHECK(strain > 0.0);
    CHECK(run.result.measures.largest_strain == strain);
    CHECK(std::isnan(run.result.measures.energy_gain));
    CHECK_FALSE(measure_values(run.result.measures).contains("energy_gain"));
    const StepEnergy &end = run.result.totals.energy, &whole = all.result.totals.energy;
    for (const auto entry : {&StepEnergy::kinetic, &StepEnergy::gravity, &StepEnergy::elastic, &StepEnergy::contact})
        CHECK(end.*entry == whole.*entry);
    CHECK(std::isnan(end.work));
    for (const auto entry : ledger_entries) CHECK(std::isnan(end.*entry));
}

TEST_CASE("where [expect] reads strain or gain of energy all steps are measured, unless the file says otherwise") {
    const auto expecting = [](const std::string& measure, const std::vector<Override>& overrides = {}) {
        return scene_of(sheet_on_box() + "[expect]\n" + measure + " = { below = 1.0 }\n", overrides);
    };
    const auto measures_of = [](const Scene& scene) { return build_scene(scene).scene.step.measure; };
    CHECK(measures_of(scene_of(sheet_on_box())) == StepMeasures::automatic);
    CHECK(measures_of(expecting("speed_at_end")) == StepMeasures::automatic);
    for (const std::string measure : {"largest_strain", "energy_gain"}) {
        CAPTURE(measure);
        CHECK(expecting(measure).step.measure == StepMeasures::automatic);
        CHECK(measures_of(expecting(measure)) == StepMeasures::all);
        CHECK(measures_of(expecting(measure, {{"step.measure", "ledger"}})) == StepMeasures::ledger);
        CHECK(measures_of(expecting(measure, {{"step.measure", "none"}})) == StepMeasures::none);
        const Recorded run = record(expecting(measure)), all = record(scene_of(sheet_on_box(), {{"step.measure", "all"}}));
        for (const StepReport& report : run.steps)
            CHECK((std::isfinite(report.energy.total()) && std::isfinite(report.largest_strain)));
        CHECK(run.result.measures.largest_strain == all.result.measures.largest_strain);
        CHECK(run.result.measures.energy_gain == all.result.measures.energy_gain);
        CHECK(run.hashes == all.hashes);
    }
}

TEST_CASE("statuses have the words of the report") {
    CHECK(std::string(status_word(RunStatus::finished)) == "finished");
    CHECK(std::string(status_word(RunStatus::failed)) == "failed");
    CHECK(std::string(status_word(RunStatus::stopped)) == "stopped");
}

TEST_CASE("asked to, a run certifies the start and the state after every step, whatever the frames") {
    BuiltScene built = build_scene(scene_of(sheet_on_box(), {{"output.fps", "1"}}));
    CHECK_FALSE(record(scene_of(falling_sheet())).result.measures.steps.has_value());
    std::vector<double> distances;
    RunHooks hooks;
    hooks.step = [&](const StepReport&, const Simulation& simulation) {
        TriangleMesh cloth = built.cloth_meshes[0], box = built.obstacle_meshes[0];
        const auto positions = simulation.positions(built.cloths[0]);
        cloth.vertices.assign(positions.begin(), positions.end());
        box.vertices = transform(simulation.obstacle_pose(built.obstacles[0]), std::span<const Vec3>(box.vertices));
        distances.push_back(certify(cloth, box, 0.02).smallest_distance);
    };
    const RunResult result = run_scene(built, hooks, {.certify_steps = true});
    REQUIRE(result.measures.steps.has_value());
    const StepChecks& checks = *result.measures.steps;
    CHECK(checks.states == 13);
    CHECK(checks.intersections == 0);
    CHECK(checks.deepest_penetration == 0.0);
    const auto nearest = std::min_element(distances.begin(), distances.end());
    CHECK(checks.smallest_distance == *nearest);
    CHECK(checks.worst_step == 1 + static_cast<int>(nearest - distances.begin()));
    CHECK(checks.worst_time == Approx(checks.worst_step / 60.0));
    CHECK(checks.smallest_distance < result.measures.worst.smallest_distance);
}

TEST_CASE("a step in which an obstacle turns far is made in equal parts that end where the step does") {
    const std::string spin = "spin = { turns_per_s = 50, from = 0.1 }\n";
    std::string text = sheet_on_box();
    text.insert(text.find("[output]"), spin);
    const Recorded recorded = record(scene_of(text, {{"obstacle.box.friction", "0"}}));
    REQUIRE(recorded.result.status == RunStatus::finished);
    // Six whole steps, then six of twenty parts.
    REQUIRE(recorded.steps.size() == 126);
    CHECK(recorded.result.totals.steps == 126);
    CHECK(recorded.steps[5].dt == Approx(1.0 / 60.0));
    CHECK(recorded.steps[6].dt == Approx(1.0 / 1200.0));
    CHECK(recorded.steps.back().time == Approx(0.2).epsilon(1e-12));
    REQUIRE(recorded.frames.size() == 7);
    for (const Frame& frame : recorded.frames) CHECK(frame.time == Approx(frame.index / 30.0));
    // Fifty turns a second are whole turns after 0.1 s.
    CHECK((recorded.frames.back().obstacles[0].vertices[0] - recorded.frames[0].obstacles[0].vertices[0]).norm() < 1e-9);
}

TEST_CASE("a sheet on a plate that turns fifty times a second is dragged the way the plate turns") {
    std::string text = sheet_on_box();
    text.insert(text.find("[output]"), "spin = { turns_per_s = 50, from = 0.5 }\n");
    BuiltScene built = build_scene(scene_of(text, {{"duration", "0.6"}, {"obstacle.box.friction", "0.5"}}));
    REQUIRE(run_scene(built).status == RunStatus::finished);
    const auto positions = built.simulation.positions(built.cloths[0]), velocities = built.simulation.velocities(built.cloths[0]);
    const auto masses = built.simulation.masses(built.cloths[0]);
    double momentum = 0.0, lever = 0.0, mass = 0.0, rise = 0.0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vec3 &x = positions[i], &v = velocities[i];
        momentum += masses[i] * (x.z() * v.x() - x.x() * v.z());
        lever += masses[i] * std::hypot(x.x(), x.z());
        mass += masses[i];
        rise += masses[i] * v.y();
    }
    // It slides everywhere, so friction's impulse is mu times that of the normal forces: what the weight gave in 0.1 s and what
    // the sheet, at rest before, still has of it.
    CHECK(momentum == Approx(0.5 * lever * (0.1 * g + rise / mass)).epsilon(0.05));
}

TEST_CASE("panels that start through each other are sewn without contact, which later frames have") {
    const test::TestFolder folder;
    // Two squares, the second through the first, sewn along one edge of each.
    TriangleMesh first = make_grid(0.4, 0.4, 7, 7);
    std::string text;
    for (int panel = 0; panel < 2; ++panel) {
        for (const Vec3& x : first.vertices) {
            const double u = x.x() + 0.2 * panel;
            text +=
                "v " + std::to_string(u) + ' ' + std::to_string(panel * (0.5 * u - 0.05)) + ' ' + std::to_string(x.z()) + '\n';
        }
    }
    for (int panel = 0; panel < 2; ++panel) {
        for (const auto& [a, b, c] : first.triangles) {
            const int o = 1 + 49 * panel;
            text += "f " + std::to_string(a + o) + ' ' + std::to_string(b + o) + ' ' + std::to_string(c + o) + '\n';
        }
    }
    for (int k = 0; k < 7; ++k) {
        const int other = 49 + 7 * k;
        text += "stitch " + std::to_string(7 * k + 6) + ' ' + std::to_string(other) + ' ' + std::to_string(other) + " 0\n";
    }
    folder.write("panels.obj", text);
    const std::string scene =
        "duration = 0.6\ngravity = [0, 0, 0]\n[fabric.f]\narea_density = 0.2\nthickness = 0.004\nself_contact = true\n"
        "spring_damping = 0.5\nsprings = { structural = 500.0, bend = 2.0 }\n[[cloth]]\nname = \"c\"\nfabric = \"f\"\n"
        "mesh = \"panels.obj\"\n[[seam]]\nfile = \"mesh\"\nduration = 0.3\nstiffness = 500.0\n"
        "contact_while_closing = false\n[output]\nfps = 30\n";
    const std::string file = folder.write("sewn.toml", scene);
    const Recorded recorded = record(load_scene(file));
    REQUIRE(recorded.result.status == RunStatus::finished);
    CHECK(recorded.result.measures.intersections == 0);
    for (const Frame& frame : recorded.frames) {
        CAPTURE(frame.time);
        CHECK(frame.meeting == (frame.time >= 0.3 ? all_pairs(1) : PairsOfCloths{}));
        CHECK(frame.check.intersections == 0);
    }
    const std::vector<IntersectingPair> before = self_intersections(recorded.frames[2].cloths[0]);
    CHECK_FALSE(before.empty());
    CHECK(self_intersections(recorded.frames.back().cloths[0]).empty());
}

}  // namespace percale::scenes::test::run_scene_test
