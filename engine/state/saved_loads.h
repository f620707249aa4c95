#pragma once

#include <utility>
#include <vector>

#include "percale/contact_load.h"
#include "percale/saved_state.h"

namespace percale {

/// Forces of obstacles on vertices, as a saved state holds them.
struct SavedLoads {
    bool known = false;
    std::vector<ContactLoad> all;
};

template <class Archive, OfType<ContactLoad> Value>
void exchange(Archive& archive, Value& load) {
    archive(load.vertex, load.obstacle, load.normal, load.friction, load.cloth_point, load.obstacle_point);
}

template <class Archive, OfType<SavedLoads> Value>
void exchange(Archive& archive, Value& loads) {
    archive(loads.known, loads.all);
}

/// Whether each pair of an existing vertex and obstacle has at most one load, finite and in order.
inline bool are_loads_of(const SavedLoads& loads, int vertices, int obstacles) {
    std::pair<int, int> before{-1, -1};
    for (const ContactLoad& load : loads.all) {
        const std::pair<int, int> at{load.vertex, load.obstacle};
        const bool there = load.vertex >= 0 && load.vertex < vertices && load.obstacle >= 0 && load.obstacle < obstacles;
        if (!there || !(before < at) || !load.force().allFinite()) return false;
        if (!load.cloth_point.allFinite() || !load.obstacle_point.allFinite()) return false;
        before = at;
    }
    return loads.known || loads.all.empty();
}

}  // namespace percale
