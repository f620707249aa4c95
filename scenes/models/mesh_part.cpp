#include "models/mesh_part.h"

#include <algorithm>
#include <span>

#include "common/nearest_name.h"
#include "common/text.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// Maximum numbers of names that are kept, and that a message lists.
constexpr std::size_t max_kept = 1000, max_listed = 20;

}  // namespace

void PartNames::add(const std::string& name) {
    const bool is_new = !name.empty() && std::ranges::find(names_, name) == names_.end();
    if (is_new && names_.size() < max_kept) names_.push_back(name);
}

void PartNames::fail(const std::string& file, const std::string& part) const {
    const auto listed = std::span(names_).first(std::min(names_.size(), max_listed));
    std::string others = "; the file names none";
    if (!names_.empty()) {
        const std::string nearest = did_you_mean(part, names_);
        others = nearest + (nearest.empty() ? "; valid: " : " valid: ") + joined(listed) +
                 (listed.size() < names_.size() ? ", ..." : "");
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
