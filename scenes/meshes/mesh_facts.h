#pragma once

#include <array>
#include <vector>

#include "percale/mesh.h"

namespace percale::scenes {

using VertexPair = std::array<int, 2>;  // the lower number first

/// What a mesh is like: elements that are not as they should be, by their numbers, ascending, and its measures.
struct MeshFacts {
    std::vector<int> repeated_places;     // vertices at exactly the place of an earlier one
    std::vector<int> unused_vertices;     // of no triangle
    std::vector<int> repeated_triangles;  // with the corners of an earlier one, in any order
    std::vector<int> flat_triangles;  // without area: height over the longest edge not above 1e-12 of it, as check_mesh has it
    std::vector<int> slivers;         // height over the longest edge below a hundredth of it, but not flat

    std::vector<VertexPair> open_edges;      // of one triangle
    std::vector<VertexPair> crowded_edges;   // of three triangles or more
    std::vector<VertexPair> contrary_edges;  // of two triangles that pass it in the same sense
    std::vector<VertexPair> folded_flat;     // the vertices opposite an edge of two triangles, if they lie at the same place
    std::vector<int> pinched_vertices;       // whose triangles hang together by the vertex alone
    int parts = 0;                           // pieces joined by vertices
    std::vector<int> inverted_parts;         // lowest vertex of each closed part turned inside out, not around a cavity

    double shortest_edge = 0.0, median_edge = 0.0, longest_edge = 0.0;  // m
    Vec3 lowest = Vec3::Zero(), highest = Vec3::Zero();                 // m, of the vertices that triangles use

    bool watertight() const { return open_edges.empty() && crowded_edges.empty() && contrary_edges.empty(); }
    /// Largest edge of the bounding box, m.
    double extent() const { return (highest - lowest).maxCoeff(); }
    /// Largest magnitude of a coordinate, m.
    double farthest() const { return lowest.cwiseAbs().cwiseMax(highest.cwiseAbs()).maxCoeff(); }
};

/// `mesh`: with finite coordinates and indices in range.
MeshFacts mesh_facts(const TriangleMesh& mesh);

/// Two of its lists, each alone.
std::vector<int> unused_vertices(const TriangleMesh& mesh);
std::vector<int> repeated_triangles(const std::vector<Triangle>& triangles);

/// Whether every edge has two triangles, wound alike: MeshFacts::watertight() without the rest.
bool is_watertight(const TriangleMesh& mesh);

/// Vertices of open edges that have a vertex of another open edge within `distance` and half of the open edges at either, not in
/// their own place and of no edge in common: where a mesh was cut, or was never joined.
struct NearRims {
    std::vector<int> vertices = {};  // ascending
    double widest = 0.0;             // m, the largest distance of one to the nearest other
};
NearRims near_rims(const TriangleMesh& mesh, const MeshFacts& facts, double distance);

/// A mesh as contact sees it: corners at the same place are one vertex, the first of them, and triangles that are flat or
/// repeated then are left out. The vertices stay, with their numbers.
struct JoinedMesh {
    TriangleMesh mesh = {};
    std::vector<int> number = {};  // that each triangle had before
};
JoinedMesh joined_by_place(const TriangleMesh& mesh);

}  // namespace percale::scenes
