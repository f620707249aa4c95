#pragma once

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "collision/lists/candidate_lists.h"
#include "collision/lists/obstacle_terms.h"
#include "percale/mesh.h"

namespace percale::test {

/// Every cloth feature with every obstacle feature, without lists, boxes or trees. `touchable`: only those that the lists hold.
inline std::vector<ContactPair> all_pairs(const TriangleMesh& cloth, const Obstacle& obstacle, bool touchable) {
    const ObstacleSurface& surface = obstacle.surface();
    std::vector<ContactPair> pairs;
    for (int v = 0; v < static_cast<int>(cloth.vertices.size()); ++v) {
        for (int f = 0; f < static_cast<int>(surface.triangles.size()); ++f) {
            pairs.push_back({.kind = PairKind::vertex_face, .cloth = {v, -1, -1}, .feature = f});
        }
    }
    std::set<std::pair<int, int>> edges;
    for (const Triangle& t : cloth.triangles) {
        unsigned char bits = 0;
        for (int k = 0; k < 3; ++k) {
            if (edges.insert(std::minmax(t[k], t[(k + 1) % 3])).second) bits = static_cast<unsigned char>(bits | 1 << k);
        }
        for (int v = 0; v < static_cast<int>(surface.vertices.size()); ++v) {
            if (touchable && !surface.vertex_can_touch[v]) continue;
            pairs.push_back({.kind = PairKind::face_vertex, .cloth = t, .edge_bits = bits, .feature = v});
        }
    }
    for (const auto& [a, b] : edges) {
        for (int e = 0; e < static_cast<int>(surface.edges.size()); ++e) {
            if (touchable && !surface.edges[e].can_touch) continue;
            pairs.push_back({.kind = PairKind::edge_edge, .cloth = {a, b, -1}, .feature = e});
        }
    }
    return pairs;
}

/// Whether a pair within a thickness makes contact constraints.
inline bool makes_contact(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction,
                          double thickness) {
    if (!(pair_distance(pair, cloth, obstacle, fraction) < thickness)) return false;
    return pair.kind == PairKind::vertex_face ? obstacle_terms(pair, cloth, obstacle, fraction, thickness).count > 0
                                              : pair_contact(pair, cloth, obstacle, fraction).local_minimum;
}

/// A pair in a list, with the bound of its pack.
struct ListedPair {
    ContactPair pair;
    double reach = 0.0;
};

/// Every pair that a cluster's list holds.
inline std::vector<ListedPair> listed_pairs(const ClusterList& list, const Obstacles& obstacles) {
    std::vector<ListedPair> pairs;
    for (std::size_t i = 0; i < list.packs.size(); ++i) {
        const ContactPair& feature = list.features[list.packs.at[i].feature];
        const FeaturePack& pack = obstacles[feature.obstacle]->packs().packs[list.packs.at[i].number];
        for (int lane = 0; lane < pack.count; ++lane) {
            pairs.push_back({.pair = feature.with(pack, lane), .reach = static_cast<double>(list.packs.reach[i])});
        }
    }
    return pairs;
}

/// The identity of pairs of one obstacle, whichever way round a cloth edge or triangle is named.
using PairKey = std::tuple<int, std::set<int>, int, int>;
inline PairKey key(const ContactPair& pair) {
    return {
        static_cast<int>(pair.kind), {pair.cloth.begin(), pair.cloth.begin() + pair.cloth_count()}, pair.obstacle, pair.feature};
}

/// The obstacle's cleaned mesh at a fraction of the step.
inline TriangleMesh mesh_at(const Obstacle& obstacle, double fraction) {
    TriangleMesh mesh{.vertices = {}, .triangles = obstacle.surface().triangles};
    for (int v = 0; v < static_cast<int>(obstacle.surface().vertices.size()); ++v)
        mesh.vertices.push_back(obstacle.at(v, fraction));
    return mesh;
}

}  // namespace percale::test
