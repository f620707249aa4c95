#include "self/vertex_terms.h"

namespace percale {
namespace {

/// The faces of cloth that a vertex meets.
class MetSurface {
public:
    MetSurface(int vertex, std::span<const Vec3> x, const SelfCloth& cloth)
        : vertex_(vertex), x_(x), cloth_(cloth), surface_(cloth.surface) {}

    const Vec3& at(int vertex) const { return x_[vertex]; }
    const Triangle& corners(int face) const { return surface_.triangles[face]; }
    int edge(int face, int k) const { return surface_.triangle_edges[face][k]; }

    bool owns_edge(int face, int edge) const {
        const auto& [first, second] = surface_.edges[edge].triangle;
        return face == first || (face == second && !meets(first));
    }
    bool owns_vertex(int face, int vertex) const {
        const int lowest = surface_.vertex_owner[vertex];
        if (face == lowest || meets(lowest)) return face == lowest;
        int owner = face;
        for (const int edge : surface_.edges_at(vertex)) {
            for (const int other : surface_.edges[edge].triangle) {
                if (other < owner && meets(other)) owner = other;
            }
        }
        return owner == face;
    }

    template <class Work>
    void for_faces(int edge, Work work) const {
        const ClothSurface::Edge& of = surface_.edges[edge];
        for (int side = 0; side < 2; ++side) {
            if (meets(of.triangle[side])) work(of.opposite[side]);
        }
    }
    template <class Work>
    void for_edges(int vertex, Work work) const {
        for (const int edge : surface_.edges_at(vertex)) {
            const auto& [a, b] = surface_.edges[edge].vertex;
            work(edge, a == vertex ? b : a);
        }
    }

private:
    bool meets(int face) const { return face >= 0 && cloth_.meets(vertex_, face); }

    int vertex_;
    std::span<const Vec3> x_;
    const SelfCloth& cloth_;
    const ClothSurface& surface_;
};

}  // namespace

SurfaceTerms vertex_terms(const SelfPair& pair, std::span<const Vec3> positions, const SelfCloth& cloth) {
    const int vertex = pair.vertex[0];
    return SurfaceTermFinder(MetSurface(vertex, positions, cloth), pair.feature[1], positions[vertex], pair.thickness).find();
}

}  // namespace percale
