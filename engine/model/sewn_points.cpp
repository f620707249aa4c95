#include "sewn_points.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace percale {
namespace {

/// Vertices that stitches within one cloth join have the number of the lowest of them; empty without such stitches.
std::vector<int> sewn_numbers(std::span<const int> cloth_of_vertex, const SpringNetwork& springs) {
    std::vector<std::array<int, 2>> joined;
    for (int k = 0; k < springs.size(); ++k) {
        const int a = springs.first[k], b = springs.second[k];
        const bool stitch = springs.kind[k] == SpringKind::seam && springs.stiffness[k] > 0.0;
        if (stitch && cloth_of_vertex[a] == cloth_of_vertex[b]) joined.push_back({a, b});
    }
    if (joined.empty()) return {};
    std::vector<int> number(cloth_of_vertex.size());
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

Vec3 stitch_gap(const Stitch& stitch, const Vec3Arrays& positions) {
    if (stitch.joins_vertices()) return positions.at(stitch.vertex) - positions.at(stitch.other());
    return positions.at(stitch.vertex) -
           ((1.0 - stitch.share) * positions.at(stitch.from) + stitch.share * positions.at(stitch.to));
}

Vec3 sewn_gap(const SewnPoint& point, const Vec3Arrays& positions) {
    const auto& [vertex, from, to, share] = point.stitch;
    return positions.at(vertex) - ((1.0 - share) * positions.at(from) + share * positions.at(to));
}

double sewn_energy(const SewnPoint& point, double length, const Vec3Arrays& positions) {
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

void leave_out_sewn_edges(std::span<const int> cloth_of_vertex, SpringNetwork& springs, Hinges& hinges) {
    const std::vector<int> number = sewn_numbers(cloth_of_vertex, springs);
    if (number.empty()) return;
    const auto sewn = [&](int a, int b) { return a >= 0 && b >= 0 && number[a] == number[b]; };
    for (int k = 0; k < springs.size(); ++k) {
        const bool seam_activation_distance = springs.kind[k] == SpringKind::seam || springs.kind[k] == SpringKind::point;
        if (!seam_activation_distance && sewn(springs.first[k], springs.second[k]))
            springs.stiffness[k] = springs.damping[k] = 0.0;
    }
    for (Hinge& hinge : hinges.all) {
        // The far vertices of a fold, which may lie on each other, and the diagonals of a cell are left out.
        const int first = hinge.folds ? 0 : 1, last = 5;
        const bool flattened = std::any_of(hinge_pairs + first, hinge_pairs + last,
                                           [&](const int* pair) { return sewn(hinge.vertex[pair[0]], hinge.vertex[pair[1]]); });
        if (flattened) hinge.stiffness = 0.0;
    }
}

}  // namespace percale
