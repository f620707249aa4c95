#pragma once

#include <span>
#include <vector>

#include "pattern/pattern.h"

namespace percale::scenes {

/// Where an edge is at its own parameter t, 0 ... 1; an arc goes through its control point.
Point2 point_on(const Panel& panel, const PanelEdge& edge, double t);

/// The length of an edge, m.
double edge_length(const Panel& panel, const PanelEdge& edge);

/// The points at fractions of the arc length, ascending, 0 ... 1; 0 and 1 are the corners themselves.
std::vector<Point2> points_at(const Panel& panel, const PanelEdge& edge, std::span<const double> shares);

}  // namespace percale::scenes
