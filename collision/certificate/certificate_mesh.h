#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "certificate/box_tree.h"
#include "percale/certificate_mesh.h"

namespace percale {

/// Throws SceneError for meshes that cannot be certified: squared areas have to stay below overflow.
void check_certifiable(const TriangleMesh& mesh, const std::string& name);

/// What certificates read of a mesh.
struct CertificateMesh::Prepared {
    explicit Prepared(const TriangleMesh& given);
    /// The same triangles with their vertices elsewhere.
    void move_vertices(const std::vector<Vec3>& vertices);
    /// Whether the mesh is closed, found when first asked. Thread-safe.
    bool watertight() const;

    TriangleMesh mesh;
    std::vector<certificate::Corners> triangles;
    certificate::BoxTree tree;

private:
    mutable std::mutex mutex_;
    mutable std::optional<bool> watertight_;
};

}  // namespace percale
