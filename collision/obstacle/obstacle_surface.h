#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "percale/cleaning.h"
#include "percale/mesh.h"
#include "tolerances.h"

namespace percale {

struct SurfaceEdge {
    std::array<int, 2> vertex;
    int owner = -1;  // the first triangle that has it
    /// False for flat edges and for edges of a closed surface that are valleys outside the solid (face_sides.h), where cloth
    /// meets the faces first.
    bool can_touch = true;
};

/// A cleaned obstacle mesh and its connectivity. Positions are those it was made from; a moving obstacle moves its own copy.
struct ObstacleSurface {
    std::vector<Vec3> vertices;
    std::vector<int> given;  // of each vertex: its number in the given mesh, the first of those at its place
    std::vector<Triangle> triangles;
    std::vector<SurfaceEdge> edges;
    std::vector<std::array<int, 3>> triangle_edges;  // edge k joins corners k and k + 1
    std::vector<int> vertex_owner;                   // the first triangle of each vertex
    std::vector<bool> vertex_can_touch;              // some edge at it can touch
    std::vector<int> ring_start, ring;          // neighbours of vertex v: ring[ring_start[v]] ... ring[ring_start[v + 1] - 1]
    std::vector<int> ring_edges;                // the edges to them
    std::vector<int> opposite_start, opposite;  // vertices opposite edge e in its triangles, likewise
    bool watertight = false;                    // every edge in two triangles that agree on its direction, internal ones counted
    CleaningReport cleaning;

    std::span<const int> neighbours(int v) const {
        return std::span(ring).subspan(ring_start[v], ring_start[v + 1] - ring_start[v]);
    }
    std::span<const int> edges_at(int v) const {
        return std::span(ring_edges).subspan(ring_start[v], ring_start[v + 1] - ring_start[v]);
    }
    std::span<const int> opposites(int e) const {
        return std::span(opposite).subspan(opposite_start[e], opposite_start[e + 1] - opposite_start[e]);
    }
};

/// Whether the surface keeps its shape.
enum class SurfaceShape { rigid, deforming };

/// Merges vertices at the same place, drops triangles without area and repeated ones, and unused vertices. If the surface is
/// rigid and closed, it also drops the triangles inside (face_sides.h); edges of a rigid surface that cannot touch are marked,
/// those of a deforming one are not known yet (mark_flat). Throws SceneError if nothing is left.
ObstacleSurface make_surface(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                             SurfaceShape shape = SurfaceShape::rigid);

/// A mesh whose corners at one place are one vertex, the first of them, without triangles that have no area or are repeated. It
/// is closed where make_surface takes it as closed, internal faces included. `numbers`: those of its triangles in the given mesh.
TriangleMesh solid_of(const TriangleMesh& mesh, std::vector<int>& numbers);

/// Marks a deforming surface for a step: edges that are flat at both of its ends cannot touch, nor can vertices at which all
/// edges are flat.
void mark_flat(std::span<const Vec3> start, std::span<const Vec3> end, ObstacleSurface& surface);

/// Whether a point at `foot` on an edge, seen along the unit vector `direction`, is locally the surface's closest: no face at the
/// edge rises towards the viewer. `at` gives the current position of a vertex.
template <class Position>
bool edge_faces(const ObstacleSurface& surface, int edge, const Vec3& foot, const Vec3& direction, const Position& at) {
    for (const int other : surface.opposites(edge)) {
        const Vec3 away = at(other) - foot;
        if (away.dot(direction) > tolerances::rising_sine * away.norm()) return false;
    }
    return true;
}

/// The same at a vertex.
template <class Position>
bool vertex_faces(const ObstacleSurface& surface, int vertex, const Vec3& direction, const Position& at) {
    const Vec3 foot = at(vertex);
    for (const int other : surface.neighbours(vertex)) {
        const Vec3 away = at(other) - foot;
        if (away.dot(direction) > tolerances::rising_sine * away.norm()) return false;
    }
    return true;
}

}  // namespace percale
