#include "seams.h"

#include <algorithm>

namespace percale {
namespace {

double distance(const Vectors& x, int i, int j) { return (x.at(i) - x.at(j)).norm(); }

/// What of the lengths is left at a time.
double share_left(const Seam& seam, double time) {
    if (time <= seam.from) return 1.0;
    return seam.closes_after(time) ? 1.0 - (time - seam.from) / seam.over : 0.0;
}

}  // namespace

void append_seam(std::span<const std::array<int, 2>> pairs, double stiffness, const Vectors& positions, Seam& seam,
                 ClothModel& model) {
    SpringNetwork& network = model.springs;
    seam.first_spring = network.size();
    seam.length.clear();
    for (const auto& [one, other] : pairs) {
        append_pair(std::min(one, other), std::max(one, other), network);
        seam.length.push_back(distance(positions, one, other));
        network.rest_length.back() = seam.length.back();
        network.stiffness.back() = stiffness;
        network.kind.back() = SpringKind::seam;
    }
}

void set_seam_lengths(const Seam& seam, double time, std::vector<double>& rest_length) {
    const double left = share_left(seam, time);
    for (std::size_t k = 0; k < seam.length.size(); ++k) rest_length[seam.first_spring + k] = left * seam.length[k];
}

double seam_energy(const Seam& seam, double time, const SpringNetwork& network, const Vectors& positions) {
    const double left = share_left(seam, time);
    double twice_energy = 0.0;
    for (std::size_t k = 0; k < seam.length.size(); ++k) {
        const int spring = seam.first_spring + static_cast<int>(k);
        const double rest_length = left * seam.length[k];
        const double stretch = distance(positions, network.first[spring], network.second[spring]) - rest_length;
        twice_energy += network.stiffness[spring] * stretch * stretch;
    }
    return 0.5 * twice_energy;
}

}  // namespace percale
