#include "detector.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "geometry/clamp_floor.h"
#include "lists/candidate_state.h"
#include "lists/constraint_search.h"
#include "lists/list_removal.h"
#include "self/self_contact_detection.h"
#include "tolerances.h"
#include "untangle/untangle.h"
#include "untangle/untangle_cloth.h"

namespace percale {
namespace {

/// Fraction of h. The next update of the candidates drops the persistent contacts with obstacles of a vertex that has moved
/// farther than this since they were last dropped. 0: cloth at rest trembles between two sets of contacts. Large: contacts of
/// places that cloth has left stay until it is h away.
constexpr double persistence_displacement = 0.1;

/// Clusters in a chunk of the search for contacts (cost alone), and in a chunk of a clamp, within which the limit of one cluster
/// narrows the search of the next. More: threads wait for the last chunk. Fewer: clamps measure pairs that an earlier cluster
/// would have excluded.
constexpr unsigned clusters_a_part = 8, clusters_per_clamp = 32;

class MeshDetector : public ContactDetector {
public:
    explicit MeshDetector(TreeFactory make_tree) : make_tree_(make_tree) {}

    void set_cloth(std::span<const Triangle> triangles, std::span<const double> vertex_thickness) override {
        triangles_.assign(triangles.begin(), triangles.end());
        thickness_.assign(vertex_thickness.begin(), vertex_thickness.end());
        lists_.reset();
        between_cloths_.reset();
        scene_hash_.reset();
    }

    void set_workers(Workers* workers) override { workers_ = workers; }
    void set_cancel(const std::atomic<bool>* cancel) override { cancel_ = cancel; }
    void set_self_contact(const SelfContact& cloth) override { between_cloths_.emplace(triangles_, thickness_, cloth); }

    int add_obstacle(const TriangleMesh& mesh, const Pose& pose, double friction) override {
        return add(mesh, pose, friction, SurfaceShape::rigid);
    }
    int add_deforming_obstacle(const TriangleMesh& mesh, const Pose& pose, double friction) override {
        return add(mesh, pose, friction, SurfaceShape::deforming);
    }

    void remove_obstacle(int obstacle) override {
        const int before = total_version(obstacles_);
        obstacles_.erase(obstacles_.begin() + obstacle);
        scene_hash_.reset();
        if (lists_) percale::remove_obstacle(obstacle, before, obstacles_, lists_->memory());
    }

    void set_friction(int obstacle, double friction) override {
        obstacles_[obstacle]->set_friction(friction);
        scene_hash_.reset();
    }

    void deform_obstacle(int obstacle, std::span<const Vec3> start, std::span<const Vec3> end) override {
        obstacles_[obstacle]->deform(start, end);
    }

    void move_obstacle(int obstacle, const Pose& start, const Pose& end) override { obstacles_[obstacle]->move(start, end); }

    StartFault check_start(std::span<const Vec3> positions) override {
        const TriangleMesh cloth{.vertices = {positions.begin(), positions.end()}, .triangles = triangles_};
        for (std::size_t i = 0; i < obstacles_.size(); ++i) {
            if (const auto fault = obstacles_[i]->start_fault(cloth, static_cast<int>(i))) return *fault;
        }
        return between_cloths_ ? between_cloths_->check_start(positions) : StartFault{};
    }

    std::optional<Untangled> untangle(std::span<const Vec3> positions, std::span<const double> free) override {
        std::vector<SolidObstacle> solids;
        for (const auto& obstacle : obstacles_) solids.emplace_back(obstacle->start_mesh());
        return percale::untangle(make_tangled_cloth(triangles_, thickness_, free, cancel_), solids, positions);
    }

    std::optional<std::vector<Vec3>> untangle_cloth(std::span<const Vec3> positions, std::span<const double> free) override {
        if (!between_cloths_) return std::nullopt;
        return percale::untangle_cloth(
            {between_cloths_->triangles(), free, between_cloths_->stitches(), between_cloths_->meeting(), cancel_}, positions);
    }

    void update_candidates(std::span<const Vec3> start, std::span<const Vec3> predicted) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, start);
        if (!lists_->empty()) forget_contacts(start);
        lists_->cover({.from = start, .to = predicted, .fraction = {0.0, 1.0}}, obstacles_, workers_);
        if (between_cloths_) between_cloths_->update_candidates(start, predicted, workers_);
    }

    void find_contacts(std::span<const Vec3> positions, double fraction, ContactConstraints& constraints) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, positions);
        lists_->cover({.from = positions, .to = positions, .fraction = {fraction, fraction}}, obstacles_, workers_);
        constraints.clear();
        smallest_distance_ = std::numeric_limits<double>::infinity();
        if (!lists_->empty()) add_constraints(positions, fraction, constraints);
        if (!between_cloths_) return;
        smallest_distance_ = std::min(smallest_distance_, between_cloths_->add_constraints(positions, constraints, workers_));
    }

    double collision_free_step_size(std::span<const Vec3> from, std::span<const Vec3> to, StepFraction fraction) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, from);
        const ClothMove move{.from = from, .to = to, .fraction = fraction};
        double safe = lists_->cover(move, obstacles_, workers_);
        if (!lists_->empty()) safe = clamp(move, safe);
        return between_cloths_ ? std::min(safe, between_cloths_->collision_free_step_size(from, to, workers_)) : safe;
    }

    double smallest_distance() const override { return smallest_distance_; }

    void save(StateWriter& state) const override {
        state(own_hash());
        save_motions(obstacles_, state);
        state(forgotten_at_, smallest_distance_, lists_.has_value());
        if (lists_) percale::save(*lists_, obstacles_, state);
        if (between_cloths_) between_cloths_->save(state);
    }

    void restore(StateReader& state) override {
        std::uint64_t hash = 0;
        state(hash);
        if (hash != own_hash()) throw SceneError("saved state: it is of other cloth or other obstacles than the detector has");
        const std::vector<SavedMotion> motions = restored_motions(obstacles_, state);
        std::vector<Vec3> forgotten_at;
        double smallest_distance = 0.0;
        bool listed = false;
        state(forgotten_at, smallest_distance, listed);
        state.demand(forgotten_at.empty() || forgotten_at.size() == thickness_.size(), "a wrong number of vertices");
        std::optional<CandidateLists> lists;
        if (listed) lists = restored_lists(triangles_, thickness_, obstacles_, lists_ ? &*lists_ : nullptr, state);
        std::optional<SelfListsState> between_cloths;
        if (between_cloths_) between_cloths = between_cloths_->restored(state);
        state.demand(state.at_end(), "there is more than belongs to it");
        set_motions(motions, obstacles_);
        forgotten_at_ = std::move(forgotten_at);
        smallest_distance_ = smallest_distance;
        lists_ = std::move(lists);
        if (lists_) lists_->settle(obstacles_);
        if (between_cloths) between_cloths_->go_on_from(std::move(*between_cloths));
    }

private:
    ListedScene listed() const { return {thickness_, obstacles_}; }

    std::uint64_t own_hash() const {
        if (!scene_hash_) scene_hash_ = scene_hash(triangles_, thickness_, obstacles_);
        return *scene_hash_;
    }

    int add(const TriangleMesh& mesh, const Pose& pose, double friction, SurfaceShape shape) {
        obstacles_.push_back(std::make_unique<Obstacle>(mesh, pose, friction, make_tree_, shape));
        lists_.reset();
        scene_hash_.reset();
        return static_cast<int>(obstacles_.size()) - 1;
    }

    /// Near clusters are searched in chunks on several threads; results are joined in the order of the clusters, so constraints
    /// do not depend on the threads.
    void add_constraints(std::span<const Vec3> positions, double fraction, ContactConstraints& constraints) {
        near_clusters_.clear();
        for (ClusterList& list : lists_->lists()) {
            if (list.quiet_until <= list.travel) near_clusters_.push_back(&list);
        }
        const std::span<ClusterList* const> near = near_clusters_;
        const std::size_t grain = workers_ ? clusters_a_part : near.size() + 1, parts = chunk_count(near.size(), grain);
        if (searches_.size() < parts) searches_.resize(parts);
        parallel_for_chunks(workers_, near.size(), grain, [&](std::size_t first, std::size_t last, int) {
            ConstraintSearch& own = searches_[first / grain];
            own.run(listed(), near.subspan(first, last - first), {positions, fraction},
                    parts == 1 ? constraints : own.constraints);
        });
        for (const ConstraintSearch& own : std::span(searches_).first(parts)) {
            smallest_distance_ = std::min(smallest_distance_, own.smallest_distance);
            if (parts > 1) constraints.append(own.constraints);
        }
    }

    /// Lowers `safe` to the collision-free step size of all clusters.
    double clamp(const ClothMove& move, double safe) {
        // Chunks are the same for any number of threads; within one, the limit of a cluster bounds the search of the next ones.
        constexpr std::size_t grain = clusters_per_clamp;
        clamps_.resize(chunk_count(lists_->lists().size(), grain));
        parallel_for_chunks(workers_, lists_->lists().size(), grain, [&](std::size_t first, std::size_t last, int) {
            ChunkClamp& own = clamps_[first / grain];
            own.safe = safe;
            for (std::size_t i = first; i < last; ++i) clamp_to_cluster(move, i, own);
        });
        for (const ChunkClamp& own : clamps_) safe = std::min(safe, own.safe);
        return safe;
    }

    /// Drops the persistent contacts of vertices that have moved since theirs were last dropped, and all while an obstacle moves.
    /// Those of cloth at rest stay: otherwise contacts that join while a step is solved would be missing at the start of the
    /// next, and the cloth would tremble between the two sets.
    void forget_contacts(std::span<const Vec3> positions) {
        const auto moves = [](const auto& obstacle) { return obstacle->largest_displacement() > 0.0; };
        const bool all = forgotten_at_.size() != positions.size() || std::ranges::any_of(obstacles_, moves);
        forgotten_at_.resize(positions.size(), Vec3::Zero());
        moved_.resize(positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            moved_[i] = all || (positions[i] - forgotten_at_[i]).norm() > persistence_displacement * thickness_[i];
            if (moved_[i]) forgotten_at_[i] = positions[i];
        }
        lists_->forget_persistent(moved_);
    }

    /// How a cloth feature moves.
    struct FeatureMove {
        int number = -1;        // in the list
        double approach = 0.0;  // m, of it and the listed obstacles towards each other
        double thickness = 0.0;
        Box room;
    };
    void set_move(const ClothMove& move, const ContactPair& feature, const ClusterList& list, FeatureMove& own) const {
        own.thickness = thickness_[feature.cloth[0]];
        const double part = move.fraction.to - move.fraction.from;
        const Vec3 drift = part * list.drift;
        double square = 0.0;
        own.room = Box();
        for (const int vertex : feature.vertices()) {
            square = std::max(square, (move.to[vertex] - move.from[vertex] - drift).squaredNorm());
            own.room.add(move.from[vertex]);
            own.room.add(move.to[vertex]);
        }
        own.approach = std::sqrt(square) + part * list.spread;
        own.room.grow(tolerances::clamp_floor * own.thickness);
    }

    /// Collision-free step size of a chunk of clusters, with work space.
    struct ChunkClamp {
        double safe = 1.0;
        std::vector<int> found;
    };

    /// Lowers own.safe where a pair of the cluster needs it.
    void clamp_to_cluster(const ClothMove& move, std::size_t cluster, ChunkClamp& chunk) {
        double& safe = chunk.safe;
        ClusterList& list = lists_->lists()[cluster];
        const double limit = list.travel + distance_that_keeps_floor(lists_->approach(cluster, move) * safe, list.thickness);
        if (list.smallest_reach >= limit) return;
        FeatureMove own;
        for (const int pack : packs_up_to(list.packs.reach, limit, chunk.found)) {
            const SelectedPack at{&list, pack};
            const ContactPair& feature = at.feature();
            if (own.number != list.packs.at[pack].feature) {
                own.number = list.packs.at[pack].feature;
                set_move(move, feature, list, own);
            }
            const double near = distance_that_keeps_floor(own.approach * safe, own.thickness);
            if (static_cast<double>(list.packs.reach[pack]) - list.travel >= near) continue;
            const PackHull& hull = listed().hull_of(at);
            const bool may_cross =
                !stays_above(hull, feature, move, tolerances::clamp_floor * own.thickness) && hull.box().overlaps(own.room);
            if (may_cross) safe = clamp_to_pack(move, near, at, safe);
        }
        CandidateLists::set_smallest_bounds(list);
    }

    double clamp_to_pack(const ClothMove& move, double near, const SelectedPack& at, double safe) const {
        const PackAnswer answer = listed().measure_pack(move, at, near);
        const Obstacle& obstacle = *obstacles_[at.feature().obstacle];
        for (unsigned lanes = answer.near; lanes != 0; lanes &= lanes - 1) {
            const ContactPair pair = at.feature().with(obstacle.packs().packs[at.number()], std::countr_zero(lanes));
            const Vec3 apart = pair_apart(pair, move.from, obstacle, move.fraction.from);
            const MovingFour four = moving_pair(pair, move, obstacle);
            const double distance = apart.norm(), floor = clamped_distance(four, distance, thickness_[pair.cloth[0]]);
            // Convex features that a plane parts at both ends of a straight move are parted by it throughout.
            const double enough = floor + tolerances::clearance_left * (distance - floor);
            if (distance > 0.0 && gap_along(four, cloth_slots(pair.kind), apart / distance, safe) >= enough) continue;
            safe = time_of_impact_lower_bound(four, shape_of(pair.kind), floor, safe);
        }
        return safe;
    }

    TreeFactory make_tree_;
    std::vector<Triangle> triangles_;
    std::vector<double> thickness_;
    Obstacles obstacles_;
    std::optional<CandidateLists> lists_;
    std::vector<ClusterList*> near_clusters_;
    std::vector<ConstraintSearch> searches_;
    std::vector<ChunkClamp> clamps_;
    Workers* workers_ = nullptr;
    const std::atomic<bool>* cancel_ = nullptr;
    std::vector<Vec3> forgotten_at_;                      // m, where each vertex was when its contacts were last dropped
    std::vector<unsigned char> moved_;                    // whether they are to be dropped now
    std::optional<SelfContactDetection> between_cloths_;  // if any cloth meets cloth
    double smallest_distance_ = std::numeric_limits<double>::infinity();
    mutable std::optional<std::uint64_t> scene_hash_;  // of cloth and obstacles as they are, once it was computed
};

}  // namespace

std::unique_ptr<ContactDetector> make_detector(TreeFactory make_tree) { return std::make_unique<MeshDetector>(make_tree); }

}  // namespace percale
