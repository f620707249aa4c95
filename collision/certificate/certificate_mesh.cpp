#include "certificate/certificate_mesh.h"

#include <algorithm>

#include "certificate/inside_test.h"
#include "percale/error.h"

namespace percale {
namespace {

/// m. Coordinates of larger magnitude are refused. Squares of areas overflow above 1e77.
constexpr double largest_coordinate = 1e75;

}  // namespace

void check_certifiable(const TriangleMesh& mesh, const std::string& name) {
    check_mesh(mesh, name, false);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const double size = mesh.vertices[v].cwiseAbs().maxCoeff();
        if (size <= largest_coordinate) continue;
        throw SceneError(name + ": vertex " + std::to_string(v) + " has a coordinate of magnitude " + std::to_string(size) +
                         " m; the largest allowed is 1e75 m");
    }
}

CertificateMesh::Prepared::Prepared(const TriangleMesh& given)
    : mesh(given), triangles(certificate::corners_of(mesh)), tree(triangles) {}

void CertificateMesh::Prepared::move_vertices(const std::vector<Vec3>& vertices) {
    mesh.vertices = vertices;
    triangles = certificate::corners_of(mesh);
    tree.fit(triangles);
    watertight_.reset();
}

bool CertificateMesh::Prepared::watertight() const {
    const std::scoped_lock lock(mutex_);
    if (!watertight_) watertight_ = certificate::is_watertight(mesh);
    return *watertight_;
}

CertificateMesh::CertificateMesh(const TriangleMesh& mesh, const std::string& name) {
    check_certifiable(mesh, name);
    prepared_ = std::make_unique<Prepared>(mesh);
}

CertificateMesh::CertificateMesh(CertificateMesh&&) noexcept = default;
CertificateMesh& CertificateMesh::operator=(CertificateMesh&&) noexcept = default;
CertificateMesh::~CertificateMesh() = default;

bool CertificateMesh::move(const TriangleMesh& mesh) {
    const TriangleMesh& now = prepared_->mesh;
    const bool same_triangles = mesh.triangles == now.triangles && mesh.vertices.size() == now.vertices.size();
    if (same_triangles && mesh.vertices == now.vertices) return false;
    check_certifiable(mesh, "certificate");
    if (same_triangles)
        prepared_->move_vertices(mesh.vertices);
    else
        prepared_ = std::make_unique<Prepared>(mesh);
    return true;
}

}  // namespace percale
