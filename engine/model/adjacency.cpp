#include "adjacency.h"

#include <algorithm>

namespace percale {
namespace {

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
                     .entry = std::vector<int>(spring_count),
                     .stiffness = {},
                     .rest_length = {},
                     .damping = {},
                     .damped = false};
    const std::size_t entries = result.start.back();
    result.other.resize(entries);
    result.spring.assign(entries, spring_count);
    for (auto* list : {&result.stiffness, &result.rest_length, &result.damping}) list->assign(entries, 0.0);
    for (int s = 0; s < slices; ++s) {
        for (int i = result.start[s]; i < result.start[s + 1]; ++i) {
            result.other[i] = s * slice_lanes + (i - result.start[s]) % slice_lanes;
        }
    }
    return result;
}

}  // namespace

Adjacency make_adjacency(const SpringNetwork& network, int vertex_count) {
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
        result.stiffness[at] = network.stiffness[spring];
        result.rest_length[at] = network.rest_length[spring];
        result.damping[at] = network.damping[spring];
        result.damped = result.damped || network.damping[spring] > 0.0;
        return at;
    };
    for (int k = 0; k < network.size(); ++k) {
        result.entry[k] = enter(network.first[k], network.second[k], k);
        enter(network.second[k], network.first[k], k);
    }
    return result;
}

}  // namespace percale
