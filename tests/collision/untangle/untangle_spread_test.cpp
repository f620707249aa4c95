#include "collision/untangle/untangle_spread.h"

#include <limits>

#include "tests/support/catch.h"

namespace percale::test::untangle_spread_test {
namespace {

struct Strip {
    TriangleMesh mesh = make_grid(1.0, 0.1, 11, 2);  // 0.1 m cells
    std::vector<double> thickness = std::vector<double>(22, 0.01), free = std::vector<double>(22, 1.0);

    TangledCloth cloth() const { return make_tangled_cloth(mesh.triangles, thickness, free); }
};

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("distances from fixed vertices run along edges") {
    Strip strip;
    const auto none = distance_from_fixed(strip.cloth(), strip.mesh.vertices);
    for (const double distance : none) CHECK(distance == infinity);
    strip.free[0] = 0.0;
    const auto distance = distance_from_fixed(strip.cloth(), strip.mesh.vertices);
    for (int c = 0; c <= 10; ++c) CHECK(distance[c] == Approx(0.1 * c).margin(1e-12));
}

TEST_CASE("moves fade by half the length along the cloth and stretch little") {
    const Strip strip;
    const TangledCloth cloth = strip.cloth();
    std::vector<bool> core(22, false);
    std::vector<Vec3> moves(22, Vec3(9, 9, 9));
    core[0] = core[11] = true;
    moves[0] = moves[11] = Vec3(0, 0.2, 0);
    const std::vector<double> limit(22, infinity);
    spread_moves(cloth, strip.mesh.vertices, core, limit, moves);
    for (int c = 0; c <= 10; ++c) {
        CHECK(moves[c].y() == Approx(std::max(0.0, 0.2 - 0.05 * c)).margin(1e-12));
        CHECK(moves[c].x() == 0.0);
    }
    std::vector<Vec3> to = strip.mesh.vertices;
    for (int v = 0; v < 22; ++v) to[v] += moves[v];
    CHECK(largest_stretch(cloth, strip.mesh.vertices, to) == Approx(std::sqrt(1.25) - 1.0));
    CHECK(largest_stretch(cloth, strip.mesh.vertices, strip.mesh.vertices) == 0.0);
}

TEST_CASE("nothing moves beyond its limit") {
    const Strip strip;
    std::vector<bool> core(22, true);
    std::vector<Vec3> moves(22, Vec3(0, 0, 0.5));
    std::vector<double> limit(22, infinity);
    limit[3] = 0.1;
    limit[4] = 0.0;
    spread_moves(strip.cloth(), strip.mesh.vertices, core, limit, moves);
    CHECK(moves[3].z() == Approx(0.1));
    CHECK(moves[4] == Vec3::Zero());
    CHECK(moves[5] == Vec3(0, 0, 0.5));
}

}  // namespace percale::test::untangle_spread_test
