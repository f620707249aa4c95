#include <algorithm>
#include <cmath>

#include "percale/certify.h"
#include "percale/detectors.h"
#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::cloth_pairs_step_test {

// Settings of pairs of cloths, through the whole of a simulation.

namespace {

constexpr double h = 0.004;
const Fabric sheet_cloth{
    .thickness = h, .self_contact = true, .springs = {.structural = 200.0, .shear = 100.0, .bend = 2.0}, .spring_damping = 0.1};

/// A sheet of 0.6 m held everywhere and two of 0.2 m, one 6 mm and one 60 mm above it.
struct ThreeSheets {
    Simulation simulation{StepSettings{}, make_brute_force_detector()};
    ClothId table, napkin, cloth;

    ThreeSheets() {
        table = simulation.add_cloth(make_grid(0.6, 0.6, 19, 19), sheet_cloth, {}, "table");
        for (int v = 0; v < 19 * 19; ++v) simulation.pin(table, v);
        napkin = simulation.add_cloth(make_grid(0.2, 0.2, 7, 7), sheet_cloth, turned_at(0.006), "napkin");
        cloth = simulation.add_cloth(make_grid(0.2, 0.2, 7, 7), sheet_cloth, turned_at(0.06), "cloth");
    }
    static Pose turned_at(double height) {
        return {.translation = {0.003, height, 0.004}, .rotation = {std::cos(0.2), 0, std::sin(0.2), 0}};
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) REQUIRE(simulation.step().ok());
    }
    double lowest(ClothId id) const {
        double y = 1e9;
        for (const Vec3& x : simulation.positions(id)) y = std::min(y, x.y());
        return y;
    }
    double highest(ClothId id) const {
        double y = -1e9;
        for (const Vec3& x : simulation.positions(id)) y = std::max(y, x.y());
        return y;
    }
    /// Triangle pairs of two of the cloths that cross.
    std::size_t crossings(ClothId first, ClothId second) const {
        TriangleMesh all = mesh_of(first);
        all = joined(all, mesh_of(second));
        return certify_cloth(all).crossing.size();
    }
    TriangleMesh mesh_of(ClothId id) const {
        TriangleMesh mesh = id.index == table.index ? make_grid(0.6, 0.6, 19, 19) : make_grid(0.2, 0.2, 7, 7);
        const auto x = simulation.positions(id);
        mesh.vertices.assign(x.begin(), x.end());
        return mesh;
    }
};

}  // namespace

TEST_CASE("Cloths that are set not to meet pass through each other, others still meet them") {
    ThreeSheets scene;
    scene.simulation.set_pair(scene.napkin, scene.table, {.contact = false});
    CHECK_FALSE(scene.simulation.meets(scene.table, scene.napkin));
    CHECK(scene.simulation.meets(scene.table, scene.cloth));
    CHECK(scene.simulation.meets(scene.table, scene.table));
    scene.run(30);
    CHECK(scene.highest(scene.napkin) < -0.5);
    CHECK(scene.lowest(scene.cloth) > 0.0);
    const auto skips = scene.simulation.plan().skipped;
    CHECK(std::ranges::any_of(skips, [](const Skip& skip) { return skip.what == "contact of table with napkin"; }));
}

TEST_CASE("Cloths that do not meet may start through each other") {
    ThreeSheets scene;
    std::vector<Vec3> through;
    for (const Vec3& x : scene.simulation.positions(scene.napkin)) through.push_back({x.x(), 0.2 * x.x(), x.z()});
    scene.simulation.set_positions(scene.napkin, through);
    scene.simulation.set_pair(scene.table, scene.napkin, {.contact = false});
    scene.simulation.prepare();
    CHECK(scene.simulation.start_repair().empty());
    CHECK(scene.crossings(scene.table, scene.napkin) > 0);
    CHECK(certify_cloth(scene.mesh_of(scene.table)).crossing.empty());
}

TEST_CASE("Cloths that come to meet while they cross are untangled by the next step, and then held apart") {
    ThreeSheets scene;
    scene.simulation.set_gravity({0, -1, 0});
    scene.simulation.set_pair(scene.table, scene.napkin, {.contact = false});
    std::vector<Vec3> tilted;
    for (const Vec3& x : scene.simulation.positions(scene.napkin)) tilted.push_back({x.x(), 0.006 + 0.1 * x.x(), x.z()});
    scene.simulation.set_positions(scene.napkin, tilted);
    scene.run(1);
    REQUIRE(scene.crossings(scene.table, scene.napkin) > 0);
    scene.simulation.set_pair(scene.table, scene.napkin, {});
    for (int n = 0; n < 20; ++n) {
        scene.run(1);
        CHECK(scene.crossings(scene.table, scene.napkin) == 0);
    }
    CHECK_FALSE(scene.simulation.start_repair().empty());
}

TEST_CASE("A pair keeps the distance that is set, nearer or farther than the cloths' own") {
    for (const double thickness : {0.002, 0.010}) {
        CAPTURE(thickness);
        ThreeSheets scene;
        scene.simulation.set_pair(scene.table, scene.cloth, {.thickness = thickness});
        scene.simulation.set_pair(scene.table, scene.napkin, {.contact = false});
        scene.simulation.set_pair(scene.napkin, scene.cloth, {.contact = false});
        scene.run(120);
        CHECK(scene.lowest(scene.cloth) > 0.5 * thickness);
        CHECK(scene.highest(scene.cloth) < thickness);
    }
}

TEST_CASE("The setting of a pair is checked, and withdrawn by an empty one") {
    ThreeSheets scene;
    CHECK(scene_error([&] { scene.simulation.set_pair(scene.table, {7}, {}); }).find("no cloth 7") != std::string::npos);
    const std::string range = scene_error([&] { scene.simulation.set_pair(scene.table, scene.napkin, {.thickness = 2.0}); });
    CHECK(range.find("table and napkin: thickness = 2 m is outside the allowed range 1e-06 ... 1") != std::string::npos);
    const std::string both =
        scene_error([&] { scene.simulation.set_pair(scene.table, scene.napkin, {.contact = false, .thickness = 0.003}); });
    CHECK(both.find("without contact a thickness says nothing") != std::string::npos);
    Fabric alone = sheet_cloth;
    alone.self_contact = false;
    const ClothId other = scene.simulation.add_cloth(make_grid(0.2, 0.2, 3, 3), alone, {.translation = {0, 1, 0}}, "veil");
    const std::string meets_none = scene_error([&] { scene.simulation.set_pair(scene.table, other, {.contact = false}); });
    CHECK(meets_none.find("veil meets no cloth") != std::string::npos);
    scene.simulation.set_pair(scene.table, scene.napkin, {.contact = false});
    scene.simulation.set_pair(scene.napkin, scene.table, {});
    CHECK(scene.simulation.meets(scene.table, scene.napkin));
    scene.run(30);
    CHECK(scene.lowest(scene.napkin) > 0.0);
}

TEST_CASE("All backends see pairs alike, and a saved state is not one of a simulation with other pairs") {
    const auto run = [](std::unique_ptr<ContactDetector> detector, double thickness) {
        Simulation simulation({}, std::move(detector));
        for (int k = 0; k < 3; ++k)
            simulation.add_cloth(make_grid(0.2, 0.2, 9, 9), sheet_cloth, ThreeSheets::turned_at(0.006 * k));
        for (const int corner : {0, 8, 72, 80}) simulation.pin({0}, corner);
        simulation.set_pair({0}, {2}, {.contact = false});
        simulation.set_pair({1}, {2}, {.thickness = thickness});
        return simulation;
    };
    Simulation one = run(make_fcl_detector(), 0.003), other = run(make_bullet_detector(), 0.003);
    Simulation resumed = run(make_brute_force_detector(), 0.003), different = run(make_fcl_detector(), 0.0031);
    for (int n = 0; n < 60; ++n) {
        if (n == 30) resumed.restore(one.save());
        if (n == 30) CHECK(scene_error([&] { different.restore(one.save()); }).find("pairs of cloths") != std::string::npos);
        REQUIRE(one.step().ok());
        REQUIRE(other.step().ok());
        if (n >= 30) REQUIRE(resumed.step().ok());
        CHECK(one.state_hash() == other.state_hash());
        if (n >= 30) CHECK(one.state_hash() == resumed.state_hash());
    }
}

namespace {

/// Two panels of one garment that start over each other, sewn along one side without contact, and a napkin that falls on them.
struct SewnUnderNapkin {
    Simulation simulation{{.measure = StepMeasures::none}, make_brute_force_detector()};
    ClothId garment, napkin;
    SeamId seam;

    explicit SewnUnderNapkin(double after = 0.0) {
        TriangleMesh second = make_grid(0.4, 0.4, 11, 11);
        for (Vec3& x : second.vertices) x = {x.x() + 0.2, 0.5 * x.x() + 0.05, x.z()};
        TriangleMesh panels = joined(make_grid(0.4, 0.4, 11, 11), second);
        panels.grid_columns = panels.grid_rows = 0;
        Fabric fabric = sheet_cloth;
        fabric.springs.shear = 0.0;
        fabric.spring_damping = 0.5;
        garment = simulation.add_cloth(panels, fabric, {}, "garment");
        for (int k = 0; k < 11; ++k) simulation.pin(garment, 11 * k);
        napkin = simulation.add_cloth(make_grid(0.2, 0.2, 9, 9), sheet_cloth,
                                      {.translation = {-0.05, 0.02, 0.004}, .rotation = {std::cos(0.2), 0, std::sin(0.2), 0}});
        std::vector<Stitch> stitches;
        for (int k = 0; k < 11; ++k) stitches.push_back({11 * k + 10, 121 + 11 * k, 121 + 11 * k, 0.0});
        seam = simulation.add_seam(garment, garment, stitches,
                                   {.after = after, .over = 0.3, .stiffness = 500.0, .contact_while_closing = false});
    }
    /// Crossing triangle pairs of the garment's (first 400 triangles) with itself, and of it with the napkin.
    std::array<int, 2> crossings() const {
        TriangleMesh all = joined(joined(make_grid(0.4, 0.4, 11, 11), make_grid(0.4, 0.4, 11, 11)), make_grid(0.2, 0.2, 9, 9));
        const auto x = simulation.positions(garment), y = simulation.positions(napkin);
        std::copy(x.begin(), x.end(), all.vertices.begin());
        std::copy(y.begin(), y.end(), all.vertices.begin() + 242);
        std::array<int, 2> count{};
        for (const auto& [i, j] : certify_cloth(all).crossing) ++count[(i < 400) != (j < 400)];
        return count;
    }
};

}  // namespace

TEST_CASE("While a garment is sewn without contact of its own, other cloth meets it") {
    SewnUnderNapkin scene;
    CHECK_FALSE(scene.simulation.meets(scene.garment, scene.garment));
    CHECK(scene.simulation.meets(scene.garment, scene.napkin));
    CHECK(scene.simulation.meets(scene.napkin, scene.napkin));
    REQUIRE(scene.simulation.step().ok());
    CHECK(scene.simulation.start_repair().empty());
    CHECK(scene.crossings()[0] > 0);
    while (scene.simulation.time() < 0.5) {
        REQUIRE(scene.simulation.step().ok());
        CHECK(scene.crossings()[1] == 0);
    }
    CHECK(scene.simulation.meets(scene.garment, scene.garment));
}

TEST_CASE("A seam that closes later keeps its lengths until then") {
    SewnUnderNapkin scene(0.2);
    scene.simulation.set_gravity(Vec3::Zero());
    const std::vector<double> before = scene.simulation.seam_gaps(scene.seam);
    while (scene.simulation.time() < 0.19) REQUIRE(scene.simulation.step().ok());
    const std::vector<double> waiting = scene.simulation.seam_gaps(scene.seam);
    for (std::size_t k = 0; k < before.size(); ++k) CHECK(waiting[k] == Approx(before[k]).epsilon(1e-3).margin(1e-6));
    CHECK_FALSE(scene.simulation.meets(scene.garment, scene.garment));
    while (scene.simulation.time() < 0.4) REQUIRE(scene.simulation.step().ok());
    const std::vector<double> closing = scene.simulation.seam_gaps(scene.seam);
    CHECK(*std::ranges::max_element(closing) < 0.7 * *std::ranges::max_element(before));
    CHECK(*std::ranges::max_element(closing) > 0.1 * *std::ranges::max_element(before));
}

TEST_CASE("Cloths that seams without contact join wait together, until the last seam between them has closed") {
    Simulation simulation({.gravity = Vec3::Zero()}, make_brute_force_detector());
    for (int k = 0; k < 4; ++k)
        simulation.add_cloth(make_grid(0.2, 0.2, 5, 5), sheet_cloth, {.translation = {0.0, 0.05 * k, 0.0}});
    const auto sew = [&](int first, int second, double over) {
        simulation.add_seam({first}, {second}, std::vector<std::array<int, 2>>{{0, 0}},
                            {.over = over, .stiffness = 1.0, .contact_while_closing = false});
    };
    sew(0, 1, 0.1);
    sew(2, 1, 0.2);
    const auto meeting = [&] {
        std::vector<std::array<int, 2>> pairs;
        for (int i = 0; i < 4; ++i) {
            for (int j = i; j < 4; ++j) {
                if (simulation.meets({i}, {j})) pairs.push_back({i, j});
            }
        }
        return pairs;
    };
    using Pairs = std::vector<std::array<int, 2>>;
    CHECK(meeting() == Pairs{{0, 3}, {1, 3}, {2, 3}, {3, 3}});
    const std::vector<std::byte> waiting = simulation.save();
    while (simulation.time() < 0.15) REQUIRE(simulation.step().ok());
    CHECK(meeting() == Pairs{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 3}, {2, 3}, {3, 3}});
    const std::vector<std::byte> half = simulation.save();
    const std::uint64_t hash = simulation.state_hash();
    while (simulation.time() < 0.25) REQUIRE(simulation.step().ok());
    CHECK(meeting().size() == 10);
    // Back, whatever waits meanwhile, and to the same end.
    simulation.restore(waiting);
    CHECK(meeting().size() == 4);
    while (simulation.time() < 0.15) REQUIRE(simulation.step().ok());
    CHECK(simulation.state_hash() == hash);
    simulation.restore(half);
    CHECK(meeting().size() == 7);
}

namespace {

/// A sheet between two panels of its size that are sewn along two sides around it, nothing else: its rims stand out between the
/// panels'.
struct SewnAroundSheet {
    Simulation simulation{{.gravity = Vec3::Zero()}, make_brute_force_detector()};
    ClothId sheet, cover;
    std::vector<SeamId> seams;

    explicit SewnAroundSheet(int layer) {
        const TriangleMesh panel = make_grid(0.12, 0.12, 7, 7);
        TriangleMesh panels = joined(placed(panel, {.translation = {0, 0.02, 0}}), placed(panel, {.translation = {0, -0.02, 0}}));
        panels.grid_columns = panels.grid_rows = 0;
        Fabric fabric = sheet_cloth;
        fabric.spring_damping = 0.5;
        fabric.springs.shear = 0.0;
        sheet = simulation.add_cloth(panel, fabric, {.translation = {0, 0.001, 0}}, "sheet");
        cover = simulation.add_cloth(panels, fabric, {}, "cover");
        simulation.set_layer(cover, layer);
        for (const int column : {0, 6}) {
            std::vector<Stitch> stitches;
            for (int k = 0; k < 7; ++k) stitches.push_back({7 * k + column, 49 + 7 * k + column, 49 + 7 * k + column, 0.0});
            seams.push_back(simulation.add_seam(cover, cover, stitches,
                                                {.over = 0.3, .stiffness = 500.0, .contact_while_closing = false, .weld = true}));
        }
    }
    double largest_gap() const {
        double largest = 0.0;
        for (const SeamId seam : seams) largest = std::max(largest, std::ranges::max(simulation.seam_gaps(seam)));
        return largest;
    }
    std::size_t crossings() const {
        TriangleMesh all = joined(make_grid(0.12, 0.12, 7, 7), joined(make_grid(0.12, 0.12, 7, 7), make_grid(0.12, 0.12, 7, 7)));
        const auto x = simulation.positions(sheet), y = simulation.positions(cover);
        std::copy(x.begin(), x.end(), all.vertices.begin());
        std::copy(y.begin(), y.end(), all.vertices.begin() + 49);
        std::vector<int> cloth(all.triangles.size(), 1);
        std::fill_n(cloth.begin(), 72, 0);
        ClothPairs pairs;
        pairs.set(1, 1, {.contact = false});  // triangles at one stitch
        return certify_cloth(all, {}, {cloth, &pairs}).crossing.size();
    }
};

}  // namespace

TEST_CASE("A seam that is sewn without contact closes around a lower layer, and not upon what stands out of it", "[slow]") {
    SewnAroundSheet same(0), outside(1);
    CHECK(same.simulation.meets(same.sheet, same.cover));
    CHECK_FALSE(outside.simulation.meets(outside.sheet, outside.cover));
    for (SewnAroundSheet* scene : {&same, &outside}) {
        const double end = scene == &same ? 0.4 : 0.7;
        while (scene->simulation.time() < end) REQUIRE(scene->simulation.step().ok());
        CHECK(scene->simulation.meets(scene->sheet, scene->cover));
        CHECK(scene->crossings() == 0);
    }
    CHECK(same.largest_gap() > 0.25 * sheet_cloth.thickness);
    CHECK(outside.largest_gap() < 0.02 * sheet_cloth.thickness);
}

TEST_CASE("The certificate leaves out triangles of cloths that do not meet, and wants to know of all whose they are") {
    TriangleMesh crossed = make_grid(0.2, 0.2, 5, 5);
    TriangleMesh other = crossed;
    for (Vec3& x : other.vertices) x = {x.x() + 0.003, x.z() + 0.013, x.y() + 0.002};
    const TriangleMesh all = joined(crossed, other);
    std::vector<int> cloth(all.triangles.size(), 0);
    std::fill(cloth.begin() + static_cast<long>(crossed.triangles.size()), cloth.end(), 1);
    ClothPairs pairs;
    CHECK_FALSE(certify_cloth(all, {}, {cloth, &pairs}).crossing.empty());
    pairs.set(1, 0, {.contact = false});
    CHECK(certify_cloth(all, {}, {cloth, &pairs}).crossing.empty());
    pairs.set(1, 0, {.thickness = 0.01});
    CHECK_FALSE(certify_cloth(all, {}, {cloth, &pairs}).crossing.empty());
    cloth.pop_back();
    CHECK(scene_error([&] {
              certify_cloth(all, {}, {cloth, &pairs});
          }).find("certify_cloth: the cloths of") != std::string::npos);
}

TEST_CASE("The order of layers decides which of two interleaved cloths goes above the other, and is part of a saved state") {
    const int upper = GENERATE(0, 1);
    const auto made = [&](int layer) {
        auto simulation = std::make_unique<Simulation>(StepSettings{}, make_brute_force_detector());
        for (int k = 0; k < 2; ++k) {
            TriangleMesh sheet = make_grid(0.6, 0.6, 25 - k, 25 - k);
            for (Vec3& x : sheet.vertices) x.y() = k == 0 ? 0.0 : 0.004 * std::sin(20.0 * x.x()) * std::cos(15.0 * x.z());
            const ClothId id = simulation->add_cloth(sheet, sheet_cloth, {}, k == 0 ? "flat" : "wavy");
            if (k == upper && layer != 0) simulation->set_layer(id, layer);
        }
        return simulation;
    };
    auto simulation = made(3);
    simulation->prepare();
    CHECK_FALSE(simulation->start_repair().empty());
    REQUIRE(simulation->step().ok());
    double height[2] = {};
    for (int k = 0; k < 2; ++k) {
        const auto positions = simulation->positions({k});
        for (const Vec3& x : positions) height[k] += x.y() / static_cast<double>(positions.size());
    }
    CHECK(height[upper] > height[1 - upper] + 0.0005);

    const std::vector<std::byte> saved = simulation->save();
    CHECK(scene_error([&] { made(3)->restore(saved); }).empty());
    CHECK(scene_error([&] { made(2)->restore(saved); }).find("pairs of cloths") != std::string::npos);
    CHECK(scene_error([&] { simulation->set_layer({upper}, 1001); }).find("layer = 1001 ") != std::string::npos);
    Fabric single = sheet_cloth;
    single.self_contact = false;
    const ClothId alone = simulation->add_cloth(make_grid(0.1, 0.1, 3, 3), single, {.translation = {0, 1, 0}}, "alone");
    CHECK(scene_error([&] { simulation->set_layer(alone, 1); }).find("alone: a layer says nothing") != std::string::npos);
}

}  // namespace percale::test::cloth_pairs_step_test
