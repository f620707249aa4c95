#include "shapes/primitives.h"

#include "percale/error.h"

namespace percale::scenes {
namespace {

/// Divisions of shapes that a scene names: a sphere's (4: 5120 triangles), and around the y axis. Cloth of finer mesh sees the
/// facets; more triangles cost more.
constexpr int sphere_level = 4, shape_segments_around = 48;

}  // namespace

TriangleMesh SphereShape::mesh() const { return make_sphere(radius, sphere_level); }
TriangleMesh BoxShape::mesh() const { return make_box(size); }
TriangleMesh CylinderShape::mesh() const { return make_cylinder(radius, height, shape_segments_around); }
TriangleMesh CapsuleShape::mesh() const { return make_capsule(radius, height, shape_segments_around); }
TriangleMesh PlaneShape::mesh() const { return make_plane(half_size); }

namespace {

struct MeshOf {
    TriangleMesh operator()(std::monostate) const { throw SceneError("an obstacle needs a mesh or a shape"); }
    template <class Primitive>
    TriangleMesh operator()(const Primitive& primitive) const {
        return primitive.mesh();
    }
};

}  // namespace

TriangleMesh shape_mesh(const Shape& shape) { return std::visit(MeshOf{}, shape); }

}  // namespace percale::scenes
