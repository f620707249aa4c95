#include "run/frame_fields.h"

#include <algorithm>

namespace percale::scenes {

void place_shapes(const BuiltScene& built, std::span<TriangleMesh> cloths, std::span<TriangleMesh> obstacles) {
    const Simulation& simulation = built.simulation;
    for (std::size_t i = 0; i < cloths.size(); ++i) {
        const std::span<const Vec3> positions = simulation.positions(built.cloths[i]);
        cloths[i].vertices.assign(positions.begin(), positions.end());
    }
    for (std::size_t i = 0; i < obstacles.size(); ++i) obstacles[i].vertices = obstacle_now(built, i).vertices;
}

std::vector<MeshFields> fields_of(const BuiltScene& built, std::span<const TriangleMesh> cloths,
                                  std::span<const TriangleMesh> obstacles, const std::atomic<bool>* cancel) {
    const std::vector<std::string>& words = built.scene.output.fields;
    std::vector<MeshFields> fields;
    for (std::size_t i = 0; i < cloths.size() && !words.empty(); ++i) {
        const std::vector<ContactLoad> loads = built.simulation.contact_loads(built.cloths[i]);
        fields.push_back(fit_fields({.start = built.cloth_meshes[i],
                                     .rest = built.rest_shapes[i],
                                     .now = cloths[i],
                                     .loads = loads,
                                     .obstacles = obstacles,
                                     .cancel = cancel},
                                    words));
    }
    return fields;
}

std::vector<std::vector<std::pair<std::string, Spread>>> fit_now(const BuiltScene& built) {
    std::vector<std::vector<std::pair<std::string, Spread>>> all;
    if (built.scene.output.fields.empty()) return all;
    std::vector<TriangleMesh> cloths = built.cloth_meshes, obstacles = built.obstacle_meshes;
    place_shapes(built, cloths, obstacles);
    for (const MeshFields& fields : fields_of(built, cloths, obstacles)) {
        std::vector<std::pair<std::string, Spread>>& own = all.emplace_back();
        for (const MeshField& field : fields.triangle) own.emplace_back(field.name, spread_of(field.values));
        const auto reported = [&](const MeshField& field) {
            return std::ranges::any_of(fields.triangle, [&](const MeshField& other) { return other.name == field.name; });
        };
        for (const MeshField& field : fields.vertex) {
            if (!reported(field)) own.emplace_back(field.name, spread_of(field.values));
        }
    }
    return all;
}

}  // namespace percale::scenes
