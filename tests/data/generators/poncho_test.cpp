#include "data/generators/poncho.h"

#include <cmath>

#include "data/generators/mannequin.h"
#include "percale/certify.h"
#include "scenes/meshes/mesh_import.h"
#include "tests/scenes/mesh_laws.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::poncho_test {
namespace {

double exact_area(const PonchoShape& s) {
    return s.side * s.side - (4.0 - M_PI) * s.corner_radius * s.corner_radius - 0.25 * M_PI * s.hole_width * s.hole_depth;
}

/// Vertices with an open edge.
std::set<int> rim_of(const TriangleMesh& mesh) {
    std::set<int> rim;
    const EdgeCount edges(mesh);
    for (const auto& [edge, times] : edges.directed)
        if (edges.count(edge.second, edge.first) == 0) rim.insert({edge.first, edge.second});
    return rim;
}

/// A function that is 0 on the hole's ellipse.
double off_hole(const PonchoShape& s, const Vec3& x) {
    return std::hypot(2.0 * x[0] / s.hole_width, 2.0 * x[2] / s.hole_depth) - 1.0;
}

/// Signed distance to the rounded square, m.
double off_outline(const PonchoShape& s, const Vec3& x) {
    const double inner = 0.5 * s.side - s.corner_radius;
    const double u = std::abs(x[0]) - inner, v = std::abs(x[2]) - inner;
    return std::hypot(std::max(u, 0.0), std::max(v, 0.0)) + std::min(0.0, std::max(u, v)) - s.corner_radius;
}

}  // namespace

TEST_CASE("the poncho is one flat sheet with one hole, facing up") {
    const TriangleMesh mesh = make_poncho();
    CHECK_NOTHROW(check_mesh(mesh, "poncho", true));
    CHECK(euler_number(mesh) == 0);
    CHECK(has_single_fans(mesh));
    for (const Vec3& x : mesh.vertices) REQUIRE(x[1] == 0.0);
    for (const Triangle& t : mesh.triangles) {
        const Vec3 u = mesh.vertices[t[1]] - mesh.vertices[t[0]], v = mesh.vertices[t[2]] - mesh.vertices[t[0]];
        REQUIRE(u.cross(v)[1] > 0.0);
    }
    CHECK_FALSE(mesh.is_grid());
}

TEST_CASE("the rim of the poncho lies on its hole and its outline, everything else between them") {
    const PonchoShape shape;
    const TriangleMesh mesh = make_poncho(shape);
    const std::set<int> rim = rim_of(mesh);
    int on_hole = 0, on_outline = 0;
    for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
        const double hole = off_hole(shape, mesh.vertices[v]), outline = off_outline(shape, mesh.vertices[v]);
        if (rim.count(v) == 0) {
            REQUIRE((hole > 0.0 && outline < 0.0));
            continue;
        }
        REQUIRE(std::min(std::abs(hole), std::abs(outline)) < 1e-5);
        (std::abs(hole) < 1e-5 ? on_hole : on_outline) += 1;
    }
    CHECK(on_hole == Approx(0.8808 / shape.edge_length).margin(2));  // perimeter of the ellipse: 0.8808 m
    CHECK(on_outline == Approx((4.0 * 0.9 + 2.0 * M_PI * 0.15) / shape.edge_length).margin(2));
}

TEST_CASE("the poncho's triangles are close to equilateral and of the size asked for") {
    const PonchoShape shape;
    const TriangleMesh mesh = make_poncho(shape);
    CHECK(sharpest_angle(mesh) > 30.0);
    CHECK(mesh.vertices.size() > 2000);
    CHECK(mesh.vertices.size() < 3500);
    double shortest = 1.0, longest = 0.0;
    for (const auto& [edge, times] : EdgeCount(mesh).directed) {
        const double length = (mesh.vertices[edge.first] - mesh.vertices[edge.second]).norm();
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
    }
    CHECK(shortest > 0.5 * shape.edge_length);
    CHECK(longest < 1.6 * shape.edge_length);
}

TEST_CASE("the poncho has the area of its shape, for other shapes too") {
    PonchoShape wide, round, fine;
    wide.hole_width = 0.5, wide.side = 1.0;
    round.corner_radius = 0.6;
    fine.edge_length = 0.015;
    for (const PonchoShape& shape : {PonchoShape{}, wide, round, fine}) {
        const TriangleMesh mesh = make_poncho(shape);
        CHECK(area(mesh) == Approx(exact_area(shape)).epsilon(2e-3));
        CHECK(euler_number(mesh) == 0);
        CHECK(sharpest_angle(mesh) > 20.0);
        CHECK_NOTHROW(check_mesh(mesh, "poncho", true));
    }
}

TEST_CASE("the poncho lies around the mannequin's neck without touching it") {
    const TriangleMesh body = import_mesh(PERCALE_DATA_DIR "/meshes/mannequin.obj");
    TriangleMesh poncho = make_poncho();
    for (Vec3& x : poncho.vertices) x[1] += 1.52;
    const Certificate certificate = certify(poncho, body, 0.1);
    CHECK(certificate.clean());
    CHECK(certificate.smallest_distance > 0.02);
    for (const Vec3& x : poncho.vertices) REQUIRE(mannequin_distance(x) > 0.02);
}

TEST_CASE("a poncho that cannot be cut is refused with the field and its range") {
    const auto refusal = [](double PonchoShape::*field, double value) {
        PonchoShape shape;
        shape.*field = value;
        return message_of([&] { make_poncho(shape); });
    };
    CHECK(refusal(&PonchoShape::edge_length, 0.0).find("poncho: edge_length is 0.000000 m, allowed are") == 0);
    CHECK(refusal(&PonchoShape::edge_length, std::nan("")).find("poncho: edge_length") == 0);
    CHECK(refusal(&PonchoShape::side, 0.1).find("poncho: side") == 0);
    CHECK(refusal(&PonchoShape::corner_radius, 0.7).find("poncho: corner_radius") == 0);
    CHECK(refusal(&PonchoShape::hole_width, 1.1).find("poncho: hole_width") == 0);
    CHECK(refusal(&PonchoShape::hole_depth, 0.01).find("poncho: hole_depth") == 0);
}

}  // namespace percale::scenes::test::poncho_test
