#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "percale/certify.h"
#include "percale/contact.h"
#include "percale/mesh.h"
#include "tests/support/random.h"

namespace percale::test {

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// The same constraints in the same order to the last bit.
inline bool same_constraints(const ContactConstraints& a, const ContactConstraints& b) {
    return same_bits(a.vertex, b.vertex) && same_bits(a.weight, b.weight) && same_bits(a.direction, b.direction) &&
           same_bits(a.obstacle_point, b.obstacle_point) && same_bits(a.obstacle_displacement, b.obstacle_displacement) &&
           same_bits(a.distance, b.distance) && same_bits(a.thickness, b.thickness) && same_bits(a.friction, b.friction) &&
           same_bits(a.mollifier, b.mollifier) && a.obstacle == b.obstacle && a.feature == b.feature;
}

inline std::vector<Vec3> between(std::span<const Vec3> from, std::span<const Vec3> to, double fraction) {
    std::vector<Vec3> x;
    for (std::size_t i = 0; i < from.size(); ++i) x.push_back(from[i] + fraction * (to[i] - from[i]));
    return x;
}

/// A mesh on its way from one pose to another within a step: vertices move straight.
struct MovingMesh {
    TriangleMesh mesh;
    Pose start, end;

    TriangleMesh at(double fraction) const {
        TriangleMesh result = mesh;
        result.vertices = between(transform(start, mesh.vertices), transform(end, mesh.vertices), fraction);
        return result;
    }
    bool free_of(const TriangleMesh& cloth, double fraction) const {
        const Certificate certificate = certify(cloth, at(fraction), 0.0);
        return certificate.clean() && certificate.touching_pairs == 0;
    }
};

/// Cloth and obstacles in steps, each move clamped by a detector.
struct Steps {
    TriangleMesh cloth;
    std::vector<MovingMesh> obstacles;
    std::unique_ptr<ContactDetector> detector;

    void start(std::unique_ptr<ContactDetector> made, double thickness) {
        detector = std::move(made);
        const std::vector<double> all(cloth.vertices.size(), thickness);
        detector->set_cloth(cloth.triangles, all);
        for (std::size_t i = 0; i < obstacles.size(); ++i)
            detector->add_obstacle(obstacles[i].mesh, obstacles[i].start, 0.1 * double(i));
        report_poses();
    }
    void report_poses() {
        for (std::size_t i = 0; i < obstacles.size(); ++i) {
            detector->move_obstacle(static_cast<int>(i), obstacles[i].start, obstacles[i].end);
        }
    }
    bool clean(std::span<const Vec3> x, double fraction) const {
        TriangleMesh here = cloth;
        here.vertices.assign(x.begin(), x.end());
        return std::all_of(obstacles.begin(), obstacles.end(), [&](const MovingMesh& o) { return o.free_of(here, fraction); });
    }
};

}  // namespace percale::test
