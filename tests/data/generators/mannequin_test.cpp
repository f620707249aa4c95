#include "data/generators/mannequin.h"

#include <random>
#include <tuple>

#include "percale/certify.h"
#include "tests/scenes/mesh_laws.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::mannequin_test {
namespace {

std::tuple<Vec3, Vec3> bounds(const TriangleMesh& mesh) {
    Vec3 lowest = mesh.vertices[0], highest = lowest;
    for (const Vec3& x : mesh.vertices) lowest = lowest.cwiseMin(x), highest = highest.cwiseMax(x);
    return {lowest, highest};
}

std::vector<Vec3> random_points(int count) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k)
        points.emplace_back(1.8 * share(random) - 0.9, 2.2 * share(random) - 0.2, share(random) - 0.5);
    return points;
}

bool solid(double x, double y, double z) { return mannequin_distance({x, y, z}) < 0.0; }

std::vector<Vec3> triangle_centres(const TriangleMesh& mesh) {
    std::vector<Vec3> centres;
    for (const Triangle& t : mesh.triangles)
        centres.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0);
    return centres;
}

double largest_distance(const std::vector<Vec3>& points) {
    double largest = 0.0;
    for (const Vec3& x : points) largest = std::max(largest, std::abs(mannequin_distance(x)));
    return largest;
}

/// Vertices whose mirror image is not there to the last bit.
int mirror_images_missing(const TriangleMesh& mesh) {
    std::set<std::tuple<double, double, double>> places;
    for (const Vec3& x : mesh.vertices) places.insert({x[0], x[1], x[2]});
    int missing = 0;
    for (const Vec3& x : mesh.vertices) missing += places.count({-x[0], x[1], x[2]}) == 1 ? 0 : 1;
    return missing;
}

/// Volume of the inside counted on a lattice of 12 mm, twice the left half, m^3.
double filled_volume() {
    const double h = 0.012;
    int inside = 0;
    for (double x = 0.5 * h; x < 0.7; x += h)
        for (double y = 0.5 * h; y < 1.8; y += h)
            for (double z = -0.2; z < 0.25; z += h) inside += solid(x, y, z) ? 1 : 0;
    return 2.0 * inside * h * h * h;
}

}  // namespace

TEST_CASE(
    "the mannequin's mesh at every spacing: closed, outward, without slivers, on the surface, mirrored, of the right size") {
    const double spacing = GENERATE(0.014, 0.017, 0.02);
    const TriangleMesh mesh = make_mannequin(spacing);
    INFO("spacing " << spacing);
    CHECK(is_watertight(mesh));
    CHECK(has_single_fans(mesh));
    CHECK(euler_number(mesh) == 2);
    CHECK(sharpest_angle(mesh) > 20.0);
    CHECK(self_intersections(mesh).empty());
    CHECK_NOTHROW(check_mesh(mesh, "mannequin", true));

    CHECK(largest_distance(mesh.vertices) < 1e-9);
    std::vector<Vec3> centres = triangle_centres(mesh), body;
    for (const Vec3& x : centres)
        if (std::abs(x[0]) < 0.5) body.push_back(x);
    CHECK(largest_distance(body) < 0.25 * spacing);
    CHECK(largest_distance(centres) < 0.6 * spacing);  // finger tips are no larger than the triangles
    CHECK(volume(mesh) == Approx(filled_volume()).epsilon(0.015));
    CHECK(mirror_images_missing(mesh) == 0);

    const auto [lowest, highest] = bounds(mesh);
    CHECK(std::abs(lowest[1]) < 1e-3);
    CHECK(highest[1] == Approx(mannequin_height).margin(2e-3));
    CHECK(highest[0] == -lowest[0]);
    CHECK(highest[0] > 0.55);
    CHECK(highest[0] < 0.70);
    CHECK(area(mesh) > 1.6);  // m^2; Du Bois for 1.78 m and 75 kg: 1.9
    CHECK(area(mesh) < 2.2);
}

TEST_CASE("the distance is the same on both sides to the last bit") {
    for (const Vec3& x : random_points(20000)) REQUIRE(mannequin_distance(x) == mannequin_distance({-x[0], x[1], x[2]}));
}

TEST_CASE("the distance never changes faster than the point moves") {
    const std::vector<Vec3> points = random_points(4000);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Vec3 near = points[k] + 1e-3 * (points[k + 1] - points[k]);
        REQUIRE(std::abs(mannequin_distance(points[k]) - mannequin_distance(near)) <= (near - points[k]).norm() * (1.0 + 1e-9));
        REQUIRE(std::abs(mannequin_distance(points[k]) - mannequin_distance(points[k + 1])) <=
                (points[k + 1] - points[k]).norm());
    }
}

TEST_CASE("it has the parts of a body where they belong") {
    CHECK(solid(0, 1.70, 0));           // head
    CHECK(solid(0, 1.53, -0.02));       // neck
    CHECK(solid(0, 1.25, 0));           // chest
    CHECK(solid(0, 0.98, 0));           // pelvis
    CHECK_FALSE(solid(0, 0.60, 0));     // between the thighs
    CHECK_FALSE(solid(0, 0.05, 0));     // between the feet
    CHECK_FALSE(solid(0.30, 1.05, 0));  // between arm and waist
    CHECK_FALSE(solid(0.12, 1.56, 0));  // beside the neck
    for (const double side : {-1.0, 1.0}) {
        CHECK(solid(side * 0.10, 0.60, 0));       // thigh
        CHECK(solid(side * 0.107, 0.25, -0.01));  // shank
        CHECK(solid(side * 0.115, 0.03, 0.11));   // ball of the foot: it faces +z
        CHECK_FALSE(solid(side * 0.115, 0.03, -0.11));
        CHECK(solid(side * 0.28, 1.31, -0.02));   // upper arm
        CHECK(solid(side * 0.45, 1.10, -0.005));  // forearm
        CHECK(solid(side * 0.58, 0.91, 0.02));    // hand
    }
}

TEST_CASE("it fills the volume of a person of its height") {
    CHECK(filled_volume() > 0.060);  // m^3; 75 kg fill 0.074
    CHECK(filled_volume() < 0.095);
}

TEST_CASE("a spacing that would lose the hands or fill the memory is refused") {
    for (const double spacing : {0.0, -0.01, 0.0079, 0.0201, 1.0, std::nan("")})
        CHECK(message_of([&] { make_mannequin(spacing); }).find("allowed are 0.008 ... 0.02") != std::string::npos);
}

}  // namespace percale::scenes::test::mannequin_test
