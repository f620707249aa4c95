#include "models/joined_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_map>

#include "models/assimp_file.h"
#include "models/gltf_file.h"
#include "models/mesh_part.h"
#include "models/polygon.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {

namespace {

/// How often a file places its parts is not bounded by its size: vertices allowed.
std::size_t max_vertices(const Model& model) {
    std::size_t own = 0;
    for (const ModelMesh& mesh : model.meshes) own += mesh.vertices.size();
    return std::max(always_allowed_vertices, max_part_copies * own);
}

/// Names the vertices of the parts that are wanted. A mesh without faces has none: points and lines.
std::vector<VertexOrigin> origins_of(const Model& model, const std::string& file, const std::string& wanted) {
    const std::size_t max = max_vertices(model);
    std::vector<VertexOrigin> origins;
    PartNames names;
    for (std::size_t node = 0; node < model.nodes.size(); ++node) {
        const std::vector<ModelPart>& parts = model.nodes[node].parts;
        for (std::size_t part = 0; part < parts.size(); ++part) {
            const ModelMesh& mesh = model.meshes[static_cast<std::size_t>(parts[part].mesh)];
            for (const std::string& name : {model.nodes[node].name, mesh.name}) names.add(name);
            const bool taken = wanted.empty() || wanted == model.nodes[node].name || wanted == mesh.name;
            if (!taken || mesh.face_sizes.empty()) continue;
            if (origins.size() + mesh.vertices.size() > max)
                throw SceneError(file,
                                 "copies of its parts come to more than " + std::to_string(max) + " vertices; leave some out");
            for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
                check_finite(mesh.vertices[k], origins.size(), file);
                origins.push_back({static_cast<int>(node), static_cast<int>(part), static_cast<int>(k)});
            }
        }
    }
    if (origins.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw SceneError(file, "more vertices than an index can name");
    if (origins.empty() && !wanted.empty()) names.fail(file, wanted);
    return origins;
}

/// The triangles of a mesh whose vertices are those from `first` on. `mirrored`: turned about, so that they face outwards again.
void append_faces(const ModelMesh& mesh, std::size_t first, bool mirrored, TriangleMesh& joined) {
    std::size_t at = 0;
    std::vector<Vec3> places;
    for (const int size : mesh.face_sizes) {
        const std::span<const int> corners(mesh.corners.data() + at, static_cast<std::size_t>(size));
        at += corners.size();
        places.clear();
        for (const int corner : corners) places.push_back(joined.vertices[first + static_cast<std::size_t>(corner)]);
        const auto corner = [&](int k) { return static_cast<int>(first) + corners[static_cast<std::size_t>(k)]; };
        for (const Triangle& t : polygon_triangles(places))
            joined.triangles.push_back({corner(t[mirrored ? 1 : 0]), corner(t[mirrored ? 0 : 1]), corner(t[2])});
    }
}

struct PositionHash {
    std::size_t operator()(const std::array<double, 3>& x) const {
        std::size_t hash = 0;
        for (const double number : x) hash = (hash ^ std::hash<double>{}(number)) * 0x9e3779b97f4a7c15ull;
        return hash ^ hash >> 32;
    }
};

}  // namespace

void check_finite(const Vec3& x, std::size_t vertex, const std::string& file) {
    constexpr const char* names[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(x[axis]))
            throw SceneError(file, "vertex " + std::to_string(vertex) + ": coordinate " + names[axis] + " is not finite");
}

JoinedModel join(Model model, const std::string& file, const std::string& part) {
    check_model(model, file);
    JoinedModel joined{.model = std::move(model), .mesh = {}, .origins = {}};
    joined.origins = origins_of(joined.model, file, part);
    const std::vector<Eigen::Matrix4d> poses = rest_poses(joined.model);
    joined.mesh.vertices = SkinnedShape(joined.model, joined.origins).at(poses, rest_weights(joined.model));
    for (std::size_t k = 0; k < joined.origins.size(); ++k) {
        if (joined.origins[k].vertex > 0) continue;  // the first one of a part
        const VertexOrigin& origin = joined.origins[k];
        const ModelPart& from =
            joined.model.nodes[static_cast<std::size_t>(origin.node)].parts[static_cast<std::size_t>(origin.part)];
        // Bones carry a skin wherever its node is (glTF 2.0, 3.7.4).
        const bool mirrored =
            from.skin < 0 && poses[static_cast<std::size_t>(origin.node)].topLeftCorner<3, 3>().determinant() < 0.0;
        append_faces(joined.model.meshes[static_cast<std::size_t>(from.mesh)], k, mirrored, joined.mesh);
    }
    return joined;
}

JoinedModel read_joined_model(const std::string& file, const std::string& part) {
    return join(is_gltf_2(file) ? read_gltf(file) : read_by_assimp(file), file, part);
}

void weld(JoinedModel& joined, const std::function<bool(int vertex, int first)>& alike) {
    TriangleMesh mesh;
    std::vector<VertexOrigin> origins;
    std::unordered_map<std::array<double, 3>, std::vector<std::pair<int, int>>, PositionHash> known;  // first ones: old, new
    std::vector<int> welded(joined.mesh.vertices.size());
    for (std::size_t k = 0; k < welded.size(); ++k) {
        const int vertex = static_cast<int>(k);
        const Vec3 x = joined.mesh.vertices[k] + Vec3::Zero();  // -0 becomes +0
        auto& firsts = known[{x[0], x[1], x[2]}];
        const auto same = std::ranges::find_if(firsts, [&](const auto& first) { return !alike || alike(vertex, first.first); });
        if (same != firsts.end()) {
            welded[k] = same->second;
            continue;
        }
        welded[k] = static_cast<int>(mesh.vertices.size());
        firsts.emplace_back(vertex, welded[k]);
        mesh.vertices.push_back(joined.mesh.vertices[k]);
        origins.push_back(joined.origins[k]);
    }
    for (const Triangle& t : joined.mesh.triangles) mesh.triangles.push_back({welded[t[0]], welded[t[1]], welded[t[2]]});
    joined.mesh = std::move(mesh);
    joined.origins = std::move(origins);
}

}  // namespace percale::scenes
