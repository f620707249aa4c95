#include "picture/surfaces.h"

#include <algorithm>
#include <cmath>

namespace percale::scenes {

namespace {

// Cosine of the angle, 60 degrees, from which on an edge is sharp.
constexpr float crease_cosine = 0.5f;
// Cosine of the largest angle between normals of points on one piece of surface.
constexpr float alike_cosine = 0.85f;
// In radii of all shapes: how far off a surface rays to lights start. Larger: light leaks between cloth and body.
constexpr double lift_share = 2e-4;

Eigen::Vector3f area_normal(const TriangleMesh& mesh, const Triangle& t) {
    const auto& x = mesh.vertices;
    const auto corner = [&](int k) -> const Vec3& { return x[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])]; };
    return (corner(1) - corner(0)).cross(corner(2) - corner(0)).cast<float>();
}

double shown_radius(std::span<const ShownShape> shapes) {
    Eigen::AlignedBox3d box;
    for (const ShownShape& shape : shapes)
        for (const Vec3& x : shape.mesh.vertices) box.extend(x);
    return box.isEmpty() ? 1.0 : std::max(0.5 * box.diagonal().norm(), 1e-9);
}

}  // namespace

std::vector<std::array<Eigen::Vector3f, 3>> corner_normals(const TriangleMesh& mesh) {
    std::vector<std::vector<std::size_t>> around(mesh.vertices.size());
    std::vector<Eigen::Vector3f> whole, unit;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        whole.push_back(area_normal(mesh, mesh.triangles[i]));
        unit.push_back(whole.back().normalized());
        for (const int vertex : mesh.triangles[i]) around[static_cast<std::size_t>(vertex)].push_back(i);
    }
    const auto corner = [&](std::size_t i, int vertex) {
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (const std::size_t j : around[static_cast<std::size_t>(vertex)])
            if (j == i || unit[i].dot(unit[j]) > crease_cosine) sum += whole[j];
        return Eigen::Vector3f(sum.normalized());
    };
    std::vector<std::array<Eigen::Vector3f, 3>> normals(mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) normals[i][k] = corner(i, mesh.triangles[i][k]);
    return normals;
}

bool alike(const SurfacePoint& a, const SurfacePoint& b, float reach) {
    return a.shape == b.shape && a.back == b.back && a.normal.dot(b.normal) > alike_cosine &&
           std::abs(a.facet.dot(b.place - a.place)) < reach;
}

Surfaces::Surfaces(std::span<const ShownShape> shapes, const std::optional<Ground>& ground)
    : shapes_(shapes), ground_(ground), tree_(shapes), radius_(shown_radius(shapes)) {
    for (const ShownShape& shape : shapes) normals_.push_back(corner_normals(shape.mesh));
}

SurfacePoint Surfaces::look(const Vec3& eye, const Vec3& direction) const {
    const RayHit hit = tree_.first_hit(eye, direction);
    SurfacePoint point;
    if (hit.shape < 0) {
        if (!ground_ || direction.y() >= 0.0 || eye.y() <= ground_->height) return point;
        const double depth = (ground_->height - eye.y()) / direction.y();
        const Vec3 place = eye + depth * direction;
        if ((place - ground_->middle).norm() > ground_->radius) return point;
        point.shape = SurfacePoint::on_ground;
        point.depth = static_cast<float>(depth);
        point.place = place.cast<float>();
        point.normal = point.facet = Eigen::Vector3f::UnitY();
        return point;
    }
    const auto shape = static_cast<std::size_t>(hit.shape), triangle = static_cast<std::size_t>(hit.triangle);
    const auto& corners = normals_[shape][triangle];
    point.shape = hit.shape;
    point.triangle = hit.triangle;
    point.u = hit.u;
    point.v = hit.v;
    point.depth = static_cast<float>(hit.distance);
    point.place = (eye + hit.distance * direction).cast<float>();
    point.facet = area_normal(shapes_[shape].mesh, shapes_[shape].mesh.triangles[triangle]).normalized();
    point.normal = ((1.0f - hit.u - hit.v) * corners[0] + hit.u * corners[1] + hit.v * corners[2]).normalized();
    point.back = point.facet.dot(direction.cast<float>()) > 0.0f;
    if (point.back) point.facet = -point.facet, point.normal = -point.normal;
    return point;
}

/// With the corners x_i, their normals n_i and weights w_i, x is moved by -1/2 sum w_i min(0, (x - x_i) n_i) n_i: half as far as
/// to the tangent planes that it lies under, which is where a surface that bends evenly lies.
Vec3 Surfaces::lifted(const SurfacePoint& point) const {
    const Vec3 place = point.place.cast<double>() + lift_share * radius_ * point.facet.cast<double>();
    if (!point.is_shape()) return place;
    const auto shape = static_cast<std::size_t>(point.shape), triangle = static_cast<std::size_t>(point.triangle);
    const TriangleMesh& mesh = shapes_[shape].mesh;
    const float weights[] = {1.0f - point.u - point.v, point.u, point.v}, side = point.back ? -1.0f : 1.0f;
    Eigen::Vector3f moved = Eigen::Vector3f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3f corner = mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][k])].cast<float>();
        const Eigen::Vector3f normal = side * normals_[shape][triangle][k];
        moved -= 0.5f * weights[k] * std::min(0.0f, (point.place - corner).dot(normal)) * normal;
    }
    return place + moved.cast<double>();
}

}  // namespace percale::scenes
