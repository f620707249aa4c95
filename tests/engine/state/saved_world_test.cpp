#include "engine/state/saved_world.h"

#include <cmath>
#include <functional>
#include <limits>

#include "engine/schemes/schemes.h"
#include "engine/state/state_seal.h"
#include "engine/step/step.h"

#include "tests/support/bench_meshes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"
#include "tests/support/resumable.h"

namespace percale::test::saved_world_test {
namespace {

constexpr std::array places = {1, 9, 20};

Simulation sheet(const StepSettings& settings, const Fabric& fabric = sheet_fabric(), int count = 9) {
    Simulation simulation(settings);
    const ClothId cloth = simulation.add_cloth(make_grid(1.0, 1.0, count, count), fabric);
    for (const int vertex : {0, 1, count - 1}) simulation.pin(cloth, vertex);
    return simulation;
}

/// Changes of every kind: a pin is drawn aside, released and held again, wind and gravity change.
void move_everything(Simulation& simulation, int step) {
    const ClothId cloth{0};
    if (step < 12) simulation.move_pin(cloth, 0, Vec3(-0.5, 0.01 * step, -0.5));
    if (step == 8) simulation.set_wind({3.0, 0.0, 1.0});
    if (step == 14) simulation.unpin(cloth, 0);
    if (step == 18) simulation.pin(cloth, 40);
    if (step == 22) simulation.set_gravity({0.0, -1.62, 0.0});
}

Resumable hanging(const std::string& name, const StepSettings& settings, const Fabric& fabric = sheet_fabric(), int count = 9) {
    return {name, [=] { return sheet(settings, fabric, count); }, move_everything};
}

std::vector<Resumable> scheme_runs() {
    std::vector<Resumable> runs;
    for (const Scheme scheme : all_schemes) {
        const bool implicit = facts_of(scheme).implicit;
        const double step = implicit ? 1.0 / 60.0 : 1e-3;
        const std::string word(facts_of(scheme).word);
        runs.push_back(hanging(word, {.time_step = step, .scheme = scheme, .measure = StepMeasures::ledger}));
        const bool kept = scheme == Scheme::rk4 || scheme == Scheme::bdf2 || scheme == Scheme::tr_bdf2;
        if (kept)
            runs.push_back(hanging(word + ", adaptive",
                                   {.adaptive = true, .tolerance = 3e-2, .scheme = scheme, .measure = StepMeasures::all}));
    }
    runs.push_back(hanging("automatic", {.time_step = 0.01, .scheme = Scheme::automatic, .measure = StepMeasures::all}));
    return runs;
}

std::vector<Resumable> solver_runs() {
    std::vector<Resumable> runs;
    Fabric stiff = sheet_fabric();
    stiff.springs.structural = 3e4;
    for (const LinearSolver solver : {LinearSolver::automatic, LinearSolver::multigrid, LinearSolver::direct, LinearSolver::cg}) {
        const std::string word = "solver " + std::to_string(static_cast<int>(solver));
        runs.push_back(hanging(word, {.linear_solver = solver, .measure = StepMeasures::all}, stiff, 13));
    }
    runs.push_back(hanging("nothing skipped", {.skip = false}, stiff, 13));
    runs.push_back(hanging("a given tolerance", {.newton_tolerance = 1e-6, .measure = StepMeasures::all}));
    runs.push_back(hanging("damping by velocity", {.damping_form = DampingForm::velocity, .measure = StepMeasures::all}));
    runs.push_back(hanging("three threads", {.threads = 3, .measure = StepMeasures::all}));
    runs.push_back(hanging("nothing measured", {}));
    return runs;
}

std::vector<Resumable> fabric_runs() {
    Fabric bending = sheet_fabric(), moduli = fabric_preset("cotton");
    bending.springs.bend = 0.0;
    bending.bend_stiffness = 1e-3;
    std::vector<Resumable> runs = {hanging("hinges", {.measure = StepMeasures::ledger}, bending),
                                   hanging("moduli", {.measure = StepMeasures::all}, moduli)};
    const auto free_mesh = [](const Fabric& fabric) {
        Simulation simulation({.measure = StepMeasures::ledger});
        const ClothId cloth = simulation.add_cloth(irregular_sheet(1.0, 300), fabric);
        simulation.pin(cloth, 0);
        return simulation;
    };
    Fabric hinges = free_fabric();
    hinges.springs.bend = 0.0;
    hinges.bend_stiffness = 1e-3;
    runs.push_back({"free mesh", [=] { return free_mesh(free_fabric()); }, move_everything});
    runs.push_back({"hinges of a free mesh", [=] { return free_mesh(hinges); }, move_everything});
    const auto sewn = [] {
        Simulation simulation({.measure = StepMeasures::ledger});
        const ClothId first = simulation.add_cloth(make_grid(0.4, 0.4, 5, 5), sheet_fabric());
        const ClothId second = simulation.add_cloth(make_grid(0.4, 0.4, 5, 5), sheet_fabric(), {.translation = {0, 0.1, 0}});
        const std::vector<std::array<int, 2>> pairs = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}};
        simulation.add_seam(first, second, pairs, {.over = 0.25});
        simulation.pin(first, 24);
        return simulation;
    };
    runs.push_back({"seam", sewn});
    return runs;
}

void sew_points(Simulation& simulation) {
    const std::vector<Stitch> points = {{0, 0, 1, 0.3}, {2, 1, 2, 0.5}, {3, 3, 3}};
    simulation.add_seam({0}, {1}, points, {.over = 0.4});
}

Simulation on_plane(const StepSettings& settings, double tilt) {
    Simulation simulation(settings, std::make_unique<PlaneDetector>());
    const Pose turned{.translation = Vec3::Zero(), .rotation = {std::cos(tilt / 2), 0, 0, std::sin(tilt / 2)}};
    Pose above = turned;
    above.translation = transform(turned, Vec3(0, 0.008, 0));
    simulation.add_cloth(make_grid(0.4, 0.4, 5, 5), sheet_fabric(), above);
    simulation.add_obstacle(make_plane(1.0), turned, {.friction = 0.4, .name = "floor"});
    return simulation;
}

void move_floor(Simulation& simulation, int step) {
    if (step >= 5 && step < 15) simulation.move_obstacle({0}, {.translation = {0.004 * (step - 4), 0.001 * (step - 4), 0.0}});
    if (step == 16) simulation.set_time_step(0.004);
}

std::vector<Resumable> contact_runs() {
    std::vector<Resumable> runs;
    for (const ContactResponse response : {ContactResponse::penalty, ContactResponse::projection}) {
        const std::string word = response == ContactResponse::penalty ? "penalty" : "projection";
        const StepSettings settings{.contact_response = response, .measure = StepMeasures::ledger};
        runs.push_back({"moving floor, " + word, [=] { return on_plane(settings, 0.0); }, move_floor});
        runs.push_back({"slope, " + word, [=] { return on_plane(settings, 0.3); }});
    }
    runs.push_back(
        {"floor, tr_bdf2", [] { return on_plane({.scheme = Scheme::tr_bdf2, .measure = StepMeasures::all}, 0.0); }, move_floor});
    runs.push_back({"floor, adaptive",
                    [] { return on_plane({.adaptive = true, .scheme = Scheme::tr_bdf2, .measure = StepMeasures::all}, 0.0); },
                    move_floor});
    return runs;
}

void check_resumes(const std::vector<Resumable>& runs) {
    for (const Resumable& run : runs) {
        CAPTURE(run.name);
        CHECK(first_difference(run, places) == -1);
    }
}

Saved saved_of(const World& world, const std::vector<StartMove>& moves) {
    SavedSize size;
    return saved_world(world, moves, size);
}

}  // namespace

TEST_CASE("A resumed run makes the same steps in every bit: all schemes", "[slow]") { check_resumes(scheme_runs()); }
TEST_CASE("A resumed run makes the same steps in every bit: all solvers", "[slow]") { check_resumes(solver_runs()); }
TEST_CASE("A resumed run makes the same steps in every bit: fabrics and seams") { check_resumes(fabric_runs()); }
TEST_CASE("A resumed run makes the same steps in every bit: contact and friction") { check_resumes(contact_runs()); }

TEST_CASE("Cloth asleep stays asleep after restoring, and wakes for the same reasons") {
    const auto make = [] {
        Fabric fabric = sheet_fabric();
        fabric.spring_damping = 1.0;
        Simulation simulation({.measure = StepMeasures::ledger}, std::make_unique<PlaneDetector>());
        simulation.add_cloth(make_grid(0.2, 0.2, 3, 3), fabric, {.translation = {0, 0.004, 0}});
        simulation.add_obstacle(make_plane(1.0), {}, {.friction = 0.4, .name = "floor"});
        return simulation;
    };
    const auto script = [](Simulation& simulation, int step) {
        if (step == 150) simulation.set_gravity({0.5, -9.81, 0.0});
    };
    const Resumable run{"asleep", make, script, 180};
    Simulation first = make();
    const std::vector<StepTrace> steps = trace(run, first, 0);
    const auto slept = [&](int n) { return steps[static_cast<std::size_t>(n)].figures[10] == 1.0; };
    REQUIRE(slept(149));
    REQUIRE_FALSE(slept(151));
    int asleep_from = 0;
    while (!slept(asleep_from)) ++asleep_from;
    CHECK(first_difference(run, {asleep_from - 10, asleep_from, 120}) == -1);
}

TEST_CASE("A state of one thread is resumed by two, and includes gravity, wind and time step") {
    Simulation one = sheet({});
    one.set_gravity({0, -1, 0});
    one.set_wind({1, 0, 0});
    one.set_time_step(0.01);
    for (int n = 0; n < 5; ++n) one.step();
    Simulation two = sheet({.threads = 2, .start = StartRule::refuse});
    two.restore(one.save());
    CHECK(two.time() == one.time());
    CHECK(copy(two.positions({0})) == copy(one.positions({0})));
    CHECK(copy(two.velocities({0})) == copy(one.velocities({0})));
    one.step();
    two.step();
    CHECK(two.state_hash() == one.state_hash());
    CHECK(two.time() == Approx(0.06));
}

TEST_CASE("A simulation that has already run accepts a state like a new one") {
    const StepSettings settings{.measure = StepMeasures::all};
    Simulation one = sheet(settings), other = sheet(settings);
    for (int n = 0; n < 5; ++n) one.step();
    for (int n = 0; n < 20; ++n) move_everything(other, n), other.step();
    other.restore(one.save());
    for (int n = 0; n < 5; ++n) CHECK(other.step().energy.total() == one.step().energy.total());
    CHECK(other.state_hash() == one.state_hash());
}

TEST_CASE("A state of other cloth, other obstacles or other settings is refused, and nothing has changed") {
    Simulation plane = on_plane({}, 0.0);
    plane.step();
    const Saved saved = plane.save();
    const auto fault = [&](Simulation simulation) {
        const std::uint64_t before = simulation.state_hash();
        const std::string message = scene_error([&] { simulation.restore(saved); });
        CHECK(simulation.state_hash() == before);
        CHECK(simulation.time() == 0.0);
        return message;
    };
    CHECK(mentions(fault(sheet({})), {"other cloth"}));
    CHECK(mentions(fault(on_plane({.scheme = Scheme::tr_bdf2}, 0.0)), {"other step settings"}));
    CHECK(mentions(fault(on_plane({.newton_iterations = 3}, 0.0)), {"other step settings"}));
    Simulation more = on_plane({}, 0.0);
    more.add_obstacle(make_plane(1.0), {.translation = {0, -1, 0}});
    CHECK(mentions(fault(std::move(more)), {"other obstacles"}));
}

TEST_CASE("Damaged states are refused and change nothing") {
    Simulation simulation = on_plane({}, 0.0);
    for (int n = 0; n < 10; ++n) simulation.step();
    const Saved good = simulation.save();
    const std::uint64_t before = simulation.state_hash();
    for (std::size_t length = 0; length < good.size(); length += 7) {
        CHECK_THROWS_AS(simulation.restore(std::span(good).first(length)), SceneError);
    }
    for (std::size_t at = 0; at < good.size(); at += 11) {
        Saved bad = good;
        bad[at] ^= std::byte{1};
        CHECK_THROWS_AS(simulation.restore(bad), SceneError);
    }
    CHECK(simulation.state_hash() == before);
    CHECK_NOTHROW(simulation.restore(good));
}

/// Bytes that are damaged but sealed correctly: they are either refused or can be stepped from without harm.
TEST_CASE("No content of a correctly sealed state does harm") {
    Simulation simulation = on_plane({.measure = StepMeasures::ledger}, 0.0);
    for (int n = 0; n < 10; ++n) simulation.step();
    const Saved good = simulation.save();
    const std::span<const std::byte> view = unsealed(state_seal, good);
    Random random(7);
    int taken = 0;
    for (int round = 0; round < 2000; ++round) {
        Saved content(view.begin(), view.end());
        for (int k = 1 + random.index(3); k > 0; --k) {
            const int at = 24 + random.index(static_cast<int>(content.size()) - 24);
            content[static_cast<std::size_t>(at)] = static_cast<std::byte>(random.index(256));
        }
        Simulation other = on_plane({.measure = StepMeasures::ledger}, 0.0);
        if (!scene_error([&] { other.restore(sealed(state_seal, content)); }).empty()) continue;
        ++taken;
        if (taken % 20 == 0) other.step();
    }
    CHECK(taken > 100);
}

namespace {

struct Fault {
    const char* words;
    std::function<void(World&)> make;
    Scheme scheme = Scheme::backward_euler;
    std::vector<StartMove> moves = {};
};

World on_low_plane(Scheme scheme) {
    const TriangleMesh grid = make_grid(0.2, 0.2, 3, 3);
    World world = make_world(cloth_model(grid, sheet_fabric()), grid.vertices, {.scheme = scheme});
    world.scene.detector = std::make_unique<PlaneDetector>();
    world.scene.detector->set_cloth(world.scene.model.triangles, world.scene.model.thickness);
    world.scene.detector->add_obstacle(make_plane(1.0), {.translation = {0, -0.1, 0}}, 0.3);
    world.scene.script.obstacles.push_back({"plane", {.translation = {0, -0.1, 0}}, {.translation = {0, -0.1, 0}}, 2});
    step(world);
    return world;
}

/// An anchor between cloths.
ClothAnchor anchor(const std::array<int, 4>& vertex, const std::array<double, 4>& weight) {
    return {.vertex = vertex, .weight = weight};
}

std::vector<Fault> faults() {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    const StartMove move{.cloth = 1, .obstacle = 0};
    return {
        {"time_step", [=](World& w) { w.scene.settings.time_step = -1.0; }},
        {"not finite", [=](World& w) { w.state.time = nan; }},
        {"not finite", [=](World& w) { w.state.contact_energy = infinity; }},
        {"not finite", [=](World& w) { w.state.contact_energy = nan; }},
        {"not finite", [=](World& w) { w.state.cloth.velocities.set(3, Vec3(0, infinity, 0)); }},
        {"wrong number of vertices", [=](World& w) { w.state.cloth.positions.resize(20); }},
        {"stick anchor",
         [=](World& w) { w.state.cloth.stick_anchors.push_back({.vertex = 9, .obstacle = 0, .stretch = Vec3::Zero()}); }},
        {"stick anchor",
         [=](World& w) { w.state.cloth.stick_anchors.push_back({.vertex = 0, .obstacle = 1, .stretch = Vec3::Zero()}); }},
        {"stick anchor",
         [=](World& w) { w.state.cloth.stick_anchors.push_back({.vertex = 0, .obstacle = 0, .stretch = Vec3(nan, 0, 0)}); }},
        {"an anchor between cloths on nothing",
         [=](World& w) {
             w.state.contact.cloth_anchors = {anchor({0, 9, -1, -1}, {1.0, -1.0, 0.0, 0.0})};
         }},
        {"an anchor between cloths on nothing",
         [=](World& w) {
             w.state.contact.cloth_anchors = {anchor({0, -1, -1, -1}, {1.0, 0.0, 0.0, 0.0})};
         }},
        {"an anchor between cloths on nothing",
         [=](World& w) {
             w.state.contact.cloth_anchors = {anchor({0, 1, -1, -1}, {nan, -1.0, 0.0, 0.0})};
         }},
        {"not finite", [=](World& w) { w.state.contact.energy = infinity; }},
        {"move of nothing", [](World&) {}, Scheme::backward_euler, {move}},
        {"neither pinned nor free", [=](World& w) { w.scene.script.free[2] = 0.5; }},
        {"neither pinned nor free", [=](World& w) { w.scene.script.free.back() = 1.0; }},
        {"other sizes", [=](World& w) { w.scene.script.obstacles[0].end.scale = 2.0; }},
        {"a pose that is none", [=](World& w) { w.scene.script.obstacles[0].end.rotation.w = 2.0; }},
        {"a pose that is none", [=](World& w) { w.scene.script.obstacles[0].end.translation.x() = nan; }},
        {"scheme of another kind", [=](World& w) { w.scene.plan.scheme = Scheme::rk4; }},
        {"scheme of another kind", [=](World& w) { w.scene.plan.parts = 2; }},
        {"wrong number of cloths", [=](World& w) { w.rest.cloths.resize(2); }},
        {"negative time step", [=](World& w) { w.state.past.earlier_length = -0.1; }},
        {"wrong number of vertices", [=](World& w) { w.state.past.earlier_length = 0.1; }},
        {"wrong number of vertices", [=](World& w) { w.state.past.unbalanced.resize(20); }, Scheme::tr_bdf2},
        {"too short", [=](World& w) { w.state.control.length = 1e-300; }},
        {"below 0", [=](World& w) { w.state.control.left = -1.0; }},
        {"below 0", [=](World& w) { w.state.control.error_ratio_before = nan; }},
    };
}

}  // namespace

TEST_CASE("A state that no step can reach is refused with the reason, and nothing has changed") {
    for (const Fault& fault : faults()) {
        World bad = on_low_plane(fault.scheme), world = on_low_plane(fault.scheme);
        CHECK_NOTHROW(restore_world(saved_of(bad, {}), world));
        const Saved before = saved_of(world, {});
        fault.make(bad);
        CAPTURE(fault.words);
        CHECK(mentions(scene_error([&] { restore_world(saved_of(bad, fault.moves), world); }), {"saved state", fault.words}));
        CHECK(saved_of(world, {}) == before);
    }
}

TEST_CASE("A detector without saved state refuses to be saved") {
    class Blind : public PlaneDetector {
    public:
        void save(StateWriter& state) const override { ContactDetector::save(state); }
    };
    Simulation simulation({}, std::make_unique<Blind>());
    simulation.add_cloth(make_grid(1, 1, 3, 3), sheet_fabric());
    CHECK(mentions(scene_error([&] { simulation.save(); }), {"cannot save its state"}));
}

TEST_CASE("A simulation to which cloth was added between steps continues from its saved state") {
    for (const Scheme scheme : {Scheme::backward_euler, Scheme::bdf2, Scheme::tr_bdf2}) {
        Simulation first({.scheme = scheme}), second({.scheme = scheme});
        for (Simulation* simulation : {&first, &second}) {
            const ClothId cloth = simulation->add_cloth(make_grid(1, 1, 9, 9), sheet_fabric());
            simulation->pin(cloth, 0);
            for (int n = 0; n < 3; ++n) REQUIRE(simulation->step().ok());
            simulation->add_cloth(make_grid(1, 1, 5, 5), sheet_fabric(), {.translation = {0, 1, 0}});
        }
        const Saved at_once = first.save();
        CHECK_NOTHROW(second.restore(at_once));
        REQUIRE(first.step().ok());
        CHECK_NOTHROW(second.restore(first.save()));
        for (int n = 0; n < 3; ++n) REQUIRE((first.step().ok() && second.step().ok()));
        CHECK(first.state_hash() == second.state_hash());
    }
}

TEST_CASE("a seam of points that was made during a run continues to close in its own directions") {
    const auto make = [] {
        Simulation simulation({.measure = StepMeasures::ledger});
        simulation.add_cloth(make_grid(0.4, 0.4, 5, 5), sheet_fabric(), {.translation = {0, 0.1, 0}}, "one");
        simulation.add_cloth(make_grid(0.4, 0.4, 5, 5), sheet_fabric(), {}, "other");
        simulation.pin({1}, 24);
        return simulation;
    };
    Simulation simulation = make();
    for (int n = 0; n < 8; ++n) simulation.step();
    sew_points(simulation);
    for (int n = 0; n < 4; ++n) simulation.step();
    Simulation resumed = make();
    sew_points(resumed);
    resumed.restore(simulation.save());
    for (int n = 0; n < 8; ++n) {
        simulation.step();
        resumed.step();
        REQUIRE(resumed.state_hash() == simulation.state_hash());
    }
    Simulation sewn_otherwise = make();
    sewn_otherwise.add_seam({0}, {1}, std::vector<Stitch>{{0, 0, 1, 0.4}, {2, 1, 2, 0.5}, {3, 3, 3}}, {.over = 0.4});
    CHECK(scene_error([&] { sewn_otherwise.restore(simulation.save()); }).find("other cloth, pairs of cloths or seams") !=
          std::string::npos);
}

}  // namespace percale::test::saved_world_test
