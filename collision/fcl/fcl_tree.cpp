#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/AABB.h>
#include <fcl/math/bv/utility.h>

#include "detector.h"
#include "fcl/fcl_tree.h"
#include "percale/detectors.h"

namespace percale {
namespace {

// -march=native would change the size of FCL's types against those in its library.
static_assert(sizeof(fcl::AABBd) == 6 * sizeof(double), "FCL must be compiled with baseline instruction-set flags");

/// FCL's tree of axis-parallel boxes over a mesh, walked by ourselves: FCL's own queries copy the tree at each call and return
/// wrong signs (collision/obstacle/README.md).
class FclTree : public ObstacleTree {
public:
    FclTree(std::span<const Vec3> vertices, std::span<const Triangle> triangles) : vertices_(vertices) {
        const std::vector<fcl::Vector3d> points(vertices.begin(), vertices.end());
        std::vector<fcl::Triangle> faces;
        faces.reserve(triangles.size());
        for (const auto& [a, b, c] : triangles) faces.emplace_back(a, b, c);
        // Median splits keep the depth at the logarithm of the triangle count, which bounds the walk's stack.
        model_.bv_splitter = std::make_shared<fcl::detail::BVSplitter<fcl::AABBd>>(fcl::detail::SPLIT_METHOD_MEDIAN);
        model_.beginModel(static_cast<int>(faces.size()), static_cast<int>(points.size()));
        model_.addSubModel(points, faces);
        model_.endModel();
    }

    void find(std::span<const Box> boxes, IdLists& found) const override {
        found.start.assign(1, 0);
        found.ids.clear();
        for (const Box& box : boxes) {
            find_one(box, found.ids);
            found.start.push_back(static_cast<int>(found.ids.size()));
        }
    }

    /// Refits from the leaves to the root; the tree's shape stays.
    void refit() override {
        model_.beginReplaceModel();
        for (const Vec3& x : vertices_) model_.replaceVertex(x);
        model_.endReplaceModel(true, true);
    }

private:
    /// Depth first; a node's children are neighbours in memory, a leaf's first_child is -(triangle + 1).
    void find_one(const Box& box, std::vector<int>& ids) const {
        int waiting[64];
        int count = 0;
        waiting[count++] = 0;
        while (count > 0) {
            const fcl::BVNode<fcl::AABBd>& node = model_.getBV(waiting[--count]);
            const bool apart = (node.bv.min_.array() > box.high.array()).any() || (node.bv.max_.array() < box.low.array()).any();
            if (apart) continue;
            if (node.isLeaf()) {
                ids.push_back(node.primitiveId());
            } else {
                waiting[count++] = node.leftChild();
                waiting[count++] = node.rightChild();
            }
        }
    }

    std::span<const Vec3> vertices_;
    fcl::BVHModel<fcl::AABBd> model_;
};

}  // namespace

std::unique_ptr<ObstacleTree> make_fcl_tree(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    return std::make_unique<FclTree>(vertices, triangles);
}

std::unique_ptr<ContactDetector> make_fcl_detector() { return make_detector(make_fcl_tree); }

}  // namespace percale
