#pragma once

#include <array>
#include <span>
#include <vector>

#include "models/polygon.h"

namespace percale::scenes {

/// A constrained Delaunay triangulation of the inside of a polygon, whose sides it keeps.
class Delaunay {
public:
    /// Triangulates a simple polygon, counter-clockwise. Throws SceneError where that is not possible.
    explicit Delaunay(std::span<const Point2> outline);

    /// Adds a point; false, and nothing is added, where it is not strictly inside.
    bool insert(const Point2& point);

    /// Moves the points that are not of the outline to the middle of what is around them, where no triangle turns over and the
    /// smallest angle there does not fall; then flips edges until all are Delaunay's again.
    void smooth();

    const std::vector<Point2>& points() const { return points_; }
    std::vector<Triangle> triangles() const;

private:
    /// Corners counter-clockwise; across the side from corner k to k + 1 lies triangle next[k], -1: the outline.
    struct Cell {
        std::array<int, 3> corner, next;
    };

    void clip_ears();
    void join_cells();
    void flip_all();
    bool flip(int cell, int side);
    int cell_at(const Point2& point) const;
    int walk_to(const Point2& point) const;
    void relink(int cell, int from, int to);
    std::vector<std::vector<int>> cells_around() const;
    double smallest_angle_around(std::span<const int> cells) const;

    std::size_t outline_size_;
    std::vector<Point2> points_;
    std::vector<Cell> cells_;
    int last_ = 0;                          // where the last point was found
    std::vector<std::array<int, 2>> open_;  // sides that may have to be flipped
};

}  // namespace percale::scenes
