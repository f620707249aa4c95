#include "scenes/pattern/pattern_file.h"

#include <filesystem>

#include "meshes/mesh_import.h"
#include "percale/certify.h"
#include "scenes/pattern/pattern_mesh.h"
#include "tests/scenes/pattern/garments.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::pattern_file_test {

TEST_CASE("a pattern is read by the ending of its name, and checked") {
    const TestFolder folder;
    CHECK(read_pattern(folder.write("skirt.toml", skirt_text)).panels.size() == 2);
    CHECK(error_of([&] { read_pattern(folder.write("skirt.json", skirt_text)); }).find("is no JSON") != std::string::npos);
    CHECK(error_of([&] { read_pattern("skirt.dxf"); }).find(".toml (Percale's own) or .json (GarmentCode's)") !=
          std::string::npos);
    const std::string small = "unit = \"mm\"\n[[panel]]\nname = \"a\"\npoints = [[0, 0], [1, 0], [1, 1]]\n";
    CHECK(error_of([&] { read_pattern(folder.write("small.toml", small)); }).find("is its unit right?") != std::string::npos);
}

TEST_CASE("every shipped pattern starts clear of itself and of the mannequin, its seams of equal sides") {
    const std::string data = PERCALE_DATA_DIR;
    const TriangleMesh body = import_mesh(data + "/meshes/mannequin.obj", 1.0);
    int patterns = 0;
    for (const auto& entry : std::filesystem::directory_iterator(data + "/patterns")) {
        CAPTURE(entry.path().string());
        const PatternMesh garment = mesh_pattern(read_pattern(entry.path().string()), 0.03);
        CHECK(certify(garment.mesh, body).clean());
        CHECK(certify_cloth(garment.mesh).crossing.empty());
        for (const SewnSeam& seam : garment.seams) {
            CAPTURE(seam.name);
            double first = 0.0, second = 0.0;
            for (std::size_t k = 0; k + 1 < seam.stitches.size(); ++k) {
                const Stitch &a = seam.stitches[k], &b = seam.stitches[k + 1];
                first += (garment.mesh.vertices[a.vertex] - garment.mesh.vertices[b.vertex]).norm();
                second += (garment.mesh.vertices[a.other()] - garment.mesh.vertices[b.other()]).norm();
            }
            CHECK(second == Approx(first).epsilon(0.1));
        }
        ++patterns;
    }
    CHECK(patterns >= 3);
}

}  // namespace percale::scenes::test::pattern_file_test
