#include "membrane_entries.h"

#include <algorithm>

namespace percale {
namespace {

int entry_of(const EntryView& entries, int vertex, int other) {
    const int slice = vertex / slice_lanes;
    int e = entries.start[slice] + vertex % slice_lanes;
    while (entries.other[e] != other || !entries.is_edge[e]) e += slice_lanes;
    return e;
}

/// Enters one triangle at both ends of an edge. Both see the same numbers in an order that changes no bit: the edges to the
/// opposite vertex are only swapped, and a second triangle comes second at both.
class EdgeWriter {
public:
    EdgeWriter(const EntryView& view, MembraneEntries& entries)
        : view_(view), entries_(entries), triangles_(view.other.size(), 0) {
        for (auto& list : entries_.opposite) list = view.other;
        for (auto& list : entries_.numbers) list.assign(view.other.size(), 0.0);
    }

    void add(const MembraneTriangle& t, int e) {
        const int next = (e + 1) % 3, last = (e + 2) % 3;
        enter(t, e, next, last);
        enter(t, e, last, next);
    }

private:
    /// Edge e as seen from the vertex number `from` of the triangle. The edge between `from` and the opposite vertex e is the
    /// one opposite `to`.
    void enter(const MembraneTriangle& t, int e, int from, int to) {
        const int at = entry_of(view_, t.vertex[from], t.vertex[to]), side = triangles_[at]++;
        entries_.opposite[side][at] = t.vertex[e];
        entries_.numbers[0][at] = t.rest_square[e];
        entries_.numbers[1][at] += t.stiffness(e, e);
        entries_.numbers[2 + 2 * side][at] = t.stiffness(e, to);
        entries_.numbers[3 + 2 * side][at] = t.stiffness(e, from);
        double rest = 0.0;
        for (int f = 0; f < 3; ++f) rest += t.stiffness(e, f) * t.rest_square[f];
        entries_.numbers[6][at] += rest;
    }

    const EntryView& view_;
    MembraneEntries& entries_;
    std::vector<int> triangles_;
};

void write_corners(const std::vector<MembraneTriangle>& triangles, int slices, MembraneEntries& entries) {
    std::vector<int> degree(static_cast<std::size_t>(slices) * slice_lanes, 0);
    for (const MembraneTriangle& t : triangles) {
        for (const int vertex : t.vertex) ++degree[vertex];
    }
    entries.corner_start = {0};
    for (int s = 0; s < slices; ++s) {
        const auto first = degree.begin() + s * slice_lanes;
        entries.corner_start.push_back(entries.corner_start.back() + slice_lanes * *std::max_element(first, first + slice_lanes));
    }
    for (auto& list : entries.corner_other) list.resize(entries.corner_start.back());
    entries.coupling.assign(3 * entries.corner_count(), 0.0);
    for (int s = 0; s < slices; ++s) {
        for (int e = entries.corner_start[s]; e < entries.corner_start[s + 1]; ++e) {
            for (auto& list : entries.corner_other) list[e] = s * slice_lanes + (e - entries.corner_start[s]) % slice_lanes;
        }
    }
    std::vector<int> filled(degree.size(), 0);
    for (const MembraneTriangle& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            const int vertex = t.vertex[k], lane = vertex % slice_lanes, j = (k + 1) % 3, l = (k + 2) % 3;
            const int first = entries.corner_start[vertex / slice_lanes] + slice_lanes * filled[vertex]++;
            entries.corner_other[0][first + lane] = t.vertex[j];
            entries.corner_other[1][first + lane] = t.vertex[l];
            // p to vertex j is opposite l, q to vertex l is opposite j, r between them opposite k.
            double* coupling = &entries.coupling[3 * static_cast<std::size_t>(first) + lane];
            coupling[0] = t.stiffness(l, j);
            coupling[slice_lanes] = t.stiffness(l, k);
            coupling[2 * slice_lanes] = t.stiffness(j, k);
        }
    }
}

}  // namespace

MembraneEdges MembraneEntries::edges() const {
    MembraneEdges result{.opposite = {opposite[0].data(), opposite[1].data()}, .numbers = {}};
    for (int k = 0; k < 7; ++k) result.numbers[k] = numbers[k].data();
    return result;
}

MembraneCorners MembraneEntries::corners() const {
    return {corner_start.data(), {corner_other[0].data(), corner_other[1].data()}, coupling.data()};
}

MembraneEntries make_membrane_entries(const std::vector<MembraneTriangle>& triangles, const EntryView& entries) {
    MembraneEntries result;
    EdgeWriter writer(entries, result);
    for (const MembraneTriangle& t : triangles) {
        for (int e = 0; e < 3; ++e) writer.add(t, e);
    }
    write_corners(triangles, static_cast<int>(entries.start.size()) - 1, result);
    return result;
}

}  // namespace percale
