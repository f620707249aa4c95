#include "engine/model/sewn_points.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/random.h"

namespace percale::test {

TEST_CASE("The pairs of a sewn point store what its gap stores, and their forces are its") {
    Random random(3);
    for (int n = 0; n < 100; ++n) {
        const Stitch stitch{0, 1, 2, random.number(0.0, 1.0)};
        SpringNetwork network;
        for (const auto& [a, b] : {std::array{0, 1}, {0, 2}, {1, 2}}) append_pair(a, b, network);
        const SewnPoint point{stitch, random.decades(1e-2, 1e4), random.unit(), 0, 1};
        add_sewn_pairs(std::vector{point}, network);
        const std::vector<Vec3> x = {random.point(1.0), random.point(1.0), random.point(1.0)};
        double by_pairs = 0.0;
        for (int k = 0; k < 3; ++k) {
            by_pairs += 0.5 * network.bending[k] * (x[network.first[k]] - x[network.second[k]]).squaredNorm();
        }
        const double by_gap = sewn_energy(point, 0.0, to_vectors(x));
        CHECK(by_gap == Approx(0.5 * point.stiffness * sewn_gap(point, to_vectors(x)).squaredNorm()));
        CHECK(by_pairs == Approx(by_gap).epsilon(1e-10));
    }
}

TEST_CASE("Cloth without sewn points has no bending of theirs") {
    SpringNetwork network;
    append_pair(0, 1, network);
    add_sewn_pairs({}, network);
    CHECK(network.bending.empty());
}

}  // namespace percale::test
