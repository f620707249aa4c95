#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include "percale/fabric.h"
#include "percale/mesh.h"
#include "tests/support/cpu_time.h"

namespace percale::test {

/// One spring of the plain loop, in a straightforward implementation: an array of structs.
struct PlainSpring {
    int a, b;
    double rest, stiffness, damping;  // m, N/m, N s/m
};

/// The springs of an n x n grid of 1 m: structural, shear, bend, with the constants of bench_fabric().
inline std::vector<PlainSpring> plain_springs(int n) {
    std::vector<PlainSpring> springs;
    const double h = 1.0 / (n - 1);
    const int families[6][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 0}, {0, 2}};
    const double stiffness[6] = {1000, 1000, 500, 500, 10, 10};
    for (int family = 0; family < 6; ++family) {
        const auto [dx, dy] = families[family];
        for (int y = 0; y + dy < n; ++y) {
            for (int x = std::max(0, -dx); x < n - std::max(0, dx); ++x) {
                springs.push_back({y * n + x, (y + dy) * n + x + dx, h * std::hypot(dx, dy), stiffness[family], 0.1});
            }
        }
    }
    return springs;
}

/// The fabric of every measured sheet.
inline Fabric bench_fabric() { return {.springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0}}; }

/// forces = gravity and springs, one spring after the other; kd is damping along the spring.
inline void plain_forces(const std::vector<PlainSpring>& springs, const std::vector<Vec3>& positions,
                         const std::vector<Vec3>& velocities, std::vector<Vec3>& forces) {
    std::fill(forces.begin(), forces.end(), Vec3(0, -9.81, 0));
    for (const PlainSpring& s : springs) {
        const Vec3 x = positions[s.a] - positions[s.b];
        const double length = x.norm();
        const Vec3 d = x / length;
        const Vec3 f = -(s.stiffness * (length - s.rest) + s.damping * (velocities[s.a] - velocities[s.b]).dot(d)) * d;
        forces[s.a] += f;
        forces[s.b] -= f;
    }
}

/// CPU seconds of each call, the minimum of `rounds`. A round makes every call once, so that the load of a machine affects all
/// alike.
inline std::vector<double> min_seconds(int rounds, const std::vector<std::function<void()>>& calls) {
    std::vector<double> least(calls.size(), std::numeric_limits<double>::infinity());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t k = 0; k < calls.size(); ++k) {
            const double start = cpu_seconds();
            calls[k]();
            least[k] = std::min(least[k], cpu_seconds() - start);
        }
    }
    return least;
}

/// The plain loop over a stretched n x n sheet.
struct PlainSheet {
    std::vector<PlainSpring> springs;
    std::vector<Vec3> positions, velocities, forces;

    explicit PlainSheet(int n)
        : springs(plain_springs(n)), velocities(static_cast<std::size_t>(n) * n, Vec3(0.1, 0.2, 0.3)), forces(velocities.size()) {
        for (int i = 0; i < n * n; ++i) positions.emplace_back(1.01 * (i % n) / (n - 1), 0.0, 1.02 * (i / n) / (n - 1));
    }
    void evaluate() { plain_forces(springs, positions, velocities, forces); }
};

/// The machine unit U: CPU milliseconds of one pass of the plain loop, the minimum of many. Throws if the result is not finite.
inline double machine_unit(int n, int passes = 200) {
    PlainSheet sheet(n);
    const double seconds = min_seconds(passes, {[&] { sheet.evaluate(); }})[0];
    for (const Vec3& f : sheet.forces) {
        if (!f.allFinite()) throw std::runtime_error("the plain force loop gave a force that is not finite");
    }
    return 1e3 * seconds;
}

}  // namespace percale::test
