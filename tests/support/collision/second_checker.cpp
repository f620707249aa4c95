#include "tests/support/collision/second_checker.h"

#ifdef PERCALE_HAS_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <vector>
#endif

namespace percale::test {
#ifdef PERCALE_HAS_CGAL
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// A triangle of a mesh, as boxes carry it.
struct Face {
    Kernel::Triangle_3 shape;
    Triangle corners;
};

using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Face*>;

std::vector<Face> faces_of(const TriangleMesh& mesh) {
    const auto point = [&mesh](int vertex) {
        const Vec3& x = mesh.vertices[static_cast<std::size_t>(vertex)];
        return Kernel::Point_3(x.x(), x.y(), x.z());
    };
    std::vector<Face> faces;
    for (const Triangle& t : mesh.triangles) {
        const Face face{.shape = {point(t[0]), point(t[1]), point(t[2])}, .corners = t};
        if (!face.shape.is_degenerate()) faces.push_back(face);
    }
    return faces;
}

std::vector<Box> boxes_of(const std::vector<Face>& faces) {
    std::vector<Box> boxes;
    for (const Face& face : faces) boxes.emplace_back(face.shape.bbox(), &face);
    return boxes;
}

/// The corners that two faces of one mesh share come first in both.
int shared_first(Triangle& a, Triangle& b) {
    int shared = 0;
    for (int i = 0; i < 3; ++i) {
        const auto same = std::find(b.begin() + shared, b.end(), a[static_cast<std::size_t>(i)]);
        if (same == b.end()) continue;
        std::swap(a[static_cast<std::size_t>(shared)], a[static_cast<std::size_t>(i)]);
        std::iter_swap(b.begin() + shared, same);
        ++shared;
    }
    return shared;
}

/// Whether faces of one mesh meet beyond what they share. Those with one common corner meet beyond it only where the opposite
/// edge of one meets the other; those with a common edge, where they are folded onto each other.
bool meet_within(const TriangleMesh& mesh, const Face& first, const Face& second) {
    Triangle a = first.corners, b = second.corners;
    const auto point = [&mesh](int vertex) {
        const Vec3& x = mesh.vertices[static_cast<std::size_t>(vertex)];
        return Kernel::Point_3(x.x(), x.y(), x.z());
    };
    switch (shared_first(a, b)) {
        case 0:
            return CGAL::do_intersect(first.shape, second.shape);
        case 1:
            return CGAL::do_intersect(Kernel::Segment_3(point(a[1]), point(a[2])), second.shape) ||
                   CGAL::do_intersect(Kernel::Segment_3(point(b[1]), point(b[2])), first.shape);
        case 2:
            return CGAL::coplanar(point(a[0]), point(a[1]), point(a[2]), point(b[2])) &&
                   CGAL::coplanar_orientation(point(a[0]), point(a[1]), point(a[2]), point(b[2])) == CGAL::POSITIVE;
        default:
            return false;
    }
}

long pairs_between(const TriangleMesh& cloth, const TriangleMesh& body) {
    const std::vector<Face> ours = faces_of(cloth), theirs = faces_of(body);
    std::vector<Box> our_boxes = boxes_of(ours), their_boxes = boxes_of(theirs);
    long pairs = 0;
    CGAL::box_intersection_d(
        our_boxes.begin(), our_boxes.end(), their_boxes.begin(), their_boxes.end(),
        [&pairs](const Box& a, const Box& b) { pairs += CGAL::do_intersect(a.handle()->shape, b.handle()->shape) ? 1 : 0; });
    return pairs;
}

long pairs_within(const TriangleMesh& cloth) {
    const std::vector<Face> faces = faces_of(cloth);
    std::vector<Box> boxes = boxes_of(faces);
    long pairs = 0;
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
        pairs += meet_within(cloth, *a.handle(), *b.handle()) ? 1 : 0;
    });
    return pairs;
}

}  // namespace

SecondChecker cgal_checker() {
    return [](const scenes::Frame& frame) {
        long pairs = 0;
        for (std::size_t cloth = 0; cloth < frame.cloths.size(); ++cloth) {
            for (const TriangleMesh& body : frame.obstacles) pairs += pairs_between(frame.cloths[cloth], body);
        }
        for (const auto& [first, second] : frame.meeting) {
            const TriangleMesh& cloth = frame.cloths[static_cast<std::size_t>(first)];
            pairs += first == second ? pairs_within(cloth) : pairs_between(cloth, frame.cloths[static_cast<std::size_t>(second)]);
        }
        return pairs;
    };
}
#else
SecondChecker cgal_checker() { return {}; }
#endif
}  // namespace percale::test
