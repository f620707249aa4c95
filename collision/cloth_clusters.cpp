#include "cloth_clusters.h"

#include <algorithm>
#include <set>
#include <utility>

#include "morton_order.h"

namespace percale {
namespace {

constexpr std::size_t triangles_per_cluster = 8;

/// Gives features to the first cluster that asks for them.
class Ownership {
public:
    explicit Ownership(std::size_t vertices) : vertex_taken_(vertices, false) {}

    void fill(ClothCluster& cluster, std::span<const Triangle> triangles) {
        std::set<int> all;
        for (const int index : cluster.triangles) {
            const Triangle& t = triangles[index];
            for (int k = 0; k < 3; ++k) {
                all.insert(t[k]);
                if (!vertex_taken_[t[k]]) cluster.vertices.push_back(t[k]);
                vertex_taken_[t[k]] = true;
                const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
                if (edges_taken_.insert({low, high}).second) cluster.edges.push_back({low, high});
            }
        }
        cluster.all_vertices.assign(all.begin(), all.end());
    }

private:
    std::vector<bool> vertex_taken_;
    std::set<std::pair<int, int>> edges_taken_;
};

/// The first triangle at an edge owns it: clusters depend on the axes, contacts must not.
std::vector<unsigned char> edge_owners(std::span<const Triangle> triangles) {
    std::set<std::pair<int, int>> taken;
    std::vector<unsigned char> bits(triangles.size(), 0);
    for (std::size_t index = 0; index < triangles.size(); ++index) {
        const Triangle& t = triangles[index];
        for (int k = 0; k < 3; ++k) {
            if (!taken.insert(std::minmax(t[k], t[(k + 1) % 3])).second) continue;
            bits[index] = static_cast<unsigned char>(bits[index] | 1U << k);
        }
    }
    return bits;
}

}  // namespace

ClothClusters make_clusters(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
    return make_clusters(triangles, positions.size(), morton_order(triangles, positions));
}

ClothClusters make_clusters(std::span<const Triangle> triangles, std::size_t vertices, std::span<const int> order) {
    ClothClusters result;
    Ownership ownership(vertices);
    for (std::size_t from = 0; from < order.size(); from += triangles_per_cluster) {
        ClothCluster& cluster = result.clusters.emplace_back();
        const std::size_t to = std::min(order.size(), from + triangles_per_cluster);
        cluster.triangles.assign(order.begin() + static_cast<long>(from), order.begin() + static_cast<long>(to));
        ownership.fill(cluster, triangles);
    }
    result.edge_owner_bits = edge_owners(triangles);
    return result;
}

}  // namespace percale
