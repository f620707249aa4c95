#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "percale/contact.h"
#include "percale/saved_state.h"

namespace percale::test {

/// Contact of cloth vertices with unbounded planes in closed form, so that the engine is tested without a collision layer.
/// Every obstacle, whatever its mesh, is the plane through its pose's translation with the rotated y axis as normal; cloth
/// belongs above. Planes may move but not turn.
class PlaneDetector : public ContactDetector {
public:
    void set_cloth(std::span<const Triangle>, std::span<const double> vertex_thickness) override {
        thickness_.assign(vertex_thickness.begin(), vertex_thickness.end());
    }

    int add_obstacle(const TriangleMesh&, const Pose& pose, double friction) override {
        const Pose turn{.translation = Vec3::Zero(), .rotation = pose.rotation, .scale = 1.0};
        planes_.push_back({transform(turn, Vec3(0.0, 1.0, 0.0)), pose.translation, pose.translation, friction});
        return static_cast<int>(planes_.size()) - 1;
    }

    void remove_obstacle(int obstacle) override { planes_.erase(planes_.begin() + obstacle); }
    void set_friction(int obstacle, double friction) override { planes_[obstacle].friction = friction; }

    void move_obstacle(int obstacle, const Pose& start, const Pose& end) override {
        planes_[obstacle].start = start.translation;
        planes_[obstacle].end = end.translation;
    }

    StartFault check_start(std::span<const Vec3> positions) override {
        StartFault fault;
        for (std::size_t k = 0; k < planes_.size(); ++k) {
            for (std::size_t i = 0; i < positions.size(); ++i) {
                if (distance(planes_[k], positions[i], 0.0) >= 0.0) continue;
                ++fault.vertices_inside;
                fault.inside_vertex = static_cast<int>(i);
                fault.obstacle = static_cast<int>(k);
            }
        }
        return fault;
    }

    void update_candidates(std::span<const Vec3>, std::span<const Vec3>) override { ++candidate_updates; }

    void find_contacts(std::span<const Vec3> positions, double fraction, ContactConstraints& constraints) override {
        constraints.clear();
        smallest_ = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < positions.size(); ++i) {
            for (std::size_t k = 0; k < planes_.size(); ++k)
                add_constraint(static_cast<int>(i), static_cast<int>(k), positions, fraction, constraints);
        }
    }

    double collision_free_step_size(std::span<const Vec3> from, std::span<const Vec3> to, StepFraction part) override {
        double fraction = 1.0;
        for (const Plane& plane : planes_) {
            for (std::size_t i = 0; i < from.size(); ++i) {
                const double before = distance(plane, from[i], part.from), after = distance(plane, to[i], part.to);
                const double keep = floor_from(before, thickness_[i]);
                if (after < keep && after < before)
                    fraction = std::min(fraction, std::max(0.0, (before - keep) / (before - after)));
            }
        }
        return fraction;
    }

    double smallest_distance() const override { return smallest_; }

    void save(StateWriter& state) const override {
        for (const Plane& plane : planes_) state(plane.start, plane.end);
    }
    void restore(StateReader& state) override {
        for (Plane& plane : planes_) state(plane.start, plane.end);
    }

    int candidate_updates = 0;

private:
    struct Plane {
        Vec3 normal, start, end;
        double friction;
    };

    static Vec3 place(const Plane& plane, double fraction) { return plane.start + fraction * (plane.end - plane.start); }
    static double distance(const Plane& plane, const Vec3& x, double fraction) {
        return plane.normal.dot(x - place(plane, fraction));
    }
    /// The smallest distance that a move from this distance may reach.
    static double floor_from(double distance, double thickness) {
        return std::max(std::min(0.2 * thickness, 0.5 * distance), 1e-3 * thickness);
    }

    void add_constraint(int vertex, int obstacle, std::span<const Vec3> positions, double fraction,
                        ContactConstraints& constraints) {
        const Plane& plane = planes_[obstacle];
        const double d = distance(plane, positions[vertex], fraction);
        smallest_ = std::min(smallest_, d);
        if (d >= thickness_[vertex]) return;
        constraints.vertex.push_back({vertex, -1, -1, -1});
        constraints.weight.push_back({1.0, 0.0, 0.0, 0.0});
        constraints.direction.push_back(plane.normal);
        constraints.obstacle_point.push_back(positions[vertex] - d * plane.normal);
        constraints.obstacle_displacement.push_back(plane.end - plane.start);
        constraints.distance.push_back(d);
        constraints.thickness.push_back(thickness_[vertex]);
        constraints.friction.push_back(plane.friction);
        constraints.mollifier.push_back(1.0);
        constraints.obstacle.push_back(obstacle);
        constraints.feature.push_back(0);
    }

    std::vector<double> thickness_;
    std::vector<Plane> planes_;
    double smallest_ = std::numeric_limits<double>::infinity();
};

}  // namespace percale::test
