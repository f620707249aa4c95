#include "pattern/pattern_mesh.h"

#include <algorithm>
#include <cmath>

#include "common/text.h"
#include "meshes/obj_file.h"
#include "pattern/edge_stations.h"
#include "pattern/panel_curve.h"
#include "pattern/panel_mesh.h"
#include "pattern/pattern_parts.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

constexpr double shortest_edge = 1e-4, longest_edge = 1.0;  // m
constexpr double max_pattern_vertices = 2e6;
/// m, between the flat panels in uv.
constexpr double uv_gap = 0.05;

double signed_area(std::span<const Point2> outline) {
    double twice = 0.0;
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const Point2 &a = outline[k], &b = outline[(k + 1) % outline.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return 0.5 * twice;
}

/// The outline of a panel, and where each edge's stations begin in it.
struct Outline {
    std::vector<Point2> points;
    std::vector<int> edge_start;
};

Outline outline_of(const Panel& panel, const std::vector<std::vector<double>>& shares) {
    Outline outline;
    for (std::size_t e = 0; e < panel.edges.size(); ++e) {
        outline.edge_start.push_back(static_cast<int>(outline.points.size()));
        std::vector<Point2> points = points_at(panel, panel.edges[e], shares[e]);
        outline.points.insert(outline.points.end(), points.begin(), points.end() - 1);
    }
    return outline;
}

class PatternMesher {
public:
    PatternMesher(const Pattern& pattern, double edge_length)
        : pattern_(pattern), edge_length_(edge_length), stations_(divide_edges(pattern, edge_length)) {}

    PatternMesh mesh() {
        for (std::size_t p = 0; p < pattern_.panels.size(); ++p) add_panel(p);
        for (std::size_t s = 0; s < pattern_.seams.size(); ++s) add_seam(s);
        return std::move(result_);
    }

private:
    void add_panel(std::size_t number) {
        const Panel& panel = pattern_.panels[number];
        Outline outline = outline_of(panel, stations_.shares[number]);
        const double area = signed_area(outline.points);
        refuse_size(panel, std::abs(area));
        const bool clockwise = area < 0.0;
        const int outline_size = static_cast<int>(outline.points.size());
        if (clockwise) std::reverse(outline.points.begin(), outline.points.end());
        const PanelMesh flat = triangulated(panel, outline.points);
        PanelPart part{.name = panel.name,
                       .first_vertex = static_cast<int>(result_.mesh.vertices.size()),
                       .vertices = static_cast<int>(flat.vertices.size()),
                       .first_triangle = static_cast<int>(result_.mesh.triangles.size()),
                       .triangles = static_cast<int>(flat.triangles.size())};
        // The outline's points in its own order again.
        const bool turned_over = clockwise != panel.flipped;
        const auto own = [&](int vertex) { return clockwise && vertex < outline_size ? outline_size - 1 - vertex : vertex; };
        std::vector<Point2> points(flat.vertices.size());
        for (int v = 0; v < part.vertices; ++v) points[own(v)] = flat.vertices[v];
        for (const auto& [a, b, c] : flat.triangles) {
            const int first = part.first_vertex;
            result_.mesh.triangles.push_back(
                {first + own(a), first + own(turned_over ? c : b), first + own(turned_over ? b : c)});
        }
        add_vertices(panel, points);
        outlines_.push_back(std::move(outline));
        outline_sizes_.push_back(outline_size);
        result_.panels.push_back(part);
    }

    PanelMesh triangulated(const Panel& panel, const std::vector<Point2>& outline) const {
        try {
            return mesh_panel(outline, edge_length_);
        } catch (const SceneError& error) {
            throw SceneError(pattern_.file, "panel '" + panel.name + "': " + error.reason());
        }
    }

    void refuse_size(const Panel& panel, double area) const {
        const double vertices = area / (0.5 * std::sqrt(3.0) * edge_length_ * edge_length_);
        if (vertices + static_cast<double>(result_.mesh.vertices.size()) <= max_pattern_vertices) return;
        throw SceneError(pattern_.file, "panel '" + panel.name + "': with an edge length of " + short_number(edge_length_) +
                                            " m the mesh would have more than 2 million vertices");
    }

    void add_vertices(const Panel& panel, const std::vector<Point2>& points) {
        Point2 lowest = points[0], highest = points[0];
        for (const Point2& point : points) {
            lowest = lowest.cwiseMin(point);
            highest = highest.cwiseMax(point);
        }
        for (const Point2& point : points) {
            result_.mesh.vertices.push_back(placed_point(panel, point));
            result_.uv.push_back({point.x() - lowest.x() + next_u_, point.y()});
        }
        next_u_ += highest.x() - lowest.x() + uv_gap;
    }

    int vertex_at(const EdgeStations::Place& place) const {
        const int at = outlines_[place.panel].edge_start[place.edge] + place.station;
        return result_.panels[place.panel].first_vertex + at % outline_sizes_[place.panel];
    }

    void add_seam(std::size_t number) {
        const PatternSeam& seam = pattern_.seams[number];
        std::array<double, 2> length = {};
        for (int k = 0; k < 2; ++k) {
            for (const EdgeUse& use : seam.sides[k]) {
                const Panel& panel = pattern_.panels[use.panel];
                length[k] += scenes::edge_length(panel, panel.edges[use.edge]);
            }
        }
        SewnSeam sewn{.name = seam.name, .length = 0.5 * (length[0] + length[1]), .stitches = {}};
        for (const auto& [first, second] : stations_.sewn[number]) {
            const int i = vertex_at(first), j = vertex_at(second);
            // At the tip of a dart both sides have one vertex.
            if (i != j) sewn.stitches.push_back({i, j, j, 0.0});
        }
        result_.seams.push_back(std::move(sewn));
    }

    const Pattern& pattern_;
    double edge_length_;
    EdgeStations stations_;
    std::vector<Outline> outlines_;
    std::vector<int> outline_sizes_;
    double next_u_ = 0.0;
    PatternMesh result_;
};

}  // namespace

PatternMesh mesh_pattern(const Pattern& pattern, double edge_length) {
    if (!(edge_length >= shortest_edge && edge_length <= longest_edge)) {
        throw SceneError(pattern.file,
                         "edge length " + short_number(edge_length) + " m is outside the allowed range 0.0001 ... 1 m");
    }
    return PatternMesher(pattern, edge_length).mesh();
}

TexturedMesh textured_mesh(const PatternMesh& garment) {
    TexturedMesh textured{.mesh = garment.mesh, .uv = {}};
    for (const auto& [a, b, c] : garment.mesh.triangles) textured.uv.push_back({garment.uv[a], garment.uv[b], garment.uv[c]});
    return textured;
}

std::vector<Stitch> all_stitches(const PatternMesh& garment) {
    std::vector<Stitch> all;
    for (const SewnSeam& seam : garment.seams) all.insert(all.end(), seam.stitches.begin(), seam.stitches.end());
    return all;
}

std::string pattern_obj_text(const PatternMesh& garment) {
    std::string text;
    for (const Vec3& x : garment.mesh.vertices) {
        text += 'v';
        for (int k = 0; k < 3; ++k) text += ' ' + number_text(x[k]);
        text += '\n';
    }
    for (const Point2& uv : garment.uv) {
        text += "vt";
        for (int k = 0; k < 2; ++k) text += ' ' + number_text(uv[k]);
        text += '\n';
    }
    for (const PanelPart& part : garment.panels) {
        text += "g " + part.name + '\n';
        for (int t = part.first_triangle; t < part.first_triangle + part.triangles; ++t) {
            text += 'f';
            for (const int vertex : garment.mesh.triangles[t]) {
                const std::string number = std::to_string(vertex + 1);
                text += ' ' + number + '/' + number;
            }
            text += '\n';
        }
    }
    for (const SewnSeam& seam : garment.seams) {
        text += "# seam " + seam.name + '\n';
        for (const auto& [vertex, from, to, share] : seam.stitches) {
            text += "stitch " + std::to_string(vertex) + ' ' + std::to_string(from) + ' ' + std::to_string(to) + ' ' +
                    number_text(share) + '\n';
        }
    }
    return text;
}

}  // namespace percale::scenes
