#include "obstacle/internal_faces.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "certificate/inside_test.h"
#include "certificate/triangle_overlap.h"

namespace percale {
namespace {

using certificate::BoxTree;
using certificate::Corners;
using certificate::Overlap;

struct Solid {
    std::span<const Triangle> triangles;
    std::vector<Corners> corners;
    BoxTree tree;
};

/// How a triangle lies to all that are not its neighbours.
enum class Meeting : unsigned char { none, touched, crossed };

bool holds(const Triangle& t, int vertex) { return t[0] == vertex || t[1] == vertex || t[2] == vertex; }

bool share_a_vertex(const Triangle& a, const Triangle& b) { return holds(b, a[0]) || holds(b, a[1]) || holds(b, a[2]); }

/// Whether all corners of `other` that are not corners of `first`, too, lie clearly on one side of its plane: neighbours that do
/// share no more than their common corners. Far above rounding, so that it needs no exact test.
bool clearly_on_one_side(const Solid& solid, int first, int other) {
    const Corners& t = solid.corners[first];
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    double least = 0.0;
    for (int k = 0; k < 3; ++k) {
        if (holds(solid.triangles[first], solid.triangles[other][k])) continue;
        const Vec3 from = solid.corners[other][k] - t[0];
        const double height = normal.dot(from), little = 1e-9 * normal.norm() * (from.norm() + t[0].norm());
        if (std::abs(height) <= little || height * least < 0.0) return false;
        least = height;
    }
    return true;
}

Meeting meeting_of(const Solid& solid, int i, int j) {
    const bool neighbours = share_a_vertex(solid.triangles[i], solid.triangles[j]);
    if (neighbours && (clearly_on_one_side(solid, i, j) || clearly_on_one_side(solid, j, i))) return Meeting::none;
    const Overlap overlap = certificate::classify(solid.corners[i], solid.corners[j]);
    if (overlap == Overlap::crossing) return Meeting::crossed;
    return overlap == Overlap::touching && !neighbours ? Meeting::touched : Meeting::none;
}

/// Nothing where so many triangles lie side by side (a fan of n around one vertex has n^2/2 pairs) that it would take long.
std::optional<std::vector<Meeting>> find_meetings(const Solid& solid) {
    const long most_tests = 2000000 + 200 * static_cast<long>(solid.triangles.size());
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

/// Whether there is solid beyond the triangle as well as below it. Below it the winding number is one more than beyond.
bool is_internal(const Solid& solid, int triangle) {
    const Corners& t = solid.corners[triangle];
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    const double little = 1e-9 * (solid.tree.bounds().high - solid.tree.bounds().low).norm();
    const Vec3 beyond = middle + little * (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const int winding = certificate::winding_number(beyond, solid.corners, solid.tree);
    return winding != 0 && winding != -1;
}

double area(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

/// Triangles joined by edges that nothing meets have the same on their outer sides: one of them, the largest, answers for all.
class Regions {
public:
    Regions(const Solid& solid, const std::vector<Meeting>& meeting)
        : solid_(solid), meeting_(meeting), neighbours_(find_neighbours(solid.triangles)), seen_(solid.triangles.size()) {}

    std::vector<bool> internal() {
        std::vector<bool> result(solid_.triangles.size());
        for (std::size_t i = 0; i < result.size(); ++i) {
            if (meeting_[i] == Meeting::crossed || seen_[i]) continue;
            const std::vector<int> region = collect(static_cast<int>(i));
            const auto smaller = [&](int a, int b) { return area(solid_.corners[a]) < area(solid_.corners[b]); };
            const bool inside = is_internal(solid_, *std::max_element(region.begin(), region.end(), smaller));
            for (const int triangle : region) result[triangle] = inside;
        }
        return result;
    }

private:
    std::vector<int> collect(int first) {
        std::vector<int> region{first};
        seen_[first] = true;
        if (meeting_[first] != Meeting::none) return region;
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

std::vector<bool> internal_faces(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    const TriangleMesh mesh{.vertices = {vertices.begin(), vertices.end()}, .triangles = {triangles.begin(), triangles.end()}};
    std::vector<Corners> corners = certificate::corners_of(mesh);
    BoxTree tree{std::span<const Corners>(corners)};
    const Solid solid{triangles, std::move(corners), std::move(tree)};
    const std::optional<std::vector<Meeting>> meeting = find_meetings(solid);
    return meeting ? Regions(solid, *meeting).internal() : std::vector<bool>(triangles.size(), false);
}

}  // namespace percale
