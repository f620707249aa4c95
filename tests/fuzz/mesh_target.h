#pragma once

#include <string>

#include "fuzz_entry.h"
#include "percale/error.h"
#include "scenes/meshes/mesh_import.h"
#include "scenes/meshes/obj_file.h"
#include "tests/scenes/test_folder.h"

// What the targets of all mesh formats share.
namespace percale::fuzz {

/// What import_mesh promises of a mesh that it returns.
inline void require_sound(const TriangleMesh& mesh) {
    const int count = static_cast<int>(mesh.vertices.size());
    require(!mesh.triangles.empty(), "an imported mesh has triangles");
    for (const Vec3& x : mesh.vertices) require(x.allFinite(), "an imported vertex is finite");
    for (const Triangle& t : mesh.triangles) {
        for (const int vertex : t) require(vertex >= 0 && vertex < count, "an imported index names a vertex");
    }
}

/// What was imported, written and read again is the same to the bit.
inline void require_round_trip(const TriangleMesh& mesh, const std::string& file) {
    scenes::write_obj(file, mesh.vertices, mesh.triangles);
    const TriangleMesh again = scenes::import_mesh(file);
    require(again.vertices == mesh.vertices && again.triangles == mesh.triangles, "a mesh survives write_obj");
}

/// The same mesh comes with its fields, one value for each vertex; or one of their values is refused.
inline void require_fields(const TriangleMesh& mesh, const std::string& file) {
    std::vector<scenes::MeshField> fields;
    try {
        const TriangleMesh again = scenes::import_mesh_with_fields(file, fields);
        require(again.vertices == mesh.vertices && again.triangles == mesh.triangles, "fields change no mesh");
    } catch (const SceneError& error) {
        return require(std::string(error.what()).starts_with(file), "a refusal names the file");
    }
    for (const scenes::MeshField& field : fields)
        require(field.values.size() == mesh.vertices.size(), "a field has a value for each vertex");
}

/// Imports the bytes as a file of this extension. A refusal has to name the file.
inline void try_mesh(const std::uint8_t* data, std::size_t size, const std::string& extension) {
    static const scenes::test::TestFolder folder;
    const std::string file = folder.write("mesh" + extension, std::string(reinterpret_cast<const char*>(data), size));
    TriangleMesh mesh;
    try {
        mesh = scenes::import_mesh(file);
    } catch (const SceneError& error) {
        return require(std::string(error.what()).starts_with(file), "a refusal names the file");
    }
    require_sound(mesh);
    require_round_trip(mesh, folder.path("again.obj"));
    if (extension == ".ply") require_fields(mesh, file);
    try {
        check_mesh(mesh, "mesh", true);
    } catch (const SceneError&) {
    }
}

}  // namespace percale::fuzz
