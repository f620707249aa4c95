#include <climits>
#include <cmath>
#include <limits>

#include "percale/certify.h"
#include "percale/strain.h"
#include "tests/support/collision/c_objects.h"

namespace percale::test::mesh_calls_test {
namespace {

void check_same(const percale_mesh* made, const TriangleMesh& mesh) {
    std::size_t vertices = 0, triangles = 0;
    const double* x = percale_mesh_vertices_view(made, &vertices);
    const int* corners = percale_mesh_triangles_view(made, &triangles);
    REQUIRE(vertices == mesh.vertices.size());
    REQUIRE(triangles == mesh.triangles.size());
    bool same = true;
    for (std::size_t i = 0; i < 3 * vertices; ++i) same = same && x[i] == mesh.vertices[i / 3][static_cast<int>(i % 3)];
    for (std::size_t i = 0; i < 3 * triangles; ++i) same = same && corners[i] == mesh.triangles[i / 3][i % 3];
    CHECK(same);
    percale_mesh_vertices_view(made, nullptr);
}

template <class Make, class... Arguments>
CMesh shape(Make make, Arguments... arguments) {
    percale_mesh* made = nullptr;
    well(make(arguments..., &made));
    return CMesh(made);
}

}  // namespace

TEST_CASE("Meshes made through C are those of C++") {
    const double size[3] = {1.0, 2.0, 3.0};
    check_same(shape(percale_make_grid, 1.0, 2.0, 4, 5).get(), make_grid(1.0, 2.0, 4, 5));
    check_same(shape(percale_make_sphere, 0.5, 2).get(), make_sphere(0.5, 2));
    check_same(shape(percale_make_box, size).get(), make_box({1.0, 2.0, 3.0}));
    check_same(shape(percale_make_cylinder, 0.5, 1.0, 7).get(), make_cylinder(0.5, 1.0, 7));
    check_same(shape(percale_make_capsule, 0.5, 1.0, 8).get(), make_capsule(0.5, 1.0, 8));
    check_same(shape(percale_make_plane, 2.0).get(), make_plane(2.0));
    check_same(c_mesh(make_capsule(0.1, 0.3, 8)).get(), make_capsule(0.1, 0.3, 8));
}

TEST_CASE("Wrong meshes are refused and nothing is made") {
    percale_mesh* made = nullptr;
    const double x[] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, bad[] = {0, 0, 0, 1, 0, 0, 0, std::nan(""), 0};
    const int t[] = {0, 1, 2}, out[] = {0, 1, 3};
    const auto refused = [&](percale_status status, const char* part) {
        fails(status, PERCALE_INVALID_ARGUMENT, "percale_create_mesh", part);
        CHECK(made == nullptr);
    };
    refused(percale_create_mesh(x, 3, out, 1, &made), "3");
    refused(percale_create_mesh(bad, 3, t, 1, &made), "2");
    refused(percale_create_mesh(nullptr, 3, t, 1, &made), "vertices");
    refused(percale_create_mesh(x, 3, nullptr, 1, &made), "triangles");
    refused(percale_create_mesh(x, 3, t, 0, &made), "triangles");
    refused(percale_create_mesh(x, SIZE_MAX, t, 1, &made), "vertices");
    refused(percale_create_mesh(x, 3, t, SIZE_MAX / 2, &made), "triangle");
    refused(percale_create_mesh(x, 3, t, 1, nullptr), "NULL");
    fails(percale_make_grid(1.0, -1.0, 3, 3, &made), PERCALE_INVALID_ARGUMENT, "percale_make_grid", "-1");
    fails(percale_make_grid(1.0, 1.0, INT_MAX, INT_MAX, &made), PERCALE_INVALID_ARGUMENT, "percale_make_grid", "1073741823");
    fails(percale_make_sphere(1.0, 9, &made), PERCALE_INVALID_ARGUMENT, "percale_make_sphere", "9");
    fails(percale_make_box(nullptr, &made), PERCALE_INVALID_ARGUMENT, "percale_make_box", "size");
    fails(percale_make_cylinder(1.0, 1.0, 2, &made), PERCALE_INVALID_ARGUMENT, "percale_make_cylinder", "2");
    fails(percale_make_capsule(1.0, 1.0, 5, &made), PERCALE_INVALID_ARGUMENT, "percale_make_capsule", "5");
    fails(percale_make_plane(0.0, &made), PERCALE_INVALID_ARGUMENT, "percale_make_plane", "0");
    CHECK(made == nullptr);
    CHECK(percale_mesh_vertices_view(nullptr, nullptr) == nullptr);
    CHECK(percale_mesh_triangles_view(nullptr, nullptr) == nullptr);
    percale_destroy_mesh(nullptr);
}

TEST_CASE("The certificate through C is that of C++") {
    const TriangleMesh ball = make_sphere(0.3, 2);
    auto reported = c_struct(percale_init_certificate);
    for (const double height : {0.1, 0.295, 0.35}) {
        TriangleMesh sheet = make_grid(0.6, 0.6, 9, 9);
        for (Vec3& x : sheet.vertices) x.y() = height;
        const Certificate found = certify(sheet, ball);
        well(percale_certify(c_mesh(sheet).get(), c_mesh(ball).get(), INFINITY, &reported));
        CHECK(reported.intersecting_pairs == found.pairs.size());
        CHECK(reported.touching_pairs == static_cast<std::uint64_t>(found.touching_pairs));
        CHECK((reported.watertight == 1) == found.watertight);
        CHECK(reported.vertices_inside == found.vertices_inside);
        CHECK(reported.deepest_vertex == found.deepest_vertex);
        CHECK(reported.deepest_penetration == found.deepest_penetration);
        CHECK(reported.smallest_distance == found.smallest_distance);
        CHECK(reported.first_cloth_triangle == (found.pairs.empty() ? -1 : found.pairs[0].first));
        CHECK(reported.first_obstacle_triangle == (found.pairs.empty() ? -1 : found.pairs[0].second));
    }
    const CMesh mesh = c_mesh(ball);
    const auto before = reported;
    fails(percale_certify(mesh.get(), mesh.get(), -1.0, &reported), PERCALE_INVALID_ARGUMENT, "percale_certify", "-1");
    fails(percale_certify(nullptr, mesh.get(), 1.0, &reported), PERCALE_INVALID_ARGUMENT, "percale_certify", "cloth");
    fails(percale_certify(mesh.get(), nullptr, 1.0, &reported), PERCALE_INVALID_ARGUMENT, "percale_certify", "obstacle");
    fails(percale_certify(mesh.get(), mesh.get(), 1.0, nullptr), PERCALE_INVALID_ARGUMENT, "percale_certify", "certificate");
    reported.struct_size = 8;
    fails(percale_certify(mesh.get(), mesh.get(), 1.0, &reported), PERCALE_INVALID_ARGUMENT, "percale_certify", "struct_size");
    CHECK(reported.smallest_distance == before.smallest_distance);
}

TEST_CASE("Cloth that crosses itself is counted through C as in C++") {
    TriangleMesh both = make_grid(0.4, 0.4, 5, 5);
    const TriangleMesh wall = make_grid(0.31, 0.33, 4, 4);
    both.grid_columns = both.grid_rows = 0;
    for (const Triangle& t : wall.triangles) both.triangles.push_back({t[0] + 25, t[1] + 25, t[2] + 25});
    for (const Vec3& x : wall.vertices) both.vertices.emplace_back(0.013, x.x(), x.z());
    const ClothCertificate found = certify_cloth(both);
    std::size_t crossing = 0, touching = 99;
    well(percale_certify_cloth(c_mesh(both).get(), &crossing, &touching));
    CHECK(crossing > 0);
    CHECK(crossing == found.crossing.size());
    CHECK(touching == found.touching.size());
    fails(percale_certify_cloth(nullptr, &crossing, &touching), PERCALE_INVALID_ARGUMENT, "percale_certify_cloth", "cloth");
    fails(percale_certify_cloth(c_mesh(both).get(), nullptr, &touching), PERCALE_INVALID_ARGUMENT, "percale_certify_cloth",
          "NULL");
}

TEST_CASE("Strains of a sheet that is stretched by known fractions, at the scale of its pose") {
    TriangleMesh flat = make_grid(0.4, 0.4, 3, 3);
    flat.grid_columns = flat.grid_rows = 0;
    const CMesh mesh = c_mesh(flat);
    auto settings = c_struct(percale_init_cloth_settings);
    settings.warp[0] = 1.0;
    settings.pose.scale = 2.0;
    std::vector<double> x;
    for (const Vec3& at : flat.vertices) x.insert(x.end(), {2.0 * 1.1 * at.x(), 0.0, 2.0 * 0.95 * at.z()});
    std::vector<double> strains(3 * flat.triangles.size(), -1.0);
    well(percale_triangle_strains(mesh.get(), &settings, x.data(), 9, strains.data(), flat.triangles.size()));
    for (std::size_t t = 0; t < flat.triangles.size(); ++t) {
        CHECK(strains[3 * t] == Approx(0.1));
        CHECK(strains[3 * t + 1] == Approx(-0.05));
        CHECK(std::abs(strains[3 * t + 2]) < 1e-12);
    }
    const auto call = [&](std::size_t vertices, std::size_t capacity) {
        return percale_triangle_strains(mesh.get(), &settings, x.data(), vertices, strains.data(), capacity);
    };
    fails(call(8, 8), PERCALE_INVALID_ARGUMENT, "percale_triangle_strains", "8");
    fails(call(9, 7), PERCALE_BUFFER_TOO_SMALL, "percale_triangle_strains", "7");
    settings.warp[0] = 0.0;
    settings.warp[1] = 1.0;  // normal to all triangles
    fails(call(9, 8), PERCALE_INVALID_ARGUMENT, "percale_triangle_strains", "warp");
}

}  // namespace percale::test::mesh_calls_test
