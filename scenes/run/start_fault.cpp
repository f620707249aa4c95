#include "run/start_fault.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "common/text.h"
#include "percale/certify.h"

namespace percale::scenes {
namespace {

/// Adds some triangles of a mesh, each with corners of its own.
void add_triangles(const TriangleMesh& from, const std::set<int>& triangles, TriangleMesh& to) {
    for (const int triangle : triangles) {
        const int first = static_cast<int>(to.vertices.size());
        for (const int vertex : from.triangles[static_cast<std::size_t>(triangle)])
            to.vertices.push_back(from.vertices[static_cast<std::size_t>(vertex)]);
        to.triangles.push_back({first, first + 1, first + 2});
    }
}

std::set<int> triangles_with(const TriangleMesh& mesh, const std::vector<int>& vertices) {
    std::set<int> triangles;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const auto among = [&](int vertex) { return std::binary_search(vertices.begin(), vertices.end(), vertex); };
        if (std::any_of(t.begin(), t.end(), among)) triangles.insert(static_cast<int>(i));
    }
    return triangles;
}

}  // namespace

TriangleMesh offending_triangles(std::span<const TriangleMesh> cloths, const TriangleMesh& obstacle) {
    TriangleMesh result;
    std::set<int> crossed;
    for (const TriangleMesh& cloth : cloths) {
        const Certificate certificate = certify(cloth, obstacle, 0.0);
        std::set<int> crossing = triangles_with(cloth, certificate.inside_vertices);
        for (const IntersectingPair& pair : certificate.pairs) {
            crossing.insert(pair.first);
            crossed.insert(pair.second);
        }
        add_triangles(cloth, crossing, result);
    }
    add_triangles(obstacle, crossed, result);
    return result;
}

std::string start_move_text(const StartMove& move, std::string_view when) {
    return std::to_string(move.vertices_moved) + " vertices of " + move.cloth_name + " moved out of " +
           (move.obstacle < 0 ? "cloth that they crossed" : move.obstacle_name) + " " + std::string(when) + ", the farthest by " +
           short_number(move.largest_move) + " m";
}

std::size_t print_start_moves(const Simulation& simulation, std::size_t first, std::string_view when) {
    for (const StartMove& move : simulation.start_repair().subspan(first))
        std::printf("%s\n", start_move_text(move, when).c_str());
    return simulation.start_repair().size();
}

}  // namespace percale::scenes
