#include "seams.h"

#include <algorithm>

namespace percale {
namespace {

/// The remaining fraction of the lengths at a time.
double share_left(const Seam& seam, double time) {
    if (time <= seam.from) return 1.0;
    return seam.closes_after(time) ? 1.0 - (time - seam.from) / seam.over : 0.0;
}

void append_pair_of(const Stitch& stitch, double stiffness, double length, SpringNetwork& network) {
    const int other = stitch.other();
    append_pair(std::min(stitch.vertex, other), std::max(stitch.vertex, other), network);
    network.rest_length.back() = length;
    network.stiffness.back() = stiffness;
    network.kind.back() = SpringKind::seam;
}

}  // namespace

void append_seam(std::span<const Stitch> stitches, double stiffness, const Vec3Arrays& positions, Seam& seam, ClothModel& model) {
    SpringNetwork& network = model.springs;
    seam.first_spring = network.size();
    seam.length.clear();
    seam.stitches.assign(stitches.begin(), stitches.end());
    for (const Stitch& stitch : stitches) {
        const Vec3 gap = stitch_gap(stitch, positions);
        const double length = gap.norm();
        seam.length.push_back(length);
        // The spring of a point has no stiffness of its own: it joins the vertices, and holds the length.
        append_pair_of(stitch, stitch.joins_vertices() ? stiffness : 0.0, length, network);
    }
    if (seam.first_weld >= 0) {
        for (const Stitch& stitch : stitches) model.welds.push_back({stitch, stiffness});
    }
    for (std::size_t k = 0; k < stitches.size(); ++k) {
        const Stitch& stitch = stitches[k];
        if (stitch.joins_vertices()) continue;
        const Vec3 direction = seam.length[k] > 0.0 ? Vec3(stitch_gap(stitch, positions) / seam.length[k]) : Vec3(Vec3::Zero());
        model.sewn_points.push_back({stitch, stiffness, direction, seam.first_spring + static_cast<int>(k), network.size()});
        append_pair(stitch.vertex, stitch.to, network);
        network.kind.back() = SpringKind::point;
        append_pair(stitch.from, stitch.to, network);
    }
}

void set_seam_lengths(const Seam& seam, double time, std::vector<double>& rest_length) {
    const double left = share_left(seam, time);
    for (std::size_t k = 0; k < seam.length.size(); ++k) rest_length[seam.first_spring + k] = left * seam.length[k];
}

double seam_energy(const Seam& seam, double time, const ClothModel& model, const Vec3Arrays& positions) {
    const double left = share_left(seam, time);
    double twice_energy = 0.0;
    for (std::size_t k = 0; k < seam.length.size(); ++k) {
        const int spring = seam.first_spring + static_cast<int>(k);
        const double stretch = stitch_gap(seam.stitches[k], positions).norm() - left * seam.length[k];
        twice_energy += model.springs.stiffness[spring] * stretch * stretch;
    }
    double energy = 0.5 * twice_energy;
    const int end = seam.first_spring + static_cast<int>(seam.length.size());
    for (const SewnPoint& point : model.sewn_points) {
        if (point.spring < seam.first_spring || point.spring >= end) continue;
        energy += sewn_energy(point, left * seam.length[point.spring - seam.first_spring], positions);
    }
    return energy;
}

std::span<Weld> welds_of(const Seam& seam, ClothModel& model) {
    if (seam.first_weld < 0) return {};
    return std::span(model.welds).subspan(seam.first_weld, seam.length.size());
}

}  // namespace percale
