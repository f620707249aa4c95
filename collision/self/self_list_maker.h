#pragma once

#include <limits>
#include <span>
#include <vector>

#include "geometry/box.h"
#include "geometry/cloth_surface.h"
#include "percale/cloth_pairs.h"
#include "self/self_pair.h"
#include "self/sewn_rest.h"

namespace percale {

/// Triangles of one cloth near each other at rest.
struct SelfCluster {
    std::vector<int> vertices, edges, triangles;  // owned
    std::vector<int> all_vertices;
    int cloth = -1;
    double thickness = 0.0;                                     // m, largest, those set for pairs of its cloth included
    double skin = 0.0;                                          // m, largest
    double shortest = std::numeric_limits<double>::infinity();  // m, edge at rest
    Vec3 mean = Vec3::Zero();                                   // m, of its vertices' displacements in a move
    double spread = 0.0;                                        // m, from the mean
    Box box;                                                    // m, where a move begins
    bool is_boxed = false, features_are_boxed = false;
};

/// m, bound of how much distances of two clusters can shrink in a move.
inline double shrink_of(const SelfCluster& a, const SelfCluster& b) { return a.spread + b.spread + (a.mean - b.mean).norm(); }

/// All cloth that meets cloth, as input for its lists.
struct SelfCloth {
    std::vector<double> thickness;  // m, of each vertex
    std::vector<int> cloth;
    ClothPairs pairs;
    std::vector<Vec3> rest;  // m
    ClothSurface surface;
    SewnRest sewn = {};
    std::vector<SelfCluster> clusters = {};
    std::vector<Box> vertex_boxes = {}, edge_boxes = {}, triangle_boxes = {};  // m, where a move begins

    /// Whether a vertex and a triangle can come into contact: they share no vertex, and no stitch joins them.
    bool meets(int vertex, int triangle) const;
    /// m, distance at rest through a seam near two features, given by their vertices; 0 where they are sewn together or overlap
    /// there, infinity without such a seam.
    double sewn_distance(std::span<const int> first, std::span<const int> second) const;
    /// Marks all boxes as unknown at the start of a move.
    void forget_boxes();
    void set_box(int cluster, std::span<const Vec3> positions);
    void set_feature_boxes(int cluster, std::span<const Vec3> positions);
};

/// The pairs of two clusters (or of one with itself) that can come into contact while the distances between their features have
/// shrunk by at most `room` since the start of the step for which the list was made.
struct SelfList {
    int first = 0, second = 0;  // clusters, first <= second
    std::vector<SelfPair> pairs = {};
    std::vector<SelfPairRecord> records = {};
    double travel = 0.0;          // m, bound of how much any distance has shrunk since the list was made, along the whole path
    double room = -1.0;           // m
    double used_room = 0.0;       // m, bound of how much any distance shrank from that step's start to the start of this one
    double smallest_reach = 0.0;  // smallest SelfPair::reach
    double thickness = 0.0;       // m, largest of its pairs

    /// m, activation distance of the contact of a pair of the list; 0: it is no contact.
    double activation_distance(const SelfPair& pair) const {
        return pair.record < 0 ? 0.0 : records[pair.record].activation_distance;
    }
    const std::array<double, 4>& seam_activation_distance(const SelfPair& pair) const {
        return pair.record < 0 ? away_from_seams : records[pair.record].seam_activation_distance;
    }
    /// The record of a pair of the list, which is made where it has none.
    SelfPairRecord& record_of(SelfPair& pair);

    /// Makes the list empty, to be filled.
    void begin(double with_room);
    /// Makes the list empty and frees its memory.
    void clear(double with_room);
    /// Keeps contacts alone: the list has to be rebuilt.
    void give_up();
};

/// Finds the pairs of lists. Each belongs to one thread.
class SelfListMaker {
public:
    /// Rebuilds the list of two boxed clusters: all pairs that can come into contact while the clusters move against each other
    /// by no more than the list's new room from the start of the step, where their features are boxed. Distances are those `now`.
    /// Contacts stay contacts. Returns the number of pairs considered.
    long fill(const SelfCloth& cloth, SelfList& list, std::span<const Vec3> start, std::span<const Vec3> now);

private:
    struct Near {
        std::vector<int> vertices, edges, triangles;
    };
    struct Reach {
        double room = 0.0;         // m, pairs whose distance is below their thickness plus this are kept
        double thickness = 0.0;    // m, upper bound of all pairs
        bool rest_counts = false;  // of one cloth, so fine that the distance at rest bounds most thicknesses

        double limit() const { return thickness + room; }
    };

    void find_near(const SelfCluster& cluster, Box other, double limit, Near& near) const;
    void pair_vertices(const Near& points, const Near& faces, Reach reach, std::span<const Vec3> start);
    void pair_edges(bool one, Reach reach, std::span<const Vec3> start);
    void set_seam_activation_distance(SelfPair& pair, std::array<double, 4>& seam_activation_distance) const;
    double thickness_by_rest(std::span<const int> first, std::span<const int> second, double max) const;
    void consider(SelfPair pair, double room, std::span<const Vec3> start);
    void take_over_activation_distances();

    const SelfCloth* cloth_ = nullptr;
    ClothPair pair_;                       // of the clusters
    SelfList old_;                         // the contacts of the list being rebuilt
    std::vector<SelfPair> pairs_;          // found for it
    std::vector<SelfPairRecord> records_;  // of these
    Near near_first_, near_second_;
    long considered_ = 0;
};

}  // namespace percale
