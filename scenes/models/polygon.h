#pragma once

#include <optional>
#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale::scenes {

using Point2 = Eigen::Vector2d;

/// > 0 where a, b, c turn left: twice the area of the triangle, m^2.
double turn_left(const Point2& a, const Point2& b, const Point2& c);

/// The value that turn_left has to exceed for a triangle to have an area beside rounding, m^2.
double min_turn_of(const Point2& a, const Point2& b, const Point2& c);

/// The smallest angle of a triangle, rad.
double smallest_angle_of(const Point2& a, const Point2& b, const Point2& c);

/// The triangles of a simple polygon, counter-clockwise, by its points' numbers: corners are cut off, the best shaped first.
/// Nothing where it crosses or touches itself. The time grows at least with the square of its number of points.
std::optional<std::vector<Triangle>> cut_ears(std::span<const Point2> outline);

/// Polygons of a mesh file.
class PolygonList {
public:
    void reserve(std::size_t polygons) { ends_.reserve(polygons); }
    /// A corner of the polygon that is being read.
    void add_corner(int vertex) { corners_.push_back(vertex); }
    void end_polygon() { ends_.push_back(corners_.size()); }

    std::size_t size() const { return ends_.size(); }
    std::size_t corner_count() const { return corners_.size(); }
    std::span<const int> polygon(std::size_t k) const {
        const std::size_t start = k == 0 ? 0 : ends_[k - 1];
        return std::span(corners_).subspan(start, ends_[k] - start);
    }

private:
    std::vector<int> corners_;
    std::vector<std::size_t> ends_;
};

/// The triangles of a polygon in space, by the numbers of its corners (0, 1, ...): a fan from the first where it is one without a
/// fold, seen along the polygon's normal (Newell 1972: sum of x_k cross x_k+1), else ears. Where there are no ears either, as it
/// crosses or touches itself, and with more than 10,000 corners, a fan. Fewer than three corners give nothing.
std::vector<Triangle> polygon_triangles(std::span<const Vec3> corners);

/// The triangles of all polygons, by vertices.
std::vector<Triangle> triangles_of(const PolygonList& polygons, std::span<const Vec3> vertices);

/// Whether two lists are the triangles of the same polygons in the same order, which may be cut differently where their vertices
/// lie differently.
bool are_same_polygons(std::span<const Triangle> some, std::span<const Triangle> others);

}  // namespace percale::scenes
