#include "brute_force/brute_force_tree.h"

#include "detector.h"
#include "percale/detectors.h"

namespace percale {
namespace {

/// No tree: every triangle's box is compared with every queried box.
class BruteForceTree : public ObstacleTree {
public:
    BruteForceTree(std::span<const Vec3> vertices, std::span<const Triangle> triangles)
        : vertices_(vertices), triangles_(triangles) {
        BruteForceTree::refit();
    }

    void find(std::span<const Box> boxes, IdLists& found) const override {
        found.start.assign(1, 0);
        found.ids.clear();
        for (const Box& box : boxes) {
            for (std::size_t i = 0; i < boxes_.size(); ++i) {
                if (boxes_[i].overlaps(box)) found.ids.push_back(static_cast<int>(i));
            }
            found.start.push_back(static_cast<int>(found.ids.size()));
        }
    }

    void refit() override {
        boxes_.assign(triangles_.size(), {});
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            for (const int vertex : triangles_[i]) boxes_[i].add(vertices_[vertex]);
        }
    }

private:
    std::span<const Vec3> vertices_;
    std::span<const Triangle> triangles_;
    std::vector<Box> boxes_;
};

}  // namespace

std::unique_ptr<ObstacleTree> make_brute_force_tree(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    return std::make_unique<BruteForceTree>(vertices, triangles);
}

std::unique_ptr<ContactDetector> make_brute_force_detector() { return make_detector(make_brute_force_tree); }

}  // namespace percale
