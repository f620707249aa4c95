#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cloth_clusters.h"
#include "contact_pair.h"
#include "obstacle.h"

namespace percale {

using Obstacles = std::vector<std::unique_ptr<Obstacle>>;

/// The pairs of one cluster that can come closer than the thickness while its vertices stay in their boxes.
struct ClusterList {
    std::vector<Box> boxes;          // one for each of the cluster's vertices (ClothCluster::all_vertices)
    std::vector<ContactPair> pairs;  // by kind, cloth feature, obstacle, obstacle triangle
    double thickness = 0.0;          // m, largest of its vertices
    double travel = 0.0;             // m, bound of how much any distance has shrunk since the cluster's first list
    double least_reach = 0.0;        // least ContactPair::reach
    int version = -1;                // of the obstacles' motion it was built for
};

/// Verlet lists: candidate pairs of all cloth, rebuilt only where the cloth left its boxes or an obstacle moves.
class CandidateLists {
public:
    CandidateLists(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                   std::span<const Vec3> positions);

    /// Makes every list good for all states between two, and moves the lists' time to `move.from`. A move so long that its lists
    /// would not fit into memory is covered in part: returns the share of it, from its start, that the lists are good for.
    double cover(const ClothMove& move, const Obstacles& obstacles);

    /// Tells the lists that cloth and obstacles are here now: shortens the bounds by what they moved.
    void advance(std::span<const Vec3> positions, double fraction, const Obstacles& obstacles);

    std::span<const ClothCluster> clusters() const { return clusters_.clusters; }
    std::span<ClusterList> lists() { return lists_; }

private:
    bool covers(std::size_t cluster, const ClothMove& move, int version) const;
    Box set_boxes(std::size_t cluster, const ClothMove& move);
    void add_pairs(std::size_t cluster, int obstacle_number, std::span<const int> near, const ClothMove& move,
                   const Obstacle& obstacle);
    void set_rooms(std::size_t cluster, const ClothMove& move);
    std::span<const int> close_to(std::span<const int> vertices, std::span<const int> near, double thickness,
                                  const Obstacle& obstacle);
    bool rebuild(const ClothMove& move, const Obstacles& obstacles, bool whatever_it_takes);
    void mark_held();
    double shrink_of(std::size_t cluster, std::span<const Vec3> positions) const;

    std::vector<Triangle> triangles_;
    std::vector<double> thickness_;
    ClothClusters clusters_;
    std::vector<ClusterList> lists_;
    std::vector<Vec3> seen_;         // positions at the last advance
    std::vector<double> room_;       // m, how far a vertex can get from `from` inside its box; valid while a cluster is built
    std::vector<Box> vertex_boxes_;  // likewise
    std::vector<int> close_;         // triangles near the feature being paired
    std::vector<std::size_t> dirty_;
    std::vector<Box> asked_;
    std::vector<std::pair<std::size_t, ContactPair>> held_;  // of the lists being replaced, with their clusters
    TriangleLists found_;
    std::vector<Vec3> shortened_;  // the end of the part of a long move that is covered
    double seen_fraction_ = 0.0;
    long considered_ = 0;  // pairs, while lists are built
};

}  // namespace percale
