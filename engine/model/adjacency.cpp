#include "adjacency.h"

#include <algorithm>
#include <cstdlib>

namespace percale {
namespace {

/// Fraction of the places of all bands that springs must fill. Springs that fill fewer are kept in slices. Cost alone.
constexpr double min_band_filling = 0.7;

/// Vertices. Wider grids leave the caches: the many arrays that bands read side by side are then slower than slices, which read
/// one (percale_force_cost at N = 257: a product took 1.5 times as long). Cost alone.
constexpr std::size_t longest_band_guard = 512;

std::vector<int> slice_starts(const std::vector<int>& degree, int slices) {
    std::vector<int> start(1, 0);
    for (int s = 0; s < slices; ++s) {
        const auto first = degree.begin() + s * slice_lanes;
        start.push_back(start.back() + slice_lanes * *std::max_element(first, first + slice_lanes));
    }
    return start;
}

/// Slices in which every entry is padding.
Adjacency padding_only(const std::vector<int>& degree, int vertex_count, int spring_count) {
    const int slices = static_cast<int>(degree.size()) / slice_lanes;
    Adjacency result{.vertex_count = vertex_count,
                     .start = slice_starts(degree, slices),
                     .other = {},
                     .spring = {},
                     .bands = {},
                     .place = std::vector<int>(spring_count),
                     .stiffness = {},
                     .rest_length = {},
                     .damping = {},
                     .bending = {},
                     .damped = false,
                     .sewn = {},
                     .membrane = {}};
    const std::size_t entries = result.start.back();
    result.other.resize(entries);
    result.spring.assign(entries, spring_count);
    for (int s = 0; s < slices; ++s) {
        for (int i = result.start[s]; i < result.start[s + 1]; ++i) {
            result.other[i] = s * slice_lanes + (i - result.start[s]) % slice_lanes;
        }
    }
    return result;
}

/// The bands of a network, if few bands hold all springs and each place holds at most one.
BandPattern find_bands(const SpringNetwork& network, int vertex_count) {
    BandPattern bands;
    std::vector<std::vector<bool>> taken;
    for (int k = 0; k < network.size(); ++k) {
        const int offset = std::abs(network.second[k] - network.first[k]), at = std::min(network.first[k], network.second[k]);
        int* band = std::find(bands.offset, bands.offset + bands.count, offset);
        if (band == bands.offset + bands.count) {
            if (bands.count == BandPattern::max) return {};
            bands.offset[bands.count++] = offset;
            taken.emplace_back(vertex_count, false);
        }
        auto place = taken[band - bands.offset].begin() + at;
        if (*place) return {};
        *place = true;
    }
    if (network.size() < min_band_filling * bands.count * vertex_count) return {};
    const int widest = *std::max_element(bands.offset, bands.offset + bands.count);
    bands.guard = static_cast<std::size_t>((widest + slice_lanes - 1) / slice_lanes) * slice_lanes;
    if (bands.guard > longest_band_guard) return {};
    bands.padded = static_cast<std::size_t>((vertex_count + slice_lanes - 1) / slice_lanes) * slice_lanes;
    return bands;
}

void place_in_bands(const SpringNetwork& network, Adjacency& adjacency) {
    const BandPattern& bands = adjacency.bands;
    for (int k = 0; k < network.size(); ++k) {
        const int offset = std::abs(network.second[k] - network.first[k]), at = std::min(network.first[k], network.second[k]);
        const auto band = std::find(bands.offset, bands.offset + bands.count, offset) - bands.offset;
        adjacency.place[k] = static_cast<int>(band * bands.padded) + at;
    }
}

/// Calls set(place, spring) for every place of every spring.
template <class Set>
void for_places(const SpringNetwork& network, const Adjacency& adjacency, Set set) {
    if (adjacency.bands.count > 0) {
        for (int k = 0; k < network.size(); ++k) set(adjacency.place[k], k);
        return;
    }
    for (std::size_t e = 0; e < adjacency.other.size(); ++e) {
        if (adjacency.spring[e] < network.size()) set(e, adjacency.spring[e]);
    }
}

void copy_constants(const SpringNetwork& network, Adjacency& adjacency) {
    const bool banded = adjacency.bands.count > 0;
    const std::size_t places = banded ? adjacency.bands.count * adjacency.bands.padded : adjacency.other.size();
    for (auto* list : {&adjacency.stiffness, &adjacency.rest_length, &adjacency.damping}) list->assign(places, 0.0);
    for_places(network, adjacency, [&](std::size_t place, int spring) {
        adjacency.stiffness[place] = network.stiffness[spring];
        adjacency.rest_length[place] = network.rest_length[spring];
        adjacency.damping[place] = network.damping[spring];
        adjacency.damped = adjacency.damped || network.damping[spring] > 0.0;
    });
    copy_bending(network, adjacency);
}

bool is_sewn_to_point(const SpringNetwork& network, int k) {
    return network.kind[k] == SpringKind::point || (network.kind[k] == SpringKind::seam && network.stiffness[k] == 0.0);
}

}  // namespace

Adjacency make_adjacency(const SpringNetwork& network, int vertex_count, SpringLayout layout) {
    const int slices = (vertex_count + slice_lanes - 1) / slice_lanes;
    std::vector<int> degree(static_cast<std::size_t>(slices) * slice_lanes, 0);
    for (int k = 0; k < network.size(); ++k) {
        ++degree[network.first[k]];
        ++degree[network.second[k]];
    }
    Adjacency result = padding_only(degree, vertex_count, network.size());
    std::vector<int> filled(degree.size(), 0);
    const auto enter = [&](int vertex, int other, int spring) {
        const int at = result.start[vertex / slice_lanes] + slice_lanes * filled[vertex]++ + vertex % slice_lanes;
        result.other[at] = other;
        result.spring[at] = spring;
        return at;
    };
    for (int k = 0; k < network.size(); ++k) {
        if (is_sewn_to_point(network, k)) result.sewn.push_back(k);
        result.place[k] = enter(network.first[k], network.second[k], k);
        enter(network.second[k], network.first[k], k);
    }
    if (layout == SpringLayout::best) result.bands = find_bands(network, vertex_count);
    if (result.bands.count > 0) place_in_bands(network, result);
    copy_constants(network, result);
    return result;
}

void add_membrane(Adjacency& adjacency, const SpringNetwork& network, const std::vector<MembraneTriangle>& triangles) {
    std::vector<bool> is_edge(adjacency.other.size(), false);
    for (std::size_t e = 0; e < is_edge.size(); ++e) {
        const int spring = adjacency.spring[e];
        is_edge[e] = spring < network.size() &&
                     (network.kind[spring] == SpringKind::structural || network.kind[spring] == SpringKind::shear);
    }
    adjacency.membrane = make_membrane_entries(triangles, {adjacency.start, adjacency.other, is_edge});
}

double Adjacency::strength(int k) const {
    const bool point = std::binary_search(sewn.begin(), sewn.end(), k);
    const double alone = point ? bending[place[k]] : stiffness[place[k]];
    return membrane.empty() ? alone : alone + 4.0 * membrane.numbers[0][place[k]] * membrane.numbers[1][place[k]];
}

void copy_bending(const SpringNetwork& network, Adjacency& adjacency) {
    adjacency.bending.assign(network.bending.empty() ? 0 : adjacency.stiffness.size(), 0.0);
    if (network.bending.empty()) return;
    for_places(network, adjacency, [&](std::size_t place, int spring) { adjacency.bending[place] = network.bending[spring]; });
}

void put_rest_length(const Adjacency& adjacency, const SpringNetwork& network, int spring, double length,
                     AlignedVector<double>& list) {
    if (adjacency.bands.count > 0) {
        list[adjacency.place[spring]] = length;
        return;
    }
    for (const int entry : adjacency.entries_of(network, spring)) list[entry] = length;
}

std::array<int, 2> Adjacency::entries_of(const SpringNetwork& network, int k) const {
    const int end = network.second[k];
    int entry = start[end / slice_lanes] + end % slice_lanes;
    while (spring[entry] != k) entry += slice_lanes;
    return {place[k], entry};
}

std::size_t Adjacency::value_count() const {
    return bands.count > 0 ? 4 * bands.count * (bands.guard + bands.padded) : 4 * other.size();
}

Adjacency::ValuePlace Adjacency::value_place(int k) const {
    const std::size_t at = place[k];
    if (bands.count == 0) return {4 * (at - at % slice_lanes) + at % slice_lanes, slice_lanes};
    const std::size_t apart = bands.guard + bands.padded;
    return {4 * (at / bands.padded) * apart + bands.guard + at % bands.padded, apart};
}

std::size_t Adjacency::point_count() const {
    return bands.count > 0 ? 3 * (bands.padded + 2 * bands.guard) : 4 * static_cast<std::size_t>(slices()) * slice_lanes;
}

void pack_points(const Compute& compute, const Adjacency& adjacency, const Vec3Arrays& from, AlignedVector<double>& points) {
    prepare_points(adjacency, points);
    for_chunks(compute, from.slices(), [&](Slices range) { place_points(compute, adjacency, from, points, range); });
}

void prepare_points(const Adjacency& adjacency, AlignedVector<double>& points) {
    points.resize(adjacency.point_count());
    const BandPattern& bands = adjacency.bands;
    if (bands.count == 0) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double* own = points.data() + axis * (bands.padded + 2 * bands.guard);
        std::fill_n(own, bands.guard, 0.0);
        std::fill_n(own + bands.guard + bands.padded, bands.guard, 0.0);
    }
}

void place_points(const Compute& compute, const Adjacency& adjacency, const Vec3Arrays& from, AlignedVector<double>& points,
                  Slices range) {
    const BandPattern& bands = adjacency.bands;
    if (bands.count == 0) return compute.kernels->pack_points(from.axes(), points.data(), range);
    const std::size_t first = static_cast<std::size_t>(range.first) * slice_lanes;
    const std::size_t count = static_cast<std::size_t>(range.last - range.first) * slice_lanes;
    double* to = points.data() + bands.guard + first;
    for (const auto* axis : {&from.x, &from.y, &from.z}) {
        std::copy_n(axis->data() + first, count, to);
        to += bands.padded + 2 * bands.guard;
    }
}

}  // namespace percale
