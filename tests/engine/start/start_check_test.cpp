#include "engine/start/start_check.h"

#include <memory>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test::start_check_test {
namespace {

/// Finds the faults that the test sets.
class FaultyDetector : public PlaneDetector {
public:
    explicit FaultyDetector(StartFault fault) : fault_(std::move(fault)) {}
    StartFault check_start(std::span<const Vec3>) override { return fault_; }
    void set_self_contact(const SelfContact&) override {}

private:
    StartFault fault_;
};

/// A free sheet, its vertices not in the caller's order, and a grid, above a floor; both meet cloth.
struct Scene {
    Simulation simulation;
    explicit Scene(const StartFault& fault, StartRule rule = StartRule::repair)
        : simulation({.start = rule}, std::make_unique<FaultyDetector>(fault)) {
        Fabric fabric = sheet_fabric();
        fabric.self_contact = true;
        const TriangleMesh grid = make_grid(0.4, 0.4, 4, 4);
        Fabric free = fabric;
        free.springs.shear = 0.0;
        simulation.add_cloth({.vertices = grid.vertices, .triangles = grid.triangles}, free, {.translation = Vec3(0, 1, 0)},
                             "shawl");
        simulation.add_cloth(grid, fabric, {.translation = Vec3(0, 2, 0)}, "towel");
        simulation.add_obstacle(make_plane(1.0), {}, {.name = "floor"});
    }
    StartError refusal() {
        try {
            simulation.prepare();
        } catch (const StartError& error) {
            return error;
        }
        return {"nothing was refused", {}};
    }
};

}  // namespace

TEST_CASE("A clear start moves nothing") {
    Scene scene({});
    scene.simulation.prepare();
    CHECK(scene.simulation.start_repair().empty());
}

TEST_CASE("Cloth in cloth is refused with both triangles, counted in their cloths") {
    StartFault fault;
    fault.intersecting_pairs = 3;
    fault.cloth_triangle = 5;
    fault.other_cloth_triangle = 18 + 7;
    CHECK(std::string(Scene(fault).refusal().what())
              .starts_with("shawl starts through towel: 3 intersecting triangle pairs, one of them triangle 5 of shawl and "
                           "triangle 7 of towel"));
    fault.intersecting_pairs = 0;
    CHECK(std::string(Scene(fault).refusal().what()) ==
          "shawl starts touching towel: triangle 5 of shawl and triangle 7 of towel, and no way out was found; move them apart, "
          "say by layers which is worn outside, or let self_contact be false");
    fault.other_cloth_triangle = 6;
    CHECK(
        std::string(Scene(fault, StartRule::refuse).refusal().what()) ==
        "shawl starts touching itself: triangle 5 and triangle 6; move them apart, or let self_contact be false, or allow start "
        "= repair");
}

TEST_CASE("A refused start names and numbers vertices as the caller does") {
    StartFault fault{.obstacle = 0};
    fault.vertices_inside = 1;
    for (int vertex = 0; vertex < 32; ++vertex) {
        fault.inside_vertex = vertex;
        fault.inside_vertices = {vertex};
        const StartError error = Scene(fault, StartRule::refuse).refusal();
        const int number = error.fault().inside_vertex;
        CAPTURE(vertex, number, error.what());
        CHECK((vertex < 16 ? number >= 0 && number < 16 : number == vertex));
        CHECK(error.fault().inside_vertices == std::vector<int>{number});
        const std::string name = vertex < 16 ? std::to_string(number) + " of shawl" : std::to_string(number - 16) + " of towel";
        CHECK(
            std::string(error.what()).starts_with("the cloth starts inside floor: 1 vertices, one of them vertex " + name + ";"));
    }
}

TEST_CASE("Without a way out the start is refused with the reason") {
    StartFault fault{.obstacle = 0};
    fault.vertices_inside = 2;
    fault.inside_vertex = 17;
    CHECK(
        std::string(Scene(fault).refusal().what()).ends_with(", and no way out was found; move the cloth or the obstacle apart"));
}

}  // namespace percale::test::start_check_test
