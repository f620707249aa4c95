#pragma once

#include <array>

#include "percale/contact.h"

namespace percale::test {

/// A constraint at a distance of 4 mm, at a thickness of 5 mm and a friction of 0.3; `obstacle` -1: between cloths.
inline void add_constraint(const std::array<int, 4>& vertex, const std::array<double, 4>& weight, int obstacle,
                           ContactConstraints& constraints) {
    constraints.vertex.push_back(vertex);
    constraints.weight.push_back(weight);
    constraints.direction.push_back(Vec3::UnitY());
    constraints.obstacle_point.push_back(Vec3::Zero());
    constraints.obstacle_displacement.push_back(Vec3::Zero());
    constraints.distance.push_back(0.004);
    constraints.thickness.push_back(0.005);
    constraints.friction.push_back(0.3);
    constraints.mollifier.push_back(1.0);
    constraints.obstacle.push_back(obstacle);
    constraints.feature.push_back(0);
}

}  // namespace percale::test
