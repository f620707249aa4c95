#include "garment/seam_stitches.h"

#include <algorithm>

#include "garment/cloth_shape.h"
#include "meshes/stitch_file.h"
#include "percale/error.h"

namespace percale::scenes {

int cloth_number(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.cloths, name, &ClothSpec::name);
    if (found == scene.cloths.end()) throw SceneError("no cloth '" + name + "'");
    return static_cast<int>(found - scene.cloths.begin());
}

namespace {

std::vector<Stitch> file_stitches(const Scene& scene, const SeamSpec& seam) {
    if (seam.file != "mesh") return read_stitch_file(path_beside(scene, seam.file));
    const auto [first, second] = seam_cloths(scene, seam);
    const ClothSpec& cloth = scene.cloths[first];
    if (first != second) throw SceneError("seam: file = \"mesh\" is of one cloth, but cloths names two");
    if (cloth.mesh.empty()) throw SceneError("seam: file = \"mesh\", but cloth '" + cloth.name + "' has no mesh file");
    if (!cloth.part.empty())
        throw SceneError("seam: file = \"mesh\" counts all vertices of the file, but cloth '" + cloth.name + "' takes part \"" +
                         cloth.part + "\" of it alone");
    if (cloth.weld > 0.0)
        throw SceneError("seam: file = \"mesh\" counts the vertices of the file, of which weld makes fewer in cloth '" +
                         cloth.name + "'");
    return read_obj_stitches(path_beside(scene, cloth.mesh));
}

}  // namespace

std::array<int, 2> seam_cloths(const Scene& scene, const SeamSpec& seam) {
    if (!seam.cloths) return {0, 0};
    return {cloth_number(scene, (*seam.cloths)[0]), cloth_number(scene, (*seam.cloths)[1])};
}

std::vector<Stitch> seam_stitches(const Scene& scene, const SeamSpec& seam) {
    std::vector<Stitch> stitches;
    if (seam.vertices) {
        for (const auto& [one, other] : *seam.vertices) stitches.push_back({one, other, other, 0.0});
    }
    if (seam.points) stitches.insert(stitches.end(), seam.points->begin(), seam.points->end());
    if (seam.file.empty()) return stitches;
    const std::vector<Stitch> more = file_stitches(scene, seam);
    stitches.insert(stitches.end(), more.begin(), more.end());
    return stitches;
}

std::vector<Stitch> joined_stitches(std::span<const ClothStitches> seams, std::span<const int> first_vertex) {
    std::vector<Stitch> joined;
    for (const auto& [cloths, stitches] : seams) {
        const int first = first_vertex[cloths[0]], second = first_vertex[cloths[1]];
        if (first < 0 || second < 0) continue;
        for (const auto& [vertex, from, to, share] : stitches)
            joined.push_back({first + vertex, second + from, second + to, share});
    }
    return joined;
}

}  // namespace percale::scenes
