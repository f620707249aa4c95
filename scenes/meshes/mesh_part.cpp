#include "meshes/mesh_part.h"

#include <algorithm>

#include "common/nearest_name.h"
#include "common/text.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// In a message.
constexpr std::size_t most_named = 20;

}  // namespace

void fail_without_part(const std::string& file, const std::string& part, std::span<const std::string> known) {
    const auto named = known.first(std::min(known.size(), most_named));
    std::string others = "; the file names none";
    if (!known.empty()) {
        const std::string nearest = did_you_mean(part, known);
        others =
            nearest + (nearest.empty() ? "; valid: " : " valid: ") + joined(named) + (named.size() < known.size() ? ", ..." : "");
    }
    throw SceneError(file, "no object or group '" + part + "' with faces" + others);
}

void drop_unused_vertices(TriangleMesh& mesh) {
    std::vector<int> number(mesh.vertices.size(), -1);
    for (const Triangle& triangle : mesh.triangles) {
        for (const int vertex : triangle) number[static_cast<std::size_t>(vertex)] = 0;
    }
    std::vector<Vec3> kept;
    for (std::size_t k = 0; k < number.size(); ++k) {
        if (number[k] < 0) continue;
        number[k] = static_cast<int>(kept.size());
        kept.push_back(mesh.vertices[k]);
    }
    mesh.vertices = std::move(kept);
    for (Triangle& triangle : mesh.triangles) {
        for (int& vertex : triangle) vertex = number[static_cast<std::size_t>(vertex)];
    }
}

}  // namespace percale::scenes
