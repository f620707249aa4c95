#include <algorithm>
#include <string>
#include <string_view>

#include "fuzz_entry.h"
#include "percale/error.h"
#include "scenes/bodies/point_cache.h"
#include "tests/scenes/test_folder.h"

namespace {

/// A scene whose obstacle is a triangle and goes by `cache`.
percale::scenes::Scene scene_in(const percale::scenes::test::TestFolder& folder) {
    percale::scenes::Scene scene;
    scene.file = folder.path("scene.toml");
    folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n");
    return scene;
}

}  // namespace

/// The bytes as a PC2 file if they begin as one, else as an MDD file. Shapes at many times are finite, however few fit the
/// header.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace percale;
    static const scenes::test::TestFolder folder;
    static const scenes::Scene scene = scene_in(folder);
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    scenes::ObstacleSpec obstacle;
    obstacle.mesh = "triangle.obj";
    obstacle.cache = bytes.starts_with("POINT") ? "cache.pc2" : "cache.mdd";
    const std::string file = folder.write(obstacle.cache, bytes);
    try {
        scenes::PointCache cache(scene, obstacle);
        fuzz::require(cache.length() > 0.0, "a cache lasts");
        for (int k = -1; k <= 12; ++k) {
            for (const Vec3& x : cache.at(0.1 * k * cache.length())) fuzz::require(x.allFinite(), "a shape is finite");
        }
    } catch (const SceneError& error) {
        fuzz::require(std::string_view(error.what()).find(file) != std::string_view::npos, "a refusal names the file");
    }
    return 0;
}
