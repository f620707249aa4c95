#include "engine/schemes/schemes.h"
#include "tests/support/bench_meshes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

namespace percale::test::seam_laws_test {
namespace {

using Pairs = std::vector<std::array<int, 2>>;

/// Two panels face to face, sewn together along both long sides.
struct Tube {
    Simulation simulation;
    ClothId front, back;
    Pairs pairs;

    explicit Tube(StepSettings settings, double over = 0.5) : simulation(settings) {
        Fabric fabric = sheet_fabric();
        fabric.spring_damping = 0.02;
        fabric.springs.bend = 0.0;
        fabric.bend_stiffness = 1e-4;
        front = simulation.add_cloth(make_grid(0.3, 0.4, 7, 9), fabric, {.translation = {0, 0.05, 0}}, "front");
        back = simulation.add_cloth(make_grid(0.3, 0.4, 7, 9), fabric, {.translation = {0, -0.05, 0}}, "back");
        for (int row = 0; row < 9; ++row) {
            pairs.push_back({7 * row, 7 * row});
            pairs.push_back({7 * row + 6, 7 * row + 6});
        }
        simulation.add_seam(front, back, pairs, {.over = over, .stiffness = 2000.0, .name = "sides"});
    }

    double widest_gap() const {
        double gap = 0.0;
        for (const auto& [i, j] : pairs)
            gap = std::max(gap, (simulation.positions(front)[i] - simulation.positions(back)[j]).norm());
        return gap;
    }
};

Vec3 momentum(const Simulation& simulation, ClothId cloth) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < simulation.masses(cloth).size(); ++i)
        sum += simulation.masses(cloth)[i] * simulation.velocities(cloth)[i];
    return sum;
}

/// The error in the gap of two triangles face to face, three point masses each, at 0.2 s while seams of 0.1 N/m close over
/// `over`, m; and that of the reported work, J. The corners of the first lie over the other's edges, at this fraction of them.
/// With the reduced mass mu, w^2 = k/mu and L = L0 (1 - t/T)
///     gap = L + L0/(T w) sin w t.
struct DrawnTogether {
    double gap_error = 0.0, work_error = 0.0;
};

DrawnTogether draw_together(Scheme scheme, double dt, double share) {
    constexpr double density = 0.2, side = 0.1, stiffness = 0.1, start = 0.05, over = 1.0, end = 0.2;
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {0, 0, side}, {side, 0, 0}};
    mesh.triangles = {{0, 1, 2}};
    Fabric fabric = free_fabric();
    fabric.area_density = density;
    fabric.spring_damping = 0.0;
    Simulation simulation(
        {.time_step = dt, .scheme = scheme, .newton_tolerance = 1e-12, .measure = StepMeasures::all, .gravity = Vec3::Zero()});
    TriangleMesh inner = mesh;
    for (int k = 0; k < 3; ++k) inner.vertices[k] += share * (mesh.vertices[(k + 1) % 3] - mesh.vertices[k]);
    const ClothId one = simulation.add_cloth(inner, fabric, {.translation = {0, start, 0}}, "one");
    const ClothId other = simulation.add_cloth(mesh, fabric, {}, "other");
    const std::vector<Stitch> stitches = {{0, 0, 1, share}, {1, 1, 2, share}, {2, 2, 0, share}};
    const SeamId seam = simulation.add_seam(one, other, stitches, {.over = over, .stiffness = stiffness});
    double work = 0.0;
    for (int n = 0; n < std::lround(end / dt); ++n) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        work += report.energy.work;
    }
    const double first = simulation.masses(one)[0], second = simulation.masses(other)[0];
    const double reduced = first * second / (first + second), w = std::sqrt(stiffness / reduced);
    const double swing = start / over / w * std::sin(w * end), speed = start / over * (std::cos(w * end) - 1.0);
    const double gap = simulation.positions(one)[0].y() - simulation.positions(other)[0].y();
    CHECK(simulation.seam_gaps(seam)[1] == Approx(gap).epsilon(1e-12));
    const double exact_work = 3.0 * (0.5 * stiffness * swing * swing + 0.5 * reduced * speed * speed);
    return {std::abs(gap - start * (1.0 - end / over) - swing), std::abs(work - exact_work)};
}

/// Iterations of the linear solver for each of Newton's, of two sheets sewn vertex to point along a side.
double multigrid_iterations(double stiffness) {
    constexpr int n = 25;
    Simulation simulation({.linear_solver = LinearSolver::multigrid});
    const ClothId left = simulation.add_cloth(make_grid(0.5, 0.5, n, n), sheet_fabric(), {}, "left");
    const ClothId right =
        simulation.add_cloth(make_grid(0.5, 0.5, n, n), sheet_fabric(), {.translation = {0.502, 0, 0}}, "right");
    simulation.pin(left, 0);
    simulation.pin(left, n * (n - 1));
    std::vector<Stitch> stitches;
    for (int row = 0; row + 1 < n; ++row) stitches.push_back({n * row + n - 1, n * row, n * (row + 1), 0.5});
    simulation.add_seam(left, right, stitches, {.over = 0.0, .stiffness = stiffness});
    long newton = 0, linear = 0;
    for (int step = 0; step < 20; ++step) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        newton += report.newton_iterations;
        linear += report.linear_iterations;
    }
    return static_cast<double>(linear) / static_cast<double>(newton);
}

}  // namespace

TEST_CASE("Schemes keep their order, in gap and in work, while a seam closes", "[law]") {
    const double share = GENERATE(0.0, 0.1);
    for (const Scheme scheme : all_schemes) {
        const DrawnTogether coarse = draw_together(scheme, 0.002, share), fine = draw_together(scheme, 0.001, share);
        const bool second = facts_of(scheme).order >= 2;
        const std::string name =
            (share > 0.0 ? "closing points, " : "closing seam, ") + std::string(facts_of(scheme).word) + ": ";
        check_law_between(name + "error of the gap over that of half the step", coarse.gap_error / fine.gap_error,
                          second ? 3.4 : 1.7, second ? 4.4 : 2.3);
        if (!second || scheme == Scheme::bdf2) continue;
        check_law_between(name + "error of the work over that of half the step", coarse.work_error / fine.work_error, 3.6, 4.4);
    }
}

TEST_CASE("Stiff seams begin to close without a jolt in TR-BDF2 and the trapezoid") {
    for (const Scheme scheme : {Scheme::tr_bdf2, Scheme::trapezoid}) {
        Tube tube({.scheme = scheme, .measure = StepMeasures::all, .gravity = Vec3::Zero()});
        // Each side moves at 0.1 m/s; twice that in all of the cloth is far more than a smooth start gives.
        const double most = 0.5 * 2.0 * 0.2 * 0.3 * 0.4 * 0.2 * 0.2;
        for (int n = 0; n < 5; ++n) CHECK(tube.simulation.step().energy.kinetic < most);
    }
}

TEST_CASE("Two panels are drawn together at a steady rate and stay sewn") {
    Tube tube({.gravity = Vec3::Zero()});
    for (int n = 1; n <= 120; ++n) {
        const StepReport report = tube.simulation.step();
        REQUIRE(report.ok());
        const double target = 0.1 * std::max(0.0, 1.0 - n / 30.0);
        CHECK(tube.widest_gap() < target + 2e-3);
        if (n > 60) CHECK(tube.widest_gap() < 3e-4);
        CHECK((momentum(tube.simulation, tube.front) + momentum(tube.simulation, tube.back)).norm() < 1e-9);
    }
    // The tube is open in between.
    const Vec3 middle = tube.simulation.positions(tube.front)[4 * 7 + 3] - tube.simulation.positions(tube.back)[4 * 7 + 3];
    CHECK(middle.norm() > 0.02);
}

TEST_CASE("Sewn cloth that hangs by one panel carries the other") {
    Tube tube({});
    for (int column = 0; column < 7; ++column) tube.simulation.pin(tube.front, column);
    for (int n = 0; n < 180; ++n) REQUIRE(tube.simulation.step().ok());
    // Half the weight of the back, 0.12 m^2 of 0.2 kg/m^2, over 9 pairs at 2000 N/m: below 1 mm.
    CHECK(tube.widest_gap() < 1e-3);
}

TEST_CASE("Energy never rises beyond the work of a closing seam") {
    Tube tube({.newton_tolerance = 1e-9, .measure = StepMeasures::all, .gravity = Vec3::Zero()}, 0.1);
    double before = tube.simulation.energy().total();
    CHECK(before < 1e-15);
    for (int n = 0; n < 30; ++n) {
        const StepReport report = tube.simulation.step();
        CHECK(report.energy.total() <= before + report.energy.work + 1e-9);
        CHECK((report.energy.work > 0.0) == (n < 6));
        before = report.energy.total();
    }
}

TEST_CASE("Sides of unequal sampling are sewn vertex to point, and momentum is kept") {
    Simulation simulation({.gravity = Vec3::Zero()});
    Fabric fabric = sheet_fabric();
    fabric.spring_damping = 0.02;
    const ClothId fine = simulation.add_cloth(make_grid(0.3, 0.4, 7, 14), fabric, {.translation = {0, 0.05, 0}}, "fine");
    const ClothId coarse = simulation.add_cloth(make_grid(0.3, 0.4, 5, 6), fabric, {.translation = {0, -0.05, 0}}, "coarse");
    std::vector<Stitch> stitches;
    for (int row = 0; row < 14; ++row) {
        const double place = row / 13.0 * 5.0;
        const int below = std::min(static_cast<int>(place), 4);
        stitches.push_back({7 * row, 5 * below, 5 * (below + 1), place - below});
    }
    const SeamId seam = simulation.add_seam(fine, coarse, stitches, {.over = 0.5, .stiffness = 2000.0});
    CHECK(simulation.plan().springs.seam == 14);
    for (int n = 0; n < 120; ++n) {
        REQUIRE(simulation.step().ok());
        CHECK((momentum(simulation, fine) + momentum(simulation, coarse)).norm() < 1e-9);
    }
    const std::vector<double> gaps = simulation.seam_gaps(seam);
    CHECK(gaps.size() == 14);
    CHECK(*std::max_element(gaps.begin(), gaps.end()) < 2e-4);
    // A vertex in the middle of an edge carries as much as the edge's ends.
    const auto x = simulation.positions(coarse);
    const auto& [vertex, from, to, share] = stitches[6];
    CHECK((simulation.positions(fine)[vertex] - ((1.0 - share) * x[from] + share * x[to])).norm() ==
          Approx(gaps[6]).margin(1e-12));
}

TEST_CASE("Stiff stitches to points cost multigrid less than 2.2 times the iterations") {
    CHECK(multigrid_iterations(1e5) < 2.2 * multigrid_iterations(1e3));  // 3.8 times without sewn_point_easing
}

TEST_CASE("Welded seams that carry a weight leave no gap at rest, and the ledger closes while they tighten") {
    const bool weld = GENERATE(false, true);
    StepSettings settings{.measure = StepMeasures::ledger};
    settings.newton_tolerance = 1e-9;
    Simulation simulation(settings);
    Fabric fabric = sheet_fabric();
    fabric.spring_damping = 0.2;
    const ClothId upper = simulation.add_cloth(make_grid(0.3, 0.3, 7, 7), fabric, {}, "upper");
    const ClothId lower = simulation.add_cloth(make_grid(0.3, 0.3, 7, 7), fabric, {.translation = {0, -0.02, 0.3}}, "lower");
    Pairs pairs;
    for (int k = 0; k < 7; ++k) {
        simulation.pin(upper, k);
        pairs.push_back({42 + k, k});
    }
    const SeamId seam = simulation.add_seam(upper, lower, pairs, {.over = 0.2, .stiffness = 20.0, .weld = weld});
    double imbalance = 0.0, work = 0.0;
    for (int n = 0; n < 600; ++n) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        imbalance = std::max(imbalance, std::abs(report.energy.imbalance));
        work += std::abs(report.energy.work);
    }
    CHECK(imbalance < 1e-9 * std::max(1.0, work));
    double widest = 0.0, hanging = 0.0;
    for (const double gap : simulation.seam_gaps(seam)) widest = std::max(widest, gap);
    for (const double mass : simulation.masses(lower)) hanging += 9.81 * mass;
    // A spring alone would be stretched by the weight.
    if (!weld) CHECK(widest > 0.5 * hanging / 7.0 / 20.0);
    if (weld) CHECK(widest < 3e-5);
}

TEST_CASE("An obstacle that keeps a welded seam open meets a bounded force, and a restored simulation keeps its holds") {
    Simulation simulation({.gravity = Vec3::Zero()});
    const ClothId cloth = simulation.add_cloth(make_grid(0.3, 0.3, 4, 4), sheet_fabric());
    for (int v = 0; v < 16; ++v) {
        if (v != 5) simulation.pin(cloth, v);
    }
    const SeamId seam = simulation.add_seam(cloth, cloth, Pairs{{5, 0}}, {.over = 0.0, .stiffness = 100.0, .weld = true});
    for (int n = 0; n < 300; ++n) REQUIRE(simulation.step().ok());
    const double gap = simulation.seam_gaps(seam)[0];  // the spring's own pull, and that of 1 cm more
    const std::vector<std::byte> saved = simulation.save();
    for (int n = 0; n < 60; ++n) REQUIRE(simulation.step().ok());
    CHECK(simulation.seam_gaps(seam)[0] == Approx(gap).epsilon(1e-4));
    CHECK(gap > 0.01);
    const std::uint64_t after = simulation.state_hash();
    simulation.restore(saved);
    for (int n = 0; n < 60; ++n) REQUIRE(simulation.step().ok());
    CHECK(simulation.state_hash() == after);
}

TEST_CASE("Welded seams are refused by schemes without numerical damping, and make auto an implicit scheme") {
    const auto made = [](Scheme scheme) {
        Simulation simulation({.scheme = scheme});
        const ClothId cloth = simulation.add_cloth(make_grid(0.3, 0.3, 4, 4), sheet_fabric());
        simulation.add_seam(cloth, cloth, Pairs{{15, 0}}, {.weld = true});
        return simulation;
    };
    for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4, Scheme::implicit_midpoint, Scheme::trapezoid}) {
        Simulation simulation = made(scheme);
        CHECK(scene_error([&] { simulation.step(); }).find("takes no welded seams; use scheme backward_euler") !=
              std::string::npos);
    }
    for (const Scheme scheme : {Scheme::automatic, Scheme::backward_euler, Scheme::tr_bdf2}) {
        Simulation simulation = made(scheme);
        CHECK(simulation.step().ok());
    }
    CHECK(made(Scheme::automatic).plan().scheme == Scheme::backward_euler);
}

TEST_CASE("Explicit schemes close seams, too") {
    Tube tube({.time_step = 5e-5, .scheme = Scheme::symplectic_euler, .gravity = Vec3::Zero()}, 0.1);
    for (int n = 0; n < 3000; ++n) REQUIRE(tube.simulation.step().ok());
    CHECK(tube.widest_gap() < 1e-3);
}

TEST_CASE("A seam made at once has no length from the first step, and wakes cloth at rest") {
    Simulation simulation({.measure = StepMeasures::all, .gravity = Vec3::Zero()});
    const ClothId cloth = simulation.add_cloth(irregular_sheet(0.3, 300), free_fabric());
    for (int n = 0; n < 60; ++n) simulation.step();
    REQUIRE(simulation.step().slept);
    simulation.add_seam(cloth, cloth, Pairs{{0, 10}}, {.over = 0.0, .stiffness = 10.0});
    const double energy = simulation.energy().elastic;
    const StepReport report = simulation.step();
    CHECK_FALSE(report.slept);
    const double length = 10.0;
    CHECK(report.energy.work > energy);
    CHECK(report.energy.work < length);
    CHECK(report.energy.elastic > 0.0);
}

TEST_CASE("A wrong seam is refused and changes nothing") {
    Tube tube({});
    const std::uint64_t hash = tube.simulation.state_hash();
    const auto refused = [&](ClothId a, ClothId b, const Pairs& pairs, const SeamSettings& settings) {
        return scene_error([&] { tube.simulation.add_seam(a, b, pairs, settings); });
    };
    CHECK(refused(tube.front, tube.back, {{0, 63}}, {}).find("no vertex 63, vertices are 0 ... 62") != std::string::npos);
    CHECK(refused(tube.front, {7}, {{0, 0}}, {}).find("no cloth 7") != std::string::npos);
    CHECK(refused(tube.front, tube.front, {{5, 5}}, {}) == "seam: vertex 5 of front is sewn to itself");
    CHECK(refused(tube.front, tube.back, {}, {.name = "hem"}) == "hem: no vertices, a seam joins at least one pair");
    CHECK(refused(tube.front, tube.back, {{0, 0}}, {.over = -1.0}) ==
          "seam: over = -1 s is outside the allowed range 0 ... 1e+06");
    CHECK(refused(tube.front, tube.back, {{0, 0}}, {.stiffness = 0.0}).find("stiffness = 0 N/m") != std::string::npos);
    const auto refused_point = [&](const Stitch& stitch) {
        return scene_error([&] { tube.simulation.add_seam(tube.front, tube.front, std::vector{stitch}); });
    };
    CHECK(refused_point({0, 1, 2, 1.5}) == "seam: the share of a stitch = 1.5 is outside the allowed range 0 ... 1");
    CHECK(refused_point({1, 1, 2, 0.5}) == "seam: vertex 1 of front is sewn to itself");
    CHECK(scene_error([&] { tube.simulation.seam_gaps({3}); }) == "there is no seam 3, seams are 0 ... 0");
    CHECK(tube.simulation.state_hash() == hash);
    CHECK(tube.simulation.plan().springs.seam == 18);
}

}  // namespace percale::test::seam_laws_test
