#include "detector.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "candidate_lists.h"
#include "pack_measure.h"
#include "percale/certify.h"

namespace percale {
namespace {

constexpr double most_floor = 0.2;  // of the thickness

/// The distance a cut leaves of a distance d, m: a fifth of the thickness h for d above 0.4 h, half of d below, but never less
/// than h/1000 unless d itself is there. Without a floor distances collapse to rounding, where directions are lost; a fixed floor
/// would lock vertices.
double floor_below(double d, double h) {
    if (d > 2.0 * most_floor * h) return most_floor * h;
    return d > 1e-3 * h ? std::max(0.5 * d, 1e-3 * h) : 0.999 * d;
}

/// Pairs farther apart than this keep their floor if they come closer by no more than `way`.
double within(double way, double h) { return way > most_floor * h ? way + most_floor * h : std::max(2.0 * way, way + 1e-3 * h); }

StartFault start_fault(int obstacle, const Certificate& certificate) {
    StartFault fault{.obstacle = obstacle,
                     .intersecting_pairs = static_cast<int>(certificate.pairs.size()),
                     .vertices_inside = certificate.vertices_inside,
                     .inside_vertex = certificate.deepest_vertex};
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
    }

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
        return {};
    }

    void refresh(std::span<const Vec3> start, std::span<const Vec3> predicted) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, start);
        for (ClusterList& list : lists_->lists()) {
            if (!list.holds) continue;
            for (ListedPack& pack : list.packs) pack.held = 0;
            list.holds = false;
        }
        lists_->cover({.from = start, .to = predicted, .part = {0.0, 1.0}}, obstacles_);
    }

    void evaluate(std::span<const Vec3> positions, double fraction, ContactRows& rows) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, positions);
        lists_->cover({.from = positions, .to = positions, .part = {fraction, fraction}}, obstacles_);
        rows.clear();
        smallest_distance_ = std::numeric_limits<double>::infinity();
        for (ClusterList& list : lists_->lists()) {
            const bool near = list.least_reach - list.travel < list.thickness;
            if (near && (list.holds || list.least_row_reach <= list.travel)) evaluate_cluster(positions, fraction, list, rows);
        }
    }

    double largest_safe_fraction(std::span<const Vec3> from, std::span<const Vec3> to, StepFraction part) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, from);
        const ClothMove move{.from = from, .to = to, .part = part};
        const double covered = lists_->cover(move, obstacles_);
        double obstacle_way = 0.0;
        for (const auto& obstacle : obstacles_) obstacle_way = std::max(obstacle_way, obstacle->longest_way());
        obstacle_way *= part.to - part.from;
        double safe = covered;
        for (ClusterList& list : lists_->lists()) {
            if (!list.features.empty()) safe = cut_cluster(move, obstacle_way, list, safe);
        }
        return safe;
    }

    double smallest_distance() const override { return smallest_distance_; }

private:
    void evaluate_cluster(std::span<const Vec3> positions, double fraction, ClusterList& list, ContactRows& rows) {
        list.least_reach = list.least_row_reach = std::numeric_limits<double>::infinity();
        for (const ListedFeature& feature : list.features) {
            const double thickness = thickness_[feature.pair.cloth[0]];
            for (int i = feature.first; i < feature.first + feature.count; ++i) {
                ListedPack& listed = list.packs[i];
                const bool may_have_rows = listed.held != 0 || listed.row_reach <= list.travel;
                if (may_have_rows && listed.reach - list.travel < thickness) {
                    evaluate_pack({positions, positions, {fraction, fraction}}, feature, list, listed, rows);
                }
                list.least_reach = std::min(list.least_reach, listed.reach);
                list.least_row_reach = std::min(list.least_row_reach, listed.row_reach);
            }
        }
    }

    PackAnswer measure_pack(const ClothMove& move, const ListedFeature& feature, double near, const ClusterList& list,
                            ListedPack& listed) {
        Obstacle& obstacle = *obstacles_[feature.pair.obstacle];
        const PackAnswer answer =
            measure(feature.pair, move.from, obstacle.packs().packs[listed.pack], obstacle.placed(listed.pack, move.part.from),
                    {.near = near, .thickness = thickness_[feature.pair.cloth[0]]});
        listed.reach = static_cast<double>(answer.least) + list.travel;
        listed.row_reach = static_cast<double>(answer.least_row) + list.travel;
        return answer;
    }

    void evaluate_pack(const ClothMove& here, const ListedFeature& feature, ClusterList& list, ListedPack& listed,
                       ContactRows& rows) {
        const double thickness = thickness_[feature.pair.cloth[0]];
        const PackAnswer answer = measure_pack(here, feature, thickness, list, listed);
        const Obstacle& obstacle = *obstacles_[feature.pair.obstacle];
        const FeaturePack& pack = obstacle.packs().packs[listed.pack];
        for (unsigned lanes = answer.row | (listed.held & answer.near); lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            const ContactPair pair = feature.with(pack, lane);
            const PairContact contact = pair_contact(pair, here.from, obstacle, here.part.from);
            smallest_distance_ = std::min(smallest_distance_, contact.distance);
            if (contact.distance >= thickness) continue;
            // A pair that was a contact stays one until the next refresh: rows only join while a step is being solved, so
            // that the force is continuous where closest points pass from one feature to the next.
            if (contact.local_minimum) listed.held = static_cast<unsigned char>(listed.held | 1U << lane);
            if ((listed.held >> lane & 1U) != 0) add_row(pair, contact, thickness, rows);
        }
        list.holds = list.holds || listed.held != 0;
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
    double cut_cluster(const ClothMove& move, double obstacle_way, ClusterList& list, double safe) {
        const std::span<const double> ways = lists_->ways();
        for (const ListedFeature& feature : list.features) {
            Box room;
            double way = 0.0;
            for (int k = 0; k < feature.pair.cloth_count(); ++k) {
                const int vertex = feature.pair.cloth[k];
                room.add(move.from[vertex]);
                room.add(move.to[vertex]);
                way = std::max(way, ways[vertex]);
            }
            const double thickness = thickness_[feature.pair.cloth[0]];
            room.grow(most_floor * thickness);
            for (int i = feature.first; i < feature.first + feature.count; ++i) {
                ListedPack& listed = list.packs[i];
                const double near = within((way + obstacle_way) * safe, thickness);
                if (listed.reach - list.travel >= near) continue;
                const FeaturePack& pack = obstacles_[feature.pair.obstacle]->packs().packs[listed.pack];
                if (pack.box.overlaps(room)) safe = cut_pack(move, feature, near, list, listed, safe);
            }
        }
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
    double smallest_distance_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::unique_ptr<ContactDetector> make_detector(TreeFactory make_tree) { return std::make_unique<MeshDetector>(make_tree); }

}  // namespace percale
