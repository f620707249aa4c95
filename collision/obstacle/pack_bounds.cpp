// Compiled once for every instruction set, with its compiler flags (PERCALE_PACK_SET says which). Everything but the table has
// internal linkage and nothing of the standard library is called, so that no code of a wider set can reach a narrower machine.
#include "obstacle/pack_bounds.h"
#include "tolerances.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define PERCALE_INLINE [[gnu::always_inline]] inline

namespace percale {
namespace {

/// Fraction of a pack's size. The kernels subtract it from a distance for some thirty roundings of single precision. Smaller:
/// bounds exceed the distance, and contacts are missed. Larger: more pairs are measured exactly.
constexpr float pack_rounding = 2e-6F;

/// m^2 or m^4. Denominators of the kernels are at least this, so that points and needles cause no division by 0.
constexpr float min_denominator = 1e-37F;

/// Margins within which the kernels leave a decision to the exact measurement: a parameter along an edge of a triangle; an area
/// outside a triangle as a fraction of its own; a rise as a fraction of the cloth edge; a parameter along two edges, and that per
/// size over length; sin^2 between two edges; a cosine of a cone. Smaller: rounding refuses contacts. Larger: cost alone.
constexpr float unsure_parameter = 1e-2F, unsure_area = 1e-2F, unsure_rise = 1e-4F;
constexpr float unsure_crossing = 1e-4F, unsure_crossing_per_size = 4e-4F, unsure_parallel = 1e-3F, unsure_cone = 1e-3F;

using Lanes = float __attribute__((vector_size(32)));
using Mask = int __attribute__((vector_size(32)));

using namespace tolerances;

PERCALE_INLINE Lanes all(float value) { return Lanes{} + value; }
PERCALE_INLINE Lanes load(const float* from) {
    Lanes result;
    __builtin_memcpy(&result, from, sizeof(result));
    return result;
}
PERCALE_INLINE Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }
PERCALE_INLINE Lanes smaller(Lanes a, Lanes b) { return a < b ? a : b; }
PERCALE_INLINE Lanes size_of(Lanes a) { return larger(a, -a); }
PERCALE_INLINE Lanes clamp01(Lanes a) { return smaller(larger(a, all(0.0F)), all(1.0F)); }

PERCALE_INLINE Lanes root(Lanes a) {
#if defined(__AVX__)
    return reinterpret_cast<Lanes>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a)));
#else
    Lanes result;
    for (int lane = 0; lane < pack_lanes; ++lane) result[lane] = __builtin_sqrtf(a[lane]);
    return result;
#endif
}

PERCALE_INLINE unsigned char bits(Mask mask) {
#if defined(__AVX__)
    return static_cast<unsigned char>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#else
    unsigned result = 0;
    for (int lane = 0; lane < pack_lanes; ++lane) result |= (mask[lane] != 0 ? 1U : 0U) << lane;
    return static_cast<unsigned char>(result);
#endif
}

PERCALE_INLINE float smallest_of(Lanes a) {
    a = smaller(a, __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3));
    a = smaller(a, __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5));
    a = smaller(a, __builtin_shufflevector(a, a, 1, 0, 3, 2, 5, 4, 7, 6));
    return a[0];
}

struct Point {
    Lanes x, y, z;
};

PERCALE_INLINE Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
PERCALE_INLINE Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
PERCALE_INLINE Point operator*(Lanes f, const Point& a) { return {f * a.x, f * a.y, f * a.z}; }
PERCALE_INLINE Lanes dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
PERCALE_INLINE Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
PERCALE_INLINE Point choose(Mask which, const Point& yes, const Point& no) {
    return {which ? yes.x : no.x, which ? yes.y : no.y, which ? yes.z : no.z};
}

PERCALE_INLINE Point lanes_point(const PackLanes& lanes, int row) {
    return {load(lanes.at[row]), load(lanes.at[row + 1]), load(lanes.at[row + 2])};
}
PERCALE_INLINE Point query_point(const PackQuery& query, int first) {
    return {all(query.at[first]), all(query.at[first + 1]), all(query.at[first + 2])};
}

/// Vector from the closest point of a segment or triangle to a point.
struct Apart {
    Point vector;
    Lanes square;
    Mask inner;  // not at a corner, within rounding
};

PERCALE_INLINE Apart from_segment(const Point& p, const Point& a, const Point& b) {
    const Point along = b - a, offset = p - a;
    const Lanes parameter = dot(offset, along) / larger(dot(along, along), all(min_denominator));
    const Point vector = offset - clamp01(parameter) * along;
    return {vector, dot(vector, vector), (parameter > -unsure_parameter) & (parameter < 1.0F + unsure_parameter)};
}

PERCALE_INLINE Apart nearer(const Apart& a, const Apart& b) {
    const Mask first = a.square < b.square;
    return {choose(first, a.vector, b.vector), smaller(a.square, b.square), first ? a.inner : b.inner};
}

/// Over the inside of the triangle, and a little around it, this is the distance of the plane (never more than that of the
/// triangle); elsewhere that of the nearest edge.
PERCALE_INLINE Apart from_triangle(const Point& p, const Point& a, const Point& b, const Point& c, float sharpness) {
    const Point normal = cross(b - a, c - a);
    const Lanes area = larger(dot(normal, normal), all(min_denominator));
    const Lanes outside = all(-unsure_area - 2.0F * pack_rounding * sharpness * sharpness) * area;
    const Point pa = p - a, pb = p - b, pc = p - c;
    const Mask inside = (dot(normal, cross(pa, pb)) >= outside) & (dot(normal, cross(pb, pc)) >= outside) &
                        (dot(normal, cross(pc, pa)) >= outside);
    const Lanes height = dot(normal, pa) / area;
    const Point plane = height * normal;
    const Apart edge = nearer(nearer(from_segment(p, a, b), from_segment(p, b, c)), from_segment(p, c, a));
    return {choose(inside, plane, edge.vector), inside ? dot(plane, plane) : edge.square, inside | edge.inner};
}

PERCALE_INLINE void answer(Lanes bound, Lanes contact_bound, Mask may_be_contact, const PackQuery& query, PackAnswer& result) {
    result.distance_bound = smallest_of(bound);
    result.travel_to_contact = smallest_of(larger(bound - query.thickness, contact_bound));
    result.near = static_cast<unsigned char>(bits(bound < query.near) & query.all);
    result.contact = static_cast<unsigned char>(bits(may_be_contact) & result.near);
}

void vertex_face(const PackLanes& lanes, const PackQuery& query, PackAnswer& result) {
    const Apart apart = from_triangle(query_point(query, 0), lanes_point(lanes, 0), lanes_point(lanes, 3), lanes_point(lanes, 6),
                                      query.sharpness);
    const Lanes bound = root(apart.square) - pack_rounding * query.size * query.sharpness;
    answer(bound, all(no_bound), Mask{} == 0, query, result);
}

/// A contact's direction is perpendicular to both edges and lies between the normals n and m of the obstacle edge's triangles (or
/// between their opposites). If the cloth edge u has n.u and m.u of one sign, no direction between them is perpendicular to it
/// until its ends have moved by half the smaller of the two.
PERCALE_INLINE Lanes travel_to_contact(const PackLanes& lanes, const Point& u, float length) {
    const Lanes n = dot(u, lanes_point(lanes, 6)), m = dot(u, lanes_point(lanes, 9));
    const Lanes travel = 0.5F * (smaller(size_of(n), size_of(m)) - unsure_rise * length);
    const Mask one_sign = (n * m > 0.0F) & (travel > 0.0F);
    return one_sign ? travel : all(no_bound);
}

void edge_edge(const PackLanes& lanes, const PackQuery& query, PackAnswer& result) {
    const Point p = query_point(query, 0), q = query_point(query, 3), a = lanes_point(lanes, 0), b = lanes_point(lanes, 3);
    const Point u = q - p, v = b - a, r = p - a, normal = cross(u, v);
    const Lanes uu = larger(dot(u, u), all(min_denominator)), vv = larger(dot(v, v), all(min_denominator)), uv = dot(u, v),
                ur = dot(u, r), vr = dot(v, r);
    const Lanes area = dot(normal, normal), sine_squared = area / (uu * vv);
    // As closest_on_edges, without its special cases.
    const Lanes s_line = dot(normal, cross(v, r)) / larger(area, all(min_denominator)), s_first = clamp01(s_line);
    const Lanes t_line = (uv * s_first + vr) / vv, t = clamp01(t_line), s = clamp01((uv * t - ur) / uu);
    const Point apart = r + s * u - t * v;
    // Where the edges are nearly parallel the places of the closest points have few digits, and the distance has half of them.
    const Lanes slack = pack_rounding * query.size / root(larger(sine_squared, all(pack_rounding)));
    const Lanes bound = root(dot(apart, apart)) - slack;
    const float s_unsure = unsure_crossing + unsure_crossing_per_size * query.size / query.length;
    const float t_unsure = unsure_crossing + unsure_crossing_per_size * query.size / query.shortest_edge;
    const Mask inside = (s_line > -s_unsure) & (s_line < 1.0F + s_unsure) & (t_line > -t_unsure) & (t_line < 1.0F + t_unsure);
    const Lanes travel = travel_to_contact(lanes, u, query.length);
    answer(bound, travel, (inside | (sine_squared < unsure_parallel)) & (travel <= 0.0F), query, result);
}

void face_vertex(const PackLanes& lanes, const PackQuery& query, PackAnswer& result) {
    const Point p = lanes_point(lanes, 0);
    const Apart apart = from_triangle(p, query_point(query, 0), query_point(query, 3), query_point(query, 6), query.sharpness);
    const Lanes distance = root(apart.square);
    const float slack = pack_rounding * query.size * query.sharpness;
    // Directions run from the obstacle to the cloth.
    const Lanes along = -dot(apart.vector, lanes_point(lanes, 3)), cosine = load(lanes.at[6]);
    const Mask in_cone = along >= (cosine - unsure_cone) * distance - 2.0F * slack;
    answer(distance - slack, all(no_bound), apart.inner & in_cone, query, result);
}

using Doubles = double __attribute__((vector_size(32)));

double largest_difference(const double* a, const double* b, long count) {
    Doubles max{};
    long i = 0;
    for (; i + 4 <= count; i += 4) {
        Doubles x, y;
        __builtin_memcpy(&x, a + i, sizeof(x));
        __builtin_memcpy(&y, b + i, sizeof(y));
        const Doubles difference = x - y, size = difference > -difference ? difference : -difference;
        max = size > max ? size : max;
    }
    double result = 0.0;
    for (int lane = 0; lane < 4; ++lane) result = max[lane] > result ? max[lane] : result;
    for (; i < count; ++i) {
        const double size = __builtin_fabs(a[i] - b[i]);
        result = size > result ? size : result;
    }
    return result;
}

float smallest(const float* values, long count) {
    Lanes smallest_lanes = all(__builtin_inff());
    long i = 0;
    for (; i + pack_lanes <= count; i += pack_lanes) smallest_lanes = smaller(load(values + i), smallest_lanes);
    float result = smallest_of(smallest_lanes);
    for (; i < count; ++i) result = values[i] < result ? values[i] : result;
    return result;
}

long find_up_to(const float* values, long count, float limit, int* found) {
    long number = 0, i = 0;
    for (; i + pack_lanes <= count; i += pack_lanes) {
        for (unsigned hits = bits(load(values + i) <= all(limit)); hits != 0; hits &= hits - 1) {
            found[number++] = static_cast<int>(i) + __builtin_ctz(hits);
        }
    }
    for (; i < count; ++i) {
        if (values[i] <= limit) found[number++] = static_cast<int>(i);
    }
    return number;
}

constexpr PackKernels kernels{.vertex_face = vertex_face,
                              .edge_edge = edge_edge,
                              .face_vertex = face_vertex,
                              .largest_difference = largest_difference,
                              .smallest = smallest,
                              .find_up_to = find_up_to};

}  // namespace

#if defined(PERCALE_PACKS_AVX2)
const PackKernels* avx2_pack_kernels() { return __builtin_cpu_supports("avx2") ? &kernels : nullptr; }
#else
const PackKernels* baseline_pack_kernels() { return &kernels; }
#if !defined(PERCALE_WIDE_PACKS)
const PackKernels* avx2_pack_kernels() { return nullptr; }
#endif
#endif

}  // namespace percale
