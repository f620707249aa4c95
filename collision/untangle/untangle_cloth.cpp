#include "untangle/untangle_cloth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/joined_places.h"
#include "percale/certify.h"
#include "untangle/edge_crossings.h"
#include "untangle/layer_order.h"

namespace percale {
namespace {

/// Cloth through cloth. Fraction of the mean edge by which a round moves a vertex: a larger one overshoots thin layers, a smaller
/// one takes more rounds. Length of a retreat vector (2 is the longest where an edge stands upright) at which half of the move is
/// made: at 0 vertices whose retreat vectors nearly vanish jump about.
constexpr double retreat_ratio = 0.05, min_retreat = 0.1;

/// Strain that edges may have while cloth comes apart, and the number of sweeps over all edges in a round that enforce it. They
/// affect cost, and how much the engine has to relax afterwards.
constexpr double bond_slack = 0.05;
constexpr int bond_sweeps = 4;

/// Fraction of the mean edge. Vertices that a stitch holds nearer than this are one vertex while cloth comes apart. Larger: open
/// seams are drawn together at once. Smaller: cloth is taken for torn where a seam gapes a little, and crosses itself there
/// endlessly.
constexpr double closed_stitch = 0.25;

/// Fractions of the mean edge: the distance from a lower layer within which cloth is moved outside of it, and the gap to which it
/// is moved. Larger reach: cloth is taken for that of the other side of a limb. Larger gap: cloth is stretched more.
constexpr double layer_reach = 2.0, layer_gap = 0.05;

/// Maximum number of rounds in which layers are ordered. It affects cost, and how deep layers may lie in each other.
constexpr int max_layer_rounds = 60;

/// Number of rounds without fewer crossings after which cloth near the last ones is smoothed, and the number of rings of vertices
/// around them that are smoothed. Fewer rounds: folds are ironed that would have come apart. More rings: more cloth is moved.
constexpr int idle_rounds_before_smoothing = 20, smoothed_rings = 2;

/// All cloth is searched for crossings every `rounds_between_searches` rounds, and when none are known; the other rounds search
/// `searched_rings` rings of vertices around those found last. Cost alone.
constexpr int rounds_between_searches = 10, searched_rings = 3;

/// Maximum number of rounds of untangling cloth from cloth, and of successive rounds without fewer crossings. Larger: hopeless
/// starts take longer (16,000 triangles: 30 ms a round). Smaller: solvable ones are refused.
constexpr int max_untangle_rounds = 600, max_idle_rounds = 100;

/// Keeps two vertices as far apart as they were.
struct Bond {
    std::array<int, 2> vertex;
    double length;  // m
};

/// A stitch that is not closed: its sides do not separate further.
struct Tie {
    Stitch stitch;
    double length;  // m
};

Vec3 across(const Stitch& stitch, std::span<const Vec3> x) {
    return x[stitch.vertex] - ((1.0 - stitch.share) * x[stitch.from] + stitch.share * x[stitch.to]);
}

class Rounds {
public:
    /// `near`: stitches shorter than so many mean edges are closed.
    Rounds(const CrossedCloth& cloth, std::span<const Vec3> positions, double near)
        : cloth_(cloth), given_(positions), merged_(merge_sewn(cloth, positions, near)) {
        surface_ = make_cloth_surface(mesh_.triangles, mesh_.vertices.size());
        for (const ClothSurface::Edge& edge : surface_.edges) {
            bonds_.push_back({edge.vertex, (mesh_.vertices[edge.vertex[0]] - mesh_.vertices[edge.vertex[1]]).norm()});
        }
        for (const Stitch& stitch : merged_.stitches) ties_.push_back({stitch, across(stitch, mesh_.vertices).norm()});
        reach_ = retreat_ratio * merged_.mean_edge();
    }

    std::optional<std::vector<Vec3>> run() {
        std::size_t fewest = std::numeric_limits<std::size_t>::max();
        int since_fewest = 0;
        for (int round = 0; round < max_untangle_rounds && !cancelled(); ++round) {
            const std::vector<IntersectingPair> pairs = find_pairs(round);
            if (pairs.empty()) return clear_places();
            if (round == 0 && order_layers()) continue;
            ++since_fewest;
            if (pairs.size() < fewest) {
                fewest = pairs.size();
                since_fewest = 0;
            }
            if (since_fewest > max_idle_rounds) return std::nullopt;
            move_back(crossings_of(pairs));
            if (since_fewest > idle_rounds_before_smoothing) smooth(of_one_layer(pairs));
            for (int sweep = 0; sweep < bond_sweeps; ++sweep) keep_lengths();
        }
        return std::nullopt;
    }

private:
    bool cancelled() const { return cloth_.cancel != nullptr && *cloth_.cancel; }

    /// Moves cloth of higher layers outside of lower ones; returns false where all cloth is of one layer.
    bool order_layers() {
        if (cloth_.meeting.pairs == nullptr || cloth_.meeting.pairs->layers().empty()) return false;
        std::vector<int> cloth(mesh_.triangles.size());
        layer_.resize(cloth.size());
        for (std::size_t t = 0; t < merged_.triangle.size(); ++t) {
            if (merged_.triangle[t] < 0) continue;
            cloth[merged_.triangle[t]] = cloth_.meeting.cloth[t];
            layer_[merged_.triangle[t]] = cloth_.meeting.pairs->layer(cloth_.meeting.cloth[t]);
        }
        const std::vector<double> outwards = outward_signs(mesh_.triangles, cloth, mesh_.vertices);
        for (const int c : cloth) outwards_.push_back(outwards[c]);
        const double edge = merged_.mean_edge();
        const LayeredCloth layered{surface_, cloth, layer_, outwards, free_, layer_reach * edge, layer_gap * edge};
        for (int round = 0; round < max_layer_rounds && !cancelled() && push_outside(layered, mesh_.vertices); ++round) {
            for (int sweep = 0; sweep < bond_sweeps; ++sweep) keep_lengths();
        }
        return true;
    }

    /// Between layers the side to which an edge goes back is known.
    void turn_by_layers(std::vector<EdgeCrossing>& crossings) const {
        if (layer_.empty()) return;
        for (EdgeCrossing& crossing : crossings) {
            const int own = surface_.vertex_owner[crossing.edge[0]], other = surface_.vertex_owner[crossing.triangle[0]];
            if (layer_[own] == layer_[other]) continue;
            const auto& [a, b, c] = crossing.triangle;
            const std::vector<Vec3>& x = mesh_.vertices;
            const double side = layer_[own] > layer_[other] ? outwards_[other] : -outwards_[other];
            crossing.retreat = side * (x[b] - x[a]).cross(x[c] - x[a]).normalized();
        }
    }

    std::vector<Vec3> places(bool gaps) const { return merged_.places(given_, gaps); }

    /// Vertices that have not moved keep the gaps that they had, unless that makes something cross.
    std::vector<Vec3> clear_places() const {
        std::vector<Vec3> with_gaps = places(true);
        const std::vector<Triangle> triangles(cloth_.triangles.begin(), cloth_.triangles.end());
        const ClothCertificate found =
            certify_cloth({.vertices = with_gaps, .triangles = triangles}, cloth_.stitches, cloth_.meeting);
        return found.crossing.empty() && found.touching.empty() ? with_gaps : places(false);
    }

    /// The pairs that cross or touch, by the rules of the check of the start (triangles at one stitch may): all cloth is searched
    /// now and then and when no pairs are left, otherwise cloth near the crossings found then.
    std::vector<IntersectingPair> find_pairs(int round) {
        if (round % rounds_between_searches != 0) {
            const std::vector<IntersectingPair> pairs = pairs_among(near_);
            if (!pairs.empty()) return pairs;
        }
        std::vector<int> all(cloth_.triangles.size());
        std::iota(all.begin(), all.end(), 0);
        const std::vector<IntersectingPair> pairs = pairs_among(all);
        const std::vector<bool> near = near_vertices(pairs, searched_rings);
        std::erase_if(all,
                      [&](int t) { return std::ranges::none_of(cloth_.triangles[t], [&](int v) { return near[number_[v]]; }); });
        near_ = std::move(all);
        return pairs;
    }

    /// The pairs among triangles with numbers as given.
    std::vector<IntersectingPair> pairs_among(const std::vector<int>& triangles) const {
        TriangleMesh part{.vertices = places(false), .triangles = {}};
        std::vector<int> cloth;
        for (const int t : triangles) {
            part.triangles.push_back(cloth_.triangles[t]);
            if (!cloth_.meeting.cloth.empty()) cloth.push_back(cloth_.meeting.cloth[t]);
        }
        ClothCertificate certificate = certify_cloth(part, cloth_.stitches, {cloth, cloth_.meeting.pairs});
        std::vector<IntersectingPair>& pairs = certificate.crossing;
        pairs.insert(pairs.end(), certificate.touching.begin(), certificate.touching.end());
        for (auto& [first, second] : pairs) {
            first = triangles[first];
            second = triangles[second];
        }
        return std::move(pairs);
    }

    std::vector<EdgeCrossing> crossings_of(const std::vector<IntersectingPair>& pairs) const {
        std::vector<IntersectingPair> merged;
        for (const auto& [first, second] : pairs) {
            const int one = merged_.triangle[first], other = merged_.triangle[second];
            if (one >= 0 && other >= 0) merged.push_back({one, other});
        }
        std::vector<EdgeCrossing> crossings = edge_crossings(surface_, merged, mesh_.vertices);
        turn_by_layers(crossings);
        return crossings;
    }

    /// Whether a vertex belongs to one of the pairs, or is at most `rings` edges from one that does.
    std::vector<bool> near_vertices(const std::vector<IntersectingPair>& pairs, int rings) const {
        std::vector<bool> near(mesh_.vertices.size(), false);
        for (const auto& [first, second] : pairs) {
            for (const int triangle : {first, second}) {
                for (const int v : cloth_.triangles[triangle]) near[number_[v]] = true;
            }
        }
        for (int ring = 0; ring < rings; ++ring) {
            const std::vector<bool> inner = near;
            for (const ClothSurface::Edge& edge : surface_.edges) {
                for (int k = 0; k < 2; ++k) near[edge.vertex[k]] = near[edge.vertex[k]] || inner[edge.vertex[1 - k]];
            }
        }
        return near;
    }

    /// Moves each vertex along the mean of the retreat vectors of its crossings.
    void move_back(const std::vector<EdgeCrossing>& crossings) {
        std::vector<Vec3> moves(mesh_.vertices.size(), Vec3::Zero());
        std::vector<double> weights(moves.size(), 0.0);
        for (const EdgeCrossing& crossing : crossings) {
            const double length = crossing.retreat.norm();
            if (!(length > 0.0)) continue;
            // The retreat vector is long where the edge lies flat: it becomes a direction, and is reduced where the curve would
            // hardly get shorter.
            const Vec3 share = crossing.retreat / std::hypot(length, min_retreat);
            const auto add = [&](int vertex, double weight, double sign) {
                moves[vertex] += sign * weight * share;
                weights[vertex] += weight;
            };
            add(crossing.edge[0], 1.0 - crossing.share, 1.0);
            add(crossing.edge[1], crossing.share, 1.0);
            for (int k = 0; k < 3; ++k) add(crossing.triangle[k], crossing.weight[k], -1.0);
        }
        for (std::size_t v = 0; v < moves.size(); ++v) {
            if (weights[v] > 0.0 && free_[v] > 0.0) mesh_.vertices[v] += reach_ / std::max(weights[v], 1.0) * moves[v];
        }
    }

    std::vector<IntersectingPair> of_one_layer(std::vector<IntersectingPair> pairs) const {
        const auto layer = [&](int triangle) { return cloth_.meeting.pairs->layer(cloth_.meeting.cloth[triangle]); };
        if (!layer_.empty()) std::erase_if(pairs, [&](const IntersectingPair& p) { return layer(p.first) != layer(p.second); });
        return pairs;
    }

    /// Moves crossing cloth, and cloth near it, half way to the mean of its neighbours: folds that hang on one vertex, or between
    /// two seams, have no shorter curve to go back to.
    void smooth(const std::vector<IntersectingPair>& pairs) {
        const std::vector<bool> near = near_vertices(pairs, smoothed_rings);
        const std::vector<Vec3> before = mesh_.vertices;
        for (std::size_t v = 0; v < near.size(); ++v) {
            if (!near[v] || free_[v] == 0.0) continue;
            Vec3 sum = Vec3::Zero();
            const auto neighbours = surface_.neighbours(static_cast<int>(v));
            for (const int other : neighbours) sum += before[other];
            mesh_.vertices[v] = 0.5 * (before[v] + sum / static_cast<double>(neighbours.size()));
        }
    }

    void keep_lengths() {
        for (const auto& [vertex, length] : bonds_) {
            Vec3 &a = mesh_.vertices[vertex[0]], &b = mesh_.vertices[vertex[1]];
            const double now = (b - a).norm(), max = length * (1.0 + bond_slack), min = length * (1.0 - bond_slack);
            if ((now >= min && now <= max) || !(now > 0.0)) continue;
            const double one = free_[vertex[0]], other = free_[vertex[1]];
            if (one + other == 0.0) continue;
            const Vec3 change = (now - std::clamp(now, min, max)) / (now * (one + other)) * (b - a);
            a += one * change;
            b -= other * change;
        }
        for (const auto& [stitch, length] : ties_) draw_together(stitch, length);
    }

    void draw_together(const Stitch& stitch, double length) {
        const Vec3 gap = across(stitch, mesh_.vertices);
        const double now = gap.norm();
        const std::array<int, 3> vertex{stitch.vertex, stitch.from, stitch.to};
        const std::array<double, 3> weight{1.0, stitch.share - 1.0, -stitch.share};
        double sum = 0.0;
        for (int k = 0; k < 3; ++k) sum += weight[k] * weight[k] * free_[vertex[k]];
        if (now <= length || sum == 0.0) return;
        for (int k = 0; k < 3; ++k) {
            mesh_.vertices[vertex[k]] -= weight[k] * free_[vertex[k]] * (now - length) / (now * sum) * gap;
        }
    }

    CrossedCloth cloth_;
    std::span<const Vec3> given_;
    MergedCloth merged_;
    TriangleMesh& mesh_ = merged_.mesh;
    const std::vector<int>& number_ = merged_.number;
    const std::vector<double>& free_ = merged_.free;
    ClothSurface surface_;          // it knows two triangles of an edge with more, which are enough for a direction
    std::vector<int> layer_;        // of each triangle of the mesh, where there are layers
    std::vector<double> outwards_;  // likewise: 1 or -1, whether it faces outside as it is wound
    std::vector<Bond> bonds_;
    std::vector<Tie> ties_;
    std::vector<int> near_;  // triangles as given near the crossings of the last search of all cloth
    double reach_ = 0.0;     // m, largest move of a vertex in a round
};

}  // namespace

std::optional<std::vector<Vec3>> untangle_cloth(const CrossedCloth& cloth, std::span<const Vec3> given) {
    const std::vector<Vec3> positions = joined_places(given, cloth.triangles);  // as in the check of the start
    // Sides slightly apart may be clear as they are and cross when they are drawn together: then all is repeated with them as
    // they are.
    std::optional<std::vector<Vec3>> apart = Rounds(cloth, positions, closed_stitch).run();
    return apart || cloth.stitches.empty() ? apart : Rounds(cloth, positions, 0.0).run();
}

}  // namespace percale
