#include "lists/obstacle_terms.h"

namespace percale {
namespace {

/// The faces of an obstacle at a fraction of the step.
class PlacedSurface {
public:
    PlacedSurface(const Obstacle& obstacle, double fraction)
        : obstacle_(obstacle), surface_(obstacle.surface()), fraction_(fraction) {}

    Vec3 at(int vertex) const { return obstacle_.at(vertex, fraction_); }
    const Triangle& corners(int face) const { return surface_.triangles[face]; }
    int edge(int face, int k) const { return surface_.triangle_edges[face][k]; }
    bool owns_edge(int face, int edge) const { return surface_.edges[edge].owner == face; }
    bool owns_vertex(int face, int vertex) const { return surface_.vertex_owner[vertex] == face; }

    template <class Work>
    void for_faces(int edge, Work work) const {
        for (const int opposite : surface_.opposites(edge)) work(opposite);
    }
    template <class Work>
    void for_edges(int vertex, Work work) const {
        const std::span<const int> others = surface_.neighbours(vertex), edges = surface_.edges_at(vertex);
        for (std::size_t i = 0; i < others.size(); ++i) work(edges[i], others[i]);
    }

private:
    const Obstacle& obstacle_;
    const ObstacleSurface& surface_;
    double fraction_;
};

}  // namespace

SurfaceTerms obstacle_terms(const ContactPair& pair, std::span<const Vec3> cloth, const Obstacle& obstacle, double fraction,
                            double thickness) {
    const PlacedSurface surface(obstacle, fraction);
    return SurfaceTermFinder(surface, pair.feature, cloth[pair.cloth[0]], thickness).find();
}

}  // namespace percale
