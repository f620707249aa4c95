#include "certificate/sewn_triangles.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <string>

#include "percale/error.h"

namespace percale::certificate {
namespace {

void check(const Stitch& stitch, std::size_t vertices) {
    for (const int vertex : {stitch.vertex, stitch.from, stitch.to}) {
        if (vertex >= 0 && static_cast<std::size_t>(vertex) < vertices) continue;
        throw SceneError("certify_cloth: a stitch of vertex " + std::to_string(vertex) + ", vertices are 0 ... " +
                         std::to_string(static_cast<long>(vertices) - 1));
    }
}

using Edge = std::array<int, 2>;

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

std::vector<int> closed_vertices(std::size_t count, std::span<const Stitch> stitches) {
    std::vector<int> number(count);
    std::iota(number.begin(), number.end(), 0);
    const auto root = [&](int vertex) {
        while (number[vertex] != vertex) vertex = number[vertex];
        return vertex;
    };
    for (const Stitch& stitch : stitches) {
        if (!stitch.joins_vertices()) continue;
        const int a = root(stitch.vertex), b = root(stitch.other());
        number[std::max(a, b)] = std::min(a, b);
    }
    for (int vertex = 0; vertex < static_cast<int>(count); ++vertex) number[vertex] = root(vertex);
    return number;
}

SewnTriangles::SewnTriangles(const TriangleMesh& mesh, std::span<const Stitch> stitches) {
    if (stitches.empty()) return;
    for (const Stitch& stitch : stitches) check(stitch, mesh.vertices.size());
    const std::vector<int> number = closed_vertices(mesh.vertices.size(), stitches);
    std::vector<bool> sewn(mesh.vertices.size(), false);
    std::map<Edge, std::vector<int>> on_edge;
    for (const Stitch& stitch : stitches) {
        sewn[number[stitch.vertex]] = true;
        if (!stitch.joins_vertices()) on_edge[edge_of(stitch.from, stitch.to)].push_back(number[stitch.vertex]);
    }
    points_.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& corners = mesh.triangles[t];
        std::vector<int>& points = points_[t];
        for (int k = 0; k < 3; ++k) {
            if (sewn[number[corners[k]]]) points.push_back(number[corners[k]]);
            const auto found = on_edge.find(edge_of(corners[k], corners[(k + 1) % 3]));
            if (found != on_edge.end()) points.insert(points.end(), found->second.begin(), found->second.end());
        }
        std::sort(points.begin(), points.end());
    }
}

bool SewnTriangles::together(int first, int second) const {
    if (points_.empty()) return false;
    const auto &a = points_[first], &b = points_[second];
    return std::any_of(a.begin(), a.end(), [&](int point) { return std::binary_search(b.begin(), b.end(), point); });
}

}  // namespace percale::certificate
