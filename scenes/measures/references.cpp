#include "measures/references.h"

#include "common/scene_file_error.h"
#include "garment/cloth_shape.h"
#include "meshes/mesh_import.h"

namespace percale::scenes {

std::vector<std::vector<Vec3>> read_references(const Scene& scene, std::size_t vertices) {
    std::vector<std::vector<Vec3>> references;
    for (const Expectation& expectation : scene.expectations) {
        std::vector<Vec3>& reference = references.emplace_back();
        if (expectation.file.empty()) continue;
        const std::string file = path_beside(scene, expectation.file);
        reference = at_place(expectation.place, "matches: ", [&] { return import_mesh(file); }).vertices;
        if (reference.size() != vertices)
            fail_at(expectation.place, "matches: " + file + " has " + std::to_string(reference.size()) +
                                           " vertices, the cloth has " + std::to_string(vertices));
    }
    return references;
}

}  // namespace percale::scenes
