#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "obstacle/obstacle_packs.h"
#include "obstacle/obstacle_surface.h"
#include "obstacle/obstacle_tree.h"
#include "percale/contact.h"

namespace percale {

/// One obstacle in motion. Within a step each vertex runs straight from its place at the start to its place at the end.
class Obstacle {
public:
    /// `pose` places the mesh (its scale included); the tree is built there, once. The tree of a deforming obstacle is refitted
    /// to each step.
    Obstacle(const TriangleMesh& mesh, const Pose& pose, double friction, TreeFactory make_tree,
             SurfaceShape shape = SurfaceShape::rigid);

    void move(const Pose& start, const Pose& end);
    /// Where the given vertices of a deforming obstacle are before its pose, m, at both ends of the step that the next call of
    /// `move` defines. Throws SceneError where vertices separate that the mesh has at one place.
    void deform(std::span<const Vec3> start, std::span<const Vec3> end);
    /// Throws as `deform` does.
    void check_shape(std::span<const Vec3> shape) const;

    const ObstacleSurface& surface() const { return surface_; }
    double friction() const { return friction_; }
    void set_friction(double friction) { friction_ = friction; }
    bool moves() const { return moves_; }
    /// m, largest displacement of a vertex in the coming step.
    double largest_displacement() const { return largest_displacement_; }
    /// The poses at the two ends of the coming step.
    const Pose& start_pose() const { return start_pose_; }
    const Pose& end_pose() const { return end_pose_; }
    /// The cleaned vertices without the pose, m, as they were given first.
    std::span<const Vec3> local_vertices() const { return local_; }
    bool deforms() const { return shape_ == SurfaceShape::deforming; }
    /// The given vertices before the pose at the two ends of the coming step, m. Empty of rigid obstacles.
    std::span<const Vec3> start_shape() const { return start_shape_; }
    std::span<const Vec3> end_shape() const { return end_shape_; }
    /// Number of poses it has had: lists made for another one are no longer valid.
    int version() const { return version_; }

    Vec3 at(int vertex, double fraction) const {
        return moves_ ? Vec3(start_[vertex] + fraction * (end_[vertex] - start_[vertex])) : start_[vertex];
    }
    /// Prefetches a vertex.
    void fetch(int vertex) const { __builtin_prefetch(&start_[vertex]); }
    Vec3 displacement(int vertex) const { return moves_ ? Vec3(end_[vertex] - start_[vertex]) : Vec3(Vec3::Zero()); }

    const ObstaclePacks& packs() const { return packs_; }
    /// Box of everything during the whole step, m, world.
    const Box& whole_box() const { return whole_box_; }
    /// A pack at a fraction of the step; it is placed at the first call. Threads may call at the same time, with the same
    /// fraction.
    const PlacedPack& placed(int pack, double fraction);
    /// Computes the hulls of a patch's packs during the step, and how the patch moves in it, at the first call, like placed
    /// packs: most of a body is far from all cloth.
    void ready(int patch) {
        if (!is_ready(patch)) make_ready(patch);
    }
    const PackHull& hull(int pack) {
        ready(packs_.patch_of_pack[pack]);
        return packs_.hulls[pack];
    }
    const PatchMotion& motion_of(int patch) {
        ready(patch);
        return patch_motions_[patch];
    }

    /// Patches whose boxes come near each world box during the step, ascending and the same for every kind of tree.
    void find(std::span<const Box> boxes, IdLists& found);
    /// The mesh at the start of the step, as it was given; if a body is closed but for repeated vertices and triangles, without
    /// these (solid_of).
    TriangleMesh start_mesh() const;
    /// The fault of cloth that starts there, with `number` as the obstacle's number; nothing if the cloth is clear.
    std::optional<StartFault> start_fault(const TriangleMesh& cloth, int number) const;

private:
    Box to_tree(const Box& box) const;
    void find_doubles();
    void place_vertices();
    void refit();
    void set_pack_boxes();
    bool is_ready(int patch) const {
        return std::atomic_ref(const_cast<unsigned char&>(ready_[patch])).load(std::memory_order_acquire) != 0;
    }
    void make_ready(int patch);
    void make_patch_tree(TreeFactory make_tree);
    VertexPaths paths() const { return {start_, moves_ ? end_ : start_}; }

    TriangleMesh mesh_;                 // of start_mesh, before the pose
    std::vector<int> given_triangles_;  // of its triangles in the given mesh; empty: the same
    ObstacleSurface surface_;           // vertices where the tree was built
    std::vector<Vec3> local_;           // cleaned vertices before the pose
    std::vector<Vec3> start_shape_, end_shape_;
    std::vector<std::array<int, 2>> doubles_;  // used given vertices at one place, of a deforming obstacle
    std::vector<Vec3> start_, end_;            // m, world
    ObstaclePacks packs_;
    Box whole_box_;
    std::vector<Box> boxes_;  // of the patches where the tree was built
    std::vector<PatchMotion> patch_motions_;
    std::vector<Vec3> stand_in_corners_;
    std::vector<Triangle> stand_ins_;  // one triangle for each patch, with the patch's box: what the tree holds
    std::unique_ptr<ObstacleTree> tree_;
    /// Guards the packs and patches whose numbers leave its own as the remainder.
    struct LockedPart {
        std::mutex mutex;
        std::vector<int> placed, ready;  // in this step: packs, patches
    };
    std::unique_ptr<std::array<LockedPart, 16>> parts_;
    std::vector<unsigned char> ready_;  // patches whose hulls and motion are those of the step
    std::vector<Box> query_boxes_;      // work space of find
    IdLists raw_;
    Pose built_, start_pose_, end_pose_;
    double friction_ = 0.0;
    double largest_displacement_ = 0.0;
    int version_ = 0;
    SurfaceShape shape_ = SurfaceShape::rigid;
    bool moves_ = false;
    bool away_ = false;      // not where the tree was built
    bool reshaped_ = false;  // `deform` came after the last `move`
};

}  // namespace percale
