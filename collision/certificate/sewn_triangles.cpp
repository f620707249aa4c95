#include "certificate/sewn_triangles.h"

#include <algorithm>
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
    std::vector<std::vector<int>> points_at(mesh.vertices.size());
    for (const Stitch& stitch : stitches) {
        const int point = number[stitch.vertex];
        points_at[point].push_back(point);
        if (stitch.joins_vertices()) continue;
        for (const int end : {stitch.from, stitch.to}) points_at[number[end]].push_back(point);
    }
    points_.resize(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::vector<int>& points = points_[t];
        for (const int corner : mesh.triangles[t]) {
            const std::vector<int>& own = points_at[number[corner]];
            points.insert(points.end(), own.begin(), own.end());
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
