#include "scenes/pattern/pattern_mesh.h"

#include <sstream>

#include "scenes/meshes/stitch_file.h"
#include "tests/scenes/pattern/garments.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::pattern_mesh_test {
namespace {

double area_of_triangles(const PatternMesh& garment, bool flat) {
    double twice = 0.0;
    for (const auto& [a, b, c] : garment.mesh.triangles) {
        const auto at = [&](int v) { return flat ? Vec3(garment.uv[v].x(), garment.uv[v].y(), 0.0) : garment.mesh.vertices[v]; };
        twice += (at(b) - at(a)).cross(at(c) - at(a)).norm();
    }
    return 0.5 * twice;
}

}  // namespace

TEST_CASE("panels lie where the pattern places them, as large as they are flat, each vertex of a seam sewn to one") {
    const Pattern pattern = parse_pattern_toml(skirt_text, "t");
    const PatternMesh garment = mesh_pattern(pattern, 0.02);
    REQUIRE(garment.panels.size() == 2);
    CHECK(garment.panels[1].first_vertex == garment.panels[0].vertices);
    CHECK(garment.uv.size() == garment.mesh.vertices.size());
    CHECK(area_of_triangles(garment, false) == Approx(area_of_triangles(garment, true)).epsilon(1e-12));
    for (int v = 0; v < garment.panels[0].vertices; ++v) CHECK(garment.mesh.vertices[v].z() == 0.15);
    // Both sides of the skirt are mirror images: sewn vertices lie exactly behind each other.
    for (const SewnSeam& seam : garment.seams) {
        CHECK(seam.length == Approx(std::hypot(0.05, 0.4)));
        CHECK(seam.stitches.size() > 15);
        for (const Stitch& stitch : seam.stitches) {
            CHECK(stitch.from == stitch.to);
            const Vec3 apart = garment.mesh.vertices[stitch.vertex] - garment.mesh.vertices[stitch.from];
            CHECK((apart - Vec3(0, 0, 0.3)).norm() < 1e-12);
        }
    }
    CHECK(all_stitches(garment).size() == garment.seams[0].stitches.size() + garment.seams[1].stitches.size());
}

TEST_CASE("triangles wind as the outline does, and in a mirrored panel the other way") {
    const std::string text =
        "unit = \"cm\"\n[[panel]]\nname = \"a\"\npoints = [[5, 0], [45, 0], [45, 30]]\nmirror = \"b\"\n"
        "[[panel]]\nname = \"c\"\npoints = [[5, 0], [45, 30], [45, 0]]\nat = [0, 0, 9]\n";
    const PatternMesh garment = mesh_pattern(parse_pattern_toml(text, "t"), 0.05);
    const auto faces = [&](std::size_t panel) {
        const auto& [a, b, c] = garment.mesh.triangles[garment.panels[panel].first_triangle];
        const auto& x = garment.mesh.vertices;
        return (x[b] - x[a]).cross(x[c] - x[a]).z() > 0.0;
    };
    CHECK(faces(0));
    CHECK(faces(1));
    CHECK_FALSE(faces(2));
}

TEST_CASE("the tip of a dart is no stitch, what is along it is") {
    const std::string dart =
        "unit = \"cm\"\n[[panel]]\nname = \"a\"\n"
        "points = [[0, 0], [40, 0], [40, 30], [23, 30], [20, 18], [17, 30], [0, 30]]\n"
        "[[seam]]\nsides = [[\"a.3\"], [\"a.4-\"]]\n";
    const PatternMesh garment = mesh_pattern(parse_pattern_toml(dart, "t"), 0.02);
    const int pieces = static_cast<int>(std::lround(std::hypot(0.03, 0.12) / 0.02));
    CHECK(garment.seams[0].stitches.size() == static_cast<std::size_t>(pieces));
    for (const auto& [vertex, from, to, share] : garment.seams[0].stitches) {
        const Vec3 &x = garment.mesh.vertices[vertex], &y = garment.mesh.vertices[from];
        CHECK(x.x() + y.x() == Approx(0.4));
        CHECK(x.y() == Approx(y.y()));
    }
}

TEST_CASE("the OBJ file is read back with its texture and its stitches") {
    const PatternMesh garment = mesh_pattern(parse_pattern_toml(skirt_text, "t"), 0.03);
    const TestFolder folder;
    const std::string text = pattern_obj_text(garment);
    std::istringstream in(text);
    const TexturedMesh read = read_textured_obj(in, "skirt.obj"), own = textured_mesh(garment);
    CHECK(read.mesh.vertices == garment.mesh.vertices);
    CHECK(read.mesh.triangles == garment.mesh.triangles);
    CHECK(read.uv == own.uv);
    CHECK(read_obj_stitches(folder.write("skirt.obj", text)) == all_stitches(garment));
    CHECK(text.find("g front\n") != std::string::npos);
}

TEST_CASE("edge lengths that make no mesh are refused") {
    const Pattern pattern = parse_pattern_toml(skirt_text, "t");
    CHECK(error_of([&] { mesh_pattern(pattern, 2.0); }).find("edge length 2 m is outside the allowed range") !=
          std::string::npos);
    CHECK(error_of([&] { mesh_pattern(pattern, 1e-4); }).find("more than 2 million vertices") != std::string::npos);
}

}  // namespace percale::scenes::test::pattern_mesh_test
