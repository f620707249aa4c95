#include "detector.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "candidate_lists.h"
#include "cut_floor.h"
#include "percale/certify.h"
#include "self_contact_detection.h"

namespace percale {
namespace {

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

    void refresh(std::span<const Vec3> start, std::span<const Vec3> predicted) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, start);
        for (ClusterList& list : lists_->lists()) {
            for (ContactPair& pair : list.pairs) pair.held = false;
        }
        lists_->cover({.from = start, .to = predicted, .part = {0.0, 1.0}}, obstacles_);
        if (between_cloths_) between_cloths_->refresh(start, predicted);
    }

    void evaluate(std::span<const Vec3> positions, double fraction, ContactRows& rows) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, positions);
        lists_->cover({.from = positions, .to = positions, .part = {fraction, fraction}}, obstacles_);
        rows.clear();
        smallest_distance_ = std::numeric_limits<double>::infinity();
        for (ClusterList& list : lists_->lists()) {
            if (list.least_reach - list.travel < list.thickness) evaluate_cluster(positions, fraction, list, rows);
        }
        if (between_cloths_) smallest_distance_ = std::min(smallest_distance_, between_cloths_->add_rows(positions, rows));
    }

    double largest_safe_fraction(std::span<const Vec3> from, std::span<const Vec3> to, StepFraction part) override {
        if (!lists_) lists_.emplace(triangles_, thickness_, from);
        const ClothMove move{.from = from, .to = to, .part = part};
        const double covered = lists_->cover(move, obstacles_);
        double obstacle_way = 0.0;
        for (const auto& obstacle : obstacles_) obstacle_way = std::max(obstacle_way, obstacle->longest_way());
        obstacle_way *= part.to - part.from;
        double safe = covered;
        const std::span<const ClothCluster> clusters = lists_->clusters();
        for (std::size_t i = 0; i < clusters.size(); ++i) {
            ClusterList& list = lists_->lists()[i];
            if (list.pairs.empty()) continue;
            double way = 0.0;
            for (const int vertex : clusters[i].all_vertices) way = std::max(way, (to[vertex] - from[vertex]).norm());
            safe = cut_cluster(move, way + obstacle_way, list, safe);
        }
        return between_cloths_ ? std::min(safe, between_cloths_->largest_safe_fraction(from, to)) : safe;
    }

    double smallest_distance() const override { return smallest_distance_; }

private:
    void evaluate_cluster(std::span<const Vec3> positions, double fraction, ClusterList& list, ContactRows& rows) {
        list.least_reach = std::numeric_limits<double>::infinity();
        for (ContactPair& pair : list.pairs) {
            const double thickness = thickness_[pair.cloth[0]];
            if (pair.reach - list.travel < thickness) {
                const PairContact contact = pair_contact(pair, positions, *obstacles_[pair.obstacle], fraction);
                pair.reach = contact.distance + list.travel;
                smallest_distance_ = std::min(smallest_distance_, contact.distance);
                // A pair that was a contact stays one until the next refresh: rows only join while a step is being solved, so
                // that the force is continuous where closest points pass from one feature to the next.
                pair.held = pair.held || (contact.distance < thickness && contact.local_minimum);
                if (pair.held && contact.distance < thickness) add_row(pair, contact, thickness, rows);
            }
            list.least_reach = std::min(list.least_reach, pair.reach);
        }
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

    /// `way`: how much any distance of the cluster can shrink during the whole move. Lowers `safe` where a pair needs it.
    double cut_cluster(const ClothMove& move, double way, ClusterList& list, double safe) {
        const auto far = [&](double distance, double thickness) {
            return distance - floor_below(distance, thickness) > way * safe;
        };
        if (far(list.least_reach - list.travel, list.thickness)) return safe;
        for (ContactPair& pair : list.pairs) {
            const double thickness = thickness_[pair.cloth[0]];
            if (far(pair.reach - list.travel, thickness)) continue;
            const Obstacle& obstacle = *obstacles_[pair.obstacle];
            const double distance = pair_distance(pair, move.from, obstacle, move.part.from);
            pair.reach = distance + list.travel;
            if (far(distance, thickness)) continue;
            safe = safe_time(moving_pair(pair, move, obstacle), shape_of(pair.kind), floor_below(distance, thickness), safe);
        }
        return safe;
    }

    TreeFactory make_tree_;
    std::vector<Triangle> triangles_;
    std::vector<double> thickness_;
    Obstacles obstacles_;
    std::optional<CandidateLists> lists_;
    std::optional<SelfContactDetection> between_cloths_;  // if any cloth meets cloth
    double smallest_distance_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::unique_ptr<ContactDetector> make_detector(TreeFactory make_tree) { return std::make_unique<MeshDetector>(make_tree); }

}  // namespace percale
