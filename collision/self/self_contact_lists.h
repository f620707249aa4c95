#pragma once

#include <span>
#include <utility>
#include <vector>

#include "geometry/cloth_clusters.h"
#include "percale/contact.h"
#include "self/cluster_tree.h"
#include "self/self_pair.h"
#include "self/sewn_rest.h"

namespace percale {

/// The pairs of two clusters (or of one with itself) that can come into contact while the lists hold.
struct SelfList {
    int first = 0, second = 0;       // clusters, first <= second
    std::size_t begin = 0, end = 0;  // of its pairs
    double travel = 0.0;             // m, bound of how much any distance of it has shrunk since the lists were made
    double smallest_reach = 0.0;     // smallest SelfPair::reach
    double thickness = 0.0;          // m, largest of its pairs
};

/// What lists remember from call to call. Later answers depend on nothing else but the cloth.
struct SelfListsMemory {
    std::vector<Vec3> start, displacement;  // m, what the lists hold for
    std::vector<Vec3> seen;                 // m, positions of the last cover
    std::vector<SelfList> lists;
    std::vector<SelfPair> pairs;
    bool made = false;
};

/// Candidate pairs of cloth against cloth. They hold for the states start + s displacement + t + e, with s from 0 to 1 and t the
/// same for all vertices and e at most half of the thickness: how cloth moves as a whole is of no matter, nor is going on from a
/// prediction. What leaves that range makes all lists anew.
class SelfContactLists {
public:
    SelfContactLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness, const SelfContact& cloth);

    /// Makes the lists good for all states on the straight line between two, and shortens the bounds to `from`. A move so long
    /// that too many pairs would have to be looked at is covered in part: returns that fraction of it, from its start.
    double cover(std::span<const Vec3> from, std::span<const Vec3> to);

    /// Sets what `shrink` says.
    void set_motion(std::span<const Vec3> from, std::span<const Vec3> to);
    /// m, bound of how much distances of the list can shrink on the straight line last given to set_motion.
    double shrink(const SelfList& list) const;

    const SelfListsMemory& memory() const { return memory_; }
    /// Goes on from what other lists of the same cloth remember.
    void set_memory(SelfListsMemory memory) { memory_ = std::move(memory); }

    std::span<SelfList> lists() { return memory_.lists; }
    std::span<SelfPair> pairs(const SelfList& list) {
        return std::span(memory_.pairs).subspan(list.begin, list.end - list.begin);
    }
    const ClothSurface& surface() const { return surface_; }
    const ClothPairs& cloth_pairs() const { return cloth_pairs_; }
    std::size_t cluster_count() const { return clusters_.size(); }

private:
    struct Cluster {
        std::vector<int> vertices, edges, triangles;  // owned
        std::vector<int> all_vertices;
        int cloth = -1;
        double thickness = 0.0;  // m, largest, what is said of pairs of its cloth included
        Vec3 mean = Vec3::Zero();
        double spread = 0.0;  // m, from the mean motion
    };
    struct Near {
        std::vector<int> vertices, edges, triangles;
    };

    void add_clusters(int cloth, std::span<const int> triangles, std::span<const Vec3> rest);
    bool covers(std::span<const Vec3> positions) const;
    bool rebuild(std::span<const Vec3> from, std::span<const Vec3> to, bool whatever_it_takes);
    void set_boxes();
    Vec3 mean_motion(std::span<const Vec3> from, std::span<const Vec3> to) const;
    /// Pairs whose boxes come within `limit` and whose distance is below its own thickness and `room` are kept, m.
    struct Reach {
        double room = 0.0, limit = 0.0;
    };
    void fill_list(SelfList& list, std::span<const Vec3> from);
    void find_near(const Cluster& cluster, const Box& other, Near& near) const;
    void pair_vertices(const Near& points, const Near& faces, Reach reach, std::span<const Vec3> from);
    void pair_edges(bool one, Reach reach, std::span<const Vec3> from);
    void set_of_seam(SelfPair& pair) const;
    double sewn_distance(const SelfPair& pair) const;
    void consider(SelfPair pair, double room, std::span<const Vec3> from);
    void take_over_zones();

    std::vector<double> thickness_;
    std::vector<int> cloth_;
    ClothPairs cloth_pairs_;
    ClothPair pair_;  // of the clusters whose list is being filled
    std::vector<Vec3> rest_;
    ClothSurface surface_;
    SewnRest sewn_;
    std::vector<Cluster> clusters_;
    ClusterTree tree_;
    std::vector<int> vertices_;  // that meet cloth
    SelfListsMemory memory_;
    std::vector<Box> vertex_boxes_, edge_boxes_, triangle_boxes_, cluster_boxes_;  // m, during the move
    std::vector<std::pair<int, int>> cluster_pairs_;
    std::vector<SelfPair> old_pairs_;
    std::vector<Vec3> shortened_;
    Near near_first_, near_second_;
    long considered_ = 0;
};

}  // namespace percale
