#include "pattern/edge_stations.h"

#include <algorithm>
#include <cmath>

#include "common/scene_file_error.h"
#include "common/text.h"
#include "pattern/panel_curve.h"

namespace percale::scenes {
namespace {

/// Ratio of a seam's sides from which on it is a gather: the longer one gets vertices between stitches. Larger: edges of the
/// longer side are pressed together. Smaller: eased seams are gathered.
constexpr double gathered_ratio = 1.1;

/// In edge lengths: corners nearer to each other than this are sewn together.
constexpr double one_corner = 1.0 / 3.0;

/// Relative to the length of a side.
constexpr double station_rounding = 1e-9;

int pieces(double length, double edge_length) { return std::max(1, static_cast<int>(std::lround(length / edge_length))); }

/// One side of a seam: its edges one after the other.
class SeamSide {
public:
    SeamSide(const Pattern& pattern, const std::vector<EdgeUse>& uses) : uses_(uses), ends_{0.0} {
        for (const EdgeUse& use : uses) {
            const Panel& panel = pattern.panels[static_cast<std::size_t>(use.panel)];
            ends_.push_back(ends_.back() + edge_length(panel, panel.edges[static_cast<std::size_t>(use.edge)]));
        }
    }

    double length() const { return ends_.back(); }
    /// The ends of its edges, without the last one, as fractions of its length.
    std::vector<double> corners() const {
        std::vector<double> shares;
        for (std::size_t k = 1; k + 1 < ends_.size(); ++k) shares.push_back(ends_[k] / length());
        return shares;
    }
    const std::vector<EdgeUse>& uses() const { return uses_; }
    /// The edge at a fraction of the side, and the fraction of that edge, in the edge's own direction.
    std::pair<std::size_t, double> edge_at(double share) const {
        const double place = share * length();
        std::size_t k = 0;
        while (k + 2 < ends_.size() && place >= ends_[k + 1] - station_rounding * length()) ++k;
        const double along = std::clamp((place - ends_[k]) / (ends_[k + 1] - ends_[k]), 0.0, 1.0);
        return {k, uses_[k].reversed ? 1.0 - along : along};
    }

private:
    const std::vector<EdgeUse>& uses_;
    std::vector<double> ends_;  // m
};

/// Fractions of both sides at which a piece of a seam ends.
using Break = std::array<double, 2>;

std::vector<Break> breaks_of(const PatternSeam& seam, const SeamSide& first, const SeamSide& second, double edge_length) {
    std::vector<Break> breaks = {{0.0, 0.0}, {1.0, 1.0}};
    std::vector<double> others = second.corners();
    const double near = one_corner * edge_length / std::min(first.length(), second.length());
    for (const double corner : first.corners()) {
        const auto nearest = std::ranges::min_element(others, {}, [corner](double other) { return std::abs(other - corner); });
        const bool same = nearest != others.end() && std::abs(*nearest - corner) < near;
        breaks.push_back({corner, same ? *nearest : corner});
        if (same) others.erase(nearest);
    }
    for (const double corner : others) breaks.push_back({corner, corner});
    std::sort(breaks.begin(), breaks.end());
    const auto goes_back = [](const Break& a, const Break& b) { return b[0] <= a[0] || b[1] <= a[1]; };
    if (std::ranges::adjacent_find(breaks, goes_back) == breaks.end()) return breaks;
    fail_at(seam.place, "seam '" + seam.name + "': its edges are too short for an edge length of " + short_number(edge_length) +
                            " m; choose a smaller one");
}

/// The beginnings of so many equal pieces.
void add_stations(double from, double to, int count, std::vector<double>& stations) {
    for (int k = 0; k < count; ++k) stations.push_back(std::lerp(from, to, 1.0 * k / count));
}

class Divider {
public:
    Divider(const Pattern& pattern, double edge_length) : pattern_(pattern), edge_length_(edge_length) {
        for (const Panel& panel : pattern.panels) result_.shares.emplace_back(panel.edges.size());
    }

    EdgeStations divide() {
        for (const PatternSeam& seam : pattern_.seams) divide_seam(seam);
        for (std::size_t p = 0; p < pattern_.panels.size(); ++p) {
            for (std::size_t e = 0; e < pattern_.panels[p].edges.size(); ++e) {
                if (result_.shares[p][e].empty()) divide_alone(p, e);
            }
        }
        return std::move(result_);
    }

private:
    void divide_alone(std::size_t panel, std::size_t edge) {
        const double length = scenes::edge_length(pattern_.panels[panel], pattern_.panels[panel].edges[edge]);
        const int count = pieces(length, edge_length_);
        for (int k = 0; k <= count; ++k) result_.shares[panel][edge].push_back(static_cast<double>(k) / count);
    }

    void divide_seam(const PatternSeam& seam) {
        const std::array<SeamSide, 2> sides = {SeamSide(pattern_, seam.sides[0]), SeamSide(pattern_, seam.sides[1])};
        for (const SeamSide& side : sides) refuse_second_use(seam, side);
        std::array<std::vector<double>, 2> stations;
        std::vector<std::array<std::size_t, 2>> joined;  // numbers of stations that are sewn together
        const std::vector<Break> breaks = breaks_of(seam, sides[0], sides[1], edge_length_);
        for (std::size_t b = 0; b + 1 < breaks.size(); ++b) {
            std::array<double, 2> length;
            for (int s = 0; s < 2; ++s) length[s] = (breaks[b + 1][s] - breaks[b][s]) * sides[s].length();
            const Division division = divided(sides, length);
            for (int k = 0; k < division.stitches; ++k) {
                joined.push_back({stations[0].size() + static_cast<std::size_t>(k * division.between[0]),
                                  stations[1].size() + static_cast<std::size_t>(k * division.between[1])});
            }
            for (int s = 0; s < 2; ++s)
                add_stations(breaks[b][s], breaks[b + 1][s], division.stitches * division.between[s], stations[s]);
        }
        joined.push_back({stations[0].size(), stations[1].size()});
        for (auto& list : stations) list.push_back(1.0);
        std::array<std::vector<EdgeStations::Place>, 2> places;
        for (int s = 0; s < 2; ++s) places[s] = enter(sides[s], stations[s]);
        auto& sewn = result_.sewn.emplace_back();
        for (const auto& [first, second] : joined) sewn.push_back({places[0][first], places[1][second]});
    }

    /// How a piece of a seam is divided: into pieces from stitch to stitch, each side's into as many edges.
    struct Division {
        int stitches = 1;
        std::array<int, 2> between = {1, 1};
    };

    /// Where one side is longer it is gathered: between two stitches it gets vertices that are free to buckle. Sewn at each of
    /// its vertices its edges would be pressed together. `length`: of a piece on both sides, m.
    Division divided(const std::array<SeamSide, 2>& sides, const std::array<double, 2>& length) const {
        const int longer = sides[1].length() > sides[0].length() ? 1 : 0;
        if (sides[longer].length() < gathered_ratio * sides[1 - longer].length())
            return {.stitches = pieces(0.5 * (length[0] + length[1]), edge_length_)};
        Division division{.stitches = pieces(length[1 - longer], edge_length_)};
        division.between[longer] = std::max(2, pieces(length[longer] / division.stitches, edge_length_));
        return division;
    }

    void refuse_second_use(const PatternSeam& seam, const SeamSide& side) const {
        for (const EdgeUse& use : side.uses()) {
            if (result_.shares[use.panel][use.edge].empty()) continue;
            fail_at(seam.place, "seam '" + seam.name + "': edge " + std::to_string(use.edge) + " of panel '" +
                                    pattern_.panels[use.panel].name + "' is in another seam, too; an edge is in one at most");
        }
    }

    /// Puts the stations of a side, ascending along it, onto its edges; returns where each of them is.
    std::vector<EdgeStations::Place> enter(const SeamSide& side, const std::vector<double>& stations) {
        std::vector<std::vector<double>> on_edge(side.uses().size());
        std::vector<std::pair<std::size_t, std::size_t>> where;  // edge of the side, number along it
        std::size_t last = 0;
        for (const double station : stations) {
            const auto [k, share] = side.edge_at(station);
            // Where an edge begins, the one before ends.
            if (k > last) on_edge[last].push_back(side.uses()[last].reversed ? 0.0 : 1.0);
            last = k;
            where.push_back({k, on_edge[k].size()});
            on_edge[k].push_back(share);
        }
        std::vector<EdgeStations::Place> places;
        for (const auto& [k, number] : where) {
            const EdgeUse& use = side.uses()[k];
            const int count = static_cast<int>(on_edge[k].size()), along = static_cast<int>(number);
            places.push_back({use.panel, use.edge, use.reversed ? count - 1 - along : along});
        }
        for (std::size_t k = 0; k < on_edge.size(); ++k) {
            const EdgeUse& use = side.uses()[k];
            if (use.reversed) std::reverse(on_edge[k].begin(), on_edge[k].end());
            on_edge[k].front() = 0.0;
            on_edge[k].back() = 1.0;
            result_.shares[use.panel][use.edge] = on_edge[k];
        }
        return places;
    }

    const Pattern& pattern_;
    double edge_length_;
    EdgeStations result_;
};

}  // namespace

EdgeStations divide_edges(const Pattern& pattern, double edge_length) { return Divider(pattern, edge_length).divide(); }

}  // namespace percale::scenes
