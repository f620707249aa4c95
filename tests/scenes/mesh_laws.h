#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "percale/mesh.h"

// What the meshes we make have to obey, checked without any of the code that makes them.
namespace percale::scenes::test {

struct EdgeCount {
    std::map<std::pair<int, int>, int> directed;

    explicit EdgeCount(const TriangleMesh& mesh) {
        for (const Triangle& t : mesh.triangles)
            for (int k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
    }
    int count(int a, int b) const {
        const auto found = directed.find({a, b});
        return found == directed.end() ? 0 : found->second;
    }
    /// Edges with one triangle only.
    int open_edges() const {
        int open = 0;
        for (const auto& [edge, times] : directed) open += count(edge.second, edge.first) == 0 ? 1 : 0;
        return open;
    }
    int edges() const { return (static_cast<int>(directed.size()) + open_edges()) / 2; }
    /// Each direction of an edge at most once: manifold edges, neighbours turning the same way.
    bool oriented() const {
        for (const auto& [edge, times] : directed)
            if (times != 1) return false;
        return true;
    }
};

/// Vertices, that triangles use, minus edges plus triangles: 2 for a closed sphere, 0 for a ring.
inline int euler_number(const TriangleMesh& mesh) {
    std::set<int> used;
    for (const Triangle& t : mesh.triangles) used.insert(t.begin(), t.end());
    return static_cast<int>(used.size()) - EdgeCount(mesh).edges() + static_cast<int>(mesh.triangles.size());
}

inline bool is_watertight(const TriangleMesh& mesh) {
    const EdgeCount edges(mesh);
    return edges.oriented() && edges.open_edges() == 0;
}

/// Whether the triangles around every vertex form one closed or open fan: walks from triangle to triangle over shared edges.
inline bool has_single_fans(const TriangleMesh& mesh) {
    std::vector<std::map<int, int>> next(mesh.vertices.size());  // of each vertex: from one neighbour to the next
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) next[t[k]][t[(k + 1) % 3]] = t[(k + 2) % 3];
    for (const std::map<int, int>& fan : next) {
        if (fan.empty()) continue;
        std::set<int> targets;
        for (const auto& [from, to] : fan) targets.insert(to);
        int start = fan.begin()->first;
        for (const auto& [from, to] : fan) start = targets.count(from) == 0 ? from : start;
        std::set<int> seen;
        for (auto at = fan.find(start); at != fan.end() && seen.insert(at->first).second;) at = fan.find(at->second);
        if (seen.size() != fan.size()) return false;
    }
    return true;
}

/// m^3, positive where normals point outward (divergence theorem).
inline double volume(const TriangleMesh& mesh) {
    double six = 0.0;
    for (const Triangle& t : mesh.triangles) six += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
    return six / 6.0;
}

/// m^2.
inline double area(const TriangleMesh& mesh) {
    double twice = 0.0;
    for (const Triangle& t : mesh.triangles)
        twice += (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm();
    return 0.5 * twice;
}

/// Smallest angle of any triangle in degrees, by the law of cosines.
inline double sharpest_angle(const TriangleMesh& mesh) {
    double largest_cosine = -1.0;
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const double a = (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[(k + 2) % 3]]).norm();
            const double b = (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm();
            const double c = (mesh.vertices[t[k]] - mesh.vertices[t[(k + 2) % 3]]).norm();
            largest_cosine = std::max(largest_cosine, (b * b + c * c - a * a) / (2.0 * b * c));
        }
    return std::acos(std::min(1.0, largest_cosine)) * 180.0 / 3.14159265358979323846;
}

}  // namespace percale::scenes::test
