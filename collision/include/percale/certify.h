#pragma once

#include <atomic>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "percale/certificate_mesh.h"
#include "percale/cloth_pairs.h"
#include "percale/mesh.h"
#include "percale/stitch.h"

namespace percale {

/// Two triangles that intersect.
struct IntersectingPair {
    int first = -1;   // triangle of the first mesh (the cloth)
    int second = -1;  // triangle of the second mesh (the obstacle)
};

/// What the independent check of one cloth against one obstacle found.
struct Certificate {
    std::vector<IntersectingPair> pairs;  // intersecting, not merely touching; ordered
    int touching_pairs = 0;               // pairs that share points but do not cross
    bool watertight = false;              // whether the obstacle is closed, so that depth has a meaning
    int vertices_inside = 0;              // cloth vertices inside a watertight obstacle
    std::vector<int> inside_vertices;     // these, ascending
    int deepest_vertex = -1;
    double deepest_penetration = 0.0;                                    // m; 0 on an open obstacle
    double smallest_distance = std::numeric_limits<double>::infinity();  // m, cloth to obstacle, 0 where they intersect

    bool clean() const { return pairs.empty() && vertices_inside == 0; }
};

/// Thrown where the caller cancelled a certificate.
class CertificateCancelled : public std::runtime_error {
public:
    CertificateCancelled() : std::runtime_error("the certificate was cancelled") {}
};

/// An exact check that shares no code with the solver: triangle-triangle tests by exact predicates, signed depth of every cloth
/// vertex, smallest distance between the surfaces (searched up to `distance_limit`, m; beyond it stays infinity). Both meshes in
/// world coordinates, finite. Thread-safe. Throws CertificateCancelled soon after `cancel`, where there is one, has become true.
Certificate certify(const CertificateMesh& cloth, const CertificateMesh& obstacle,
                    double distance_limit = std::numeric_limits<double>::infinity(), const std::atomic<bool>* cancel = nullptr);
Certificate certify(const TriangleMesh& cloth, const TriangleMesh& obstacle,
                    double distance_limit = std::numeric_limits<double>::infinity(), const std::atomic<bool>* cancel = nullptr);

/// Distance of each point from a mesh's surface, m; negative inside a watertight mesh. Exact apart from rounding. All in world
/// coordinates, finite. Thread-safe. `cancel`: as of certify.
std::vector<double> surface_distances(const TriangleMesh& mesh, std::span<const Vec3> points,
                                      const std::atomic<bool>* cancel = nullptr);

/// Intersections of cloth with itself, all its pieces taken as one mesh.
struct ClothCertificate {
    std::vector<IntersectingPair> crossing;  // first < second, ordered; neighbours that share vertices included
    std::vector<IntersectingPair> touching;  // that share a point though no vertex, and do not cross
    std::vector<IntersectingPair> at_seams;  // crossing pairs of triangles at one stitch; in neither of the other lists
};

/// An exact check with the triangle-triangle tests of certify, which shares no code with the solver. Neighbours cross where they
/// share more than their common vertices, edge or points. Triangles at one stitch (each has a vertex of it) are counted
/// separately, since how far they cross depends on its gap and on how the sides of the seam are divided. Triangles of cloths that
/// do not meet (`meeting`) are not tested. Thread-safe. `cancel`: as of certify.
ClothCertificate certify_cloth(const CertificateMesh& cloth, std::span<const Stitch> stitches = {},
                               const MeetingCloth& meeting = {}, const std::atomic<bool>* cancel = nullptr);
ClothCertificate certify_cloth(const TriangleMesh& cloth, std::span<const Stitch> stitches = {}, const MeetingCloth& meeting = {},
                               const std::atomic<bool>* cancel = nullptr);

/// Crossing pairs of one mesh, as far as they were searched for.
struct CrossingSearch {
    std::vector<IntersectingPair> pairs;  // first < second, ordered
    bool complete = true;                 // false: one of the limits was reached
};

/// The crossing pairs of certify_cloth, at most `most_pairs` of them, from at most `most_tests` tests of two triangles, so that
/// no mesh takes long: a fan of n triangles around one vertex alone needs n^2/2 tests. Thread-safe.
CrossingSearch find_crossings(const TriangleMesh& mesh, long most_pairs, long most_tests);

/// Intersecting pairs inside one mesh, neighbours that share a vertex left out.
std::vector<IntersectingPair> self_intersections(const TriangleMesh& mesh);

}  // namespace percale
