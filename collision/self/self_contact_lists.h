#pragma once

#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "geometry/cloth_clusters.h"
#include "percale/contact.h"
#include "self/cluster_tree.h"
#include "self/near_cloths.h"
#include "self/self_pair.h"
#include "self/sewn_rest.h"

namespace percale {

/// The pairs of two clusters (or of one with itself) that can come into contact while the lists hold.
struct SelfList {
    int first = 0, second = 0;       // clusters, first <= second
    std::size_t begin = 0, end = 0;  // of its group's pairs
    double travel = 0.0;             // m, bound of how much any distance of it has shrunk since the lists were made
    double smallest_reach = 0.0;     // smallest SelfPair::reach
    double thickness = 0.0;          // m, largest of its pairs
};

/// Cloths near each other, and all lists of them.
struct SelfGroup {
    std::vector<int> cloths;  // ascending, counted among those that meet cloth
    std::vector<SelfList> lists;
    std::vector<SelfPair> pairs;

    std::span<SelfPair> pairs_of(const SelfList& list) { return std::span(pairs).subspan(list.begin, list.end - list.begin); }
};

/// What lists remember from call to call. Later answers depend on nothing else but the cloth.
struct SelfListsMemory {
    std::vector<Vec3> start, displacement;  // m, what the lists hold for
    std::vector<Vec3> seen;                 // m, positions of the last cover
    std::vector<SelfGroup> groups;          // in the order of their first cloths; none: lists have not been made
};

/// Candidate pairs of cloth against cloth, in groups of cloths that come near each other. A group's hold for the states start +
/// s displacement + t + e, with s from 0 to 1 and t the same for all of its vertices and e at most the vertex's skin: how a
/// group moves as a whole is of no matter, nor is going on from a prediction. The lists of a group that leaves that range, or
/// that another group meets, are made anew, and the groups with them.
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

    /// Calls `work(SelfList&, std::span<SelfPair>)` for each list, in an order that follows from the groups.
    template <typename Work>
    void for_each(const Work& work) {
        for (SelfGroup& group : memory_.groups) {
            for (SelfList& list : group.lists) work(list, group.pairs_of(list));
        }
    }
    const ClothSurface& surface() const { return surface_; }
    const ClothPairs& cloth_pairs() const { return cloth_pairs_; }
    std::size_t cloth_count() const { return near_cloths_.count(); }
    /// Of a cloth that meets cloth, ascending.
    std::span<const int> clusters(int cloth) const { return clusters_of_cloth_[cloth]; }

private:
    struct Cluster {
        std::vector<int> vertices, edges, triangles;  // owned
        std::vector<int> all_vertices;
        int cloth = -1;
        double thickness = 0.0;                                     // m, largest, what is said of pairs of its cloth included
        double skin = 0.0;                                          // m, largest
        double shortest = std::numeric_limits<double>::infinity();  // m, edge at rest
        Vec3 mean = Vec3::Zero();
        double spread = 0.0;  // m, from the mean motion

        /// m, half of how near its features come to others before their pairs are looked at.
        double reach() const { return 0.5 * thickness + skin; }
    };
    struct Near {
        std::vector<int> vertices, edges, triangles;
    };

    void add_clusters(int cloth, std::span<const int> triangles, std::span<const Vec3> rest);
    std::vector<int> take_stale(std::span<const Vec3> from, std::span<const Vec3> to);
    bool covers(const SelfGroup& group, std::span<const Vec3> positions) const;
    bool rebuild(std::span<const int> cloths, std::span<const Vec3> from, std::span<const Vec3> to, bool whatever_it_takes);
    bool fill(SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to, long most);
    void set_boxes(const SelfGroup& group);
    Vec3 mean_motion(const SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to) const;
    /// Pairs whose boxes come within `limit`, and whose distance is below their own thickness and `room`, are kept, m.
    struct Reach {
        double room = 0.0, limit = 0.0;
        double skins = 0.0;        // boxes farther apart than this and a pair's thickness never come into contact
        bool rest_counts = false;  // of one cloth, so fine that it is the distance at rest that bounds most thicknesses
    };
    void fill_list(SelfList& list, std::span<const Vec3> from);
    void keep_fresh();
    void find_near(const Cluster& cluster, const Box& other, Near& near) const;
    void pair_vertices(const Near& points, const Near& faces, Reach reach, std::span<const Vec3> from);
    void pair_edges(bool one, Reach reach, std::span<const Vec3> from);
    void set_of_seam(SelfPair& pair) const;
    double thickness_by_rest(std::span<const int> first, std::span<const int> second) const;
    double sewn_distance(const SelfPair& pair) const;
    void consider(SelfPair pair, double room, std::span<const Vec3> from);
    void take_over_zones(SelfGroup& group) const;
    template <typename Work>
    void for_each_vertex(const SelfGroup& group, const Work& work) const {
        for (const int cloth : group.cloths) {
            for (const int v : near_cloths_.vertices(cloth)) work(v);
        }
    }

    std::vector<double> thickness_;
    std::vector<int> cloth_;
    ClothPairs cloth_pairs_;
    ClothPair pair_;  // of the clusters whose list is being filled
    std::vector<Vec3> rest_;
    ClothSurface surface_;
    std::vector<double> skin_;
    SewnRest sewn_;
    std::vector<Cluster> clusters_;
    NearCloths near_cloths_;
    std::vector<std::vector<int>> clusters_of_cloth_;
    ClusterTree tree_;
    SelfListsMemory memory_;
    std::vector<SelfGroup> fresh_, spare_;  // made in this call; whose memory can be used again
    SelfGroup* filled_ = nullptr;           // whose lists are being made
    std::vector<Box> vertex_boxes_, edge_boxes_, triangle_boxes_, cluster_boxes_;  // m, during the move
    std::vector<int> group_of_cloth_;
    std::vector<char> group_meets_;
    std::vector<Box> tree_boxes_;
    std::vector<int> tree_clusters_;
    std::vector<std::pair<int, int>> cluster_pairs_;
    std::vector<SelfPair> old_pairs_;  // that are contacts, of the groups being replaced
    std::vector<Vec3> shortened_;
    Near near_first_, near_second_;
    long considered_ = 0;
};

}  // namespace percale
