#include "geometry/cloth_clusters.h"

#include <algorithm>
#include <set>
#include <utility>

#include "geometry/morton_order.h"

namespace percale {
namespace {

constexpr std::size_t triangles_per_cluster = 8;

/// Gives features to the first cluster that asks for them.
class Ownership {
public:
    Ownership(std::size_t vertices, std::size_t triangles) : vertex_taken_(vertices, false), bits_(triangles, 0) {}

    void fill(ClothCluster& cluster, std::span<const Triangle> triangles) {
        std::set<int> all;
        for (const int index : cluster.triangles) {
            const Triangle& t = triangles[index];
            for (int k = 0; k < 3; ++k) {
                all.insert(t[k]);
                if (!vertex_taken_[t[k]]) cluster.vertices.push_back(t[k]);
                vertex_taken_[t[k]] = true;
                if (!edges_taken_.insert(std::minmax(t[k], t[(k + 1) % 3])).second) continue;
                cluster.edges.push_back({t[k], t[(k + 1) % 3]});
                bits_[index] = static_cast<unsigned char>(bits_[index] | 1U << k);
            }
        }
        cluster.all_vertices.assign(all.begin(), all.end());
    }

    std::vector<unsigned char> take_bits() { return std::move(bits_); }

private:
    std::vector<bool> vertex_taken_;
    std::set<std::pair<int, int>> edges_taken_;
    std::vector<unsigned char> bits_;
};

}  // namespace

ClothClusters make_clusters(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
    return make_clusters(triangles, positions.size(), morton_order(triangles, positions));
}

ClothClusters make_clusters(std::span<const Triangle> triangles, std::size_t vertices, std::span<const int> order) {
    ClothClusters result;
    Ownership ownership(vertices, triangles.size());
    for (std::size_t from = 0; from < order.size(); from += triangles_per_cluster) {
        ClothCluster& cluster = result.clusters.emplace_back();
        const std::size_t to = std::min(order.size(), from + triangles_per_cluster);
        cluster.triangles.assign(order.begin() + static_cast<long>(from), order.begin() + static_cast<long>(to));
        ownership.fill(cluster, triangles);
    }
    result.edge_owner_bits = ownership.take_bits();
    return result;
}

}  // namespace percale
