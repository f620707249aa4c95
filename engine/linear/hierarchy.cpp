#include "hierarchy.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tolerances.h"

namespace percale {
namespace {

/// Coefficient of a finer pair's block in a coarser one. Smaller ones are left out. Larger: coarser levels miss stiffness.
constexpr double min_galerkin_coefficient = 1e-4;

/// Fraction of vertices that a coarser level may keep; with more it gains nothing and the hierarchy ends.
constexpr double max_coarse_ratio = 0.8;

/// Levels of multigrid. Fewer: the bottom may be too large to be inverted. The second number counts the vertices of a level that
/// are sorted by degree together: cost alone.
constexpr int max_multigrid_levels = 12, level_sorting_window = 128;

struct Entry {
    int index;
    double weight;
};
using Rows = std::vector<std::vector<Entry>>;

int slices_for(std::size_t count) { return static_cast<int>((count + slice_lanes - 1) / slice_lanes); }

/// The start of each slice: it has as many entries per lane as its longest row.
std::vector<int> slice_starts(const std::vector<int>& lengths) {
    std::vector<int> start(1, 0);
    for (int s = 0; s < slices_for(lengths.size()); ++s) {
        int longest = 0;
        for (std::size_t i = s * slice_lanes; i < std::min<std::size_t>(lengths.size(), (s + 1) * slice_lanes); ++i) {
            longest = std::max(longest, lengths[i]);
        }
        start.push_back(start.back() + slice_lanes * longest);
    }
    return start;
}

TransferLists transfer_lists(const Rows& rows) {
    std::vector<int> lengths(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) lengths[i] = static_cast<int>(rows[i].size());
    TransferLists lists{.start = slice_starts(lengths), .other = {}, .weight = {}};
    lists.other.assign(lists.start.back(), 0);
    lists.weight.assign(lists.start.back(), 0.0f);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::size_t at = lists.start[i / slice_lanes] + i % slice_lanes;
        for (const Entry& entry : rows[i]) {
            lists.other[at] = entry.index;
            lists.weight[at] = static_cast<float>(entry.weight);
            at += slice_lanes;
        }
    }
    return lists;
}

void set_transfers(const Coarsening& coarsening, LevelPattern& level) {
    Rows up(coarsening.rows.size()), down(coarsening.kept.size());
    for (std::size_t i = 0; i < up.size(); ++i) {
        const InterpolationRow& row = coarsening.rows[i];
        for (int k = 0; k < row.count; ++k) {
            up[i].push_back({row.vertex[k], row.weight[k]});
            down[row.vertex[k]].push_back({static_cast<int>(i), row.weight[k]});
        }
    }
    level.prolongation = transfer_lists(up);
    level.restriction = transfer_lists(down);
    level.rows = coarsening.rows;
}

/// A part of a coarse pair's block: coefficient times the block of a fine pair.
struct Term {
    int first, second, pair;
    float coefficient;
};

/// The coefficients of x_i - x_j in coarse vertices.
int difference(const InterpolationRow& i, const InterpolationRow& j, std::array<Entry, 6>& entries) {
    int count = 0;
    for (int k = 0; k < i.count; ++k) entries[count++] = {i.vertex[k], i.weight[k]};
    for (int k = 0; k < j.count; ++k) {
        const auto same = std::find_if(entries.begin(), entries.begin() + count,
                                       [&](const Entry& entry) { return entry.index == j.vertex[k]; });
        if (same != entries.begin() + count) {
            same->weight -= j.weight[k];
        } else {
            entries[count++] = {j.vertex[k], -j.weight[k]};
        }
    }
    return count;
}

std::vector<Term> galerkin_terms(const SpringGraph& graph, const Coarsening& coarsening) {
    std::vector<Term> terms;
    std::array<Entry, 6> entries;
    for (std::size_t e = 0; e < graph.pairs.size(); ++e) {
        const auto [i, j] = graph.pairs[e];
        const int count = difference(coarsening.rows[i], coarsening.rows[j], entries);
        for (int a = 0; a < count; ++a) {
            for (int b = a + 1; b < count; ++b) {
                const double coefficient = -entries[a].weight * entries[b].weight;
                if (std::abs(coefficient) <= min_galerkin_coefficient) continue;
                const auto [first, second] = std::minmax(entries[a].index, entries[b].index);
                terms.push_back({first, second, static_cast<int>(e), static_cast<float>(coefficient)});
            }
        }
    }
    std::sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) {
        return a.first != b.first ? a.first < b.first : a.second != b.second ? a.second < b.second : a.pair < b.pair;
    });
    return terms;
}

/// Groups the terms by coarse pair; fills in pairs, their strengths and the lists of the sums.
SpringGraph coarse_graph(const SpringGraph& graph, const std::vector<Term>& terms, LevelPattern& level) {
    SpringGraph coarse;
    level.term_start = {0};
    for (std::size_t k = 0; k < terms.size(); ++k) {
        const bool opens = k == 0 || terms[k].first != terms[k - 1].first || terms[k].second != terms[k - 1].second;
        if (opens) {
            coarse.pairs.push_back({terms[k].first, terms[k].second});
            coarse.strength.push_back(0.0);
            level.term_start.push_back(static_cast<int>(k));
        }
        level.term_start.back() = static_cast<int>(k) + 1;
        level.term_pair.push_back(terms[k].pair);
        level.coefficient.push_back(terms[k].coefficient);
        coarse.strength.back() += terms[k].coefficient * graph.strength[terms[k].pair];
    }
    return coarse;
}

/// New numbers, by falling degree within windows: slices then need little padding.
void sort_by_degree(SpringGraph& coarse, Coarsening& coarsening) {
    const std::size_t count = coarsening.kept.size();
    std::vector<int> degree(count, 0), order(count), number(count), kept(count);
    for (const auto& pair : coarse.pairs) {
        for (const int i : pair) ++degree[i];
    }
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t first = 0; first < count; first += level_sorting_window) {
        std::stable_sort(order.begin() + first, order.begin() + std::min(count, first + level_sorting_window),
                         [&](int a, int b) { return degree[a] > degree[b]; });
    }
    for (std::size_t i = 0; i < count; ++i) {
        number[order[i]] = static_cast<int>(i);
        kept[i] = coarsening.kept[order[i]];
    }
    coarsening.kept = kept;
    for (auto& pair : coarse.pairs) pair = {number[pair[0]], number[pair[1]]};
    for (InterpolationRow& row : coarsening.rows) {
        for (int k = 0; k < row.count; ++k) row.vertex[k] = number[row.vertex[k]];
    }
}

void set_entries(LevelPattern& level) {
    std::vector<int> degree(level.vertices, 0);
    for (const auto& pair : level.pairs) {
        for (const int i : pair) ++degree[i];
    }
    level.start = slice_starts(degree);
    level.other.resize(level.start.back());
    level.entry_pair.assign(level.start.back(), static_cast<int>(level.pairs.size()));
    for (int s = 0; s < level.slices(); ++s) {
        for (int e = level.start[s]; e < level.start[s + 1]; ++e) {
            level.other[e] = s * slice_lanes + (e - level.start[s]) % slice_lanes;
        }
    }
    std::vector<int> filled(level.vertices, 0);
    for (std::size_t p = 0; p < level.pairs.size(); ++p) {
        for (int end = 0; end < 2; ++end) {
            const int i = level.pairs[p][end];
            const int at = level.start[i / slice_lanes] + slice_lanes * filled[i]++ + i % slice_lanes;
            level.other[at] = level.pairs[p][1 - end];
            level.entry_pair[at] = static_cast<int>(p);
        }
    }
}

}  // namespace

std::vector<LevelPattern> make_hierarchy(SpringGraph graph) {
    std::vector<LevelPattern> levels;
    while (static_cast<int>(graph.positions.size()) > dense_vertices && static_cast<int>(levels.size()) < max_multigrid_levels) {
        Coarsening coarsening = coarsen(graph);
        if (static_cast<double>(coarsening.kept.size()) > max_coarse_ratio * static_cast<double>(graph.positions.size())) break;
        LevelPattern level;
        SpringGraph coarse = coarse_graph(graph, galerkin_terms(graph, coarsening), level);
        sort_by_degree(coarse, coarsening);
        for (const int i : coarsening.kept) coarse.positions.push_back(graph.positions[i]);
        level.vertices = static_cast<int>(coarsening.kept.size());
        level.pairs = coarse.pairs;
        set_entries(level);
        set_transfers(coarsening, level);
        levels.push_back(std::move(level));
        graph = std::move(coarse);
    }
    return levels;
}

}  // namespace percale
