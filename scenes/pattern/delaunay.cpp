#include "pattern/delaunay.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "percale/error.h"

namespace percale::scenes {
namespace {

/// A bound relative to the terms of the determinant: points that are nearer to a common circle lie on it, so that flips end.
constexpr long double circle_rounding = 1e-13L;

/// Whether d lies inside the circle through a, b, c, which turn left.
bool in_circle(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
    const auto row = [&](const Point2& p) {
        const long double x = static_cast<long double>(p.x()) - d.x(), y = static_cast<long double>(p.y()) - d.y();
        return std::array<long double, 3>{x, y, x * x + y * y};
    };
    const auto [ax, ay, aa] = row(a);
    const auto [bx, by, bb] = row(b);
    const auto [cx, cy, cc] = row(c);
    const long double terms[3] = {aa * (bx * cy - by * cx), bb * (cx * ay - cy * ax), cc * (ax * by - ay * bx)};
    return terms[0] + terms[1] + terms[2] > circle_rounding * (std::abs(terms[0]) + std::abs(terms[1]) + std::abs(terms[2]));
}

}  // namespace

Delaunay::Delaunay(std::span<const Point2> outline) : outline_size_(outline.size()), points_(outline.begin(), outline.end()) {
    if (outline.size() < 3)
        throw SceneError("an outline has three points or more, this one has " + std::to_string(outline.size()));
    clip_ears();
    join_cells();
    for (int cell = 0; cell < static_cast<int>(cells_.size()); ++cell) {
        for (int side = 0; side < 3; ++side) open_.push_back({cell, side});
    }
    flip_all();
}

void Delaunay::clip_ears() {
    const std::optional<std::vector<Triangle>> ears = cut_ears(points_);
    if (!ears) throw SceneError("the outline crosses or touches itself");
    for (const Triangle& ear : *ears) cells_.push_back({{ear[0], ear[1], ear[2]}, {-1, -1, -1}});
}

void Delaunay::join_cells() {
    std::map<std::array<int, 2>, std::array<int, 2>> sides;
    for (int cell = 0; cell < static_cast<int>(cells_.size()); ++cell) {
        for (int side = 0; side < 3; ++side) {
            const int a = cells_[cell].corner[side], b = cells_[cell].corner[(side + 1) % 3];
            const auto other = sides.find({b, a});
            sides[{a, b}] = {cell, side};
            if (other == sides.end()) continue;
            cells_[cell].next[side] = other->second[0];
            cells_[other->second[0]].next[other->second[1]] = cell;
        }
    }
}

void Delaunay::relink(int cell, int from, int to) {
    if (cell < 0) return;
    for (int& next : cells_[cell].next) {
        if (next == from) {
            next = to;
            return;
        }
    }
}

/// Turns the side around between the other two corners, if the one across lies inside the cell's circle.
bool Delaunay::flip(int cell, int side) {
    const int other = cells_[cell].next[side];
    if (other < 0) return false;
    const Cell here = cells_[cell], there = cells_[other];
    const int back = static_cast<int>(std::find(there.next.begin(), there.next.end(), cell) - there.next.begin());
    const int a = here.corner[side], b = here.corner[(side + 1) % 3], c = here.corner[(side + 2) % 3];
    const int d = there.corner[(back + 2) % 3];
    if (!in_circle(points_[a], points_[b], points_[c], points_[d])) return false;
    if (turn_left(points_[a], points_[d], points_[c]) <= 0.0 || turn_left(points_[d], points_[b], points_[c]) <= 0.0)
        return false;
    const int bc = here.next[(side + 1) % 3], ca = here.next[(side + 2) % 3];
    const int ad = there.next[(back + 1) % 3], db = there.next[(back + 2) % 3];
    cells_[cell] = {{a, d, c}, {ad, other, ca}};
    cells_[other] = {{d, b, c}, {db, bc, cell}};
    relink(ad, other, cell);
    relink(bc, cell, other);
    for (const std::array<int, 2> next : {std::array{cell, 0}, {cell, 2}, {other, 0}, {other, 1}}) open_.push_back(next);
    return true;
}

void Delaunay::flip_all() {
    while (!open_.empty()) {
        const auto [cell, side] = open_.back();
        open_.pop_back();
        flip(cell, side);
    }
}

int Delaunay::walk_to(const Point2& point) const {
    int cell = last_;
    for (std::size_t steps = 0; steps < cells_.size(); ++steps) {
        int out = -1;
        for (int side = 0; side < 3 && out < 0; ++side) {
            const auto& corner = cells_[cell].corner;
            if (turn_left(points_[corner[side]], points_[corner[(side + 1) % 3]], point) < 0.0) out = side;
        }
        if (out < 0) return cell;
        cell = cells_[cell].next[out];
        if (cell < 0) return -1;
    }
    return -1;
}

/// The cell around a point; -1: none. If the walk runs into the outline, all cells are looked at.
int Delaunay::cell_at(const Point2& point) const {
    const int found = walk_to(point);
    if (found >= 0) return found;
    for (int cell = 0; cell < static_cast<int>(cells_.size()); ++cell) {
        const auto& [a, b, c] = cells_[cell].corner;
        const bool inside = turn_left(points_[a], points_[b], point) >= 0.0 && turn_left(points_[b], points_[c], point) >= 0.0 &&
                            turn_left(points_[c], points_[a], point) >= 0.0;
        if (inside) return cell;
    }
    return -1;
}

bool Delaunay::insert(const Point2& point) {
    const int cell = cell_at(point);
    if (cell < 0) return false;
    const Cell whole = cells_[cell];
    const auto [a, b, c] = whole.corner;
    // On a side, or so near it that the part there had no area.
    for (int side = 0; side < 3; ++side) {
        const Point2 &from = points_[whole.corner[side]], &to = points_[whole.corner[(side + 1) % 3]];
        if (turn_left(from, to, point) <= min_turn_of(points_[a], points_[b], points_[c])) return false;
    }
    const int added = static_cast<int>(points_.size()), second = static_cast<int>(cells_.size()), third = second + 1;
    points_.push_back(point);
    cells_[cell] = {{a, b, added}, {whole.next[0], second, third}};
    cells_.push_back({{b, c, added}, {whole.next[1], third, cell}});
    cells_.push_back({{c, a, added}, {whole.next[2], cell, second}});
    relink(whole.next[1], cell, second);
    relink(whole.next[2], cell, third);
    for (const int part : {cell, second, third}) open_.push_back({part, 0});
    flip_all();
    last_ = cell;
    return true;
}

std::vector<std::vector<int>> Delaunay::cells_around() const {
    std::vector<std::vector<int>> around(points_.size());
    for (int cell = 0; cell < static_cast<int>(cells_.size()); ++cell) {
        for (const int corner : cells_[cell].corner) around[corner].push_back(cell);
    }
    return around;
}

/// The smallest angle of the cells; -1 where one is turned over.
double Delaunay::smallest_angle_around(std::span<const int> cells) const {
    double smallest = std::numbers::pi;
    for (const int cell : cells) {
        const auto& [a, b, c] = cells_[cell].corner;
        if (turn_left(points_[a], points_[b], points_[c]) <= 0.0) return -1.0;
        smallest = std::min(smallest, smallest_angle_of(points_[a], points_[b], points_[c]));
    }
    return smallest;
}

void Delaunay::smooth() {
    const std::vector<std::vector<int>> around = cells_around();
    for (std::size_t v = outline_size_; v < points_.size(); ++v) {
        Point2 sum = Point2::Zero();
        double area = 0.0;
        for (const int cell : around[v]) {
            const auto& [a, b, c] = cells_[cell].corner;
            const double part = turn_left(points_[a], points_[b], points_[c]);
            sum += part / 3.0 * (points_[a] + points_[b] + points_[c]);
            area += part;
        }
        const Point2 before = points_[v];
        const double angle = smallest_angle_around(around[v]);
        points_[v] = sum / area;
        if (smallest_angle_around(around[v]) < angle) points_[v] = before;
    }
    for (int cell = 0; cell < static_cast<int>(cells_.size()); ++cell) {
        for (int side = 0; side < 3; ++side) open_.push_back({cell, side});
    }
    flip_all();
}

std::vector<Triangle> Delaunay::triangles() const {
    std::vector<Triangle> result;
    for (const Cell& cell : cells_) result.push_back({cell.corner[0], cell.corner[1], cell.corner[2]});
    return result;
}

}  // namespace percale::scenes
