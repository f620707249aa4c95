#pragma once

#include <memory>

#include "obstacle/obstacle_tree.h"
#include "percale/contact.h"

namespace percale {

/// The detector that all backends share: lists, exact distances, contact constraints and clamps on top of a backend's tree.
std::unique_ptr<ContactDetector> make_detector(TreeFactory make_tree);

}  // namespace percale
