#include "untangle/merged_cloth.h"

#include <algorithm>
#include <set>

#include "certificate/sewn_triangles.h"

namespace percale {
namespace {

double mean_edge_of(std::span<const Triangle> triangles, std::span<const Vec3> x) {
    double sum = 0.0;
    for (const Triangle& t : triangles) {
        for (int k = 0; k < 3; ++k) sum += (x[t[(k + 1) % 3]] - x[t[k]]).norm();
    }
    return triangles.empty() ? 0.0 : sum / (3.0 * static_cast<double>(triangles.size()));
}

/// The stitches that join two vertices of cloth that are near each other.
std::vector<Stitch> closed_stitches(const CrossedCloth& cloth, std::span<const Vec3> x, double edges) {
    std::vector<bool> meets(x.size(), false);
    for (const Triangle& t : cloth.triangles) {
        for (const int v : t) meets[v] = true;
    }
    const double near = edges * mean_edge_of(cloth.triangles, x);
    std::vector<Stitch> closed;
    for (const Stitch& stitch : cloth.stitches) {
        if (!stitch.joins_vertices() || !meets[stitch.vertex] || !meets[stitch.other()]) continue;
        if ((x[stitch.vertex] - x[stitch.other()]).norm() <= near) closed.push_back(stitch);
    }
    return closed;
}

void join_places(MergedCloth& merged) {
    const std::size_t count = merged.number.size();
    std::vector<Vec3> sum(count, Vec3::Zero());
    std::vector<int> joined(count, 0), fixed(count, -1);
    for (std::size_t v = 0; v < count; ++v) {
        const int lowest = merged.number[v];
        sum[lowest] += merged.mesh.vertices[v];
        ++joined[lowest];
        if (merged.free[v] == 0.0 && fixed[lowest] < 0) fixed[lowest] = static_cast<int>(v);
    }
    for (std::size_t v = 0; v < count; ++v) {
        if (joined[v] < 2) continue;
        merged.mesh.vertices[v] = fixed[v] < 0 ? Vec3(sum[v] / joined[v]) : merged.mesh.vertices[fixed[v]];
        if (fixed[v] >= 0) merged.free[v] = 0.0;
    }
}

void add_triangles(std::span<const Triangle> triangles, MergedCloth& merged) {
    std::set<Triangle> known;
    for (const Triangle& t : triangles) {
        const Triangle sewn{merged.number[t[0]], merged.number[t[1]], merged.number[t[2]]};
        Triangle sorted = sewn;
        std::sort(sorted.begin(), sorted.end());
        const bool flat = sorted[0] == sorted[1] || sorted[1] == sorted[2];
        const bool left_out = flat || !known.insert(sorted).second;
        merged.triangle.push_back(left_out ? -1 : static_cast<int>(merged.mesh.triangles.size()));
        if (!left_out) merged.mesh.triangles.push_back(sewn);
    }
}

}  // namespace

double MergedCloth::mean_edge() const { return mean_edge_of(mesh.triangles, joined); }

std::vector<Vec3> MergedCloth::places(std::span<const Vec3> given, bool gaps) const {
    std::vector<Vec3> result;
    for (std::size_t v = 0; v < number.size(); ++v) {
        const bool moved = mesh.vertices[number[v]] != joined[number[v]];
        result.push_back(moved || !gaps ? mesh.vertices[number[v]] : given[v]);
    }
    return result;
}

MergedCloth merge_sewn(const CrossedCloth& cloth, std::span<const Vec3> positions, double near) {
    MergedCloth merged{.number = certificate::closed_vertices(positions.size(), closed_stitches(cloth, positions, near)),
                       .free = {cloth.free.begin(), cloth.free.end()},
                       .mesh = {.vertices = {positions.begin(), positions.end()}, .triangles = {}}};
    join_places(merged);
    add_triangles(cloth.triangles, merged);
    for (const auto& [vertex, from, to, share] : cloth.stitches) {
        Stitch stitch{merged.number[vertex], merged.number[from], merged.number[to], share};
        if (stitch.joins_vertices()) stitch = {stitch.vertex, stitch.other(), stitch.other(), 0.0};
        if (stitch.vertex != stitch.from && stitch.vertex != stitch.to) merged.stitches.push_back(stitch);
    }
    merged.joined = merged.mesh.vertices;
    return merged;
}

}  // namespace percale
