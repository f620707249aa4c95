#include "scenes/frames/morph_glb.h"

#include <algorithm>

#include "percale/error.h"
#include "tests/scenes/frames/glb_reader.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::morph_glb_test {
namespace {

TriangleMesh sheet_at(int frame) {
    TriangleMesh mesh = make_grid(1.0, 0.5, 4, 3);
    for (Vec3& x : mesh.vertices) x += Vec3(1.0 / 3.0, 0.1 * frame * x.x() * x.x(), -0.2 * frame);
    return mesh;
}

const std::vector<MorphName> two_names = {{"sheet", true}, {"ball \"x\"", false}};

std::string glb_of(const TestFolder& folder, std::span<const double> times) {
    const TriangleMesh ball = make_sphere(0.3, 1);
    std::string samples;
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
        const TriangleMesh sheet = sheet_at(static_cast<int>(frame));
        const std::vector<MorphShape> shapes = {{&sheet, true}, {&ball, false}};
        if (frame == 0) samples = morph_header(shapes);
        samples += morph_frame(shapes);
    }
    write_morph_glb(folder.path("scene.glb"), folder.write("samples", samples), two_names, times);
    return folder.read("scene.glb");
}

double largest_distance(const std::vector<float>& found, std::span<const Vec3> wanted) {
    REQUIRE(found.size() == 3 * wanted.size());
    double largest = 0.0;
    for (std::size_t v = 0; v < wanted.size(); ++v)
        for (std::size_t k = 0; k < 3; ++k)
            largest = std::max(largest, std::abs(found[3 * v + k] - wanted[v][static_cast<int>(k)]));
    return largest;
}

}  // namespace

TEST_CASE("at every key the animation shows the frame of its time, places and normals") {
    const TestFolder folder;
    const std::vector<double> times = {0.0, 0.04, 0.08, 0.12};
    const GlbReader glb(glb_of(folder, times));
    for (std::size_t key = 0; key < times.size(); ++key) {
        const TriangleMesh sheet = sheet_at(static_cast<int>(key));
        CHECK(largest_distance(glb.morphed(0, key), sheet.vertices) < 2e-7);
        CHECK(largest_distance(glb.morphed(0, key, "NORMAL"), morph_normals(sheet)) < 2e-7);
        CHECK(largest_distance(glb.morphed(1, key), make_sphere(0.3, 1).vertices) < 2e-8);
    }
    const auto& sampler = glb.json["animations"][0]["samplers"][0];
    CHECK(glb.floats(sampler["input"]) == std::vector<float>{0.0f, 0.04f, 0.08f, 0.12f});
    CHECK(sampler["interpolation"] == "LINEAR");
    CHECK(glb.json["animations"][0]["channels"].size() == 1);
    CHECK(glb.json["nodes"][1]["name"] == "ball \"x\"");
    const std::vector<int> indices = glb.indices(glb.primitive(0)["indices"]);
    REQUIRE(indices.size() == 3 * sheet_at(0).triangles.size());
    CHECK(indices[5] == sheet_at(0).triangles[1][2]);
}

TEST_CASE("bounds are those of the numbers in the file, and everything lies at a multiple of four bytes") {
    const TestFolder folder;
    const GlbReader glb(glb_of(folder, std::vector<double>{0.0, 1.0, 2.0}));
    const auto check_bounds = [&](std::size_t accessor) {
        const std::vector<float> x = glb.floats(accessor);
        for (std::size_t k = 0; k < 3; ++k) {
            float lowest = x[k], highest = x[k];
            for (std::size_t i = k; i < x.size(); i += 3) lowest = std::min(lowest, x[i]), highest = std::max(highest, x[i]);
            CHECK(glb.json["accessors"][accessor]["min"][k].get<float>() == lowest);
            CHECK(glb.json["accessors"][accessor]["max"][k].get<float>() == highest);
        }
    };
    check_bounds(glb.primitive(0)["attributes"]["POSITION"]);
    for (const auto& target : glb.primitive(0)["targets"]) check_bounds(target["POSITION"]);
    check_bounds(glb.primitive(1)["attributes"]["POSITION"]);
    for (const auto& view : glb.json["bufferViews"]) CHECK(view["byteOffset"].get<std::size_t>() % 4 == 0);
}

TEST_CASE("a single frame, and shapes that all rest, have no animation") {
    const TestFolder folder;
    const GlbReader glb(glb_of(folder, std::vector<double>{0.0}));
    CHECK_FALSE(glb.json.contains("animations"));
    CHECK_FALSE(glb.primitive(0).contains("targets"));
    CHECK(glb.primitive(0)["material"] != glb.primitive(1)["material"]);
}

TEST_CASE("samples that end too early are refused, and no file is left") {
    const TestFolder folder;
    const TriangleMesh sheet = sheet_at(0);
    const std::vector<MorphShape> shapes = {{&sheet, true}};
    const std::string samples = folder.write("samples", morph_header(shapes) + morph_frame(shapes));
    CHECK_THROWS_WITH(write_morph_glb(folder.path("scene.glb"), samples, two_names, std::vector<double>{0.0, 1.0}),
                      Catch::Contains("samples: cannot be read"));
    CHECK_THROWS_AS(write_morph_glb(folder.path("scene.glb"), folder.path("none"), two_names, std::vector<double>{0.0}),
                    SceneError);
    CHECK(folder.file_count() == 1);
}

TEST_CASE("normals of vertices are of length 1, those of triangles by their area, and 0 where there is none") {
    TriangleMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 3, 0}, {5, 5, 5}}, .triangles = {{0, 1, 2}, {0, 2, 3}}};
    const std::vector<Vec3> normals = morph_normals(mesh);
    CHECK((normals[1] - Vec3(0, 1, 0)).norm() < 1e-15);
    CHECK((normals[3] - Vec3(1, 0, 0)).norm() < 1e-15);
    CHECK((normals[0] - Vec3(3, 1, 0).normalized()).norm() < 1e-15);
    CHECK(normals[4].norm() == 0.0);
}

}  // namespace percale::scenes::test::morph_glb_test
