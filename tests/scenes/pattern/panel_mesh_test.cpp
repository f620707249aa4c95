#include "scenes/pattern/panel_mesh.h"

#include <Eigen/Geometry>
#include <set>

#include "scenes/pattern/delaunay.h"
#include "tests/scenes/pattern/garments.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::panel_mesh_test {
namespace {

constexpr double to_degrees = 180.0 / std::numbers::pi;

void check_mesh_of(const std::vector<Point2>& outline, double edge_length, double min_degrees) {
    const PanelMesh mesh = mesh_panel(outline, edge_length);
    REQUIRE(mesh.vertices.size() >= outline.size());
    for (std::size_t k = 0; k < outline.size(); ++k) CHECK(mesh.vertices[k] == outline[k]);
    std::set<std::array<int, 2>> sides;
    double twice = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const double turn = turn_left(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
        CHECK(turn > 0.0);
        twice += turn;
        for (int k = 0; k < 3; ++k) CHECK(sides.insert({t[k], t[(k + 1) % 3]}).second);
    }
    CHECK(0.5 * twice == Approx(area_of(outline)).epsilon(1e-12));
    const int count = static_cast<int>(outline.size());
    for (int k = 0; k < count; ++k) {
        CHECK(sides.contains({k, (k + 1) % count}));
        CHECK_FALSE(sides.contains({(k + 1) % count, k}));
    }
    CHECK(smallest_angle(mesh) * to_degrees > min_degrees);
}

}  // namespace

TEST_CASE("fifty round panels have their outline, their area, and no sliver", "[slow]") {
    Random random(11);
    for (int round = 0; round < 50; ++round) {
        const double edge_length = random.number(0.01, 0.03);
        check_mesh_of(bumpy_outline(random, random.number(0.15, 0.5), edge_length), edge_length, 22.0);
    }
}

TEST_CASE("straight panels, combs and waistbands have no sliver either") {
    check_mesh_of(divided({{0, 0}, {0.5, 0}, {0.5, 0.6}, {0, 0.6}}, 0.02), 0.02, 25.0);
    check_mesh_of(divided({{0, 0}, {0.9, 0}, {0.9, 0.4}, {0.6, 0.4}, {0.6, 0.1}, {0.3, 0.1}, {0.3, 0.4}, {0, 0.4}}, 0.02), 0.02,
                  25.0);
    for (const double width : {0.02, 0.03, 0.04, 0.05}) {
        check_mesh_of(divided({{0, 0}, {0.7, 0}, {0.7, width}, {0, width}}, 0.02), 0.02, 20.0);
    }
    check_mesh_of({{0, 0}, {1, 0}, {0, 1}}, 2.0, 40.0);
}

TEST_CASE("straight sides whose points are rounded off their line have none either") {
    Random random(5);
    for (int round = 0; round < 60; ++round) {
        const double hem = random.number(0.3, 0.5), waist = random.number(0.2, 0.5), top = random.number(0.2, 0.6);
        const double edge_length = random.number(0.02, 0.035), angle = random.number(0.0, 0.1);
        const Eigen::Rotation2Dd turned(angle);
        check_mesh_of(divided({turned * Point2(-hem, 0.5), turned * Point2(hem, 0.5), turned * Point2(waist, 0.5 + top),
                               turned * Point2(-waist, 0.5 + top)},
                              edge_length),
                      edge_length, 20.0);
    }
}

TEST_CASE("edges are about as long as asked, and the same outline gives the same bits") {
    const std::vector<Point2> outline = divided({{0, 0}, {1, 0}, {1, 0.8}, {0, 0.8}}, 0.02);
    const PanelMesh mesh = mesh_panel(outline, 0.02), again = mesh_panel(outline, 0.02);
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        sum += ((mesh.vertices[a] - mesh.vertices[b]).norm() + (mesh.vertices[b] - mesh.vertices[c]).norm() +
                (mesh.vertices[c] - mesh.vertices[a]).norm()) /
               3.0;
    }
    CHECK(sum / static_cast<double>(mesh.triangles.size()) == Approx(0.02).epsilon(0.1));
    CHECK(mesh.vertices == again.vertices);
    CHECK(mesh.triangles == again.triangles);
}

}  // namespace percale::scenes::test::panel_mesh_test
