#include "scenes/page/mesh_track.h"

#include <cmath>
#include <limits>

#include "tests/scenes/message_of.h"
#include "tests/scenes/page/packed_numbers.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::mesh_track_test {

namespace {

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
    for (Vec3& x : mesh.vertices) x += by;
    return mesh;
}

MeshTrack track_of(const TriangleMesh& first, std::vector<std::string> own = {}) {
    PlaybackMesh described;
    described.name = "sheet";
    return MeshTrack(described, first, std::move(own));
}

}  // namespace

TEST_CASE("The frames of a mesh are packed one after the other, each coordinate within half a step of its axis") {
    const TriangleMesh first = make_grid(0.3, 0.5, 4, 5);
    MeshTrack track = track_of(first);
    const std::vector<Vec3> moves = {Vec3(0, 0, 0), Vec3(0.1, -2.0, 0), Vec3(0.123, -2.5, 1e-3)};
    for (const Vec3& by : moves) track.add("x.obj", moved(first, by), {});
    const PlaybackMesh mesh = track.packed_mesh();
    CHECK(mesh.vertices == 20);
    CHECK(mesh.triangles == first.triangles.size());
    const std::vector<std::uint32_t> numbers = numbers_of_base64(mesh.positions, 2);
    REQUIRE(numbers.size() == 3 * 20 * 3);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const PackRange& axis = mesh.axes[i % 3];
        const double right = first.vertices[i / 3 % 20][i % 3] + moves[i / 60][i % 3];
        CHECK(std::abs(axis.low + axis.step * numbers[i] - right) <= 0.5 * axis.step + 1e-6);
    }
    const std::vector<std::uint32_t> corners = numbers_of_base64(mesh.corners, 4);
    REQUIRE(corners.size() == 3 * first.triangles.size());
    for (std::size_t i = 0; i < corners.size(); ++i) CHECK(static_cast<int>(corners[i]) == first.triangles[i / 3][i % 3]);
}

TEST_CASE("A field keeps its values, says which are absent, and where most of them lie") {
    const TriangleMesh first = make_grid(1.0, 1.0, 10, 10);
    MeshTrack track = track_of(first, {"distance"});
    std::vector<double> distance(100), pressure(100, 3.0);
    for (std::size_t v = 0; v < 100; ++v) distance[v] = static_cast<double>(v) / 99.0;
    distance[99] = std::numeric_limits<double>::infinity();
    track.add("x.ply", first, {{"pressure", pressure}, {"distance", distance}});
    const PlaybackMesh mesh = track.packed_mesh();
    REQUIRE(mesh.fields.size() == 2);
    CHECK(mesh.fields[0].of_frames);
    CHECK(mesh.fields[0].range.low == 3.0);
    CHECK(mesh.fields[0].range.step == 0.0);
    const PlaybackField& field = mesh.fields[1];
    CHECK_FALSE(field.of_frames);
    const std::vector<std::uint32_t> numbers = numbers_of_base64(field.values, 2);
    REQUIRE(numbers.size() == 100);
    for (std::size_t v = 0; v < 99; ++v)
        CHECK(field.range.low + field.range.step * numbers[v] == Approx(distance[v]).margin(field.range.step));
    CHECK(numbers[99] == packed_absent);
    CHECK(field.low == Approx(2.0 / 99.0).margin(0.011));
    CHECK(field.high == Approx(96.0 / 99.0).margin(0.011));
}

TEST_CASE("A frame of another mesh or with other fields is refused by the name of its file") {
    const TriangleMesh first = make_grid(0.3, 0.3, 3, 3);
    MeshTrack track = track_of(first);
    const std::vector<MeshField> pressure = {{"pressure", std::vector<double>(9, 0.0)}};
    track.add("a.ply", first, pressure);
    CHECK(message_of([&] { track.add("b.ply", make_grid(0.3, 0.3, 3, 4), pressure); }) ==
          "b.ply: has 12 vertices, but 9 in frame 0 of the run");
    TriangleMesh turned = first;
    std::swap(turned.triangles[0][0], turned.triangles[0][1]);
    CHECK(message_of([&] { track.add("b.ply", turned, pressure); }) ==
          "b.ply: its triangles are not those of frame 0 of the run");
    turned.triangles.pop_back();
    CHECK(message_of([&] { track.add("b.ply", turned, pressure); }) == "b.ply: has 7 triangles, but 8 in frame 0 of the run");
    CHECK(message_of([&] { track.add("b.ply", first, {}); }) == "b.ply: has other fields of vertices than frame 0 of the run");
    CHECK(numbers_of_base64(track.packed_mesh().positions, 2).size() == 27);
}

TEST_CASE("Edges of a sheet that is stretched evenly have changed by that much at every vertex") {
    const TriangleMesh first = make_grid(0.4, 0.4, 5, 5);
    std::vector<Vec3> now = first.vertices;
    for (Vec3& x : now) x *= 1.07;
    for (const double change : edge_change(first, now)) CHECK(change == Approx(0.07));
    for (const double change : edge_change(first, moved(first, Vec3(1, 2, 3)).vertices)) CHECK(std::abs(change) < 1e-12);
}

TEST_CASE("Edges without length and vertices without triangles change by nothing") {
    const TriangleMesh first{.vertices = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {5, 5, 5}}, .triangles = {{0, 1, 2}}};
    std::vector<Vec3> now = first.vertices;
    now[1] = Vec3(0, 1, 0);
    const std::vector<double> change = edge_change(first, now);
    CHECK(change[0] == 0.0);
    CHECK(change[1] == Approx(std::sqrt(2.0) - 1.0));
    CHECK(change[2] == Approx(0.5 * (std::sqrt(2.0) - 1.0)));
    CHECK(change[3] == 0.0);
}

}  // namespace percale::scenes::test::mesh_track_test
