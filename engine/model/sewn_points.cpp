#include "sewn_points.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace percale {
namespace {

/// Vertices that stitches join have the number of the lowest of them; empty without stitches from vertex to vertex.
std::vector<int> sewn_numbers(const SpringNetwork& springs, int vertices) {
    std::vector<std::array<int, 2>> joined;
    for (int k = 0; k < springs.size(); ++k) {
        const bool stitch = springs.kind[k] == SpringKind::seam && springs.stiffness[k] > 0.0;
        if (stitch) joined.push_back({springs.first[k], springs.second[k]});
    }
    if (joined.empty()) return {};
    std::vector<int> number(static_cast<std::size_t>(vertices));
    std::iota(number.begin(), number.end(), 0);
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b] : joined) {
            changed = changed || number[a] != number[b];
            number[a] = number[b] = std::min(number[a], number[b]);
        }
    }
    return number;
}

}  // namespace

Vec3 stitch_gap(const Stitch& stitch, const Vectors& positions) {
    if (stitch.joins_vertices()) return positions.at(stitch.vertex) - positions.at(stitch.other());
    return positions.at(stitch.vertex) -
           ((1.0 - stitch.share) * positions.at(stitch.from) + stitch.share * positions.at(stitch.to));
}

Vec3 sewn_gap(const SewnPoint& point, const Vectors& positions) {
    const auto& [vertex, from, to, share] = point.stitch;
    return positions.at(vertex) - ((1.0 - share) * positions.at(from) + share * positions.at(to));
}

double sewn_energy(const SewnPoint& point, double length, const Vectors& positions) {
    return 0.5 * point.stiffness * (sewn_gap(point, positions) - length * point.direction).squaredNorm();
}

void add_sewn_pairs(std::span<const SewnPoint> points, SpringNetwork& network) {
    if (points.empty()) return;
    network.bending.resize(network.size(), 0.0);
    for (const SewnPoint& point : points) {
        const double k = point.stiffness, t = point.stitch.share;
        network.bending[point.spring] += k * (1.0 - t);
        network.bending[point.pair] += k * t;
        network.bending[point.pair + 1] -= k * t * (1.0 - t);
    }
}

void leave_out_sewn_edges(int vertices, SpringNetwork& springs, Hinges& hinges, std::vector<MembraneTriangle>& membrane) {
    const std::vector<int> number = sewn_numbers(springs, vertices);
    if (number.empty()) return;
    const auto sewn = [&](int a, int b) { return a >= 0 && b >= 0 && number[a] == number[b]; };
    for (int k = 0; k < springs.size(); ++k) {
        const bool of_seam = springs.kind[k] == SpringKind::seam || springs.kind[k] == SpringKind::point;
        if (!of_seam && sewn(springs.first[k], springs.second[k])) springs.stiffness[k] = springs.damping[k] = 0.0;
    }
    for (Hinge& hinge : hinges.all) {
        // All pairs but the last, of two vertices that no edge joins: cloth folded together there holds as it is.
        const bool flattened = std::any_of(std::begin(hinge_pairs), std::end(hinge_pairs) - 1,
                                           [&](const int* p) { return sewn(hinge.vertex[p[0]], hinge.vertex[p[1]]); });
        if (flattened) hinge.stiffness = hinge.rest_angle = 0.0;  // an angle without area is not finite
    }
    std::erase_if(hinges.curved, [&](int hinge) { return hinges.all[hinge].rest_angle == 0.0; });
    for (MembraneTriangle& triangle : membrane) {
        const auto [a, b, c] = triangle.vertex;
        if (sewn(a, b) || sewn(b, c) || sewn(c, a)) triangle.stiffness.setZero();
    }
}

}  // namespace percale
