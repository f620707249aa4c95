// Degenerate states that users reach. Each is simulated, finite and without gain of energy, or refused by name.
#include <cmath>

#include "percale/detectors.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::degenerate_states_test {
namespace {

/// One way of stepping.
struct Way {
    const char* name;
    Scheme scheme;
    ContactResponse response = ContactResponse::penalty;
};

constexpr std::array free_ways = {Way{"backward Euler", Scheme::backward_euler}, Way{"TR-BDF2", Scheme::tr_bdf2}};
constexpr std::array contact_ways = {Way{"backward Euler, penalty", Scheme::backward_euler},
                                     Way{"backward Euler, projection", Scheme::backward_euler, ContactResponse::projection},
                                     Way{"TR-BDF2", Scheme::tr_bdf2}};

StepSettings settings_of(const Way& way) {
    // The solver's residual is energy, too: it is smaller than by default.
    return {.scheme = way.scheme, .newton_error_ratio = 0.1, .contact_response = way.response, .measure = StepMeasures::ledger};
}

Fabric woven_fabric() {
    Fabric fabric = free_fabric();
    fabric.springs = {.structural = 0.0};
    fabric.stretch_stiffness = {{400.0, 400.0}};
    fabric.bend_stiffness = 1e-4;
    return fabric;
}

struct Outcome {
    int steps = 0;              // taken
    int rough = 0;              // of them not converged
    double gain = 0.0;          // J, largest rise of total energy in a step beyond the work done
    double closure = 0.0;       // worst of the ledger
    double reach = 0.0;         // m, largest distance from the origin
    double nearest = infinity;  // m, smallest distance of a contact
    static constexpr double infinity = std::numeric_limits<double>::infinity();
};

void note_step(const StepReport& report, double before, Outcome& outcome) {
    ++outcome.steps;
    outcome.rough += report.status == StepStatus::not_converged ? 1 : 0;
    outcome.gain = std::max(outcome.gain, report.energy.total() - before - report.energy.work);
    outcome.closure = std::max(outcome.closure, report.energy.closure());
    outcome.nearest = std::min(outcome.nearest, report.smallest_distance);
}

/// Makes steps that must end well, in finite states.
Outcome stepped(Simulation& simulation, int steps) {
    Outcome outcome;
    double before = simulation.energy().total();
    for (int n = 0; n < steps; ++n) {
        const StepReport report = simulation.step();
        CAPTURE(n, report.explanation());
        REQUIRE(report.ok());
        note_step(report, before, outcome);
        before = report.energy.total();
        for (int c = 0; c < simulation.cloth_count(); ++c) {
            for (const Vec3& x : simulation.positions({c})) outcome.reach = std::max(outcome.reach, x.norm());
            for (const Vec3& v : simulation.velocities({c})) REQUIRE(v.allFinite());
        }
        REQUIRE(std::isfinite(outcome.reach));
    }
    return outcome;
}

constexpr int side = 6;
constexpr double drop_energy = 0.2 * 0.09 * 9.81 * 0.05;  // J, of a sheet from its height

struct Sheet {
    Simulation simulation;
    ClothId cloth;
    std::vector<Vec3> rest;

    Sheet(const Way& way, const Fabric& fabric, std::unique_ptr<ContactDetector> detector = nullptr)
        : simulation(settings_of(way), std::move(detector)) {
        cloth = simulation.add_cloth(make_grid(0.3, 0.3, side, side), fabric, {.translation = Vec3(0.0, 0.05, 0.0)});
        rest = copy(simulation.positions(cloth));
    }

    /// Moves every vertex by a function of its position.
    template <class Change>
    void deform(Change change) {
        std::vector<Vec3> points = rest;
        for (Vec3& x : points) x = change(x);
        simulation.set_positions(cloth, points);
    }
};

using Deformation = Vec3 (*)(const Vec3&);

struct State {
    const char* name;
    Deformation deform;
};

const State states[] = {
    {"all vertices in one point", [](const Vec3& x) { return Vec3(0.0, x.y(), 0.0); }},
    {"all vertices on a line", [](const Vec3& x) { return Vec3(x.x(), x.y(), 0.0); }},
    {"inverted", [](const Vec3& x) { return Vec3(-x.x(), x.y(), x.z()); }},
    {"folded onto itself", [](const Vec3& x) { return Vec3(std::abs(x.x()), x.y(), x.z()); }},
    {"folded twice", [](const Vec3& x) { return Vec3(std::abs(x.x()), x.y(), std::abs(x.z())); }},
    {"stretched tenfold", [](const Vec3& x) { return Vec3(10.0 * x.x(), x.y(), 10.0 * x.z()); }},
    {"two neighbours in one place", [](const Vec3& x) { return x.x() > 0.1 ? Vec3(0.09, x.y(), x.z()) : x; }},
};

/// A cloth of one triangle.
TriangleMesh one_triangle() { return {.vertices = {{0, 0.05, 0}, {0.1, 0.05, 0}, {0, 0.05, 0.1}}, .triangles = {{0, 2, 1}}}; }

/// A strip whose triangles are `aspect` times as long as they are wide.
TriangleMesh sliver_strip(double aspect) {
    TriangleMesh mesh = make_grid(0.1, 0.1 / aspect, 2, 5);
    mesh.grid_columns = mesh.grid_rows = 0;
    for (Vec3& x : mesh.vertices) x.y() = 0.05;
    return mesh;
}

}  // namespace

TEST_CASE("Springs of no length, coincident vertices, inverted and folded cloth stay finite and without gain of energy") {
    for (const Way& way : free_ways) {
        for (const Fabric& fabric : {sheet_fabric(), woven_fabric()}) {
            for (const State& state : states) {
                CAPTURE(way.name, state.name, fabric.has_moduli());
                Sheet sheet(way, fabric);
                sheet.simulation.pin(sheet.cloth, 0);
                sheet.deform(state.deform);
                const double stored = std::abs(sheet.simulation.energy().total());
                const Outcome outcome = stepped(sheet.simulation, 40);
                CHECK(outcome.gain <= (way.scheme == Scheme::backward_euler ? 1e-5 : 0.05) * stored);
                CHECK(outcome.reach < 50.0);
                CHECK(outcome.closure < 1e-9);
            }
        }
    }
}

TEST_CASE("The same states settle on a floor without going through it") {
    for (const Way& way : contact_ways) {
        for (const State& state : states) {
            CAPTURE(way.name, state.name);
            Sheet sheet(way, sheet_fabric(), make_brute_force_detector());
            sheet.simulation.add_obstacle(make_plane(4.0));
            sheet.deform(state.deform);
            const Outcome outcome = stepped(sheet.simulation, 40);
            CHECK(outcome.nearest > 0.0);
            CHECK(outcome.reach < 50.0);
        }
    }
}

TEST_CASE("A cloth of which every vertex is pinned stays, and follows its pins to the bit") {
    for (const Way& way : free_ways) {
        CAPTURE(way.name);
        Sheet sheet(way, sheet_fabric());
        for (int i = 0; i < side * side; ++i) sheet.simulation.pin(sheet.cloth, i);
        stepped(sheet.simulation, 5);
        CHECK(copy(sheet.simulation.positions(sheet.cloth)) == sheet.rest);
        for (int i = 0; i < side * side; ++i) sheet.simulation.move_pin(sheet.cloth, i, 2.0 * sheet.rest[i]);
        stepped(sheet.simulation, 1);
        for (int i = 0; i < side * side; ++i) CHECK(sheet.simulation.positions(sheet.cloth)[i] == 2.0 * sheet.rest[i]);
    }
}

TEST_CASE("One triangle falls freely, hangs by a corner and comes to lie on a floor") {
    for (const Way& way : contact_ways) {
        for (const bool pinned : {false, true}) {
            CAPTURE(way.name, pinned);
            Simulation simulation(settings_of(way), make_brute_force_detector());
            const ClothId cloth = simulation.add_cloth(one_triangle(), free_fabric());
            simulation.add_obstacle(make_plane(1.0));
            if (pinned) simulation.pin(cloth, 0);
            const Outcome outcome = stepped(simulation, 60);
            CHECK(outcome.nearest > 0.0);
            CHECK(outcome.nearest < 5e-3);
            CHECK(outcome.rough == 0);
        }
    }
}

TEST_CASE("A mesh that cannot be cloth is refused by the call that adds it, by name and number") {
    Simulation simulation({});
    const auto refusal = [&](const TriangleMesh& mesh) {
        return scene_error([&] { simulation.add_cloth(mesh, free_fabric(), {}, "rag"); });
    };
    CHECK(mentions(refusal({}), {"rag", "no triangles"}));
    CHECK(mentions(refusal({.vertices = {Vec3::Zero()}, .triangles = {}}), {"rag", "no triangles"}));
    TriangleMesh isolated = one_triangle();
    isolated.vertices.emplace_back(1.0, 1.0, 1.0);
    CHECK(mentions(refusal(isolated), {"rag", "vertex 3", "no triangle"}));
    const TriangleMesh book{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}},
                            .triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
    CHECK(mentions(refusal(book), {"rag", "edge (0, 1)", "non-manifold"}));
    CHECK(simulation.cloth_count() == 0);
    CHECK(simulation.step().ok());
}

TEST_CASE("The time step may change by any factor in the middle of a run") {
    for (const Way& way : contact_ways) {
        CAPTURE(way.name);
        Sheet sheet(way, sheet_fabric(), make_brute_force_detector());
        sheet.simulation.add_obstacle(make_sphere(0.04, 2));
        double time = 0.0;
        for (const double dt : {1.0 / 60.0, 1e-3, 0.1, 1e-4, 1.0 / 30.0, 1.0, 1.0 / 60.0}) {
            sheet.simulation.set_time_step(dt);
            const Outcome outcome = stepped(sheet.simulation, 6);
            CHECK(outcome.nearest > 0.0);
            CHECK(outcome.gain < (way.scheme == Scheme::backward_euler ? 0.1 : 3.0) * drop_energy);
            time += 6.0 * dt;
        }
        CHECK(sheet.simulation.time() == Approx(time));
    }
}

TEST_CASE("Free cloth takes any time step after any other") {
    for (const Way& way : free_ways) {
        CAPTURE(way.name);
        Sheet sheet(way, sheet_fabric());
        sheet.simulation.pin(sheet.cloth, 0);
        for (const double dt : {1.0 / 60.0, 1e-7, 1.0, 1e-5, 1.0 / 30.0, 1e-7, 1.0 / 60.0}) {
            sheet.simulation.set_time_step(dt);
            const Outcome outcome = stepped(sheet.simulation, 6);
            CHECK(outcome.gain < (way.scheme == Scheme::backward_euler ? 0.01 : 1.0) * drop_energy);
            CHECK(outcome.reach < 0.6);
        }
    }
}

TEST_CASE("Without gravity cloth at rest keeps every bit, at a thousand times that of the earth it stays above a floor") {
    for (const Way& way : contact_ways) {
        CAPTURE(way.name);
        Sheet still(way, sheet_fabric(), make_brute_force_detector());
        still.simulation.add_obstacle(make_plane(1.0));
        still.simulation.set_gravity(Vec3::Zero());
        stepped(still.simulation, 5);
        CHECK(largest_difference(copy(still.simulation.positions(still.cloth)), still.rest) < 1e-15);
        Sheet pressed(way, sheet_fabric(), make_brute_force_detector());
        pressed.simulation.add_obstacle(make_plane(4.0));
        pressed.simulation.set_gravity(Vec3(0.0, -1e3, 0.0));
        const Outcome outcome = stepped(pressed.simulation, 60);
        CHECK(outcome.nearest > 0.0);
    }
}

TEST_CASE("Cloths whose masses differ by a factor of a million lie on each other and never go through each other", "[slow]") {
    for (const Way& way : contact_ways) {
        for (const bool heavy_on_top : {false, true}) {
            CAPTURE(way.name, heavy_on_top);
            Simulation simulation(settings_of(way), make_brute_force_detector());
            Fabric light = sheet_fabric(), heavy = sheet_fabric();
            light.self_contact = heavy.self_contact = true;
            light.area_density = 1e-3;
            heavy.area_density = 1e3;
            const TriangleMesh grid = make_grid(0.2, 0.2, 4, 4);
            simulation.add_cloth(grid, heavy_on_top ? light : heavy, {.translation = Vec3(0.0, 0.01, 0.0)}, "lower");
            simulation.add_cloth(grid, heavy_on_top ? heavy : light, {.translation = Vec3(0.003, 0.02, 0.002)}, "upper");
            simulation.add_obstacle(make_plane(1.0));
            const Outcome outcome = stepped(simulation, 6);
            CHECK(outcome.nearest > 0.0);
            CHECK(outcome.reach < 1.0);
            if (!heavy_on_top) CHECK(outcome.rough == 0);
        }
    }
}

TEST_CASE("A sheet sewn to one a million times as heavy hangs from it, and carries it") {
    for (const Way& way : free_ways) {
        for (const bool carries : {false, true}) {
            CAPTURE(way.name, carries);
            Simulation simulation(settings_of(way));
            Fabric light = sheet_fabric(), heavy = sheet_fabric();
            light.area_density = 1e-3;
            heavy.area_density = 1e3;
            const TriangleMesh grid = make_grid(0.2, 0.2, 4, 4);
            const ClothId upper = simulation.add_cloth(grid, carries ? light : heavy);
            const ClothId lower = simulation.add_cloth(grid, carries ? heavy : light, {.translation = Vec3(0.0, 0.0, 0.2)});
            simulation.add_seam(upper, lower,
                                std::array{std::array{12, 0}, std::array{13, 1}, std::array{14, 2}, std::array{15, 3}});
            for (int i = 0; i < 4; ++i) simulation.pin(upper, i);
            const Outcome outcome = stepped(simulation, 40);
            CHECK(outcome.rough == 0);
            CHECK(outcome.reach < 10.0);
            CHECK(outcome.closure < 1e-9);
        }
    }
}

TEST_CASE(
    "Slivers hang and come to lie on a floor: of a million to one with springs, of a hundred, by penalty a thousand, with "
    "moduli") {
    struct Strip {
        double aspect;
        Fabric fabric;
    };
    for (const Way& way : contact_ways) {
        for (const Strip& strip : {Strip{1e2, free_fabric()}, Strip{1e4, free_fabric()}, Strip{1e6, free_fabric()},
                                   Strip{1e2, woven_fabric()}, Strip{1e3, woven_fabric()}}) {
            const bool projects = way.response == ContactResponse::projection;
            if (projects && strip.fabric.has_moduli() && strip.aspect > 1e2) continue;
            CAPTURE(way.name, strip.aspect, strip.fabric.has_moduli());
            Simulation simulation(settings_of(way), make_brute_force_detector());
            const ClothId cloth = simulation.add_cloth(sliver_strip(strip.aspect), strip.fabric);
            simulation.add_obstacle(make_plane(1.0));
            simulation.pin(cloth, 0);
            const Outcome outcome = stepped(simulation, 40);
            CHECK(outcome.nearest > 0.0);
            CHECK(outcome.reach < 1.0);
        }
    }
}

}  // namespace percale::test::degenerate_states_test
