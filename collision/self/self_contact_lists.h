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
struct Island {
    std::vector<int> cloths;      // ascending, counted among those that meet cloth
    std::vector<SelfList> lists;  // by first, then second cluster, those without a pair, too
};

/// State of the lists that is kept from call to call. Later answers depend on nothing else but the cloth.
struct SelfListsState {
    std::vector<Vec3> start;      // m, positions at the start of the step
    std::vector<Vec3> seen;       // m, positions of the last cover
    std::vector<Box> rooms;       // m, of each cluster, from the centre of its island: no list is missing while it is in it
    std::vector<Island> islands;  // in the order of their first cloths; empty: no lists have been made
};

/// Candidate pairs of cloth against cloth, in islands of cloths that come near each other. A list of two clusters is valid until
/// they have moved far enough against each other from where they were when the step began, whatever others do and on whatever
/// path: the iterations of a step go to and fro. The set of lists is valid while each cluster stays in a box relative to the
/// centre of its island: the motion of an island as a whole does not matter.
class SelfContactLists {
public:
    SelfContactLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness, const SelfContact& cloth);

    /// Threads that share the work, or null; results do not depend on them.
    void set_workers(Workers* workers) { workers_ = workers; }

    /// Makes the lists valid for all states of the linear motion between two, and shrinks the bounds to `from`. A move so long
    /// that too many pairs would have to be considered is covered in part: returns that fraction of it, from its start.
    double cover(std::span<const Vec3> from, std::span<const Vec3> to);
    /// The same at the start of a step: it also gives up lists made for longer moves, and divides islands whose cloths are far
    /// apart again.
    double begin_step(std::span<const Vec3> from, std::span<const Vec3> to);

    /// Sets the motion for `shrink`.
    void set_motion(std::span<const Vec3> from, std::span<const Vec3> to);
    /// m, bound of how much distances of the list can shrink in the motion last given to set_motion.
    double shrink(const SelfList& list) const;

    const SelfListsState& memory() const { return memory_; }
    /// Continues from the state of other lists of the same cloth.
    void set_memory(SelfListsState memory) { memory_ = std::move(memory); }

    /// Calls `work(SelfList&)` for each list, in an order that follows from the islands.
    template <typename Work>
    void for_each(const Work& work) {
        for (Island& island : memory_.islands) {
            for (SelfList& list : island.lists) work(list);
        }
    }
    const SelfCloth& cloth() const { return cloth_; }
    const ClothSurface& surface() const { return cloth_.surface; }
    const ClothPairs& cloth_pairs() const { return cloth_.pairs; }
    std::size_t cloth_count() const { return near_cloths_.count(); }
    std::size_t cluster_count() const { return cloth_.clusters.size(); }
    /// The clusters of a cloth that meets cloth, ascending.
    std::span<const int> clusters(int cloth) const { return clusters_of_cloth_[cloth]; }

private:
    void add_clusters(int cloth, std::span<const int> triangles);
    void move_to(std::span<const Vec3> now);
    double cover_move(std::span<const Vec3> from, std::span<const Vec3> to);
    void rebuild_islands(std::span<const Vec3> from, std::span<const Vec3> to, bool may_part);
    void give_up_room(std::span<const Vec3> from, std::span<const Vec3> to);
    void give_up_lists_just_made();
    template <typename Work>
    void for_each_swept(const Island& island, std::span<const Vec3> from, std::span<const Vec3> to, const Work& work);
    bool set_rooms(const Island& island, std::span<const Vec3> from, std::span<const Vec3> to);
    Vec3 centre(const Island& island, std::span<const Vec3> positions) const;
    bool find_lists(Island& island, long max);
    SelfList take_list(Island& island, int first, int second);
    bool make_stale(std::span<const Vec3> from, long max);

    SelfCloth cloth_;
    std::vector<double> skin_;  // m, of each vertex
    NearCloths near_cloths_;
    std::vector<std::vector<int>> clusters_of_cloth_;
    ClusterTree tree_;
    SelfListsState memory_;
    std::vector<SelfList> loose_lists_, next_lists_;  // of islands that no longer exist; of the one being updated
    std::vector<SelfList*> stale_;                    // to be rebuilt
    std::vector<SelfListMaker> makers_;               // of each thread
    std::vector<long> considered_;                    // of each list of a round, how many pairs
    std::vector<char> left_;                          // of each cluster, whether it left its room
    Workers* workers_ = nullptr;
    std::vector<int> island_of_cloth_, tree_clusters_;
    std::vector<Box> tree_boxes_;
    std::vector<std::pair<int, int>> cluster_pairs_;
    std::vector<Vec3> shortened_;
};

}  // namespace percale
