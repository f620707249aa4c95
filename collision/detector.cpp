#include "detector.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "candidate_lists.h"
#include "cut_floor.h"
#include "list_passes.h"
#include "pack_measure.h"
#include "percale/certify.h"
#include "self_contact_detection.h"
#include "untangle.h"

namespace percale {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr double kept_way = 0.1;  // of the thickness: a vertex that has moved no farther keeps its contacts from step to step

/// Pairs farther apart than this keep their floor if they come closer by no more than `way`.
double within(double way, double h) {
    return way > largest_floor * h ? way + largest_floor * h : std::max(2.0 * way, way + 1e-3 * h);
}

bool stays_above(const PackPlane& plane, const ContactPair& pair, const ClothMove& move, double height) {
    return height_above(plane, pair.vertices(), move.from) > height && height_above(plane, pair.vertices(), move.to) > height;
}

StartFault start_fault(int obstacle, const Certificate& certificate) {
    StartFault fault{.obstacle = obstacle,
                     .intersecting_pairs = static_cast<int>(certificate.pairs.size()),
                     .vertices_inside = certificate.vertices_inside,
                     .inside_vertex = certificate.deepest_vertex,
                     .inside_vertices = certificate.inside_vertices};
    if (!certificate.pairs.empty()) {
        fault.cloth_triangle = certificate.pairs[0].first;
        fault.obstacle_triangle = certificate.pairs[0].second;
    }
    return fault;
}

class MeshDetector : public ContactDetector {
public:
    explicit MeshDetector(TreeFactory make_tree) : make_tree_(make_tree) {}

    void set_cloth(std::span<const Triangle> triangles, std::span<const double> vertex_thickness) override {
        triangles_.assign(triangles.begin(), triangles.end());
        thickness_.assign(vertex_thickness.begin(), vertex_thickness.end());
        lists_.reset();
        between_cloths_.reset();
    }

    void set_self_contact(const SelfContact& cloth) override { between_cloths_.emplace(triangles_, thickness_, cloth); }

    int add_obstacle(const TriangleMesh& mesh, const Pose& pose, double friction) override {
        obstacles_.push_back(std::make_unique<Obstacle>(mesh, pose, friction, make_tree_));
        lists_.reset();
        return static_cast<int>(obstacles_.size()) - 1;
    }

    void move_obstacle(int obstacle, const Pose& start, const Pose& end) override { obstacles_[obstacle]->move(start, end); }

    StartFault check_start(std::span<const Vec3> positions) override {
        const TriangleMesh cloth{.vertices = {positions.begin(), positions.end()}, .triangles = triangles_};
        for (std::size_t i = 0; i < obstacles_.size(); ++i) {
            // Only whether the distance is 0 matters here, so nothing is searched farther away.
            const Certificate certificate = certify(cloth, obstacles_[i]->given_mesh(), 0.0);
            if (certificate.clean() && certificate.smallest_distance > 0.0) continue;
            return start_fault(static_cast<int>(i), certificate);
        }
        return between_cloths_ ? between_cloths_->check_start(positions) : StartFault{};
    }

    std::optional<Untangled> untangle(std::span<const Vec3> positions, std::span<const double> free) override {
        std::vector<SolidObstacle> solids;
        for (const auto& obstacle : obstacles_) solids.emplace_back(obstacle->given_mesh());
        return percale::untangle(make_tangled_cloth(triangles_, thickness_, free), solids, positions);
    }

    void refresh(std::span<const Vec3> start, std::span<const Vec3> predicted) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, start);
        if (!lists_->empty()) forget_contacts(start);
        lists_->cover({.from = start, .to = predicted, .part = {0.0, 1.0}}, obstacles_);
        if (between_cloths_) between_cloths_->refresh(start, predicted);
    }

    void evaluate(std::span<const Vec3> positions, double fraction, ContactRows& rows) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, positions);
        lists_->cover({.from = positions, .to = positions, .part = {fraction, fraction}}, obstacles_);
        rows.clear();
        smallest_distance_ = std::numeric_limits<double>::infinity();
        if (!lists_->empty()) add_rows(positions, fraction, rows);
        if (between_cloths_) smallest_distance_ = std::min(smallest_distance_, between_cloths_->add_rows(positions, rows));
    }

    double largest_safe_fraction(std::span<const Vec3> from, std::span<const Vec3> to, StepFraction part) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, from);
        const ClothMove move{.from = from, .to = to, .part = part};
        double safe = lists_->cover(move, obstacles_);
        if (!lists_->empty()) safe = cut(move, safe);
        return between_cloths_ ? std::min(safe, between_cloths_->largest_safe_fraction(from, to)) : safe;
    }

    double smallest_distance() const override { return smallest_distance_; }

    void save(StateWriter& state) const override {
        state(scene_hash(triangles_, thickness_, obstacles_));
        for (const auto& obstacle : obstacles_) state(obstacle->start_pose(), obstacle->end_pose());
        state(kept_at_, smallest_distance_, lists_.has_value());
        if (lists_) lists_->save(obstacles_, state);
        if (between_cloths_) between_cloths_->save(state);
    }

    void restore(StateReader& state) override {
        std::uint64_t hash = 0;
        state(hash);
        if (hash != scene_hash(triangles_, thickness_, obstacles_))
            throw SceneError("saved state: it is of other cloth or other obstacles than the detector has");
        const std::vector<std::array<Pose, 2>> poses = restored_poses(obstacles_, state);
        std::vector<Vec3> kept_at;
        double smallest_distance = 0.0;
        bool listed = false;
        state(kept_at, smallest_distance, listed);
        state.demand(kept_at.empty() || kept_at.size() == thickness_.size(), "a wrong number of vertices");
        std::optional<CandidateLists> lists;
        if (listed) lists = CandidateLists::restored(triangles_, thickness_, obstacles_, state);
        std::optional<SelfContactDetection> between_cloths = between_cloths_;
        if (between_cloths) between_cloths->restore(state);
        state.demand(state.at_end(), "there is more than belongs to it");
        for (std::size_t i = 0; i < obstacles_.size(); ++i) obstacles_[i]->move(poses[i][0], poses[i][1]);
        kept_at_ = std::move(kept_at);
        smallest_distance_ = smallest_distance;
        lists_ = std::move(lists);
        if (lists_) lists_->settle(obstacles_);
        between_cloths_ = std::move(between_cloths);
    }

private:
    /// Each pass asks memory for what the next places need: lists, packs and the obstacle's surface are too large for the
    /// nearest caches.
    void add_rows(std::span<const Vec3> positions, double fraction, ContactRows& rows) {
        find_active();
        find_candidates(positions);
        select_packs(positions);
        measure_selected({positions, positions, {fraction, fraction}});
        for (std::size_t i = 0; i < lanes_.size(); ++i) {
            fetch_ahead(i);
            add_lane(positions, fraction, lanes_[i], rows);
        }
        for (const auto& [list, feature] : active_) list->bounds[feature] = least_bounds(list->features[feature], *list);
        for (ClusterList* list : near_clusters_) set_least(*list);
    }

    static void set_least(ClusterList& list) {
        list.least_reach = list.quiet_until = infinity;
        for (const FeatureBounds& bounds : list.bounds) {
            list.least_reach = std::min(list.least_reach, static_cast<double>(bounds.reach));
            list.quiet_until = std::min(list.quiet_until, static_cast<double>(bounds.quiet_until));
        }
    }

    /// The features whose bounds are used up.
    void find_active() {
        near_clusters_.clear();
        for (ClusterList& list : lists_->lists()) {
            if (list.quiet_until <= list.travel) near_clusters_.push_back(&list);
        }
        active_.clear();
        for (std::size_t i = 0; i < near_clusters_.size(); ++i) {
            if (i + 2 < near_clusters_.size()) fetch(*near_clusters_[i + 2]);
            ClusterList& list = *near_clusters_[i];
            for (std::size_t f = 0; f < list.bounds.size(); ++f) {
                if (static_cast<double>(list.bounds[f].quiet_until) <= list.travel)
                    active_.push_back({&list, static_cast<int>(f)});
            }
        }
    }

    /// Their packs whose bounds are used up.
    void find_candidates(std::span<const Vec3> positions) {
        candidates_.clear();
        for (std::size_t i = 0; i < active_.size(); ++i) {
            if (i + 6 < active_.size()) fetch_packs(active_[i + 6]);
            ClusterList& list = *active_[i].list;
            ListedFeature& feature = list.features[active_[i].feature];
            const float thickness = float_thickness(feature);
            if (static_cast<double>(feature.others.quiet_until) <= list.travel) find_busy(positions, feature, list);
            for_busy(feature, [&](int pack) {
                if (static_cast<double>(list.packs[pack].quiet_until(thickness)) > list.travel) return;
                candidates_.push_back({&list, active_[i].feature, pack});
            });
        }
    }

    /// Those of them that have to be measured.
    void select_packs(std::span<const Vec3> positions) {
        selected_.clear();
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            if (i + 8 < candidates_.size()) {
                const auto& [list, feature, pack] = candidates_[i + 8];
                __builtin_prefetch(&packs_for(list->features[feature]).planes[list->packs[pack].pack]);
            }
            const auto& [list, feature, pack] = candidates_[i];
            if (!raise_bounds(positions, list->features[feature], list->travel, list->packs[pack])) {
                selected_.push_back(candidates_[i]);
            }
        }
    }

    const ObstaclePacks& packs_for(const ListedFeature& feature) const { return obstacles_[feature.pair.obstacle]->packs(); }

    /// Finds the lanes that can be contacts.
    void measure_selected(const ClothMove& here) {
        lanes_.clear();
        for (std::size_t i = 0; i < selected_.size(); ++i) {
            if (i + 4 < selected_.size()) {
                const auto& [list, feature, pack] = selected_[i + 4];
                packs_for(list->features[feature]).placed[list->packs[pack].pack].prefetch(list->features[feature].pair.kind);
            }
            const auto& [list, number, pack] = selected_[i];
            const ListedFeature& feature = list->features[number];
            ListedPack& listed = list->packs[pack];
            const PackAnswer answer = measure_pack(here, feature, thickness_[feature.pair.cloth[0]], *list, listed);
            for (unsigned lanes = answer.row | (listed.held & answer.near); lanes != 0; lanes &= lanes - 1) {
                lanes_.push_back({selected_[i], std::countr_zero(lanes)});
                __builtin_prefetch(&packs_for(feature).packs[listed.pack].feature);
            }
        }
    }

    /// Lowers `safe` to what all clusters allow.
    double cut(const ClothMove& move, double safe) {
        double obstacle_way = 0.0;
        for (const auto& obstacle : obstacles_) obstacle_way = std::max(obstacle_way, obstacle->longest_way());
        obstacle_way *= move.part.to - move.part.from;
        for (std::size_t i = 0; i < lists_->lists().size(); ++i) safe = cut_cluster(move, obstacle_way, i, safe);
        return safe;
    }

    /// Contacts of vertices that have moved since theirs were last forgotten, and all while an obstacle moves. Those of cloth
    /// that rests stay, or contacts that join while a step is solved would be missing at the start of the next: the cloth would
    /// tremble between the two.
    void forget_contacts(std::span<const Vec3> positions) {
        const bool all = kept_at_.size() != positions.size() ||
                         std::any_of(obstacles_.begin(), obstacles_.end(), [](const auto& o) { return o->longest_way() > 0.0; });
        kept_at_.resize(positions.size(), Vec3::Zero());
        moved_.resize(positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            moved_[i] = all || (positions[i] - kept_at_[i]).norm() > kept_way * thickness_[i];
            if (moved_[i]) kept_at_[i] = positions[i];
        }
        for (ClusterList& list : lists_->lists()) {
            if (!list.holds) continue;
            list.holds = false;
            for (ListedFeature& feature : list.features) forget_contacts(feature, list);
        }
    }

    /// Held packs are busy ones, or their list has not been looked at since it was made.
    void forget_contacts(ListedFeature& feature, ClusterList& list) const {
        bool moved = false;
        for (int k = 0; k < feature.pair.cloth_count(); ++k) moved = moved || moved_[feature.pair.cloth[k]];
        if (feature.others.quiet_until < 0.0F) feature.busy = ~0UL >> (most_marked - std::min(feature.count, most_marked));
        for_busy(feature, [&](int i) {
            if (moved) list.packs[i].held = 0;
            list.holds = list.holds || list.packs[i].held != 0;
        });
    }

    float float_thickness(const ListedFeature& feature) const { return static_cast<float>(thickness_[feature.pair.cloth[0]]); }

    FeatureBounds least_bounds(const ListedFeature& feature, const ClusterList& list) const {
        FeatureBounds least = feature.others;
        const float thickness = float_thickness(feature);
        for_busy(feature, [&](int i) {
            least.reach = std::min(least.reach, list.packs[i].reach);
            least.quiet_until = std::min(least.quiet_until, list.packs[i].quiet_until(thickness));
        });
        return least;
    }

    /// Most packs whose bounds are used up are told to be far by their planes.
    bool raise_bounds(std::span<const Vec3> positions, const ListedFeature& feature, double travel, ListedPack& listed) const {
        const double thickness = thickness_[feature.pair.cloth[0]];
        const PackPlane& plane = obstacles_[feature.pair.obstacle]->packs().planes[listed.pack];
        const double height = height_above(plane, feature.pair.vertices(), positions);
        if (height < thickness) return false;
        listed.reach = std::max(listed.reach, below(height + travel));
        listed.row_reach = std::max(listed.row_reach, below(height - thickness + travel));
        return true;
    }

    /// Marks the packs that a tenth of the thickness more of travel would wake, and those that are held.
    void find_busy(std::span<const Vec3> positions, ListedFeature& feature, ClusterList& list) const {
        const float thickness = float_thickness(feature);
        const double soon = list.travel + 0.1 * static_cast<double>(thickness);
        feature.busy = 0;
        feature.others = {.reach = infinity, .quiet_until = infinity};
        const PackPlane* planes = obstacles_[feature.pair.obstacle]->packs().planes.data();
        for (int i = 0; i < feature.count; ++i) __builtin_prefetch(planes + list.packs[feature.first + i].pack);
        for (int i = 0; i < std::min(feature.count, most_marked); ++i) {
            ListedPack& listed = list.packs[feature.first + i];
            if (static_cast<double>(listed.quiet_until(thickness)) < soon) raise_bounds(positions, feature, list.travel, listed);
            if (listed.held != 0 || static_cast<double>(listed.quiet_until(thickness)) < soon) {
                feature.busy |= 1UL << i;
            } else {
                feature.others.reach = std::min(feature.others.reach, listed.reach);
                feature.others.quiet_until = std::min(feature.others.quiet_until, listed.quiet_until(thickness));
            }
        }
    }

    PackAnswer measure_pack(const ClothMove& move, const ListedFeature& feature, double near, const ClusterList& list,
                            ListedPack& listed) {
        const PlacedPack& placed = obstacles_[feature.pair.obstacle]->placed(static_cast<int>(listed.pack), move.part.from);
        const PackAnswer answer =
            measure(feature.pair, move.from, placed, {.near = near, .thickness = thickness_[feature.pair.cloth[0]]});
        listed.reach = std::max(listed.reach, below(static_cast<double>(answer.least) + list.travel));
        listed.row_reach = std::max(listed.row_reach, below(static_cast<double>(answer.least_row) + list.travel));
        return answer;
    }

    ContactPair pair_of(const SelectedLane& at) const {
        const auto& [list, feature, pack] = at.place;
        return list->features[feature].with(packs_for(list->features[feature]).packs[list->packs[pack].pack], at.lane);
    }

    void fetch_ahead(std::size_t lane) const {
        for (int depth = 0; depth < pair_fetches; ++depth) {
            const std::size_t ahead = lane + 4 * static_cast<std::size_t>(pair_fetches - depth);
            if (ahead >= lanes_.size()) continue;
            const ContactPair pair = pair_of(lanes_[ahead]);
            fetch_pair(pair, *obstacles_[pair.obstacle], depth);
        }
    }

    void add_lane(std::span<const Vec3> positions, double fraction, const SelectedLane& at, ContactRows& rows) {
        const ContactPair pair = pair_of(at);
        const double thickness = thickness_[pair.cloth[0]];
        const PairContact contact = pair_contact(pair, positions, *obstacles_[pair.obstacle], fraction);
        smallest_distance_ = std::min(smallest_distance_, contact.distance);
        if (contact.distance >= thickness) return;
        // A pair that was a contact stays one until the next refresh: rows only join while a step is being solved, so
        // that the force is continuous where closest points pass from one feature to the next.
        ListedPack& listed = at.place.list->packs[at.place.pack];
        if (contact.local_minimum) {
            listed.held |= 1U << at.lane & 0xffU;
            at.place.list->holds = true;
        }
        if ((listed.held >> at.lane & 1U) != 0) add_row(pair, contact, thickness, rows);
    }

    void add_row(const ContactPair& pair, const PairContact& contact, double thickness, ContactRows& rows) const {
        rows.vertex.push_back({pair.cloth[0], pair.cloth[1], pair.cloth[2], -1});
        rows.weight.push_back(contact.weight);
        rows.direction.push_back(contact.direction);
        rows.obstacle_point.push_back(contact.obstacle_point);
        rows.obstacle_displacement.push_back(contact.obstacle_displacement);
        rows.distance.push_back(contact.distance);
        rows.thickness.push_back(thickness);
        rows.friction.push_back(obstacles_[pair.obstacle]->friction());
        rows.obstacle.push_back(pair.obstacle);
        rows.feature.push_back(pair.feature);
    }

    /// Lowers `safe` where a pair of the cluster needs it. `obstacle_way`: how far obstacles go during the whole move.
    double cut_cluster(const ClothMove& move, double obstacle_way, std::size_t cluster, double safe) {
        ClusterList& list = lists_->lists()[cluster];
        const auto farther = [&](double reach, double way, double thickness) {
            return reach - list.travel >= within((way + obstacle_way) * safe, thickness);
        };
        if (farther(list.least_reach, lists_->cluster_way(cluster), list.thickness)) return safe;
        list.least_reach = infinity;
        for (std::size_t f = 0; f < list.features.size(); ++f) {
            const ListedFeature& feature = list.features[f];
            double way = 0.0;
            for (int k = 0; k < feature.pair.cloth_count(); ++k) way = std::max(way, lists_->ways()[feature.pair.cloth[k]]);
            if (!farther(static_cast<double>(list.bounds[f].reach), way, thickness_[feature.pair.cloth[0]])) {
                safe = cut_feature(move, way + obstacle_way, f, list, safe);
            }
            list.least_reach = std::min(list.least_reach, static_cast<double>(list.bounds[f].reach));
        }
        return safe;
    }

    double cut_feature(const ClothMove& move, double way, std::size_t f, ClusterList& list, double safe) {
        const ListedFeature& feature = list.features[f];
        const double thickness = thickness_[feature.pair.cloth[0]];
        Box room;
        for (int k = 0; k < feature.pair.cloth_count(); ++k) {
            room.add(move.from[feature.pair.cloth[k]]);
            room.add(move.to[feature.pair.cloth[k]]);
        }
        room.grow(largest_floor * thickness);
        const ObstaclePacks& packs = obstacles_[feature.pair.obstacle]->packs();
        float least = infinity;
        for (int i = feature.first; i < feature.first + feature.count; ++i) {
            ListedPack& listed = list.packs[i];
            const double near = within(way * safe, thickness);
            const bool may_cross = static_cast<double>(listed.reach) - list.travel < near &&
                                   !stays_above(packs.planes[listed.pack], feature.pair, move, largest_floor * thickness) &&
                                   packs.packs[listed.pack].box.overlaps(room);
            if (may_cross) safe = cut_pack(move, feature, near, list, listed, safe);
            least = std::min(least, listed.reach);
        }
        list.bounds[f].reach = least;
        return safe;
    }

    double cut_pack(const ClothMove& move, const ListedFeature& feature, double near, const ClusterList& list, ListedPack& listed,
                    double safe) {
        const PackAnswer answer = measure_pack(move, feature, near, list, listed);
        const Obstacle& obstacle = *obstacles_[feature.pair.obstacle];
        for (unsigned lanes = answer.near; lanes != 0; lanes &= lanes - 1) {
            const ContactPair pair = feature.with(obstacle.packs().packs[listed.pack], std::countr_zero(lanes));
            const Vec3 apart = pair_apart(pair, move.from, obstacle, move.part.from);
            const double distance = apart.norm(), floor = floor_below(distance, thickness_[pair.cloth[0]]);
            const MovingFour four = moving_pair(pair, move, obstacle);
            // Convex features that a plane parts at both ends of a straight move are parted by it throughout.
            const double kept = floor + 0.1 * (distance - floor);
            if (distance > 0.0 && gap_along(four, cloth_slots(pair.kind), apart / distance, safe) >= kept) continue;
            safe = safe_time(four, shape_of(pair.kind), floor, safe);
        }
        return safe;
    }

    TreeFactory make_tree_;
    std::vector<Triangle> triangles_;
    std::vector<double> thickness_;
    Obstacles obstacles_;
    std::optional<CandidateLists> lists_;
    std::vector<ClusterList*> near_clusters_;
    std::vector<ActiveFeature> active_;
    std::vector<SelectedPack> candidates_, selected_;
    std::vector<SelectedLane> lanes_;
    std::vector<Vec3> kept_at_;                           // m, where each vertex was when its contacts were last forgotten
    std::vector<unsigned char> moved_;                    // whether they are to be forgotten now
    std::optional<SelfContactDetection> between_cloths_;  // if any cloth meets cloth
    double smallest_distance_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::unique_ptr<ContactDetector> make_detector(TreeFactory make_tree) { return std::make_unique<MeshDetector>(make_tree); }

}  // namespace percale
