#pragma once

#include "forces/blocks.h"

namespace percale {

/// The product m u.
inline Vec3 block_times(const SymmetricBlock& m, const Vec3& u) {
    return {m[0] * u.x() + m[1] * u.y() + m[2] * u.z(), m[1] * u.x() + m[3] * u.y() + m[4] * u.z(),
            m[2] * u.x() + m[4] * u.y() + m[5] * u.z()};
}

}  // namespace percale
