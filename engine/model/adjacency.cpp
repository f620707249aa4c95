#include "adjacency.h"

#include <algorithm>

#include "vectors.h"

namespace percale {
namespace {

constexpr int lanes = Vectors::lanes;

std::vector<int> slice_starts(const std::vector<int>& degree, int slices) {
    std::vector<int> start(1, 0);
    for (int s = 0; s < slices; ++s) {
        const auto first = degree.begin() + s * lanes;
        start.push_back(start.back() + lanes * *std::max_element(first, first + lanes));
    }
    return start;
}

}  // namespace

Adjacency make_adjacency(const SpringNetwork& network, int vertex_count) {
    const int slices = (vertex_count + lanes - 1) / lanes;
    std::vector<int> degree(static_cast<std::size_t>(slices) * lanes, 0);
    for (int k = 0; k < network.size(); ++k) {
        ++degree[network.first[k]];
        ++degree[network.second[k]];
    }
    Adjacency result{.vertex_count = vertex_count, .start = slice_starts(degree, slices), .other = {}, .spring = {}, .sign = {}};
    result.other.resize(result.start.back());
    result.spring.assign(result.start.back(), network.size());
    result.sign.assign(result.start.back(), 0.0);
    for (int s = 0; s < slices; ++s) {
        for (int i = result.start[s]; i < result.start[s + 1]; ++i) result.other[i] = s * lanes + (i - result.start[s]) % lanes;
    }
    std::vector<int> filled(degree.size(), 0);
    const auto enter = [&](int vertex, int other, int spring, double sign) {
        const int at = result.start[vertex / lanes] + lanes * filled[vertex]++ + vertex % lanes;
        result.other[at] = other;
        result.spring[at] = spring;
        result.sign[at] = sign;
    };
    for (int k = 0; k < network.size(); ++k) {
        enter(network.first[k], network.second[k], k, 1.0);
        enter(network.second[k], network.first[k], k, -1.0);
    }
    return result;
}

}  // namespace percale
