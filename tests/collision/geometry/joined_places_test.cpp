#include "collision/geometry/joined_places.h"

#include <limits>

#include "percale/certify.h"
#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/random.h"

namespace percale::test::joined_places_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A tube whose seam is open, its rims so far apart.
TriangleMesh open_tube(double gap) {
    TriangleMesh tube = make_grid(1.0, 0.4, 25, 9);
    const int last = 24;
    for (int k = 0; k < static_cast<int>(tube.vertices.size()); ++k) {
        Vec3& x = tube.vertices[k];
        const double angle = 2.0 * 3.14159265358979323846 * (k % 25) / last, height = x.z();
        x = k % 25 == 0 || k % 25 == last ? Vec3(0.16, height, k % 25 == 0 ? 0.0 : -gap)
                                          : Vec3(0.16 * std::cos(angle), height, 0.16 * std::sin(angle));
    }
    return tube;
}

}  // namespace

TEST_CASE("vertices that are apart by less than rounding are in one place, all others stay where they are") {
    Random random(3);
    std::vector<Vec3> x;
    std::vector<Triangle> triangles;
    for (int k = 0; k < 300; ++k) {
        x.push_back(random.point(1.0));
        x.push_back(x.back() + random.point(8.0 * epsilon));
        x.push_back(x.back() + random.point(1e-13));
        triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    }
    const std::vector<Vec3> joined = joined_places(x, triangles);
    for (int k = 0; k < 300; ++k) {
        CHECK(joined[3 * k] == x[3 * k]);
        CHECK(joined[3 * k + 1] == x[3 * k]);
        CHECK(joined[3 * k + 2] == x[3 * k + 2]);
    }
    x[5] = x[2];
    CHECK(joined_places(x, std::vector<Triangle>{}) == x);
}

TEST_CASE("a tube whose rims touch, or are apart by whatever rounding left, makes its first steps and crosses nothing") {
    for (const double gap : {0.0, 1e-18, 6e-17, 1e-16, 7e-16, 3e-15, 1e-14, 1e-12}) {
        CAPTURE(gap);
        Simulation simulation({.time_step = 1.0 / 60.0}, backends().back().make_detector());
        const TriangleMesh tube = open_tube(gap);
        Fabric fabric{.area_density = 0.2, .springs = {.structural = 500.0, .bend = 5.0}};
        fabric.thickness = 0.006;
        fabric.self_contact = true;
        const ClothId cloth = simulation.add_cloth(tube, fabric);
        for (int step = 0; step < 3; ++step) {
            const StepReport report = simulation.step();
            CHECK(report.ok());
            CHECK(report.newton_iterations < 100);
            CHECK(report.linear_iterations < 20000);
        }
        TriangleMesh now = tube;
        now.vertices.assign(simulation.positions(cloth).begin(), simulation.positions(cloth).end());
        CHECK(certify_cloth(now).crossing.empty());
    }
}

}  // namespace percale::test::joined_places_test
