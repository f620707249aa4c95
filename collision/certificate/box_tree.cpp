#include "certificate/box_tree.h"

#include <cmath>
#include <numeric>

namespace percale::certificate {
namespace {

/// Triangles in a leaf of a tree. Cost alone.
constexpr int leaf_size = 4;

/// A split must leave one item in this many on each side, else the items are halved by number. Keeps the depth logarithmic: with
/// a split that may leave one item alone, meshes made of ever smaller parts give trees as deep as they have triangles.
constexpr int max_uneven_split = 8;

std::vector<Box> boxes_of(std::span<const Corners> triangles) {
    std::vector<Box> boxes;
    boxes.reserve(triangles.size());
    for (const Corners& triangle : triangles) boxes.push_back(box_of(triangle));
    return boxes;
}

}  // namespace

void Box::add(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
}

void Box::add(const Box& box) {
    low = low.cwiseMin(box.low);
    high = high.cwiseMax(box.high);
}

Box box_of(const Corners& triangle) {
    Box box;
    for (const Vec3& corner : triangle) box.add(corner);
    return box;
}

bool overlap(const Box& a, const Box& b) {
    return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

double distance(const Box& a, const Box& b) {
    const Vec3 gap = (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0);
    return gap.norm();
}

std::vector<Corners> corners_of(const TriangleMesh& mesh) {
    std::vector<Corners> corners;
    corners.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) corners.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
    return corners;
}

BoxTree::BoxTree(std::span<const Box> items) : items_(items.begin(), items.end()) { build(); }

BoxTree::BoxTree(std::span<const Corners> triangles) : items_(boxes_of(triangles)) { build(); }

void BoxTree::build() {
    order_.resize(items_.size());
    std::iota(order_.begin(), order_.end(), 0);
    if (items_.empty()) return;
    nodes_.reserve(items_.size());
    nodes_.emplace_back();
    split(0, 0, static_cast<int>(items_.size()));
}

void BoxTree::fit(std::span<const Corners> triangles) {
    items_ = boxes_of(triangles);
    // Children lie behind their parents.
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        node.box = {};
        for (int item = node.first; item < node.first + node.count; ++item) node.box.add(items_[order_[item]]);
        if (node.child > 0) {
            node.box.add(nodes_[node.child].box);
            node.box.add(nodes_[node.child + 1].box);
        }
        node.extent = (node.box.high - node.box.low).sum();
    }
}

void BoxTree::split(int node, int first, int count) {
    Box box;
    for (int i = first; i < first + count; ++i) box.add(items_[order_[i]]);
    nodes_[node].box = box;
    nodes_[node].extent = (box.high - box.low).sum();
    nodes_[node].first = first;
    if (count <= leaf_size) {
        nodes_[node].count = count;
        return;
    }
    const int left = partition(first, count);
    const int child = static_cast<int>(nodes_.size());
    nodes_[node].child = child;
    nodes_.resize(nodes_.size() + 2);
    split(child, first, left);
    split(child + 1, first + left, count - left);
}

/// Halves the longest axis of the items' centres; where that leaves less than an eighth on one side, halves their number, so that
/// the depth stays logarithmic.
int BoxTree::partition(int first, int count) {
    const auto centre = [this](int item) -> Vec3 { return 0.5 * items_[item].low + 0.5 * items_[item].high; };
    Box centres;
    for (int i = first; i < first + count; ++i) centres.add(centre(order_[i]));
    int axis = 0;
    (centres.high - centres.low).maxCoeff(&axis);
    const double middle = 0.5 * centres.low[axis] + 0.5 * centres.high[axis];
    const auto coordinate = [&](int item) { return 0.5 * items_[item].low[axis] + 0.5 * items_[item].high[axis]; };
    const auto begin = order_.begin() + first, end = begin + count;
    const auto cut = std::partition(begin, end, [&](int item) { return coordinate(item) < middle; });
    const int left = static_cast<int>(cut - begin);
    if (max_uneven_split * std::min(left, count - left) >= count) return left;
    std::nth_element(begin, begin + count / 2, end, [&](int a, int b) { return coordinate(a) < coordinate(b); });
    return count / 2;
}

bool BoxTree::opens_first(const BoxTree& other, NodePair pair) const {
    const Node &a = nodes_[pair.first], &b = other.nodes_[pair.second];
    return b.child == 0 || (a.child > 0 && a.extent >= b.extent);
}

std::pair<BoxTree::NodePair, BoxTree::NodePair> BoxTree::opened(const BoxTree& other, NodePair pair) const {
    const auto [a, b] = pair;
    if (opens_first(other, pair)) return {{nodes_[a].child, b}, {nodes_[a].child + 1, b}};
    const int child = other.nodes_[b].child;
    return {{a, child}, {a, child + 1}};
}

}  // namespace percale::certificate
