#include "pattern/panel_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pattern/delaunay.h"

namespace percale::scenes {
namespace {

/// In edge lengths: the distance that lattice points keep from the outline. Nearer ones make flat triangles there, farther ones
/// long ones.
constexpr double outline_distance = 0.65;
constexpr int smoothing_rounds = 12;

double square_distance(const Point2& point, const Point2& a, const Point2& b) {
    const double along = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (point - a - along * (b - a)).squaredNorm();
}

/// Sides of the outline, sorted into rows of equal height.
class SideRows {
public:
    SideRows(std::span<const Point2> outline, double height) : outline_(outline), height_(height), lowest_(outline[0].y()) {
        double highest = lowest_;
        for (const Point2& point : outline) {
            lowest_ = std::min(lowest_, point.y());
            highest = std::max(highest, point.y());
        }
        rows_.resize(static_cast<std::size_t>((highest - lowest_) / height) + 1);
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const auto [low, high] = std::minmax(outline[k].y(), outline[(k + 1) % outline.size()].y());
            for (std::size_t row = row_of(low); row <= row_of(high); ++row) rows_[row].push_back(k);
        }
    }

    /// Where a level line meets the outline, ascending: it is inside from the first to the second, and so on.
    std::vector<double> crossings(double y) const {
        std::vector<double> x;
        for (const std::size_t k : rows_[row_of(y)]) {
            const Point2 &a = outline_[k], &b = outline_[(k + 1) % outline_.size()];
            if ((a.y() <= y) != (b.y() <= y)) x.push_back(std::lerp(a.x(), b.x(), (y - a.y()) / (b.y() - a.y())));
        }
        std::sort(x.begin(), x.end());
        return x;
    }

    /// Whether all sides are farther from the point than that, at most a row's height.
    bool is_clear(const Point2& point, double distance) const {
        const std::size_t row = row_of(point.y());
        for (std::size_t r = row > 0 ? row - 1 : 0; r < std::min(row + 2, rows_.size()); ++r) {
            for (const std::size_t k : rows_[r]) {
                const Point2 &a = outline_[k], &b = outline_[(k + 1) % outline_.size()];
                if (std::min(a.x(), b.x()) > point.x() + distance || std::max(a.x(), b.x()) < point.x() - distance) continue;
                if (square_distance(point, a, b) < distance * distance) return false;
            }
        }
        return true;
    }

    double lowest() const { return lowest_; }
    double highest() const { return lowest_ + height_ * static_cast<double>(rows_.size()); }

private:
    std::size_t row_of(double y) const {
        const double row = std::floor((y - lowest_) / height_);
        return static_cast<std::size_t>(std::clamp(row, 0.0, static_cast<double>(rows_.size() - 1)));
    }

    std::span<const Point2> outline_;
    double height_, lowest_;
    std::vector<std::vector<std::size_t>> rows_;
};

/// Points of one row of the lattice between two crossings of the outline.
void add_row_points(const SideRows& rows, const std::array<double, 2>& between, const Point2& origin, double edge_length,
                    std::vector<Point2>& points) {
    for (double n = std::ceil((between[0] - origin.x()) / edge_length);; n += 1.0) {
        const Point2 point(origin.x() + n * edge_length, origin.y());
        if (point.x() >= between[1]) return;
        if (rows.is_clear(point, outline_distance * edge_length)) points.push_back(point);
    }
}

/// Points of an equilateral lattice inside, row by row.
std::vector<Point2> lattice_points(std::span<const Point2> outline, double edge_length) {
    const SideRows rows(outline, edge_length);
    const double height = 0.5 * std::numbers::sqrt3 * edge_length;
    std::vector<Point2> points;
    int row = 0;
    for (double y = rows.lowest() + 0.5 * height; y < rows.highest(); y += height, ++row) {
        const std::vector<double> x = rows.crossings(y);
        const Point2 origin(row % 2 == 0 ? 0.0 : 0.5 * edge_length, y);
        for (std::size_t k = 0; k + 1 < x.size(); k += 2) add_row_points(rows, {x[k], x[k + 1]}, origin, edge_length, points);
    }
    return points;
}

}  // namespace

PanelMesh mesh_panel(std::span<const Point2> outline, double edge_length) {
    Delaunay triangulation(outline);
    for (const Point2& point : lattice_points(outline, edge_length)) triangulation.insert(point);
    for (int round = 0; round < smoothing_rounds; ++round) triangulation.smooth();
    return {triangulation.points(), triangulation.triangles()};
}

double smallest_angle(const PanelMesh& mesh) {
    double smallest = mesh.triangles.empty() ? 0.0 : std::numbers::pi;
    for (const auto& [a, b, c] : mesh.triangles) {
        smallest = std::min(smallest, smallest_angle_of(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
    }
    return smallest;
}

}  // namespace percale::scenes
