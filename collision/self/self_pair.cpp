#include "self/self_pair.h"

#include <algorithm>
#include <cmath>

#include "geometry/triangle_distance.h"

namespace percale {
namespace {

/// Sine (17 degrees). Edges whose closest points are interior are in contact below h where all faces beside them fall away by as
/// much, below flat_edge_ratio h where they are flat, as vertices meet faces there, and not where one rises by as much; in
/// between the ratio is linear. Smaller: cloth that bends a little gains and loses such contacts, and never comes to rest.
/// Larger: ridges are no contacts, or one contact counts twice.
constexpr double sharp_sine = 0.3;
/// Smaller: a sheet sinks in between the vertices of one that ends below it. 1: edges of flat sheets, which cross at other places
/// with every move, carry load.
constexpr double flat_edge_ratio = 0.75;

/// Sine (2 degrees). Edges at smaller angles have no contact of their own, but their ends have; the activation distance grows to
/// all of h at twice the sine. 0: closest points jump from end to end of parallel threads.
constexpr double min_crossing_sine = 0.03;

/// Fraction of h, the thickness of the pair. Two edges of which the shorter rises by more over its length have a contact at any
/// angle: the ends may be too far apart to hold them. Larger: long edges approach slowly until the clamp stops them for good.
/// Smaller: closest points jump.
constexpr double min_crossing_rise = 0.2;

/// How far from its ends an edge's contact is faded: fractions of the thickness and of its length, the smaller counts. Larger:
/// sheets come closer where their ridges cross near a vertex. 0: stacks whose corners meet tremble for ever.
constexpr double end_thicknesses = 0.5, end_fraction = 0.25;

PointTriangle vertex_on_face(const SelfPair& pair, std::span<const Vec3> x) {
    return closest_on_triangle(x[pair.vertex[0]], x[pair.vertex[1]], x[pair.vertex[2]], x[pair.vertex[3]]);
}

EdgeEdge edge_on_edge(const SelfPair& pair, std::span<const Vec3> x) {
    return closest_on_edges(x[pair.vertex[0]], x[pair.vertex[1]], x[pair.vertex[2]], x[pair.vertex[3]]);
}

/// Activation ratio of an edge whose closest point `foot` to another edge, in the direction `towards`, is inside: 1 for a ridge
/// or boundary, flat_edge_ratio in flat cloth, 0 in a valley, and linear in between, by the steepest rise of the faces beside it.
double edge_activation_ratio(const ClothSurface::Edge& edge, const Vec3& foot, const Vec3& towards, std::span<const Vec3> x) {
    if (edge.opposite[1] < 0) return 1.0;
    double highest = -sharp_sine;
    for (const int vertex : edge.opposite) {
        const Vec3 along = x[vertex] - foot;
        highest = std::max(highest, along.dot(towards) / along.norm());  // not where 0/0
    }
    const double rise = highest / sharp_sine;
    return rise < 0.0 ? flat_edge_ratio - (1.0 - flat_edge_ratio) * rise : flat_edge_ratio * std::max(0.0, 1.0 - rise);
}

/// |e x f|^2 = (|e| |f| sin)^2 of two edges up to which they count as parallel, from |e|^2, |f|^2 and their thickness.
double square_of_parallel(double first, double second, double thickness) {
    const double sine = min_crossing_sine, rise = min_crossing_rise * thickness;
    return std::min(sine * sine * first * second, rise * rise * std::max(first, second));
}

/// Factor of the activation distance that fades two edges near an end, where vertices meet faces instead. 1: edges that cross
/// near their ends have all of the energy of contact or none, as rounding moves them to and fro.
double end_ratio(double place, double length, double thickness) {
    const double faded = std::min(end_thicknesses * thickness, end_fraction * length);
    return std::min(1.0, std::min(place, 1.0 - place) * length / faded);
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

EdgeContact edge_contact(const SelfPair& pair, std::span<const Vec3> x, const ClothSurface& surface) {
    const EdgeEdge closest = edge_on_edge(pair, x);
    const double s = closest.s, t = closest.t;
    const Vec3 &a = x[pair.vertex[0]], &b = x[pair.vertex[1]], &c = x[pair.vertex[2]], &d = x[pair.vertex[3]];
    EdgeContact contact{.weight = {1.0 - s, s, t - 1.0, -t}};
    const Vec3 first = a + s * (b - a), second = c + t * (d - c);
    const Vec3 apart = first - second;
    contact.distance = apart.norm();
    if (contact.distance > 0.0) contact.direction = apart / contact.distance;
    if (contact.distance >= pair.thickness) return contact;
    const double parallel = square_of_parallel((b - a).squaredNorm(), (d - c).squaredNorm(), pair.thickness),
                 square = (b - a).cross(d - c).squaredNorm();
    contact.crossing = square > parallel ? std::min(1.0, std::sqrt(square / parallel) - 1.0) : 0.0;
    if (contact.crossing == 0.0 || s <= 0.0 || s >= 1.0 || t <= 0.0 || t >= 1.0) return contact;
    const double ends = std::min(end_ratio(s, (b - a).norm(), pair.thickness), end_ratio(t, (d - c).norm(), pair.thickness));
    contact.activation_ratio = ends * contact.crossing *
                               std::min(edge_activation_ratio(surface.edges[pair.feature[0]], first, -contact.direction, x),
                                        edge_activation_ratio(surface.edges[pair.feature[1]], second, contact.direction, x));
    return contact;
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
