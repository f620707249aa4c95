#include "cloth_clusters.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>

namespace percale {
namespace {

constexpr std::size_t triangles_per_cluster = 8;

/// Spreads the lowest 20 bits to every third one.
std::uint64_t spread(std::uint64_t x) {
    std::uint64_t result = 0;
    for (int bit = 0; bit < 20; ++bit) result |= (x >> bit & 1U) << (3 * bit);
    return result;
}

std::vector<std::uint64_t> morton_codes(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
    Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
    for (const Vec3& x : positions) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    const double extent = std::max((high - low).maxCoeff(), 1e-300);
    std::vector<std::uint64_t> codes;
    for (const auto& [a, b, c] : triangles) {
        const Vec3 centre = ((positions[a] + positions[b] + positions[c]) / 3.0 - low) / extent * 1048575.0;
        codes.push_back(spread(static_cast<std::uint64_t>(centre.x())) | spread(static_cast<std::uint64_t>(centre.y())) << 1 |
                        spread(static_cast<std::uint64_t>(centre.z())) << 2);
    }
    return codes;
}

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
    const std::vector<std::uint64_t> codes = morton_codes(triangles, positions);
    std::vector<int> order(triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return codes[a] < codes[b]; });
    ClothClusters result;
    Ownership ownership(positions.size(), triangles.size());
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
