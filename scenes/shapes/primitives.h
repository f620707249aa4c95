#pragma once

#include <variant>

#include "percale/mesh.h"

// Obstacles that need no mesh file: what their keys say, and the mesh that it makes. Lengths in m.
namespace percale::scenes {

struct SphereShape {
    double radius = 0.0;
    TriangleMesh mesh() const;
};
struct BoxShape {
    Vec3 size = Vec3::Zero();
    TriangleMesh mesh() const;
};
struct CylinderShape {
    double radius = 0.0, height = 0.0;  // about the y axis
    TriangleMesh mesh() const;
};
struct CapsuleShape {
    double radius = 0.0, height = 0.0;  // about the y axis; between the centres of its half spheres
    TriangleMesh mesh() const;
};
struct PlaneShape {
    double half_size = 10.0;  // of a horizontal square
    TriangleMesh mesh() const;
};

using Shape = std::variant<std::monostate, SphereShape, BoxShape, CylinderShape, CapsuleShape, PlaneShape>;

/// The mesh of a shape, centred. Throws SceneError where there is none.
TriangleMesh shape_mesh(const Shape& shape);

}  // namespace percale::scenes
