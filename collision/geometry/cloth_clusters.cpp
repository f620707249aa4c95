#include "geometry/cloth_clusters.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "geometry/morton_order.h"

namespace percale {
namespace {

/// Triangles of the cloth in a cluster. More: more features are listed again at once. Fewer: more lists to search. The order of
/// the constraints depends on it, and so do the last bits of sums over contacts.
constexpr unsigned long triangles_per_cluster = 8;

/// Numbers the edges of triangles and says which triangle owns each: the one of the lowest index among those that have it. The
/// first one on the curve would depend on the axes: a turned scene would have other contacts.
class EdgeOwners {
public:
    explicit EdgeOwners(std::span<const Triangle> triangles)
        : edges_(3 * triangles.size()), bits_(triangles.size(), 0), across_(triangles.size(), {-1, -1, -1}) {
        std::vector<Side> sides;
        sides.reserve(edges_.size());
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const Triangle& t = triangles[i];
            for (std::size_t k = 0; k < 3; ++k) sides.push_back({std::minmax(t[k], t[(k + 1) % 3]), i, k});
        }
        std::sort(sides.begin(), sides.end());
        for (std::size_t i = 0; i < sides.size(); ++i) add(triangles, sides, i);
    }

    std::size_t count() const { return ends_.size(); }
    int edge(int triangle, int k) const { return edges_[3 * static_cast<std::size_t>(triangle) + static_cast<std::size_t>(k)]; }
    const std::array<int, 2>& ends(int edge) const { return ends_[edge]; }  // in the order of their owner's corners
    void take(ClothClusters& to) {
        to.edge_owner_bits = std::move(bits_);
        to.across = std::move(across_);
    }

private:
    using Side = std::tuple<std::pair<int, int>, std::size_t, std::size_t>;  // an edge's vertices; a triangle, and k of the edge
                                                                             // in it

    /// The sides of one edge follow each other, the owner's first.
    void add(std::span<const Triangle> triangles, std::span<const Side> sides, std::size_t i) {
        const auto& [vertices, triangle, k] = sides[i];
        const Triangle& t = triangles[triangle];
        if (i == 0 || std::get<0>(sides[i - 1]) != vertices) {
            ends_.push_back({t[k], t[(k + 1) % 3]});
            bits_[triangle] = static_cast<unsigned char>(bits_[triangle] | 1U << k);
        } else {
            const auto& [same, before, there] = sides[i - 1];
            across_[triangle][k] = triangles[before][(there + 2) % 3];
            across_[before][there] = t[(k + 2) % 3];
        }
        edges_[3 * triangle + k] = static_cast<int>(ends_.size()) - 1;
    }

    std::vector<int> edges_;
    std::vector<std::array<int, 2>> ends_;
    std::vector<unsigned char> bits_;
    std::vector<std::array<int, 3>> across_;
};

/// Assigns vertices and edges to the first cluster that claims them.
class Ownership {
public:
    Ownership(std::size_t vertices, std::span<const Triangle> triangles)
        : triangles_(triangles), owners_(triangles), vertex_taken_(vertices, false), edge_taken_(owners_.count(), false) {}

    void fill(ClothCluster& cluster) {
        std::set<int> all;
        for (const int index : cluster.triangles) {
            const Triangle& t = triangles_[index];
            for (int k = 0; k < 3; ++k) {
                all.insert(t[k]);
                if (!vertex_taken_[t[k]]) cluster.vertices.push_back(t[k]);
                vertex_taken_[t[k]] = true;
                const int edge = owners_.edge(index, k);
                if (!edge_taken_[edge]) cluster.edges.push_back(owners_.ends(edge));
                edge_taken_[edge] = true;
            }
        }
        cluster.all_vertices.assign(all.begin(), all.end());
    }

    void take(ClothClusters& to) { owners_.take(to); }

private:
    std::span<const Triangle> triangles_;
    EdgeOwners owners_;
    std::vector<bool> vertex_taken_, edge_taken_;
};

}  // namespace

ClothClusters make_clusters(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
    return make_clusters(triangles, positions.size(), morton_order(triangles, positions));
}

ClothClusters make_clusters(std::span<const Triangle> triangles, std::size_t vertices, std::span<const int> order) {
    ClothClusters result;
    Ownership ownership(vertices, triangles);
    for (std::size_t from = 0; from < order.size(); from += triangles_per_cluster) {
        ClothCluster& cluster = result.clusters.emplace_back();
        const std::size_t to = std::min(order.size(), from + triangles_per_cluster);
        cluster.triangles.assign(order.begin() + static_cast<long>(from), order.begin() + static_cast<long>(to));
        ownership.fill(cluster);
    }
    ownership.take(result);
    return result;
}

}  // namespace percale
