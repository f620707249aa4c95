#pragma once

#include <array>

#include "percale/contact.h"

namespace percale::test {

/// A row 4 mm from what it touches, at a thickness of 5 mm and a friction of 0.3; `obstacle` -1: between cloths.
inline void add_row(const std::array<int, 4>& vertex, const std::array<double, 4>& weight, int obstacle, ContactRows& rows) {
    rows.vertex.push_back(vertex);
    rows.weight.push_back(weight);
    rows.direction.push_back(Vec3::UnitY());
    rows.obstacle_point.push_back(Vec3::Zero());
    rows.obstacle_displacement.push_back(Vec3::Zero());
    rows.distance.push_back(0.004);
    rows.thickness.push_back(0.005);
    rows.friction.push_back(0.3);
    rows.share.push_back(1.0);
    rows.obstacle.push_back(obstacle);
    rows.feature.push_back(0);
}

}  // namespace percale::test
