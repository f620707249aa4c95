#pragma once

#include "percale/simulation.h"

namespace percale::test {

/// A sheet of 1 m with n x n vertices, `height` m above the origin, to fall on `body`; without a body it hangs from two corners.
Simulation make_sheet_scene(int n, const TriangleMesh* body, double height, const StepSettings& settings = {});

/// The bunny scan half a metre high, centred; no triangles where it is absent.
TriangleMesh bunny_scan();

}  // namespace percale::test
