#pragma once

#include "c/handles.h"
#include "c/structs.h"
#include "percale/rest_shape.h"

namespace percale::c_interface {

/// The rest shape in the settings of a cloth. Throws SceneError where they hold two, or where it does not fit the mesh.
inline RestShape rest_shape(const TriangleMesh& mesh, const percale_cloth_settings& settings) {
    const char* name = &demanded(settings.name, "name");
    RestShape shape;
    if (settings.rest_mesh != nullptr && settings.rest_corners != nullptr) {
        throw SceneError(name, "rest_mesh and rest_corners exclude each other");
    }
    if (settings.rest_mesh != nullptr) shape = rest_shape_of(mesh, settings.rest_mesh->value, name);
    if (settings.rest_corners == nullptr && settings.rest_corner_triangles > 0) throw SceneError(name, "rest_corners is NULL");
    if (settings.rest_corners != nullptr) {
        if (settings.rest_corner_triangles != mesh.triangles.size()) {
            throw SceneError(name, "rest_corners of " + std::to_string(settings.rest_corner_triangles) +
                                       " triangles, the mesh has " + std::to_string(mesh.triangles.size()));
        }
        const auto corners = vectors_of(settings.rest_corners, 3 * settings.rest_corner_triangles, "rest_corners");
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            shape.corners.push_back({corners[i], corners[i + 1], corners[i + 2]});
        }
    }
    shape.warp = vector_of(settings.warp, "warp");
    return shape;
}

}  // namespace percale::c_interface
