#pragma once

#include <Eigen/Core>

#include "block_matrix.h"

namespace percale {

/// The blocks of a membrane's triangle between the vertex i of a corner and the two others: with y_i = -(u_p p + u_q q), u_p = pq
/// q.dq + pr r.dr, u_q = pq p.dp + qr r.dr (MembraneCorners).
struct CornerBlocks {
    Eigen::Matrix3d first, second;

    explicit CornerBlocks(const float* value) {
        const auto edge = [&](int k) {
            return Vec3(value[k * slice_lanes], value[(k + 1) * slice_lanes], value[(k + 2) * slice_lanes]);
        };
        const Vec3 p = edge(0), q = edge(3), r = edge(6);
        const double pq = value[9 * slice_lanes], pr = value[10 * slice_lanes], qr = value[11 * slice_lanes];
        first = pr * p * r.transpose() + q * (qr * r - pq * p).transpose();
        second = -p * (pq * q + pr * r).transpose() - qr * q * r.transpose();
    }
};

/// Calls work(j, block) for the blocks of springs and then of membranes between vertex i and others, kg: the blocks of row i off
/// the diagonal, several for one j.
template <class Work>
void for_each_entry(const BlockMatrix& matrix, int i, const Work& work) {
    const Adjacency& pattern = *matrix.pattern;
    const int slice = i / slice_lanes, lane = i % slice_lanes;
    for (int e = pattern.start[slice] + lane; e < pattern.start[slice + 1]; e += slice_lanes) {
        const int j = pattern.other[e];
        if (j == i) continue;
        const auto [a, w] = spring_block(pattern, *matrix.springs, pattern.spring[e]);
        work(j, Eigen::Matrix3d(-a * Eigen::Matrix3d::Identity() - w * w.transpose()));
    }
    if (matrix.springs->corners.empty()) return;
    const MembraneCorners corners = pattern.membrane.corners();
    for (int e = corners.start[slice] + lane; e < corners.start[slice + 1]; e += slice_lanes) {
        const CornerBlocks blocks(&matrix.springs->corners[corner_values * static_cast<std::size_t>(e - lane) + lane]);
        work(corners.other[0][e], blocks.first);
        work(corners.other[1][e], blocks.second);
    }
}

}  // namespace percale
