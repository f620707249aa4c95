#include <BulletCollision/CollisionShapes/btOptimizedBvh.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include "bullet/bullet_tree.h"
#include "detector.h"
#include "percale/detectors.h"

namespace percale {
namespace {

/// Fraction of the obstacle's diagonal. The box in which Bullet quantises, and against which queried boxes are tested first, is
/// larger than the obstacle by this much.
constexpr double quantised_box = 1e-6;

// Linking the single-precision library against these headers would corrupt memory silently.
static_assert(sizeof(btScalar) == 8, "Bullet must be the double-precision build (bullet-float64, BT_USE_DOUBLE_PRECISION)");

/// Collects the triangles of the leaves that a walk reaches.
class Collector : public btNodeOverlapCallback {
public:
    explicit Collector(std::vector<int>& ids) : ids_(ids) {}
    void processNode(int /*part*/, int triangle) override { ids_.push_back(triangle); }

private:
    std::vector<int>& ids_;
};

btVector3 to_bullet(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

/// Bullet's quantized tree: 16 bytes a node; boxes are rounded outwards, so it finds a few triangles more.
class BulletTree : public ObstacleTree {
public:
    BulletTree(std::span<const Vec3> vertices, std::span<const Triangle> triangles) : vertices_(vertices), triangles_(triangles) {
        static_assert(sizeof(Triangle) == 3 * sizeof(int) && sizeof(Vec3) == 3 * sizeof(double));
        set_bounds();
        btTriangleIndexVertexArray faces = mesh();
        tree_.build(&faces, true, to_bullet(bounds_.low), to_bullet(bounds_.high));
    }

    /// Refits from the leaves to the root; the tree's shape stays, its boxes are rounded within new bounds.
    void refit() override {
        set_bounds();
        btTriangleIndexVertexArray faces = mesh();
        tree_.refit(&faces, to_bullet(bounds_.low), to_bullet(bounds_.high));
    }

    void find(std::span<const Box> boxes, IdLists& found) const override {
        found.start.assign(1, 0);
        found.ids.clear();
        Collector collector(found.ids);
        for (const Box& box : boxes) {
            if (box.overlaps(bounds_)) tree_.reportAabbOverlappingNodex(&collector, to_bullet(box.low), to_bullet(box.high));
            found.start.push_back(static_cast<int>(found.ids.size()));
        }
    }

private:
    void set_bounds() {
        bounds_ = {};
        for (const Vec3& x : vertices_) bounds_.add(x);
        bounds_.grow(quantised_box * (bounds_.high - bounds_.low).norm());
    }

    /// Bullet's interface takes mutable pointers and only reads.
    btTriangleIndexVertexArray mesh() const {
        return {static_cast<int>(triangles_.size()), const_cast<int*>(triangles_[0].data()),   sizeof(Triangle),
                static_cast<int>(vertices_.size()),  const_cast<double*>(vertices_[0].data()), sizeof(Vec3)};
    }

    std::span<const Vec3> vertices_;
    std::span<const Triangle> triangles_;
    btOptimizedBvh tree_;
    Box bounds_;
};

}  // namespace

std::unique_ptr<ObstacleTree> make_bullet_tree(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    return std::make_unique<BulletTree>(vertices, triangles);
}

std::unique_ptr<ContactDetector> make_bullet_detector() { return make_detector(make_bullet_tree); }

}  // namespace percale
