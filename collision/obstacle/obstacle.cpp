#include "obstacle/obstacle.h"

#include <algorithm>

#include "certificate/inside_test.h"
#include "percale/certify.h"
#include "percale/error.h"

namespace percale {
namespace {

/// Fraction of coordinates. A box that is turned back to where the tree was built grows by this much. Below the rounding of two
/// rotations (1e-15) patches are missed.
constexpr double turned_box = 1e-9;

}  // namespace

Obstacle::Obstacle(const TriangleMesh& mesh, const Pose& pose, double friction, TreeFactory make_tree, SurfaceShape shape)
    : mesh_(mesh), built_(pose), start_pose_(pose), end_pose_(pose), friction_(friction), shape_(shape) {
    parts_ = std::make_unique<std::array<LockedPart, 16>>();
    surface_ = make_surface(mesh.vertices, mesh.triangles, shape);
    if (deforms()) {
        start_shape_ = end_shape_ = mesh.vertices;
        find_doubles();
    } else if (surface_.watertight && !certificate::is_watertight(mesh)) {
        // Contact takes the body as solid, and so must the check of the start: otherwise cloth inside would be accepted.
        mesh_ = solid_of(mesh, given_triangles_);
    }
    local_ = surface_.vertices;
    start_ = transform(pose, local_);
    end_ = start_;
    surface_.vertices = start_;
    packs_ = make_packs(surface_);  // with edges that are flat for now
    if (deforms()) mark_flat(start_, end_, surface_);
    ready_.assign(packs_.patch_count(), 0);
    patch_motions_.resize(packs_.patch_count());
    set_pack_boxes();
    make_patch_tree(make_tree);
}

/// A tree of patches has a sixteenth of the leaves, and it finds patches, which the lists need.
void Obstacle::make_patch_tree(TreeFactory make_tree) {
    boxes_ = packs_.box;
    for (const Box& box : boxes_) {
        const int first = static_cast<int>(stand_in_corners_.size());
        stand_in_corners_.push_back(box.low);
        stand_in_corners_.push_back(box.high);
        stand_ins_.push_back({first, first + 1, first});
    }
    tree_ = make_tree(stand_in_corners_, stand_ins_);
}

void Obstacle::set_pack_boxes() {
    set_boxes(packs_, surface_, paths());
    whole_box_ = {};
    for (const Box& box : packs_.box) whole_box_.add(box);
    // Data of another step are computed again when they are needed.
    for (LockedPart& part : *parts_) {
        for (const int pack : part.placed) packs_.placed[pack].fraction = -1.0;
        for (const int patch : part.ready) ready_[patch] = 0;
        part.placed.clear();
        part.ready.clear();
    }
}

void Obstacle::make_ready(int patch) {
    LockedPart& part = (*parts_)[static_cast<std::size_t>(patch) % parts_->size()];
    const std::lock_guard lock(part.mutex);
    if (ready_[patch] != 0) return;
    set_hulls(packs_, patch, surface_, paths());
    patch_motions_[patch] = moves_ ? percale::motion_of(packs_, patch, surface_, paths()) : PatchMotion{};
    part.ready.push_back(patch);
    // This store comes last: threads that see it may read the rest.
    std::atomic_ref(ready_[patch]).store(1, std::memory_order_release);
}

void Obstacle::move(const Pose& start, const Pose& end) {
    const bool stays = start == start_pose_ && end == end_pose_ && start == end && !reshaped_;
    if (stays && !moves_) return;
    ++version_;
    start_pose_ = start;
    end_pose_ = end;
    moves_ = start != end || start_shape_ != end_shape_;
    away_ = start != built_;
    reshaped_ = false;
    place_vertices();
    set_pack_boxes();
    if (deforms()) refit();
}

void Obstacle::check_shape(std::span<const Vec3> shape) const {
    for (const auto& [one, other] : doubles_) {
        if (shape[one] == shape[other]) continue;
        throw SceneError("vertices " + std::to_string(one) + " and " + std::to_string(other) +
                         ", which its mesh has at one place, part by " + std::to_string((shape[one] - shape[other]).norm()) +
                         " m");
    }
}

void Obstacle::deform(std::span<const Vec3> start, std::span<const Vec3> end) {
    check_shape(start);
    check_shape(end);
    start_shape_.assign(start.begin(), start.end());
    end_shape_.assign(end.begin(), end.end());
    reshaped_ = true;
}

/// Finds given vertices that are one vertex of the surface.
void Obstacle::find_doubles() {
    std::vector<int> order;  // of used vertices
    for (const Triangle& t : mesh_.triangles) order.insert(order.end(), t.begin(), t.end());
    std::ranges::sort(order);
    order.erase(std::unique(order.begin(), order.end()), order.end());
    const auto place = [&](int i) {
        const Vec3& x = mesh_.vertices[i];
        return std::array{x.x(), x.y(), x.z()};
    };
    std::ranges::stable_sort(order, {}, place);
    for (std::size_t i = 1; i < order.size(); ++i) {
        if (place(order[i - 1]) == place(order[i])) doubles_.push_back({order[i - 1], order[i]});
    }
}

void Obstacle::place_vertices() {
    largest_displacement_ = 0.0;
    for (std::size_t i = 0; i < local_.size(); ++i) {
        const int given = surface_.given[i];
        start_[i] = transform(start_pose_, deforms() ? start_shape_[given] : local_[i]);
        end_[i] = moves_ ? transform(end_pose_, deforms() ? end_shape_[given] : local_[i]) : start_[i];
        largest_displacement_ = std::max(largest_displacement_, (end_[i] - start_[i]).norm());
    }
    if (deforms()) mark_flat(start_, end_, surface_);
}

/// Refits the tree to the patches' boxes of the whole step.
void Obstacle::refit() {
    boxes_ = packs_.box;
    for (std::size_t patch = 0; patch < boxes_.size(); ++patch) {
        stand_in_corners_[2 * patch] = boxes_[patch].low;
        stand_in_corners_[2 * patch + 1] = boxes_[patch].high;
    }
    tree_->refit();
}

Box Obstacle::to_tree(const Box& box) const {
    if (deforms()) return box;
    Box grown = box;
    grown.grow(largest_displacement_);
    if (!away_) return grown;
    Box turned;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 x((corner & 1 ? grown.high : grown.low).x(), (corner & 2 ? grown.high : grown.low).y(),
                     (corner & 4 ? grown.high : grown.low).z());
        turned.add(transform(built_, inverse_transform(start_pose_, x)));
    }
    // Two rotations have rounding errors.
    turned.grow(turned_box * (turned.low.cwiseAbs().maxCoeff() + turned.high.cwiseAbs().maxCoeff()));
    return turned;
}

const PlacedPack& Obstacle::placed(int pack, double fraction) {
    const PlacedPack& known = packs_.placed[pack];
    if (is_placed(known, paths(), fraction)) return known;
    LockedPart& part = (*parts_)[static_cast<std::size_t>(pack) % parts_->size()];
    const std::lock_guard lock(part.mutex);
    if (known.fraction < 0.0) part.placed.push_back(pack);
    return place(packs_, pack, surface_, paths(), fraction);
}

void Obstacle::find(std::span<const Box> boxes, IdLists& found) {
    query_boxes_.clear();
    for (const Box& box : boxes) query_boxes_.push_back(to_tree(box));
    tree_->find(query_boxes_, raw_);
    found.start.assign(1, 0);
    found.ids.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const auto first = static_cast<long>(found.ids.size());
        for (int k = raw_.start[i]; k < raw_.start[i + 1]; ++k) {
            const int patch = raw_.ids[k];
            if (boxes_[patch].overlaps(query_boxes_[i]) && packs_.box[patch].overlaps(boxes[i])) found.ids.push_back(patch);
        }
        std::sort(found.ids.begin() + first, found.ids.end());
        found.start.push_back(static_cast<int>(found.ids.size()));
    }
}

TriangleMesh Obstacle::start_mesh() const {
    TriangleMesh placed = mesh_;
    placed.vertices = transform(start_pose_, std::span<const Vec3>(deforms() ? start_shape_ : mesh_.vertices));
    return placed;
}

std::optional<StartFault> Obstacle::start_fault(const TriangleMesh& cloth, int number) const {
    // Only whether the distance is 0 matters here, so the distance limit is 0.
    const Certificate certificate = certify(cloth, start_mesh(), 0.0);
    if (certificate.clean() && certificate.smallest_distance > 0.0) return std::nullopt;
    StartFault fault{.obstacle = number,
                     .intersecting_pairs = static_cast<int>(certificate.pairs.size()),
                     .vertices_inside = certificate.vertices_inside,
                     .inside_vertex = certificate.deepest_vertex,
                     .inside_vertices = certificate.inside_vertices};
    if (!certificate.pairs.empty()) {
        fault.cloth_triangle = certificate.pairs[0].first;
        const int triangle = certificate.pairs[0].second;
        fault.obstacle_triangle = given_triangles_.empty() ? triangle : given_triangles_[static_cast<std::size_t>(triangle)];
    }
    return fault;
}

}  // namespace percale
