#pragma once

#include "geometry/box.h"
#include "percale/saved_state.h"

namespace percale {

template <>
inline constexpr bool is_plain_state<Box> = sizeof(Box) == 2 * sizeof(Vec3);

/// A box in saved states.
template <class Archive, OfType<Box> Value>
void exchange(Archive& archive, Value& box) {
    archive(box.low, box.high);
}

}  // namespace percale
