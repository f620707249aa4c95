#pragma once

// CMake's targets define what a program links, so that a missing library is reported here and not by the linker.
#if defined(PERCALE_LINKS_ENGINE) && !defined(PERCALE_LINKS_COLLISION)
#error "percale::engine alone has no contact detector: link percale::fcl, percale::bullet or percale::brute_force, too"
#endif

#include <memory>

#include "percale/contact.h"

namespace percale {

/// Contact detectors that differ only in the tree that finds obstacle triangles near a box. All give the same contacts.
/// Each lives in its own library: percale::fcl, percale::bullet, percale::brute_force.
std::unique_ptr<ContactDetector> make_fcl_detector();
std::unique_ptr<ContactDetector> make_bullet_detector();
std::unique_ptr<ContactDetector> make_brute_force_detector();

}  // namespace percale
