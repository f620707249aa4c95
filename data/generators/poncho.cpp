#include "generators/poncho.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "generators/mesh_relax.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

/// Points of a ring of the poncho before it is divided evenly, and directions in which its rows are counted.
constexpr int poncho_samples = 4096, poncho_directions = 64;

/// Rounds of relaxing the poncho first and after each merge, merges, and the fraction of the spacing below which edges merge.
constexpr int poncho_rounds = 10, poncho_last_rounds = 20, poncho_merges = 3;
constexpr double poncho_merge_ratio = 0.65;

using Ring = std::vector<Vec3>;

void check_length(double value, const char* field, double lowest, double highest) {
    if (value >= lowest && value <= highest) return;
    throw SceneError(std::string("poncho: ") + field + " is " + std::to_string(value) + " m, allowed are " +
                     std::to_string(lowest) + " ... " + std::to_string(highest));
}

void check(const PonchoShape& shape) {
    check_length(shape.edge_length, "edge_length", 0.005, 0.1);
    check_length(shape.side, "side", 12.0 * shape.edge_length, 10.0);
    check_length(shape.corner_radius, "corner_radius", 1e-3 * shape.side, 0.5 * shape.side);
    const double widest = shape.side - 8.0 * shape.edge_length;
    check_length(shape.hole_width, "hole_width", 3.0 * shape.edge_length, widest);
    check_length(shape.hole_depth, "hole_depth", 3.0 * shape.edge_length, widest);
}

/// The distance from the centre to the rounded square's outline in the direction (cosine, sine): the side, or where the corner's
/// circle about (c, c) is left: |t u - (c, c)| = radius.
double outline_reach(const PonchoShape& shape, double cosine, double sine) {
    const double u = std::abs(cosine), v = std::abs(sine);
    const double half = 0.5 * shape.side, centre = half - shape.corner_radius;
    const double t = half / std::max(u, v);
    if (t * std::min(u, v) <= centre) return t;
    const double along = centre * (u + v);
    return along + std::sqrt(along * along - 2.0 * centre * centre + shape.corner_radius * shape.corner_radius);
}

double hole_reach(const PonchoShape& shape, double cosine, double sine) {
    return 0.5 / std::hypot(cosine / shape.hole_width, sine / shape.hole_depth);
}

/// The closed curve at a fraction `share` of the way from the hole (0) to the outline (1), finely sampled.
Ring curve(const PonchoShape& shape, double share) {
    Ring points;
    for (int k = 0; k < poncho_samples; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / poncho_samples;
        const double cosine = std::cos(angle), sine = std::sin(angle);
        const double inner = hole_reach(shape, cosine, sine), outer = outline_reach(shape, cosine, sine);
        points.emplace_back((inner + share * (outer - inner)) * Vec3(cosine, 0.0, -sine));
    }
    return points;
}

double length_of(const Ring& curve) {
    double length = 0.0;
    for (std::size_t k = 0; k < curve.size(); ++k) length += (curve[(k + 1) % curve.size()] - curve[k]).norm();
    return length;
}

/// `count` points at equal steps along a closed curve, the first one `phase` steps from its start.
Ring equally_spaced(const Ring& curve, int count, double phase) {
    const double step = length_of(curve) / count;
    Ring points;
    double walked = 0.0;
    for (std::size_t k = 0; k < curve.size(); ++k) {
        const Vec3 side = curve[(k + 1) % curve.size()] - curve[k];
        const double length = side.norm();
        for (double at = (points.size() + phase) * step; static_cast<int>(points.size()) < count && at < walked + length;
             at = (points.size() + phase) * step)
            points.push_back(curve[k] + (at - walked) / length * side);
        walked += length;
    }
    return points;
}

/// Triangles between two rings that start at `inner` and `outer`, taking the shorter of the two next edges every time.
void zip(TriangleMesh& mesh, int inner, int inner_count, int outer, int outer_count) {
    int i = 0, o = 0;
    const auto a = [&](int k) { return inner + k % inner_count; };
    const auto b = [&](int k) { return outer + k % outer_count; };
    const auto length = [&](int from, int to) { return (mesh.vertices[to] - mesh.vertices[from]).squaredNorm(); };
    while (i < inner_count || o < outer_count) {
        const bool advance_outer = i == inner_count || (o < outer_count && length(a(i), b(o + 1)) <= length(a(i + 1), b(o)));
        mesh.triangles.push_back({a(i), b(o), advance_outer ? b(o + 1) : a(i + 1)});
        (advance_outer ? o : i) += 1;
    }
}

/// The rows of triangles that fit between hole and outline, at the height of an equilateral triangle.
int ring_count(const PonchoShape& shape) {
    double mean = 0.0;
    for (int k = 0; k < poncho_directions; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / poncho_directions;
        mean += outline_reach(shape, std::cos(angle), std::sin(angle)) - hole_reach(shape, std::cos(angle), std::sin(angle));
    }
    return static_cast<int>(std::lround(mean / poncho_directions / (0.5 * std::numbers::sqrt3 * shape.edge_length)));
}

}  // namespace

TriangleMesh make_poncho(const PonchoShape& shape) {
    check(shape);
    TriangleMesh mesh;
    const int rings = ring_count(shape);
    int before = 0, before_count = 0;
    for (int ring = 0; ring <= rings; ++ring) {
        const Ring line = curve(shape, static_cast<double>(ring) / rings);
        const int count = static_cast<int>(std::lround(length_of(line) / shape.edge_length));
        const Ring points = equally_spaced(line, count, 0.5 * (ring % 2));
        const int first = static_cast<int>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), points.begin(), points.end());
        if (ring > 0) zip(mesh, before, before_count, first, count);
        before = first;
        before_count = count;
    }
    // The outline's vertices never move.
    std::vector<bool> fixed;
    const Projection stay = [&](std::size_t v, const Vec3& moved) { return fixed[v] ? mesh.vertices[v] : moved; };
    flip_edges(mesh);
    for (int round = 0; round < poncho_merges; ++round) {
        fixed = boundary_vertices(mesh);
        relax(mesh, poncho_rounds, stay);
        collapse_short_edges(mesh, poncho_merge_ratio * shape.edge_length);
    }
    fixed = boundary_vertices(mesh);
    relax(mesh, poncho_last_rounds, stay);
    return mesh;
}

}  // namespace percale::scenes
