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

/// The pairs of two clusters (or of one with itself) that can come into contact while `travel` is at most `room`.
struct SelfList {
    int first = 0, second = 0;  // clusters, first <= second
    std::vector<SelfPair> pairs = {};
    double travel = 0.0;          // m, bound of how much any distance has shrunk since the list was made
    double room = -1.0;           // m
    double smallest_reach = 0.0;  // smallest SelfPair::reach
    double thickness = 0.0;       // m, largest of its pairs
};

/// Cloths near each other, and a list of each two clusters of them that come near each other.
struct SelfGroup {
    std::vector<int> cloths;      // ascending, counted among those that meet cloth
    std::vector<SelfList> lists;  // by first, then second cluster, those without a pair, too
};

/// What lists remember from call to call. Later answers depend on nothing else but the cloth.
struct SelfListsMemory {
    std::vector<Vec3> seen;         // m, positions of the last cover
    std::vector<Box> rooms;         // m, of each cluster, from the centre of its group: no list is missing while it is in it
    std::vector<SelfGroup> groups;  // in the order of their first cloths; none: lists have not been made
};

/// Candidate pairs of cloth against cloth, in groups of cloths that come near each other. A list of two clusters holds until they
/// have moved far enough against each other, whatever others do. Which clusters have lists holds while each stays in a box, as
/// seen from the centre of its group: how a group moves as a whole is of no matter.
class SelfContactLists {
public:
    SelfContactLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness, const SelfContact& cloth);

    /// Makes the lists good for all states on the straight line between two, and shortens the bounds to `from`. A move so long
    /// that too many pairs would have to be looked at is covered in part: returns that fraction of it, from its start.
    double cover(std::span<const Vec3> from, std::span<const Vec3> to);
    /// The same where a step begins: gives up what was made for longer moves, and parts cloths that are far apart again.
    double begin_step(std::span<const Vec3> from, std::span<const Vec3> to);

    /// Sets what `shrink` says.
    void set_motion(std::span<const Vec3> from, std::span<const Vec3> to);
    /// m, bound of how much distances of the list can shrink on the straight line last given to set_motion.
    double shrink(const SelfList& list) const;

    const SelfListsMemory& memory() const { return memory_; }
    /// Goes on from what other lists of the same cloth remember.
    void set_memory(SelfListsMemory memory) { memory_ = std::move(memory); }

    /// Calls `work(SelfList&)` for each list, in an order that follows from the groups.
    template <typename Work>
    void for_each(const Work& work) {
        for (SelfGroup& group : memory_.groups) {
            for (SelfList& list : group.lists) work(list);
        }
    }
    const ClothSurface& surface() const { return surface_; }
    const ClothPairs& cloth_pairs() const { return cloth_pairs_; }
    std::size_t cloth_count() const { return near_cloths_.count(); }
    std::size_t cluster_count() const { return clusters_.size(); }
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
    };
    struct Near {
        std::vector<int> vertices, edges, triangles;
    };

    void add_clusters(int cloth, std::span<const int> triangles, std::span<const Vec3> rest);
    void move_to(std::span<const Vec3> from);
    double cover_move(std::span<const Vec3> from, std::span<const Vec3> to);
    void regroup(std::span<const Vec3> from, std::span<const Vec3> to, bool may_part);
    void give_up_room(std::span<const Vec3> from, std::span<const Vec3> to);
    void give_up_lists_just_made();
    bool update(SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to, long most);
    template <typename Work>
    void for_each_swept(const SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to, const Work& work);
    bool set_rooms(const SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to);
    Vec3 centre(const SelfGroup& group, std::span<const Vec3> positions) const;
    bool find_lists(SelfGroup& group, long most);
    SelfList take_list(SelfGroup& group, int first, int second);
    void fill(SelfList& list, std::span<const Vec3> from);
    const Box& box_of_cluster(int cluster, std::span<const Vec3> from);
    void set_feature_boxes(int cluster, std::span<const Vec3> from);
    struct Reach {
        double room = 0.0;         // m, pairs whose distance is below their thickness and this are kept
        double limit = 0.0;        // m, those are no farther apart
        bool rest_counts = false;  // of one cloth, so fine that it is the distance at rest that bounds most thicknesses
    };
    void find_near(const Cluster& cluster, Box other, double limit, Near& near) const;
    void pair_vertices(const Near& points, const Near& faces, Reach reach, std::span<const Vec3> from);
    void pair_edges(bool one, Reach reach, std::span<const Vec3> from);
    void set_of_seam(SelfPair& pair) const;
    double thickness_by_rest(std::span<const int> first, std::span<const int> second) const;
    double sewn_distance(const SelfPair& pair) const;
    void consider(SelfPair pair, double room, std::span<const Vec3> from);
    void take_over_zones(SelfList& list) const;

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
    std::vector<SelfList> loose_lists_, next_lists_;  // of groups that are no more; of the one being updated
    SelfList* filled_ = nullptr;
    struct Boxed {
        Box box;                               // m, of the cluster where a cover begins
        long cluster_in = 0, features_in = 0;  // the last cover that set its box, and those of its features
    };
    std::vector<Boxed> boxed_;
    std::vector<Box> vertex_boxes_, edge_boxes_, triangle_boxes_;
    long covers_ = 0;
    std::vector<int> group_of_cloth_, tree_clusters_;
    std::vector<Box> tree_boxes_;
    std::vector<std::pair<int, int>> cluster_pairs_;
    std::vector<SelfPair> old_pairs_;  // that are contacts, of the list being made anew
    std::vector<Vec3> shortened_;
    Near near_first_, near_second_;
    long considered_ = 0;
};

}  // namespace percale
