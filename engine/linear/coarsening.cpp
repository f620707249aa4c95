#include "coarsening.h"

#include <Eigen/LU>
#include <algorithm>

namespace percale {
namespace {

/// Fraction of the strongest pair at one end from which a pair is strong; the second value serves where the first keeps too many
/// vertices. Larger: coarser levels stay large. Smaller: they are poor where springs differ in stiffness.
constexpr double strong_pair_ratio = 0.25, lower_pair_ratio = 0.03;

/// Fraction of vertices kept, above which weaker pairs count too.
constexpr double max_kept_ratio = 0.4;

/// Fraction of the largest interpolation weight below which a weight is dropped. Smaller: denser levels.
constexpr double min_weight_ratio = 0.03;

/// Regularisation of the second moment for each candidate: all may lie in a plane, or on a line. 0: a singular matrix.
constexpr double moment_regularisation = 1e-3;

/// m^2. Squares of distances between candidates are at least this, so that none divides by 0.
constexpr double min_candidate_square = 1e-24;

constexpr int max_weights = 3;
constexpr int max_candidates = max_weights + 2;

/// The strong neighbours of each vertex, and the strongest of all.
struct Neighbours {
    std::vector<int> start, vertex;
    std::vector<int> strongest;  // -1 for a vertex without pairs

    Neighbours(const SpringGraph& graph, double ratio)
        : start(graph.positions.size() + 1, 0), strongest(graph.positions.size(), -1) {
        std::vector<double> largest(graph.positions.size(), 0.0);
        for (std::size_t e = 0; e < graph.pairs.size(); ++e) {
            for (int end = 0; end < 2; ++end) {
                const auto [i, j] = std::array{graph.pairs[e][end], graph.pairs[e][1 - end]};
                if (strongest[i] >= 0 && graph.strength[e] <= largest[i]) continue;
                largest[i] = graph.strength[e];
                strongest[i] = j;
            }
        }
        const auto strong = [&](std::size_t e) {
            return graph.strength[e] >= ratio * std::min(largest[graph.pairs[e][0]], largest[graph.pairs[e][1]]);
        };
        for (std::size_t e = 0; e < graph.pairs.size(); ++e) {
            if (!strong(e)) continue;
            for (const int i : graph.pairs[e]) ++start[i + 1];
        }
        for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
        vertex.resize(start.back());
        std::vector<int> filled(start.begin(), start.end() - 1);
        for (std::size_t e = 0; e < graph.pairs.size(); ++e) {
            if (!strong(e)) continue;
            vertex[filled[graph.pairs[e][0]]++] = graph.pairs[e][1];
            vertex[filled[graph.pairs[e][1]]++] = graph.pairs[e][0];
        }
    }
};

/// 1 for kept vertices, 0 for the others.
std::vector<char> independent_set(const Neighbours& near) {
    std::vector<char> state(near.strongest.size(), 2);
    for (std::size_t i = 0; i < state.size(); ++i) {
        if (state[i] != 2) continue;
        state[i] = 1;
        for (int k = near.start[i]; k < near.start[i + 1]; ++k) {
            if (state[near.vertex[k]] == 2) state[near.vertex[k]] = 0;
        }
    }
    return state;
}

struct Candidate {
    double square;  // m^2, distance
    int vertex;
    double weight = 0.0;
    bool used = true;
};

/// Kept vertices within two strong pairs, the nearest first.
void find_candidates(const SpringGraph& graph, const Neighbours& near, const std::vector<char>& kept, int i,
                     std::vector<Candidate>& found) {
    found.clear();
    const auto offer = [&](int j) {
        if (kept[j] != 1 || std::any_of(found.begin(), found.end(), [j](const Candidate& c) { return c.vertex == j; })) return;
        found.push_back(
            {.square = std::max((graph.positions[i] - graph.positions[j]).squaredNorm(), min_candidate_square), .vertex = j});
    };
    for (int k = near.start[i]; k < near.start[i + 1]; ++k) offer(near.vertex[k]);
    for (int k = near.start[i]; k < near.start[i + 1]; ++k) {
        const int j = near.vertex[k];
        for (int l = near.start[j]; l < near.start[j + 1]; ++l) offer(near.vertex[l]);
    }
    std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
        return a.square != b.square ? a.square < b.square : a.vertex < b.vertex;
    });
    if (found.size() > max_candidates) found.resize(max_candidates);
}

/// Weights (1 + g . (x_c - x_i))/|x_c - x_i|^2 with g such that their first moment vanishes; the most negative candidate is
/// dropped until none is left.
void weigh(const SpringGraph& graph, int i, std::vector<Candidate>& candidates) {
    for (std::size_t pass = 0; pass < candidates.size(); ++pass) {
        Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
        Vec3 first = Vec3::Zero();
        int used = 0;
        for (const Candidate& c : candidates) {
            if (!c.used) continue;
            const Vec3 e = graph.positions[c.vertex] - graph.positions[i];
            second += e * e.transpose() / c.square;
            first += e / c.square;
            ++used;
        }
        // All candidates may lie in a plane, or on a line.
        second += moment_regularisation * used * Eigen::Matrix3d::Identity();
        const Vec3 g = -second.inverse() * first;
        Candidate* worst = nullptr;
        double sum = 0.0;
        for (Candidate& c : candidates) {
            if (!c.used) continue;
            c.weight = (1.0 + g.dot(graph.positions[c.vertex] - graph.positions[i])) / c.square;
            sum += c.weight;
            if (c.weight < 0.0 && (!worst || c.weight < worst->weight)) worst = &c;
        }
        for (Candidate& c : candidates) c.weight /= sum;
        if (!worst) return;
        worst->used = false;
        worst->weight = 0.0;
    }
}

InterpolationRow single(int vertex) { return {.vertex = {vertex, -1, -1}, .weight = {1.0, 0.0, 0.0}, .count = 1}; }

InterpolationRow interpolation_row(const SpringGraph& graph, int i, int fallback, std::vector<Candidate>& candidates) {
    const auto weigh_and_sort = [&] {
        weigh(graph, i, candidates);
        std::erase_if(candidates, [](const Candidate& c) { return !c.used || !(c.weight > 0.0); });
        std::stable_sort(candidates.begin(), candidates.end(),
                         [](const Candidate& a, const Candidate& b) { return a.weight > b.weight; });
    };
    weigh_and_sort();
    if (candidates.size() > max_weights) {
        // The moment condition must hold for the remaining ones.
        candidates.resize(max_weights);
        weigh_and_sort();
    }
    if (candidates.empty()) return single(fallback);
    InterpolationRow row{.vertex = {-1, -1, -1}, .weight = {}, .count = 0};
    double sum = 0.0;
    for (const Candidate& c : candidates) {
        if (row.count == max_weights || c.weight <= min_weight_ratio * candidates[0].weight) break;
        row.vertex[row.count] = c.vertex;
        row.weight[row.count++] = c.weight;
        sum += c.weight;
    }
    for (double& weight : row.weight) weight /= sum;
    return row;
}

}  // namespace

Coarsening coarsen(const SpringGraph& graph) {
    Neighbours near(graph, strong_pair_ratio);
    std::vector<char> kept = independent_set(near);
    if (static_cast<double>(std::count(kept.begin(), kept.end(), 1)) > max_kept_ratio * static_cast<double>(kept.size())) {
        near = Neighbours(graph, lower_pair_ratio);
        kept = independent_set(near);
    }
    const int count = static_cast<int>(graph.positions.size());
    Coarsening result;
    std::vector<int> number(count, -1);
    for (int i = 0; i < count; ++i) {
        if (kept[i] != 1) continue;
        number[i] = static_cast<int>(result.kept.size());
        result.kept.push_back(i);
    }
    result.rows.resize(count);
    std::vector<Candidate> candidates;
    for (int i = 0; i < count; ++i) {
        InterpolationRow& row = result.rows[i];
        if (kept[i] == 1) {
            row = single(i);
        } else {
            find_candidates(graph, near, kept, i, candidates);
            row = interpolation_row(graph, i, near.strongest[i], candidates);
        }
        for (int k = 0; k < row.count; ++k) row.vertex[k] = number[row.vertex[k]];
    }
    return result;
}

}  // namespace percale
