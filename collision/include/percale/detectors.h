#pragma once

#include <memory>

#include "percale/contact.h"

namespace percale {

/// Contact detectors that differ only in the tree that finds obstacle triangles near a box. All give the same contacts.
/// Each lives in its own library: percale::fcl, percale::bullet, percale::brute_force.
std::unique_ptr<ContactDetector> make_fcl_detector();
std::unique_ptr<ContactDetector> make_bullet_detector();
std::unique_ptr<ContactDetector> make_brute_force_detector();

}  // namespace percale
