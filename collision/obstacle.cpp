#include "obstacle.h"

#include <algorithm>

namespace percale {
namespace {

/// The point whose image under the pose is `x`.
Vec3 inverse_transform(const Pose& pose, const Vec3& x) {
    const Rotation& q = pose.rotation;
    const Pose back{.translation = Vec3::Zero(), .rotation = {q.w, -q.x, -q.y, -q.z}, .scale = 1.0 / pose.scale};
    return transform(back, x - pose.translation);
}

}  // namespace

Obstacle::Obstacle(const TriangleMesh& mesh, const Pose& pose, double friction, TreeFactory make_tree)
    : mesh_(mesh), built_(pose), start_pose_(pose), end_pose_(pose), friction_(friction) {
    surface_ = make_surface(mesh.vertices, mesh.triangles);
    local_ = surface_.vertices;
    start_ = transform(pose, local_);
    end_ = start_;
    surface_.vertices = start_;
    for (const Triangle& t : surface_.triangles) {
        Box& box = boxes_.emplace_back();
        for (const int vertex : t) box.add(surface_.vertices[vertex]);
    }
    world_boxes_ = boxes_;
    packs_ = make_packs(surface_);
    set_pack_boxes();
    tree_ = make_tree(surface_.vertices, surface_.triangles);
}

void Obstacle::set_world_boxes() {
    for (std::size_t i = 0; i < world_boxes_.size(); ++i) {
        world_boxes_[i] = {};
        for (const int vertex : surface_.triangles[i]) {
            world_boxes_[i].add(start_[vertex]);
            world_boxes_[i].add(end_[vertex]);
        }
    }
}

void Obstacle::set_pack_boxes() {
    set_boxes(packs_, surface_, paths());
    whole_box_ = {};
    for (const Box& box : packs_.box) whole_box_.add(box);
}

void Obstacle::move(const Pose& start, const Pose& end) {
    const bool stays = start == start_pose_ && end == end_pose_ && start == end;
    if (stays && !moves_) return;
    ++version_;
    start_pose_ = start;
    end_pose_ = end;
    moves_ = start != end;
    away_ = start != built_;
    longest_way_ = 0.0;
    for (std::size_t i = 0; i < local_.size(); ++i) {
        start_[i] = transform(start, local_[i]);
        end_[i] = moves_ ? transform(end, local_[i]) : start_[i];
        longest_way_ = std::max(longest_way_, (end_[i] - start_[i]).norm());
    }
    set_world_boxes();
    set_pack_boxes();
}

Box Obstacle::to_tree(const Box& box) const {
    Box grown = box;
    grown.grow(longest_way_);
    if (!away_) return grown;
    Box turned;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 x((corner & 1 ? grown.high : grown.low).x(), (corner & 2 ? grown.high : grown.low).y(),
                     (corner & 4 ? grown.high : grown.low).z());
        turned.add(transform(built_, inverse_transform(start_pose_, x)));
    }
    // Two rotations round off; a billionth of the coordinates' size is far above that.
    turned.grow(1e-9 * (turned.low.cwiseAbs().maxCoeff() + turned.high.cwiseAbs().maxCoeff()));
    return turned;
}

void Obstacle::find(std::span<const Box> boxes, TriangleLists& found) const {
    std::vector<Box> asked;
    asked.reserve(boxes.size());
    for (const Box& box : boxes) asked.push_back(to_tree(box));
    TriangleLists raw;
    tree_->find(asked, raw);
    found.start.assign(1, 0);
    found.ids.clear();
    for (std::size_t i = 0; i < asked.size(); ++i) {
        const auto first = found.ids.size();
        for (int k = raw.start[i]; k < raw.start[i + 1]; ++k) {
            if (boxes_[raw.ids[k]].overlaps(asked[i])) found.ids.push_back(raw.ids[k]);
        }
        std::sort(found.ids.begin() + static_cast<long>(first), found.ids.end());
        found.start.push_back(static_cast<int>(found.ids.size()));
    }
}

TriangleMesh Obstacle::given_mesh() const {
    TriangleMesh placed = mesh_;
    placed.vertices = transform(start_pose_, mesh_.vertices);
    return placed;
}

}  // namespace percale
