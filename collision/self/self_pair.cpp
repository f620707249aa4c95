#include "self/self_pair.h"

#include <algorithm>
#include <cmath>

#include "geometry/triangle_distance.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Sine (17 degrees). Edges whose closest points are interior are in contact below h where all faces beside them fall away by as
/// much, below h/2 where they are flat, as vertices meet faces there, and not where one rises by as much; in between the ratio is
/// linear. Smaller: cloth that bends a little gains and loses such contacts, and never comes to rest. Larger: ridges are no
/// contacts, or one contact counts twice.
constexpr double sharp_sine = 0.3;

/// Sine (2 degrees). Edges at smaller angles have no contact of their own, but their ends have; the activation distance grows to
/// all of h at twice the sine. 0: closest points jump from end to end of parallel threads.
constexpr double min_crossing_sine = 0.03;

/// Fraction of h, the thickness of the pair. Two edges of which the shorter rises by more over its length have a contact at any
/// angle: the ends may be too far apart to hold them. Larger: long edges approach slowly until the clamp stops them for good.
/// Smaller: closest points jump.
constexpr double min_crossing_rise = 0.2;

PointTriangle vertex_on_face(const SelfPair& pair, std::span<const Vec3> x) {
    return closest_on_triangle(x[pair.vertex[0]], x[pair.vertex[1]], x[pair.vertex[2]], x[pair.vertex[3]]);
}

EdgeEdge edge_on_edge(const SelfPair& pair, std::span<const Vec3> x) {
    return closest_on_edges(x[pair.vertex[0]], x[pair.vertex[1]], x[pair.vertex[2]], x[pair.vertex[3]]);
}

void set_direction(const Vec3& apart, SelfPairContact& contact) {
    contact.distance = apart.norm();
    if (contact.distance > 0.0) contact.direction = apart / contact.distance;
}

/// Whether cloth from `foot` to a neighbouring vertex falls away from the direction `towards`, up to rounding, so that above an
/// edge of flat cloth at least one triangle represents the contact.
bool falls(const Vec3& neighbour, const Vec3& foot, const Vec3& towards) {
    const Vec3 along = neighbour - foot;
    return along.dot(towards) <= tolerances::rising_sine * along.norm();
}

bool edge_represents(const ClothSurface& surface, int triangle, int edge_index, const Vec3& foot, const Vec3& towards,
                     std::span<const Vec3> x) {
    const ClothSurface::Edge& edge = surface.edges[edge_index];
    if (edge.triangle[0] != triangle) return false;
    return edge.triangle[1] < 0 || falls(x[edge.opposite[1]], foot, towards);
}

bool vertex_represents(const ClothSurface& surface, int triangle, int vertex, const Vec3& towards, std::span<const Vec3> x) {
    if (surface.vertex_owner[vertex] != triangle) return false;
    const std::span<const int> ring = surface.neighbours(vertex);
    return std::all_of(ring.begin(), ring.end(), [&](int next) { return falls(x[next], x[vertex], towards); });
}

SelfPairContact vertex_face(const SelfPair& pair, std::span<const Vec3> x, const ClothSurface& surface) {
    const PointTriangle closest = vertex_on_face(pair, x);
    SelfPairContact contact{.weight = {1.0, -closest.weight[0], -closest.weight[1], -closest.weight[2]}};
    set_direction(x[pair.vertex[0]] - closest.point, contact);
    const int triangle = pair.feature[1];
    bool represents = true;
    if (closest.region == TriangleRegion::edge) {
        const int edge = surface.triangle_edges[triangle][closest.corner];
        represents = edge_represents(surface, triangle, edge, closest.point, contact.direction, x);
    } else if (closest.region == TriangleRegion::vertex) {
        const int corner = pair.vertex[1 + closest.corner];
        // If two vertices are closest, the one with the lower number is the vertex, the other the corner of a face.
        represents = pair.vertex[0] < corner && vertex_represents(surface, triangle, corner, contact.direction, x);
    }
    contact.activation_ratio = represents ? 1.0 : 0.0;
    return contact;
}

/// Activation ratio of an edge whose closest point `foot` to another edge, in the direction `towards`, is inside: 1 for a ridge
/// or boundary, 1/2 in flat cloth, 0 in a valley, and linear in between, by the steepest rise of the faces beside it.
double edge_activation_ratio(const ClothSurface::Edge& edge, const Vec3& foot, const Vec3& towards, std::span<const Vec3> x) {
    if (edge.opposite[1] < 0) return 1.0;
    double highest = -sharp_sine;
    for (const int vertex : edge.opposite) {
        const Vec3 along = x[vertex] - foot;
        highest = std::max(highest, along.dot(towards) / along.norm());  // not where 0/0
    }
    return 0.5 * std::max(0.0, 1.0 - highest / sharp_sine);
}

/// |e x f|^2 = (|e| |f| sin)^2 of two edges up to which they count as parallel, from |e|^2, |f|^2 and their thickness.
double square_of_parallel(double first, double second, double thickness) {
    const double sine = min_crossing_sine, rise = min_crossing_rise * thickness;
    return std::min(sine * sine * first * second, rise * rise * std::max(first, second));
}

SelfPairContact edge_edge(const SelfPair& pair, std::span<const Vec3> x, const ClothSurface& surface) {
    const EdgeEdge closest = edge_on_edge(pair, x);
    const double s = closest.s, t = closest.t;
    const Vec3 &a = x[pair.vertex[0]], &b = x[pair.vertex[1]], &c = x[pair.vertex[2]], &d = x[pair.vertex[3]];
    SelfPairContact contact{.weight = {1.0 - s, s, t - 1.0, -t}};
    const Vec3 first = a + s * (b - a), second = c + t * (d - c);
    set_direction(first - second, contact);
    if (contact.distance >= pair.thickness) return contact;
    const double parallel = square_of_parallel((b - a).squaredNorm(), (d - c).squaredNorm(), pair.thickness),
                 square = (b - a).cross(d - c).squaredNorm();
    contact.crossing = square > parallel ? std::min(1.0, std::sqrt(square / parallel) - 1.0) : 0.0;
    if (contact.crossing == 0.0 || s <= 0.0 || s >= 1.0 || t <= 0.0 || t >= 1.0) return contact;
    contact.activation_ratio =
        contact.crossing * std::min(edge_activation_ratio(surface.edges[pair.feature[0]], first, -contact.direction, x),
                                    edge_activation_ratio(surface.edges[pair.feature[1]], second, contact.direction, x));
    return contact;
}

}  // namespace

double activation_distance_at(const SelfPair& pair, const std::array<double, 4>& seam_activation_distance,
                              const std::array<double, 4>& weight) {
    const std::array<double, 4>&w = weight, &at = seam_activation_distance;
    if (at[0] == no_seam) return pair.thickness;
    const double between = pair.shape == PairShape::edge_edge
                               ? -w[0] * (w[2] * at[0] + w[3] * at[1]) - w[1] * (w[2] * at[2] + w[3] * at[3])
                               : -w[1] * at[0] - w[2] * at[1] - w[3] * at[2];
    return std::min(pair.thickness, between);
}

double self_distance(const SelfPair& pair, std::span<const Vec3> positions) {
    const bool edges = pair.shape == PairShape::edge_edge;
    return std::sqrt(edges ? edge_on_edge(pair, positions).distance_squared : vertex_on_face(pair, positions).distance_squared);
}

SelfPairContact self_contact(const SelfPair& pair, std::span<const Vec3> positions, const ClothSurface& surface) {
    return pair.shape == PairShape::edge_edge ? edge_edge(pair, positions, surface) : vertex_face(pair, positions, surface);
}

MovingFour moving_pair(const SelfPair& pair, std::span<const Vec3> from, std::span<const Vec3> to) {
    MovingFour four;
    for (int k = 0; k < 4; ++k) {
        four.from[k] = from[pair.vertex[k]];
        four.to[k] = to[pair.vertex[k]];
    }
    return four;
}

}  // namespace percale
