#pragma once

#include <algorithm>

#include "percale/mesh.h"

namespace percale::scenes::test {

/// How far apart the images of the three axes are: 0 for the same turn, whatever the quaternion's sign.
inline double difference(const Rotation& a, const Rotation& b) {
    double largest = 0.0;
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
        largest = std::max(largest, (transform({.translation = Vec3::Zero(), .rotation = a}, axis) -
                                     transform({.translation = Vec3::Zero(), .rotation = b}, axis))
                                        .norm());
    return largest;
}

}  // namespace percale::scenes::test
