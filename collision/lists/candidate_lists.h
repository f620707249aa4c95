#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "geometry/chunks.h"
#include "geometry/cloth_clusters.h"
#include "lists/contact_pair.h"
#include "obstacle/obstacle.h"

namespace percale {

/// Fraction of a number. A bound in single precision is moved this far to be surely below, or above, the double that it stands
/// for. See `rounded_up`.
inline constexpr double rounded_off = 1e-6;

using Obstacles = std::vector<std::unique_ptr<Obstacle>>;

/// The largest number below x in single precision, or one near it.
inline float below(double x) { return static_cast<float>(x - rounded_off * std::abs(x)); }

/// The smallest number above x in single precision, or one near it.
inline float above(double x) { return static_cast<float>(x + rounded_off * std::abs(x)); }

/// A pack of obstacle features that can come near a cloth feature.
struct ListedPack {
    int feature = 0;              // of the cluster's list
    unsigned number : 24 = 0;     // of the pack, among those of the feature's obstacle
    unsigned persistent : 8 = 0;  // one bit a lane: it has been a contact and stays one while it is near. update_candidates
                                  // clears it where a vertex has moved by more than 0.1 h, and all bits if an obstacle moves
};

/// The packs of a cluster, in the order of its features, with lower bounds that the list's travel uses up. Each bound has an
/// array of its own, because nothing else is read of packs that stay away.
struct ListedPacks {
    std::vector<float> reach;  // m, smallest distance bound + travel when last measured: reach - travel is below all distances
    std::vector<float> wake;   // m, a value of travel: while travel is below it, no pair of the pack is a contact
    std::vector<ListedPack> at;

    std::size_t size() const { return reach.size(); }
    void clear();
    void add(int cloth_feature, int number, double apart, double thickness);
    /// Nothing of the pack is nearer than `distance_bound`, and travel must grow by `to_contact` before anything new can be a
    /// contact.
    void raise(std::size_t i, double distance_bound, double to_contact, double thickness, double travel) {
        reach[i] = std::max(reach[i], below(distance_bound + travel));
        const float near = below(static_cast<double>(reach[i]) - thickness);
        wake[i] = std::max(wake[i], at[i].persistent != 0 ? near : std::max(near, below(to_contact + travel)));
    }
    void make_persistent(std::size_t i, unsigned lane, double thickness);
};

/// Placeholders for the version of lists that were read from bytes (CandidateLists::settle): valid for the saved poses of the
/// obstacles, or invalid.
constexpr int good_version = 0, no_version = -1;

/// All packs of obstacle features that can come closer to a cluster than the thickness while its vertices stay in their boxes.
struct ClusterList {
    std::vector<Box> boxes;             // one for each of the cluster's vertices (ClothCluster::all_vertices)
    std::vector<ContactPair> features;  // by obstacle, kind, cloth feature; without an obstacle feature
    ListedPacks packs;
    double thickness = 0.0;       // m, largest of its vertices
    double travel = 0.0;          // m, bound of how much any distance has shrunk since the list was made
    double cloth_travel = 0.0;    // m, bound of how far any of its vertices has gone since then
    Vec3 drift = Vec3::Zero();    // m, centre of the box of the listed patches' mean displacements in the step
    double spread = 0.0;          // m, bound of the deviation of their vertices' displacements from it
    double smallest_reach = 0.0;  // m, smallest ListedPacks::reach
    double quiet_until = 0.0;     // m, a value of travel: smallest ListedPacks::wake
    double inside_until = -1.0;   // m, a value of cloth_travel, up to which all vertices are certainly in their boxes
    bool has_persistent = false;  // some lane is persistent
    int version = no_version;     // of the obstacles' motion it was built for
};

/// A number that distinguishes all poses that the obstacles have had so far from any others.
int total_version(const Obstacles& obstacles);

/// State of the lists that is kept from call to call. Later answers depend on nothing else but the cloth and the obstacles.
struct CandidateListsState {
    std::vector<ClusterList> lists;  // of each cluster
    std::vector<Vec3> seen;          // m, positions at the last advance
    double seen_fraction = 0.0;
    std::vector<Vec3> anchor;       // m, positions from which no obstacle is near before some vertex has moved by `room`
    double room = 0.0;              // m
    int room_version = no_version;  // of the obstacles' motion
    bool empty = true;              // nothing is near any cluster
};

/// Verlet lists: candidates of all cloth, which are rebuilt only where the cloth left its boxes or an obstacle moves.
class CandidateLists {
public:
    CandidateLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                   std::span<const Vec3> positions);

    /// Lists that continue from the state of others of the same cloth, with their clusters. `settle` is called before anything
    /// else.
    CandidateLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness, ClothClusters clusters,
                   CandidateListsState memory);
    /// Gives lists with good_version the version of the obstacles, whose places are those that were saved.
    void settle(const Obstacles& obstacles);
    const CandidateListsState& memory() const { return memory_; }
    CandidateListsState& memory() { return memory_; }

    /// Makes every list valid for all states between two, and moves the lists' time to `move.from`. A move so long that its lists
    /// would not fit into memory is covered in part: returns the fraction of it, from its start, for which the lists are valid.
    double cover(const ClothMove& move, const Obstacles& obstacles, Workers* workers = nullptr);

    /// Moves the lists to these positions of cloth and obstacles: the bounds shrink by the displacements.
    void advance(std::span<const Vec3> positions, double fraction, const Obstacles& obstacles, Workers* workers = nullptr);

    /// Whether nothing is near any cluster.
    bool empty() const { return memory_.empty; }
    const ClothClusters& clusters() const { return clusters_; }
    std::span<ClusterList> lists() { return memory_.lists; }
    /// m, upper bound of how much nearer a move brings any vertex of a cluster and any listed obstacle to each other.
    double approach(std::size_t cluster, const ClothMove& move) const;
    /// Contacts of cloth features of which a vertex is marked in `moved` are no longer persistent.
    void forget_persistent(std::span<const unsigned char> moved);
    /// Sets the smallest bounds of a list whose packs' bounds have changed.
    static void set_smallest_bounds(ClusterList& list);

private:
    std::span<const int> vertices_of(std::size_t cluster) const {
        return std::span(vertices_).subspan(vertex_start_[cluster], vertex_start_[cluster + 1] - vertex_start_[cluster]);
    }
    /// Work space to build a cluster's list.
    struct Build {
        std::vector<Box> vertex_boxes;     // of the cluster's vertices
        std::span<const int> patches;      // near it, ascending
        long listed = 0;                   // packs so far
        std::vector<PatchMotion> motions;  // of patches with listed packs
    };

    bool covers(std::size_t cluster, const ClothMove& move, int version);
    Box set_boxes(std::size_t cluster, const ClothMove& move);
    void add_features(std::size_t cluster, int obstacle_number, const ClothMove& move, Obstacle& obstacle, Build& build);
    void add_packs(const ContactPair& pair, const ClothMove& move, Obstacle& obstacle, ClusterList& list, Build& build);
    void find_dirty(const ClothMove& move, int version, Workers* workers);
    bool rebuild(const ClothMove& move, const Obstacles& obstacles, bool whatever_it_takes, Workers* workers);
    void build_list(std::size_t dirty, const ClothMove& move, const Obstacles& obstacles, Build& build);
    void empty_dirty(const ClothMove& move);
    void collect_persistent(std::size_t cluster, const Obstacles& obstacles);
    void restore_persistent(const Obstacles& obstacles);
    void make_persistent(ClusterList& list, std::size_t feature, int place) const;
    bool is_far_from_obstacles(const ClothMove& move, const Obstacles& obstacles, int version);
    void advance_list(std::size_t cluster, double part);
    void set_displacements(const ClothMove& move, Workers* workers);

    std::vector<Triangle> triangles_;
    std::vector<double> thickness_;
    ClothClusters clusters_;
    std::vector<int> vertex_start_, vertices_;  // all vertices of each cluster, one after the other
    CandidateListsState memory_;
    std::vector<double> displacement_, cluster_displacement_;  // m
    bool displaced_ = false;                                   // one of them may not be 0
    std::vector<double> moved_;                                // m^2, since the last advance
    std::vector<Vec3> gone_;                                   // m, likewise, where obstacles move
    std::vector<double> max_moved_;                            // m^2, of chunks of vertices
    std::vector<Build> builds_;                                // one a slot
    std::vector<std::size_t> dirty_;
    std::vector<unsigned char> uncovered_;  // clusters
    std::vector<Box> query_boxes_;
    std::vector<std::pair<std::size_t, ContactPair>> persistent_pairs_;  // of the lists being replaced, with their clusters
    std::vector<IdLists> found_;                                         // of each obstacle
    std::vector<Vec3> shortened_;                                        // the end of the part of a long move that is covered
};

}  // namespace percale
