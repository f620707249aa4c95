#pragma once

#include <array>
#include <string>

#include "pattern/pattern.h"

// What the readers of patterns share.
namespace percale::scenes {

/// Turns about x, then y, then z, degrees.
Rotation turned(const std::array<double, 3>& degrees);

/// The point halfway along an arc that lies `bulge` to the right of the straight way from a to b, as one goes.
Point2 arc_middle(const Point2& a, const Point2& b, double bulge);

/// Where a point of a panel is in the world: laid around its cylinder, then placed, m.
Vec3 placed_point(const Panel& panel, const Point2& point);

/// The panel seen in the mirror x = 0 of the world, under another name. Edge k is the image of edge k.
Panel mirrored(const Panel& panel, const std::string& name);

/// Moves each panel along its normal by a distance, m, away from the middle of all panels: room for what is worn below.
void move_apart(Pattern& pattern, double distance);

/// Where a side of a seam begins and ends, in the world.
std::array<Vec3, 2> side_ends(const Pattern& pattern, const std::vector<EdgeUse>& side);

/// Lets a side run the other way.
void reverse_side(std::vector<EdgeUse>& side);

/// Turns the second side of a seam around where its ends then lie nearer to those of the first.
void match_ends(const Pattern& pattern, PatternSeam& seam);

}  // namespace percale::scenes
