#include "obstacle/face_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include "certificate/inside_test.h"
#include "certificate/triangle_overlap.h"

namespace percale {
namespace {

/// Fraction of lengths times areas. A neighbour lies clearly on one side of a triangle's plane above it, so that no exact test is
/// needed. Cost alone while it is above 1e-15.
constexpr double clear_side = 1e-9;

/// Fraction of the obstacle's diagonal. The winding number beyond a face is computed this far from it. Too small: rounding keeps
/// the point on the face. Too large: it lies beyond another face of a thin part, and a face is dropped or kept wrongly.
constexpr double beyond_face = 1e-9;

/// Maximum number of pairs of triangles that the search for internal faces tests, in all and for each triangle. With more pairs
/// the search gives up and all faces stay: correct, with contacts inside the body's overlaps.
constexpr long max_internal_tests = 2000000, max_internal_tests_per_triangle = 200;

using certificate::BoxTree;
using certificate::Corners;
using certificate::Overlap;

struct Solid {
    std::span<const Triangle> triangles;
    std::vector<Corners> corners;
    BoxTree tree;
};

/// How a triangle meets all that are not its neighbours.
enum class Meeting : unsigned char { none, touched, crossed };

bool has_corner(const Triangle& t, int vertex) { return t[0] == vertex || t[1] == vertex || t[2] == vertex; }

/// At most three corners, without heap memory.
struct CommonCorners {
    std::array<int, 3> vertex{};
    int count = 0;
};

CommonCorners common_corners(const Triangle& a, const Triangle& b) {
    CommonCorners common;
    for (const int vertex : a) {
        if (has_corner(b, vertex)) common.vertex[common.count++] = vertex;
    }
    return common;
}

/// Whether all corners of `other` that are not corners of `first` lie clearly on one side of its plane: such neighbours share
/// only their common corners. The margin is far above rounding, so that no exact test is needed.
bool clearly_on_one_side(const Solid& solid, int first, int other) {
    const Corners& t = solid.corners[first];
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    double previous = 0.0;
    for (int k = 0; k < 3; ++k) {
        if (has_corner(solid.triangles[first], solid.triangles[other][k])) continue;
        const Vec3 from = solid.corners[other][k] - t[0];
        const double height = normal.dot(from), little = clear_side * normal.norm() * (from.norm() + t[0].norm());
        if (std::abs(height) <= little || height * previous < 0.0) return false;
        previous = height;
    }
    return true;
}

/// Whether a ray lies in the closed sector between the rays a and b from the same point, within rounding.
bool in_sector(const Vec3& ray, const Vec3& a, const Vec3& b) {
    const Vec3 normal = a.cross(b);
    const double little = clear_side * normal.norm() * ray.norm();
    return std::abs(normal.dot(ray)) <= little && normal.dot(ray.cross(b)) >= -little * b.norm() &&
           normal.dot(a.cross(ray)) >= -little * a.norm();
}

/// Rays from corner `vertex` of a triangle to its other two.
std::array<Vec3, 2> rays_from(const Solid& solid, int triangle, int vertex) {
    const Triangle& t = solid.triangles[triangle];
    const int k = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    const Corners& x = solid.corners[triangle];
    return {x[(k + 1) % 3] - x[k], x[(k + 2) % 3] - x[k]};
}

/// Whether triangles with one common corner that do not cross meet elsewhere, too. Both are convex, so they then share a ray from
/// that corner, and it is along an edge of one of them.
bool meet_beyond_corner(const Solid& solid, int i, int j, int vertex) {
    const auto [a, b] = rays_from(solid, i, vertex);
    const auto [c, d] = rays_from(solid, j, vertex);
    return in_sector(a, c, d) || in_sector(b, c, d) || in_sector(c, a, b) || in_sector(d, a, b);
}

Meeting meeting_of(const Solid& solid, int i, int j) {
    const CommonCorners common = common_corners(solid.triangles[i], solid.triangles[j]);
    if (common.count > 0 && (clearly_on_one_side(solid, i, j) || clearly_on_one_side(solid, j, i))) return Meeting::none;
    const Overlap overlap = certificate::classify(solid.corners[i], solid.corners[j]);
    if (overlap == Overlap::crossing) return Meeting::crossed;
    if (overlap == Overlap::disjoint || common.count > 1) return Meeting::none;
    return common.count == 0 || meet_beyond_corner(solid, i, j, common.vertex[0]) ? Meeting::touched : Meeting::none;
}

/// Returns nothing where so many triangles lie side by side (a fan of n around one vertex has n^2/2 pairs) that it would take
/// long.
std::optional<std::vector<Meeting>> find_meetings(const Solid& solid) {
    const long most_tests = max_internal_tests + max_internal_tests_per_triangle * static_cast<long>(solid.triangles.size());
    std::vector<Meeting> meeting(solid.triangles.size(), Meeting::none);
    long tests = 0;
    const auto visit = [&](int i, int j) {
        if (i >= j || (meeting[i] == Meeting::crossed && meeting[j] == Meeting::crossed)) return;
        ++tests;
        const Meeting what = meeting_of(solid, i, j);
        for (const int triangle : {i, j}) meeting[triangle] = std::max(meeting[triangle], what);
    };
    solid.tree.walk_overlaps(solid.tree, visit, [&] { return tests >= most_tests; });
    if (tests >= most_tests) return std::nullopt;
    return meeting;
}

/// The triangle across each edge of a closed surface, by triangle and corner.
std::vector<std::array<int, 3>> find_neighbours(std::span<const Triangle> triangles) {
    struct Half {
        int low, high, triangle, corner;
    };
    std::vector<Half> halves;
    halves.reserve(3 * triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(triangles[i][k], triangles[i][(k + 1) % 3]);
            halves.push_back({low, high, static_cast<int>(i), k});
        }
    }
    std::sort(halves.begin(), halves.end(), [](const Half& a, const Half& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    std::vector<std::array<int, 3>> neighbours(triangles.size());
    for (std::size_t i = 0; i + 1 < halves.size(); i += 2) {
        neighbours[halves[i].triangle][halves[i].corner] = halves[i + 1].triangle;
        neighbours[halves[i + 1].triangle][halves[i + 1].corner] = halves[i].triangle;
    }
    return neighbours;
}

/// Beyond a triangle, the side its normal points to, the winding number is one less than below it.
FaceSides sides_of(const Solid& solid, int triangle) {
    const Corners& t = solid.corners[triangle];
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    const double little = beyond_face * (solid.tree.bounds().high - solid.tree.bounds().low).norm();
    const Vec3 beyond = middle + little * (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const int winding = certificate::winding_number(beyond, solid.corners, solid.tree);
    if (winding == 0) return FaceSides::outward;
    return winding == -1 ? FaceSides::inward : FaceSides::internal;
}

double area(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

/// Triangles that are joined by edges and met by nothing have equal winding numbers on their two sides: the largest triangle
/// decides for all.
class Regions {
public:
    Regions(const Solid& solid, const std::vector<Meeting>& meeting)
        : solid_(solid), meeting_(meeting), neighbours_(find_neighbours(solid.triangles)), seen_(solid.triangles.size()) {}

    std::vector<FaceSides> sides() {
        std::vector<FaceSides> result(solid_.triangles.size(), FaceSides::unproven);
        for (std::size_t i = 0; i < result.size(); ++i) {
            if (meeting_[i] != Meeting::none || seen_[i]) continue;
            const std::vector<int> region = collect(static_cast<int>(i));
            const auto smaller = [&](int a, int b) { return area(solid_.corners[a]) < area(solid_.corners[b]); };
            const FaceSides sides = sides_of(solid_, *std::max_element(region.begin(), region.end(), smaller));
            for (const int triangle : region) result[triangle] = sides;
        }
        return result;
    }

private:
    std::vector<int> collect(int first) {
        std::vector<int> region{first};
        seen_[first] = true;
        for (std::size_t k = 0; k < region.size(); ++k) {
            for (const int other : neighbours_[region[k]]) {
                if (seen_[other] || meeting_[other] != Meeting::none) continue;
                seen_[other] = true;
                region.push_back(other);
            }
        }
        return region;
    }

    const Solid& solid_;
    const std::vector<Meeting>& meeting_;
    std::vector<std::array<int, 3>> neighbours_;
    std::vector<bool> seen_;
};

}  // namespace

std::vector<FaceSides> face_sides(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    const TriangleMesh mesh{.vertices = {vertices.begin(), vertices.end()}, .triangles = {triangles.begin(), triangles.end()}};
    std::vector<Corners> corners = certificate::corners_of(mesh);
    BoxTree tree{std::span<const Corners>(corners)};
    const Solid solid{triangles, std::move(corners), std::move(tree)};
    const std::optional<std::vector<Meeting>> meeting = find_meetings(solid);
    return meeting ? Regions(solid, *meeting).sides() : std::vector<FaceSides>(triangles.size(), FaceSides::unproven);
}

}  // namespace percale
