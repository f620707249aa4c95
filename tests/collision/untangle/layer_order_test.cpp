#include "collision/untangle/layer_order.h"

#include "percale/certify.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::layer_order_test {
namespace {

/// Upright tubes without ends, one cloth each, a layer each.
struct Tubes {
    TriangleMesh mesh = {};
    std::vector<int> cloth = {}, layer = {};

    void add(const TriangleMesh& tube, int its_layer) {
        const int number = cloth.empty() ? 0 : cloth.back() + 1;
        mesh = joined(mesh, tube);
        cloth.resize(mesh.triangles.size(), number);
        layer.resize(mesh.triangles.size(), its_layer);
    }
};

TriangleMesh tube(double radius, double tilt, int around) {
    TriangleMesh tube = make_grid(1, 1, around, around);
    const int columns = around;
    for (Vec3& x : tube.vertices) {
        const double angle = 2.0 * std::numbers::pi * (x.x() + 0.5);
        x = Vec3(radius * std::cos(angle) + tilt * x.z(), x.z(), radius * std::sin(angle));
    }
    // The last column is the first.
    for (Triangle& t : tube.triangles) {
        for (int& v : t) v = v % columns == columns - 1 ? v - columns + 1 : v;
    }
    tube.grid_columns = tube.grid_rows = 0;
    return tube;
}

/// Distance from the axis of the first tube.
double radius_of(const Vec3& x) { return std::hypot(x.x(), x.z()); }

}  // namespace

TEST_CASE("outside is where most of a closed or tubular cloth faces away from its middle, whatever its winding") {
    const TriangleMesh ball = make_sphere(0.3, 2), sheet = make_grid(1, 1, 5, 5), pipe = tube(0.1, 0.0, 24);
    const auto sign = [](const TriangleMesh& mesh) {
        const std::vector<int> cloth(mesh.triangles.size(), 0);
        return outward_signs(mesh.triangles, cloth, mesh.vertices)[0];
    };
    CHECK(sign(ball) == 1.0);
    CHECK(sign(inside_out(ball)) == -1.0);
    CHECK(sign(pipe) == -sign(inside_out(pipe)));
    CHECK(sign(sheet) == 1.0);
    CHECK(sign(inside_out(sheet)) == 1.0);  // as it is wound
}

TEST_CASE("the tube of the higher layer goes outside of the lower one, which stays, and then nothing has to move") {
    const bool inner_first = GENERATE(true, false), turned = GENERATE(true, false);
    // 3 mm tilted: half of each end is inside, half outside.
    TriangleMesh lower = tube(0.1, 0.0, 31), upper = tube(0.1003, 0.006, 29);
    if (turned) upper = inside_out(upper);
    Tubes tubes;
    tubes.add(inner_first ? lower : upper, inner_first ? 0 : 2);
    tubes.add(inner_first ? upper : lower, inner_first ? 2 : 0);
    const ClothSurface surface = make_cloth_surface(tubes.mesh.triangles, tubes.mesh.vertices.size());
    const std::vector<double> free(tubes.mesh.vertices.size(), 1.0);
    const std::vector<double> outwards = outward_signs(tubes.mesh.triangles, tubes.cloth, tubes.mesh.vertices);
    const LayeredCloth layered{surface, tubes.cloth, tubes.layer, outwards, free, 0.02, 0.001};
    std::vector<Vec3> x = tubes.mesh.vertices;
    int rounds = 0;
    while (rounds < 50 && push_outside(layered, x)) ++rounds;
    CHECK(rounds > 0);
    CHECK(rounds < 50);
    CHECK_FALSE(push_outside(layered, x));
    const std::size_t first = inner_first ? lower.vertices.size() : 0, own = inner_first ? 0 : upper.vertices.size();
    for (std::size_t v = 0; v < lower.vertices.size(); ++v) CHECK(x[own + v] == lower.vertices[v]);
    int inside = 0;
    for (std::size_t v = 0; v < upper.vertices.size(); ++v) {
        // The rim of the lower tube has no outside beyond it.
        if (std::abs(upper.vertices[v].y()) > 0.45 || v % 29 == 28) continue;  // no triangle has the last column
        inside += radius_of(upper.vertices[v]) < 0.0995;
        CHECK((x[first + v] - upper.vertices[v]).norm() < 0.006);
        CHECK(radius_of(x[first + v]) > 0.0999);
    }
    CHECK(inside > 50);
}

TEST_CASE("the other side of a flat tube has no effect, and cloth beyond the reach stays") {
    // Two sides of a tube 8 mm apart, and a sheet on one of them.
    Tubes tubes;
    TriangleMesh flat = tube(0.1, 0.0, 31);
    for (Vec3& x : flat.vertices) x.z() *= 0.04;
    tubes.add(flat, 0);
    TriangleMesh patch = make_grid(0.05, 0.05, 6, 6);
    const double height = GENERATE(0.0038, 0.05);
    for (Vec3& x : patch.vertices) x = Vec3(x.x(), -x.z(), height);
    tubes.add(patch, 1);
    const ClothSurface surface = make_cloth_surface(tubes.mesh.triangles, tubes.mesh.vertices.size());
    const std::vector<double> free(tubes.mesh.vertices.size(), 1.0);
    const std::vector<double> outwards = outward_signs(tubes.mesh.triangles, tubes.cloth, tubes.mesh.vertices);
    std::vector<Vec3> x = tubes.mesh.vertices;
    for (int round = 0; round < 30; ++round) {
        push_outside({surface, tubes.cloth, tubes.layer, outwards, free, 0.02, 0.001}, x);
    }
    for (std::size_t v = flat.vertices.size(); v < x.size(); ++v) {
        if (height > 0.02) CHECK(x[v] == tubes.mesh.vertices[v]);
        CHECK(x[v].z() > 0.004);
        CHECK(x[v].z() < height + 0.003);
    }
}

}  // namespace percale::test::layer_order_test
