#pragma once

#include <span>
#include <utility>
#include <vector>

#include "geometry/cloth_clusters.h"
#include "percale/contact.h"
#include "self/cluster_tree.h"
#include "self/near_cloths.h"
#include "self/self_list_maker.h"

namespace percale {

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

    /// Threads that share the work, or null; what is found does not depend on them.
    void set_workers(Workers* workers) { workers_ = workers; }

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
    const ClothSurface& surface() const { return cloth_.surface; }
    const ClothPairs& cloth_pairs() const { return cloth_.pairs; }
    std::size_t cloth_count() const { return near_cloths_.count(); }
    std::size_t cluster_count() const { return cloth_.clusters.size(); }
    /// Of a cloth that meets cloth, ascending.
    std::span<const int> clusters(int cloth) const { return clusters_of_cloth_[cloth]; }

private:
    void add_clusters(int cloth, std::span<const int> triangles);
    void move_to(std::span<const Vec3> from);
    double cover_move(std::span<const Vec3> from, std::span<const Vec3> to);
    void regroup(std::span<const Vec3> from, std::span<const Vec3> to, bool may_part);
    void give_up_room(std::span<const Vec3> from, std::span<const Vec3> to);
    void give_up_lists_just_made();
    template <typename Work>
    void for_each_swept(const SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to, const Work& work);
    bool set_rooms(const SelfGroup& group, std::span<const Vec3> from, std::span<const Vec3> to);
    Vec3 centre(const SelfGroup& group, std::span<const Vec3> positions) const;
    bool find_lists(SelfGroup& group, long most);
    SelfList take_list(SelfGroup& group, int first, int second);
    bool make_stale(std::span<const Vec3> from, long most);

    SelfCloth cloth_;
    std::vector<double> skin_;  // m, of each vertex
    NearCloths near_cloths_;
    std::vector<std::vector<int>> clusters_of_cloth_;
    ClusterTree tree_;
    SelfListsMemory memory_;
    std::vector<SelfList> loose_lists_, next_lists_;  // of groups that are no more; of the one being updated
    std::vector<SelfList*> stale_;                    // to be made anew
    std::vector<SelfListMaker> makers_;               // of each thread
    std::vector<long> considered_;                    // of each list of a round, how many pairs
    std::vector<char> left_;                          // of each cluster, whether it left its room
    Workers* workers_ = nullptr;
    std::vector<int> group_of_cloth_, tree_clusters_;
    std::vector<Box> tree_boxes_;
    std::vector<std::pair<int, int>> cluster_pairs_;
    std::vector<Vec3> shortened_;
};

}  // namespace percale
