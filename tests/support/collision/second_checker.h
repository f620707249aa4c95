#pragma once

#include <functional>

#include "scenes/run/run_scene.h"

namespace percale::test {

/// Pairs of triangles of a frame that meet: of cloth and obstacles, and of cloths that are certified against each other
/// or themselves.
using SecondChecker = std::function<long(const scenes::Frame&)>;

/// A checker by CGAL's boxes and exact predicates, independent of the certificate; empty where the tests were built without
/// CGAL. Triangles without area are left out, and so are pairs of one cloth that share an edge, unless they lie on each other.
SecondChecker cgal_checker();

}  // namespace percale::test
