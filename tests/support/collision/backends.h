#pragma once

#include <memory>
#include <vector>

#include "collision/brute_force/brute_force_tree.h"
#include "percale/detectors.h"
#ifdef PERCALE_HAS_FCL
#include "collision/fcl/fcl_tree.h"
#endif
#ifdef PERCALE_HAS_BULLET
#include "collision/bullet/bullet_tree.h"
#endif

namespace percale::test {

struct Backend {
    const char* name;
    TreeFactory make_tree;
    std::unique_ptr<ContactDetector> (*make_detector)();
};

/// Every backend of this build, brute force first.
inline std::vector<Backend> backends() {
    return {
        {"brute_force", make_brute_force_tree, make_brute_force_detector},
#ifdef PERCALE_HAS_FCL
        {"fcl", make_fcl_tree, make_fcl_detector},
#endif
#ifdef PERCALE_HAS_BULLET
        {"bullet", make_bullet_tree, make_bullet_detector},
#endif
    };
}

}  // namespace percale::test
