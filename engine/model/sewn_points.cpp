#include "sewn_points.h"

namespace percale {

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

}  // namespace percale
