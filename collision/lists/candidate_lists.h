#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "geometry/cloth_clusters.h"
#include "geometry/stretches.h"
#include "lists/contact_pair.h"
#include "obstacle/obstacle.h"
#include "tolerances.h"

namespace percale {

using Obstacles = std::vector<std::unique_ptr<Obstacle>>;

/// The next number below in single precision, or one near it.
inline float below(double x) { return static_cast<float>(x - tolerances::rounded_off * std::abs(x)); }

/// The next number above in single precision, or one near it.
inline float above(double x) { return static_cast<float>(x + tolerances::rounded_off * std::abs(x)); }

/// A pack of obstacle features that can come near a cloth feature.
struct ListedPack {
    int feature = 0;            // of the cluster's list
    unsigned number : 24 = 0;   // of the pack, among those of the feature's obstacle
    unsigned standing : 8 = 0;  // lanes that have been contacts since the last refresh: they stay so while they are near
};

/// The packs of a cluster, in the order of its features, with lower bounds that the list's travel uses up. Each bound has an
/// array of its own, because it is all that is read of packs that stay away.
struct ListedPacks {
    std::vector<float> reach;  // m, smallest distance bound + travel when last measured: reach - travel is below all distances
    std::vector<float> wake;   // m, while travel is below this, no pair of the pack is a row
    std::vector<ListedPack> at;

    std::size_t size() const { return reach.size(); }
    void clear();
    void add(int cloth_feature, int number, double apart, double thickness);
    /// Nothing of the pack is nearer than `distance_bound`, and travel must grow by `to_contact` before anything new can be a
    /// contact.
    void raise(std::size_t i, double distance_bound, double to_contact, double thickness, double travel) {
        reach[i] = std::max(reach[i], below(distance_bound + travel));
        const float near = below(static_cast<double>(reach[i]) - thickness);
        wake[i] = std::max(wake[i], at[i].standing != 0 ? near : std::max(near, below(to_contact + travel)));
    }
    void activate(std::size_t i, unsigned lane, double thickness);
};

/// Versions of lists that were read from bytes, where the obstacles' own are not known: good for the obstacles where they are, or
/// for no place.
constexpr int good_version = 0, no_version = -1;

/// All packs of obstacle features that can come closer to a cluster than the thickness while its vertices stay in their boxes.
struct ClusterList {
    std::vector<Box> boxes;             // one for each of the cluster's vertices (ClothCluster::all_vertices)
    std::vector<ContactPair> features;  // by obstacle, kind, cloth feature; without an obstacle feature
    ListedPacks packs;
    double thickness = 0.0;       // m, largest of its vertices
    double travel = 0.0;          // m, bound of how much any distance has shrunk since the list was made
    double cloth_travel = 0.0;    // m, bound of how far any of its vertices has gone since then
    Vec3 drift = Vec3::Zero();    // m, displacement of the listed patches during the step, all of whose vertices
    double spread = 0.0;          // m, go so far within this
    double smallest_reach = 0.0;  // smallest ListedPacks::reach
    double quiet_until = 0.0;     // smallest ListedPacks::wake
    double inside_until = -1.0;   // m, cloth_travel up to which all vertices are surely in their boxes
    bool has_standing = false;    // some lane is standing
    int version = no_version;     // of the obstacles' motion it was built for
};

/// Tells all poses that the obstacles have had so far from any others.
int total_version(const Obstacles& obstacles);

/// What lists remember from call to call. Later answers depend on nothing else but the cloth and the obstacles.
struct ListsMemory {
    std::vector<ClusterList> lists;  // of each cluster
    std::vector<Vec3> seen;          // m, positions at the last advance
    double seen_fraction = 0.0;
    std::vector<Vec3> anchor;       // m, positions from which nothing is in reach before some vertex has gone `room`
    double room = 0.0;              // m
    int room_version = no_version;  // of the obstacles' motion
    bool empty = true;              // nothing is near any cluster
};

/// Verlet lists: candidates of all cloth, rebuilt only where the cloth left its boxes or an obstacle moves.
class CandidateLists {
public:
    CandidateLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                   std::span<const Vec3> positions);

    /// Lists that go on from what others of the same cloth remember, with their clusters. `settle` is called before all else.
    CandidateLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness, ClothClusters clusters,
                   ListsMemory memory);
    /// Gives lists with good_version the version of the obstacles, which are where they were.
    void settle(const Obstacles& obstacles);
    const ListsMemory& memory() const { return memory_; }
    ListsMemory& memory() { return memory_; }

    /// Makes every list good for all states between two, and moves the lists' time to `move.from`. A move so long that its lists
    /// would not fit into memory is covered in part: returns the fraction of it, from its start, that the lists are good for.
    double cover(const ClothMove& move, const Obstacles& obstacles, Workers* workers = nullptr);

    /// Tells the lists that cloth and obstacles are here now: shortens the bounds by what they moved.
    void advance(std::span<const Vec3> positions, double fraction, const Obstacles& obstacles, Workers* workers = nullptr);

    /// Nothing is near any cluster.
    bool empty() const { return memory_.empty; }
    const ClothClusters& clusters() const { return clusters_; }
    std::span<ClusterList> lists() { return memory_.lists; }
    /// m, by how much a move brings any vertex of a cluster, and any listed obstacle, nearer to each other at most.
    double approach(std::size_t cluster, const ClothMove& move) const;
    /// Contacts of cloth features of which a vertex has `moved` are no standing ones any more.
    void forget_standing(std::span<const unsigned char> moved);
    /// Sets the smallest bounds of a list whose packs' bounds have changed.
    static void set_smallest_bounds(ClusterList& list);

private:
    std::span<const int> vertices_of(std::size_t cluster) const {
        return std::span(vertices_).subspan(vertex_start_[cluster], vertex_start_[cluster + 1] - vertex_start_[cluster]);
    }
    /// What a cluster's list is built with.
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
    void collect_standing(std::size_t cluster, const Obstacles& obstacles);
    void activate_again(const Obstacles& obstacles);
    void activate(ClusterList& list, std::size_t feature, int place) const;
    bool is_out_of_reach(const ClothMove& move, const Obstacles& obstacles, int version);
    void advance_list(std::size_t cluster, double part);
    void set_displacements(const ClothMove& move, Workers* workers);

    std::vector<Triangle> triangles_;
    std::vector<double> thickness_;
    ClothClusters clusters_;
    std::vector<int> vertex_start_, vertices_;  // all vertices of each cluster, one after the other
    ListsMemory memory_;
    std::vector<double> displacement_, cluster_displacement_;  // m
    bool displaced_ = false;                                   // one of them may not be 0
    std::vector<double> moved_;                                // m^2, since the last advance
    std::vector<Vec3> gone_;                                   // m, likewise, where obstacles move
    std::vector<double> most_moved_;                           // m^2, of stretches of vertices
    std::vector<Build> builds_;                                // one a slot
    std::vector<std::size_t> dirty_;
    std::vector<unsigned char> uncovered_;  // clusters
    std::vector<Box> asked_;
    std::vector<std::pair<std::size_t, ContactPair>> standing_pairs_;  // of the lists being replaced, with their clusters
    std::vector<IdLists> found_;                                       // of each obstacle
    std::vector<Vec3> shortened_;                                      // the end of the part of a long move that is covered
};

}  // namespace percale
