#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "certificate/triangle_overlap.h"
#include "percale/mesh.h"

namespace percale::certificate {

/// Axis-parallel box, m; empty until something is added.
struct Box {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;

    void add(const Vec3& point);
    void add(const Box& box);
    bool contains(const Vec3& point) const {
        return (low.array() <= point.array()).all() && (point.array() <= high.array()).all();
    }
};

Box box_of(const Corners& triangle);

/// Closed boxes: those that share only a face overlap.
bool overlap(const Box& a, const Box& b);

/// Smallest distance between points of two boxes, m; 0 where they overlap.
double distance(const Box& a, const Box& b);

/// The triangles of a mesh as corners.
std::vector<Corners> corners_of(const TriangleMesh& mesh);

/// A binary tree of boxes over boxes 0 ... n-1. Queries may run in parallel.
class BoxTree {
public:
    explicit BoxTree(std::span<const Box> items);
    explicit BoxTree(std::span<const Corners> triangles);

    /// The same items at other places: the boxes follow. Neighbours on a surface stay near each other, however it folds.
    void fit(std::span<const Corners> triangles);

    /// The box of everything; empty for a tree without items.
    Box bounds() const { return nodes_.empty() ? Box{} : nodes_[0].box; }

    /// Calls visit(item) for every item in leaves whose boxes, and all boxes above, pass enter(box).
    template <class Enter, class Visit>
    void walk(Enter&& enter, Visit&& visit) const;

    /// Calls visit(item, other_item) once for every pair of items whose boxes overlap.
    template <class Visit>
    void walk_overlaps(const BoxTree& other, Visit&& visit) const {
        walk_overlaps(other, visit, [] { return false; });
    }
    /// The same until enough() is true, which is tested now and then.
    template <class Visit, class Enough>
    void walk_overlaps(const BoxTree& other, Visit&& visit, Enough&& enough) const;

    /// The smallest of item_distance(item) over all items, pruned by box_distance(box), a lower bound for every item in the box.
    /// Returns item and value, or {-1, limit} where no item lies within `limit`.
    template <class BoxDistance, class ItemDistance>
    std::pair<int, double> nearest(double limit, BoxDistance&& box_distance, ItemDistance&& item_distance) const;

    /// The smallest of pair_distance(item, other_item, best so far) over all pairs; infinity where none is within `limit`.
    /// pair_distance may return anything above the best so far if the pair is no nearer. It has to be no smaller than the
    /// distance of the two boxes.
    template <class PairDistance>
    double nearest_pair(const BoxTree& other, double limit, PairDistance&& pair_distance) const;

private:
    struct Node {
        Box box;
        int first = 0;      // of the node's items in order_
        int count = 0;      // items of a leaf; 0 for an inner node
        int child = 0;      // the first of two children that lie side by side; 0 for a leaf
        double extent = 0;  // m, sum of the box's edges: the larger node is opened first
    };
    using NodePair = std::pair<int, int>;

    void build();
    void split(int node, int first, int count);
    int partition(int first, int count);

    template <class Visit>
    void visit_leaves(const BoxTree& other, NodePair leaves, Visit&& visit) const;
    bool opens_first(const BoxTree& other, NodePair pair) const;
    std::pair<NodePair, NodePair> opened(const BoxTree& other, NodePair pair) const;

    std::vector<Box> items_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

template <class Enter, class Visit>
void BoxTree::walk(Enter&& enter, Visit&& visit) const {
    std::vector<int> open;
    if (!nodes_.empty()) open.push_back(0);
    while (!open.empty()) {
        const Node& node = nodes_[open.back()];
        open.pop_back();
        if (!enter(node.box)) continue;
        for (int i = node.first; i < node.first + node.count; ++i) visit(order_[i]);
        if (node.child > 0) open.insert(open.end(), {node.child + 1, node.child});
    }
}

template <class Visit>
void BoxTree::visit_leaves(const BoxTree& other, NodePair leaves, Visit&& visit) const {
    const Node &a = nodes_[leaves.first], &b = other.nodes_[leaves.second];
    for (int i = a.first; i < a.first + a.count; ++i) {
        for (int j = b.first; j < b.first + b.count; ++j) visit(order_[i], other.order_[j]);
    }
}

template <class Visit, class Enough>
void BoxTree::walk_overlaps(const BoxTree& other, Visit&& visit, Enough&& enough) const {
    std::vector<NodePair> open;
    if (!nodes_.empty() && !other.nodes_.empty()) open.push_back({0, 0});
    while (!open.empty() && !enough()) {
        const NodePair pair = open.back();
        open.pop_back();
        const Node &a = nodes_[pair.first], &b = other.nodes_[pair.second];
        if (!overlap(a.box, b.box)) continue;
        if (a.child == 0 && b.child == 0) {
            visit_leaves(other, pair, [&](int i, int j) {
                if (overlap(items_[i], other.items_[j])) visit(i, j);
            });
            continue;
        }
        const auto [left, right] = opened(other, pair);
        open.insert(open.end(), {left, right});
    }
}

template <class BoxDistance, class ItemDistance>
std::pair<int, double> BoxTree::nearest(double limit, BoxDistance&& box_distance, ItemDistance&& item_distance) const {
    std::pair<int, double> best{-1, limit};
    std::vector<std::pair<double, int>> open;
    if (!nodes_.empty()) open.push_back({box_distance(nodes_[0].box), 0});
    while (!open.empty()) {
        const auto [bound, index] = open.back();
        open.pop_back();
        if (bound > best.second) continue;
        const Node& node = nodes_[index];
        for (int i = node.first; i < node.first + node.count; ++i) {
            const double found = item_distance(order_[i]);
            if (found < best.second || (best.first < 0 && found <= limit)) best = {order_[i], found};
        }
        if (node.child == 0) continue;
        std::pair<double, int> far{box_distance(nodes_[node.child].box), node.child};
        std::pair<double, int> near{box_distance(nodes_[node.child + 1].box), node.child + 1};
        if (far < near) std::swap(far, near);
        open.insert(open.end(), {far, near});
    }
    return best;
}

template <class PairDistance>
double BoxTree::nearest_pair(const BoxTree& other, double limit, PairDistance&& pair_distance) const {
    struct Candidate {
        double bound;
        NodePair pair;
    };
    const auto candidate = [&](NodePair pair) {
        return Candidate{distance(nodes_[pair.first].box, other.nodes_[pair.second].box), pair};
    };
    double best = limit;
    bool found = false;
    std::vector<Candidate> open;
    if (!nodes_.empty() && !other.nodes_.empty()) open.push_back(candidate({0, 0}));
    while (!open.empty()) {
        const Candidate top = open.back();
        open.pop_back();
        if (top.bound > best) continue;
        if (nodes_[top.pair.first].child == 0 && other.nodes_[top.pair.second].child == 0) {
            visit_leaves(other, top.pair, [&](int i, int j) {
                if (distance(items_[i], other.items_[j]) > best) return;
                const double value = pair_distance(i, j, best);
                found |= value <= best;
                best = std::min(best, value);
            });
            continue;
        }
        const auto [left, right] = opened(other, top.pair);
        Candidate far = candidate(left), near = candidate(right);
        if (far.bound < near.bound) std::swap(far, near);
        open.insert(open.end(), {far, near});
    }
    return found ? best : std::numeric_limits<double>::infinity();
}

}  // namespace percale::certificate
