#include <algorithm>
#include <numeric>

#include "engine/schemes/schemes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"
#include "tests/support/plane_detector.h"

namespace percale::test::invariance_test {
namespace {

/// A sheet without its grid, hung from two vertices of the boundary and pushed sideways.
TriangleMesh free_sheet() {
    TriangleMesh mesh = make_grid(0.6, 0.6, 7, 7);
    mesh.grid_columns = mesh.grid_rows = 0;
    return mesh;
}

std::vector<Vec3> run(const StepSettings& settings, const TriangleMesh& mesh, const Pose& pose, const std::array<int, 2>& pins,
                      int steps) {
    Simulation simulation(settings);
    const ClothId cloth = simulation.add_cloth(mesh, free_fabric(), pose);
    for (const int vertex : pins) simulation.pin(cloth, vertex);
    for (int n = 0; n < steps; ++n) REQUIRE(simulation.step().ok());
    return copy(simulation.positions(cloth));
}

/// Few enough for schemes that grow at every step.
int steps_of(Scheme scheme) {
    if (facts_of(scheme).implicit) return 15;
    return facts_of(scheme).stable_up_to > 0.0 ? 400 : 40;
}

std::string word(Scheme scheme) { return std::string(facts_of(scheme).word); }

/// Enough iterations that no step is halved: near their limit rounding would decide it.
StepSettings tight(Scheme scheme) {
    return {.time_step = facts_of(scheme).implicit ? 1.0 / 60.0 : 5e-4,
            .scheme = scheme,
            .newton_tolerance = 1e-11,
            .newton_iterations = 500};
}

}  // namespace

TEST_CASE("A scene that is turned and shifted as a whole moves the same", "[law]") {
    Random random(21);
    for (const Scheme scheme : all_schemes) {
        const int steps = steps_of(scheme);
        const std::vector<Vec3> plain = run(tight(scheme), free_sheet(), {}, {0, 6}, steps);
        const Pose pose = random.pose(1.0);
        StepSettings turned = tight(scheme);
        turned.gravity = transform(Pose{.translation = Vec3::Zero(), .rotation = pose.rotation}, turned.gravity);
        const double difference = largest_difference(run(turned, free_sheet(), pose, {0, 6}, steps), transform(pose, plain));
        check_law("scene turned and shifted, " + word(scheme) + ": largest difference, m", difference, 1e-9);
    }
}

TEST_CASE("Renumbering vertices and triangles renumbers the result", "[law]") {
    const TriangleMesh mesh = free_sheet();
    const int count = static_cast<int>(mesh.vertices.size());
    std::vector<int> new_number(count);
    std::iota(new_number.begin(), new_number.end(), 0);
    std::mt19937 engine(4);
    std::shuffle(new_number.begin(), new_number.end(), engine);
    TriangleMesh shuffled = mesh;
    for (int i = 0; i < count; ++i) shuffled.vertices[new_number[i]] = mesh.vertices[i];
    for (Triangle& t : shuffled.triangles) t = {new_number[t[1]], new_number[t[2]], new_number[t[0]]};
    std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), engine);
    for (const Scheme scheme : all_schemes) {
        const int steps = steps_of(scheme);
        const std::vector<Vec3> plain = run(tight(scheme), mesh, {}, {0, 6}, steps);
        const std::vector<Vec3> other = run(tight(scheme), shuffled, {}, {new_number[0], new_number[6]}, steps);
        std::vector<Vec3> back(count);
        for (int i = 0; i < count; ++i) back[i] = other[new_number[i]];
        check_law("vertices renumbered, " + word(scheme) + ": largest difference, m", largest_difference(plain, back), 1e-9);
    }
}

TEST_CASE("A mirrored scene moves mirrored", "[law]") {
    const int steps = 12;  // later the sheet buckles, and rounding decides which way
    TriangleMesh mirrored = free_sheet();
    for (Vec3& x : mirrored.vertices) x.x() = -x.x();
    for (Triangle& t : mirrored.triangles) std::swap(t[1], t[2]);
    std::vector<Vec3> image = run(tight(Scheme::backward_euler), mirrored, {}, {0, 24}, steps);
    for (Vec3& x : image) x.x() = -x.x();
    const std::vector<Vec3> plain = run(tight(Scheme::backward_euler), free_sheet(), {}, {0, 24}, steps);
    check_law("mirrored scene, backward Euler: largest difference, m", largest_difference(image, plain), 1e-9);
}

TEST_CASE("Lengths, times and masses may be measured in other units", "[law]") {
    // Lengths by s, time by sqrt(s), spring constants by their own factor: the same motion, s times as large.
    const double s = 10.0;
    const auto sheet = [&](double scale) {
        Simulation simulation({.time_step = std::sqrt(scale) / 60.0, .newton_tolerance = 1e-11});
        Fabric fabric = free_fabric();
        fabric.area_density /= scale * scale;  // the same mass
        fabric.springs.structural /= scale;    // the same forces
        fabric.springs.bend /= scale;
        fabric.spring_damping /= std::sqrt(scale);
        fabric.thickness = 1e-3;
        const ClothId cloth = simulation.add_cloth(free_sheet(), fabric, {.scale = scale});
        simulation.pin(cloth, 0);
        for (int n = 0; n < 20; ++n) REQUIRE(simulation.step().ok());
        std::vector<Vec3> points = copy(simulation.positions(cloth));
        for (Vec3& x : points) x /= scale;
        return points;
    };
    check_law("lengths and times in other units, backward Euler: largest difference, m", largest_difference(sheet(1.0), sheet(s)),
              1e-9);
}

TEST_CASE("Masses and forces may be measured in other units", "[law]") {
    const auto sheet = [](Scheme scheme, double scale) {
        Simulation simulation(tight(scheme));
        Fabric fabric = free_fabric();
        fabric.area_density *= scale;
        fabric.springs.structural *= scale;
        fabric.springs.bend *= scale;
        fabric.spring_damping *= scale;
        const ClothId cloth = simulation.add_cloth(free_sheet(), fabric);
        simulation.pin(cloth, 0);
        for (int n = 0; n < steps_of(scheme); ++n) REQUIRE(simulation.step().ok());
        return copy(simulation.positions(cloth));
    };
    for (const Scheme scheme : all_schemes) {
        check_law("masses and forces in other units, " + word(scheme) + ": largest difference, m",
                  largest_difference(sheet(scheme, 1.0), sheet(scheme, 3.0)), 1e-9);
    }
}

TEST_CASE("Two runs of the same scene have the same bits in every step") {
    for (const bool contact : {false, true}) {
        std::vector<std::uint64_t> hashes[2];
        for (auto& list : hashes) {
            Simulation simulation(StepSettings{}, contact ? std::make_unique<PlaneDetector>() : nullptr);
            const ClothId cloth =
                simulation.add_cloth(make_grid(0.5, 0.5, 9, 9), sheet_fabric(), {.translation = Vec3(0, 0.1, 0)});
            if (contact)
                simulation.add_obstacle(make_plane(1.0), {.rotation = {0.995, 0.0, 0.0, std::sqrt(1.0 - 0.995 * 0.995)}});
            if (!contact) simulation.pin(cloth, 0);
            for (int n = 0; n < 40; ++n) {
                const StepReport report = simulation.step();
                list.push_back(simulation.state_hash());
                list.push_back(report.contact_hash);
            }
        }
        CHECK(hashes[0] == hashes[1]);
        CHECK(hashes[0][0] != hashes[0][2]);
    }
}

}  // namespace percale::test::invariance_test
